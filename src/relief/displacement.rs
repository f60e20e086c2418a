//! How far a view ray moves along the texture on its way down through the relief.

use crate::simd::PixelLanes;

/// Steepest view slope: rays closer to the surface than one unit of depth in 64 along it are traced
/// at that slope, so that the length of any walk over the relief is bounded.
pub const MAX_SLOPE: f32 = 64.0;

/// How far the view ray moves along the texture, in repeats, down to the deepest relief.
///
/// A surface seen from behind shows its relief just as deep on its other side.
pub fn displacement(view: &[PixelLanes; 3], relief_depth: f32) -> [PixelLanes; 2] {
    let [alpha, beta, gamma] = *view;
    let along = (alpha * alpha + beta * beta).sqrt();
    // A ray along the surface has gamma 0; the least value keeps the division finite where the ray
    // is 0 altogether.
    let gamma = gamma.abs().max(along * (1.0 / MAX_SLOPE)).max(PixelLanes::splat(1e-30));
    let scale = PixelLanes::splat(relief_depth) / gamma;
    [finite(alpha * scale), finite(beta * scale)]
}

/// The lanes, with 0 in place of what is not a finite number.
pub fn finite(lanes: PixelLanes) -> PixelLanes {
    lanes.is_finite().select(lanes, PixelLanes::ZERO)
}
