//! Pixels whose rays go elsewhere than a sweep takes them to go: where a mesh bends unevenly, and where
//! its texture goes on in other coordinates.
//!
//! ```text
//!   eye o__
//!          --__      the sweep goes on in the texture of the triangle by which the ray came in
//!   __________-\_  .
//!    triangle A \ \_        the ray is in triangle B by then, which bends by more, or has
//!                \   \_      its texture from elsewhere
//!                 B
//! ```

use super::ground::Ground;
use super::outlines::Outlines;
use crate::footprint::Footprints;
use crate::raster::QuadPair;
use crate::relief::SEEN_DEPTH;
use crate::shell::{Course, Met, ReliefHit};
use crate::simd::PixelLanes;

/// How far from where it is looked for a ray may hit, in pixels or in texels, whichever is more. A model
/// of 5856 triangles in bricks, 1200x900, has 42 dB with 0.25, 39 with 0.5 and 36 with 1, for 4.9, 4.2
/// and 2.6 times the time of sweeps alone, which have 29.
const MOST_STRAY: f32 = 0.25;

/// The rays of a quad, in pixels from its middle: one there, and where there may be breaks its corners.
const RAYS: [[f32; 2]; 5] = [[0.0; 2], [1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];

/// How much farther from there a corner's ray may hit: displacements are not linear over the quad. What
/// is beyond a break is farther.
const CORNER: f32 = 12.0;

/// Bits of the covered pixels of two quads that stray, whose displacements have the bow.
pub(super) fn strays(
    (outlines, ground): (&Outlines, &Ground),
    pair: &QuadPair,
    footprints: &Footprints,
    bow: &[PixelLanes; 2],
) -> u8 {
    let quads = (0..2).filter(|quad| footprints.covered >> (4 * quad) & 0xf != 0);
    let stray = quads.filter(|quad| {
        let triangle = pair.planes[*quad].triangle;
        let middle = pair.pixel(4 * quad).map(|c| f64::from(c) + 1.0);
        let rays = match outlines.course(triangle, middle) {
            Course::Told => return false,
            Course::Bent => 1,
            Course::Broken => RAYS.len(),
        };
        RAYS[..rays].iter().any(|[dx, dy]| {
            let place = [middle[0] + f64::from(*dx), middle[1] + f64::from(*dy)];
            match outlines.met(triangle, place) {
                Met::Polygon => false,
                // Beside the middle that is the end of the mesh.
                Met::Nothing(_) => [*dx, *dy] == RAYS[0],
                Met::Relief(hit) => is_far(ground, (footprints, bow), *quad, ([*dx, *dy], &hit)),
            }
        })
    });
    stray.fold(0, |bits, quad| bits | 0xf << (4 * quad)) & footprints.covered
}

/// Whether what a ray near the middle of a quad hits is far from where a sweep looks for what is seen
/// at its depth.
fn is_far(
    ground: &Ground,
    (footprints, bow): (&Footprints, &[PixelLanes; 2]),
    quad: usize,
    (at, hit): ([f32; 2], &ReliefHit),
) -> bool {
    let mean = |of: &[PixelLanes; 2]| {
        [0, 1].map(|i| of[i].as_array()[4 * quad..][..4].iter().sum::<f32>() * 0.25)
    };
    let Footprints { base, displacement, dx, dy, .. } = footprints;
    let [base, displacement, bow, dx, dy] = [base, displacement, bow, dx, dy].map(mean);
    let (uv, depth) = (hit.place.uv.map(|c| c as f32), hit.place.depth as f32);
    // Whole repeats are the same place.
    let [du, dv] = [0, 1].map(|i| {
        let base = base[i] + dx[i] * at[0] + dy[i] * at[1];
        let apart = uv[i] - base - depth * (displacement[i] + bow[i] * (depth - SEEN_DEPTH));
        apart - apart.round()
    });
    let [x, y] = [du * dy[1] - dv * dy[0], dx[0] * dv - dx[1] * du];
    let area = dx[0] * dy[1] - dx[1] * dy[0];
    let [across, along] = ground.prepared.surface().base().in_texels([du, dv]);
    let most = if at == RAYS[0] { MOST_STRAY } else { MOST_STRAY * CORNER }.powi(2);
    x * x + y * y > most * (area * area) && across * across + along * along > most
}
