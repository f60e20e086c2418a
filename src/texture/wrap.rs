//! What lies beyond the edge of a texture.

use crate::simd::i32x16;

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

/// Repeats from the origin beyond which a clamped texture is taken for that far: no footprint
/// reaches back from there.
const FAR_BEYOND_EDGE: f32 = 1024.0;

/// A place in repeats with the same texels around it, so near the origin that texels can be told
/// apart in f32, which those of a large texture cannot at 10,000 repeats.
#[inline(always)]
pub(crate) fn near_origin(place: [f32; 2], wrap: Wrap) -> [f32; 2] {
    place.map(|c| match wrap {
        Wrap::Clamp => c.clamp(-FAR_BEYOND_EDGE, FAR_BEYOND_EDGE),
        // Exact: the whole part is a whole number, and what is left has digits to spare.
        Wrap::Repeat | Wrap::Mirror => c - 2.0 * (0.5 * c).floor(),
    })
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

/// [`wrap_index`] of sixteen places.
#[inline(always)]
pub(crate) fn wrap_indices(wrap: Wrap, i: i32x16, n: usize) -> i32x16 {
    let last = i32x16::splat(n as i32 - 1);
    match wrap {
        Wrap::Clamp => i.max(i32x16::ZERO).min(last),
        Wrap::Repeat | Wrap::Mirror if n & (n - 1) == 0 => i & last,
        Wrap::Repeat | Wrap::Mirror => i32x16::new(i.to_array().map(|i| i.rem_euclid(n as i32))),
    }
}
