//! How far a view ray goes, and moves along the texture, on its way down through the relief.

use crate::simd::PixelLanes;

/// Steepest view slope: rays closer to the surface than one unit of depth in 64 along it are traced
/// at that slope, so that the length of any walk over the relief is bounded.
pub const MAX_SLOPE: f32 = 64.0;

/// How far the view ray moves along the texture, in repeats, down to the deepest relief.
///
/// A surface seen from behind shows its relief just as deep on its other side.
pub fn displacement(view: &[PixelLanes; 3], relief_depth: f32) -> [PixelLanes; 2] {
    let [alpha, beta, _] = *view;
    let stretch = stretch(view, relief_depth);
    [finite(alpha * stretch), finite(beta * stretch)]
}

/// How far the view ray goes on behind the polygon down to the deepest relief, in lengths of its
/// way from the eye to the polygon.
///
/// ```text
///   eye o
///       |\
///   w   | \  ray R: gamma repeats down on its way to the polygon
///       |  \
///   ----+---b----------------  polygon
///            \
///             q  hit at depth t: t S repeats further down, which is t S / gamma of R
/// ```
///
/// So the hit is at `eye + R (1 + t S / gamma)`, and, since the distance along the view is linear
/// on a ray, `w (1 + t S / gamma)` far away; where rays are parallel `R` is their direction, and the hit
/// `w + t S / gamma` far away. Rays that are traced at [`MAX_SLOPE`] have the
/// `gamma` of that slope: the hit is then where the view ray is over the same place of the texture.
pub fn stretch(view: &[PixelLanes; 3], relief_depth: f32) -> PixelLanes {
    let [alpha, beta, gamma] = *view;
    let along = (alpha * alpha + beta * beta).sqrt();
    // A ray along the surface has gamma 0; the least value keeps the division finite where the ray
    // is 0 altogether.
    let gamma = gamma.abs().max(along * (1.0 / MAX_SLOPE)).max(PixelLanes::splat(1e-30));
    PixelLanes::splat(relief_depth) / gamma
}

/// The lanes, with 0 in place of what is not a finite number.
pub fn finite(lanes: PixelLanes) -> PixelLanes {
    lanes.is_finite().select(lanes, PixelLanes::ZERO)
}
