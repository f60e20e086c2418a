//! Common practice, to compare with: parallax occlusion mapping with mip levels (Tatarchuk 2006).
//!
//! `samples` rays a pixel on a rotated grid over the pixel's square. Each takes 32 linear steps down the relief, then one
//! secant step; heights and colour are trilinear at the level that 16x anisotropic filtering takes: the shorter side of
//! the footprint, or a sixteenth of the longer if that is more, each shrunk by the density of the samples.

use super::{Filtered, Footprint, isotropic};
use crate::texture::Surface;

/// Linear steps from the polygon down to the deepest relief.
const NUM_STEPS: u16 = 32;

/// Greatest anisotropy.
const MAX_ANISOTROPY: f32 = 16.0;

/// Offsets from the pixel's centre, in pixels, of `num` samples: a lattice, turned by the golden ratio.
#[must_use]
pub fn offsets(num: u32) -> Vec<[f32; 2]> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let place = |i: u32| {
        let golden = f64::from(i) * GOLDEN + 0.5;
        [((f64::from(i) + 0.5) / f64::from(num) - 0.5) as f32, (golden - golden.floor() - 0.5) as f32]
    };
    (0..num).map(place).collect()
}

/// Base texels per texel of the level that a footprint needs with so many samples a pixel.
#[must_use]
pub fn texel_size(surface: &Surface, footprint: &Footprint, num_samples: u32) -> f32 {
    let texels = surface.texels_per_repeat(0);
    let length = |d: [f32; 2]| ((d[0] * texels[0]).powi(2) + (d[1] * texels[1]).powi(2)).sqrt();
    let (x, y) = (length(footprint.dx), length(footprint.dy));
    x.min(y).max(x.max(y) / MAX_ANISOTROPY) / (num_samples as f32).sqrt()
}

/// The texel that a ray from `base` along `displacement` (repeats down to the deepest relief) finds.
#[must_use]
pub fn trace(surface: &Surface, base: [f32; 2], displacement: [f32; 2], size: f32) -> Filtered {
    let place = |depth: f32| [base[0] + displacement[0] * depth, base[1] + displacement[1] * depth];
    let depth_of = |depth: f32| 1.0 - height(surface, place(depth), size);
    let mut above = 0.0;
    let mut gap_above = depth_of(0.0);
    let mut hit = 0.0;
    if gap_above > 0.0 {
        for i in 1..=NUM_STEPS {
            let depth = f32::from(i) / f32::from(NUM_STEPS);
            let gap = depth_of(depth) - depth;
            if gap <= 0.0 {
                hit = above + (depth - above) * gap_above / (gap_above - gap);
                break;
            }
            (above, gap_above, hit) = (depth, gap, depth);
        }
    }
    isotropic::trilinear(surface, place(hit), size)
}

fn height(surface: &Surface, place: [f32; 2], size: f32) -> f32 {
    let (level, blend) = isotropic::level_of_size(size);
    let last = surface.levels.len() - 1;
    let fine = bilinear_height(surface, level.min(last), place);
    if blend == 0.0 || level >= last {
        fine
    } else {
        fine + (bilinear_height(surface, level + 1, place) - fine) * blend
    }
}

fn bilinear_height(surface: &Surface, level: usize, place: [f32; 2]) -> f32 {
    let texels = surface.texels_per_repeat(level);
    let level = &surface.levels[level];
    let [u, v] = [place[0] * texels[0] - 0.5, place[1] * texels[1] - 0.5];
    let (x, y) = (u.floor(), v.floor());
    let at = |i: i32, j: i32| level.height_at(x as i32 + i, y as i32 + j);
    let row = |j: i32| at(0, j) + (at(1, j) - at(0, j)) * (u - x);
    row(0) + (row(1) - row(0)) * (v - y)
}
