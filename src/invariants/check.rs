//! What checks say.

/// What a check says: nothing, or what broke.
pub type Checked = Result<(), String>;

/// `Ok` where the claim holds, else what `message` says.
pub(super) fn ensure(holds: bool, message: impl FnOnce() -> String) -> Checked {
    if holds { Ok(()) } else { Err(message()) }
}

/// The largest difference of two colours.
pub(super) fn difference(a: [f32; 3], b: [f32; 3]) -> f32 {
    (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max)
}
