//! Common practice, to compare with: parallax occlusion mapping with mip levels (Tatarchuk 2006).
//!
//! `samples` rays a pixel on a rotated grid over the pixel's square. Each takes 32 linear steps
//! down the relief, then one secant step; heights and colour are trilinear at the level that 16x
//! anisotropic filtering takes: the shorter side of the footprint, or a sixteenth of the longer if
//! that is more, each shrunk by the density of the samples.

use super::points;
use crate::footprint::{Footprint, levels};
use crate::texture::{Level, Surface, Texel};

/// Linear steps from the polygon down to the deepest relief.
const NUM_STEPS: u16 = 32;

/// Offsets from the pixel's centre, in pixels, of `num` samples: a lattice, turned by the golden
/// ratio.
pub(super) fn offsets(num: u32) -> Vec<[f32; 2]> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let place = |i: u32| {
        let golden = f64::from(i) * GOLDEN + 0.5;
        [
            ((f64::from(i) + 0.5) / f64::from(num) - 0.5) as f32,
            (golden - golden.floor() - 0.5) as f32,
        ]
    };
    (0..num).map(place).collect()
}

/// The texel that the ray of a sample, one of so many a pixel, finds.
pub(super) fn trace(surface: &Surface, footprint: &Footprint, num_samples: u32) -> Texel {
    let Footprint { base, displacement, .. } = *footprint;
    let size = levels::parallax_size(surface.base(), footprint, num_samples);
    let place = |depth: f32| [base[0] + displacement[0] * depth, base[1] + displacement[1] * depth];
    let depth_of = |depth: f32| 1.0 - height(surface, place(depth), size);
    // Step down until the ray is under the relief.
    let mut above = 0.0;
    let mut gap_above = depth_of(0.0);
    let mut hit = 0.0;
    if gap_above > 0.0 {
        for i in 1..=NUM_STEPS {
            let depth = f32::from(i) / f32::from(NUM_STEPS);
            let gap = depth_of(depth) - depth;
            if gap <= 0.0 {
                // Take the gap for linear between the last two depths: a secant step.
                hit = above + (depth - above) * gap_above / (gap_above - gap);
                break;
            }
            (above, gap_above, hit) = (depth, gap, depth);
        }
    }
    points::trilinear(surface, place(hit), size)
}

fn height(surface: &Surface, place: [f32; 2], size: f32) -> f32 {
    let (level, blend) = levels::of_size(size);
    let last = surface.last_level();
    let fine = bilinear_height(&surface.levels()[level.min(last)], place);
    if blend == 0.0 || level >= last {
        return fine;
    }
    fine + (bilinear_height(&surface.levels()[level + 1], place) - fine) * blend
}

fn bilinear_height(level: &Level, place: [f32; 2]) -> f32 {
    let [u, v] = level.in_texels(place).map(|c| c - 0.5);
    let (x, y) = (u.floor(), v.floor());
    let at = |i: i32, j: i32| level.height_at(x as i32 + i, y as i32 + j);
    let row = |j: i32| at(0, j) + (at(1, j) - at(0, j)) * (u - x);
    row(0) + (row(1) - row(0)) * (v - y)
}
