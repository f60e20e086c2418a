//! What lies beyond the edge of a texture.

/// What lies beyond the edge of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The texture again.
    #[default]
    Repeat,
    /// The texture mirrored, then again.
    Mirror,
    /// The texels of the edge.
    Clamp,
}

/// The stored index of place `i` of an endless row of period `n`. A mirrored pattern is stored
/// whole, so it repeats.
#[inline(always)]
pub(crate) fn wrap_index(wrap: Wrap, i: i32, n: usize) -> usize {
    let n = n as i32;
    match wrap {
        Wrap::Clamp => i.clamp(0, n - 1) as usize,
        // A power of two, the usual size, needs no division.
        Wrap::Repeat | Wrap::Mirror if n & (n - 1) == 0 => (i & (n - 1)) as usize,
        Wrap::Repeat | Wrap::Mirror => i.rem_euclid(n) as usize,
    }
}
