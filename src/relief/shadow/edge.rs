//! Where the edge of a shadow lies on the relief, within texels and along walls.
//!
//! The last light that passes over all that lies before a texel meets its column at a height: what
//! of the relief rises above it is lit. Between texels both the relief and that height are linear,
//! so the shadow ends where they cross, however high the wall is that it ends on:
//!
//! ```text
//!   \  light                 i+1 ______
//!    \                          |         the relief rises from i to i+1, and out of the shadow at
//!   __\ i-1                     |  lit    the cross
//!      |\                       x
//!      | \                   __-|
//!      |  \  _______________/   |
//!      |___\/___________________| i  dark
//! ```
//!
//! Behind a texel that is lit, light must pass over the texel itself, so that height jumps up to it:
//! the way to the texel is lit from the cross on, the way on from it is all dark if the next texel
//! lies below the light. A texel has one number for both ways. With `a` for how far it lies above the
//! light, and `-p` and `-q` for the places before and after it, the lit part of the first way is
//! `f = a / (a + p)`. Any `x` in place of `a` makes `x / (x + p)` and `x / (x + q)` of the two ways,
//! together as much if
//!
//! ```text
//! (2 - f) x^2 + (1 - f) (p + q) x = f p q
//! ```
//!
//! Where the first way is a wall its own edge counts: it is seen from above, the way behind is not.

use super::share::steepness;
use crate::simd::TexelLanes;

/// Least length, in rows, that is divided by.
const LEAST: f32 = 1e-6;

/// How wide an edge is at least, as a share of the rise from a texel to its neighbours: it is not
/// known better than that. Measured, floors under low suns: 0.1 to 0.6 are within 0.3 dB.
const SOFTNESS: f32 = 0.3;

/// How far texels lie above the latest light: all in rows, as places on its way. `before` and `after`
/// are those on the light's line before and behind texels, `rise` is from the one before, in texels.
#[inline(always)]
pub(super) fn above(
    latest: TexelLanes,
    [before, here, after]: [TexelLanes; 3],
    rise: TexelLanes,
) -> TexelLanes {
    let latest = latest.fast_max(before);
    let (above, below, drop) = (here - latest, latest - before, here - after);
    let lit = above / (above + below).fast_max(TexelLanes::splat(LEAST));
    let (a, b, c) = (2.0 - lit, (1.0 - lit) * (below + drop), lit * below * drop);
    let root = ((b * b + a * c * 4.0).fast_max(TexelLanes::ZERO).sqrt() - b) / (a + a);
    let shared = root + (above - root) * steepness(rise);
    let is_edge = above.simd_gt(TexelLanes::ZERO) & drop.simd_gt(TexelLanes::ZERO);
    is_edge.select(shared, above)
}

/// How wide edges are at least, by the heights of texels and of their neighbours.
#[inline(always)]
pub(super) fn least_width(height: TexelLanes, neighbours: [TexelLanes; 4]) -> TexelLanes {
    let rise = |most: TexelLanes, neighbour: TexelLanes| most.fast_max((neighbour - height).abs());
    neighbours.into_iter().fold(TexelLanes::ZERO, rise) * SOFTNESS
}
