//! Trilinear look-ups of eight pixels at once, to the bits of [`isotropic::trilinear`](super::isotropic::trilinear).
//!
//! Neighbouring texels of a row lie next to each other, so a pixel's two by two texels of a level are two short loads a
//! plane; levels and places may differ from pixel to pixel. Lanes are pixels.

use super::footprint::shortened;
use super::{Differences, isotropic};
use crate::simd::{PixelLanes, high_half, i32x8, low_half, u32x8};
use crate::texture::Surface;

/// Farthest texel from the pattern's first: numbers up to there, and their neighbours, fit 32 bits.
const FARTHEST: f32 = (1 << 30) as f32;

/// The mean colours of eight pixels at `place` (repeats, within 1e6) whose footprints are `size` base texels long.
#[must_use]
pub fn colors(surface: &Surface, place: [PixelLanes; 2], size: PixelLanes) -> [PixelLanes; 3] {
    let last = surface.levels.len() - 1;
    let (mut levels, mut blends) = ([[0_usize; 8]; 2], [0.0_f32; 8]);
    for (lane, &size) in size.as_array().iter().enumerate() {
        let (level, blend) = isotropic::level_of_size(size);
        levels[0][lane] = level.min(last);
        levels[1][lane] = (level + 1).min(last);
        blends[lane] = if level >= last { 0.0 } else { blend };
    }
    let fine = bilinear(surface, &levels[0], place);
    if blends == [0.0; 8] {
        return fine;
    }
    let coarse = bilinear(surface, &levels[1], place);
    let blend = PixelLanes::new(blends);
    [0, 1, 2].map(|c| fine[c] + (coarse[c] - fine[c]) * blend)
}

/// The longer derivatives of eight footprints in base texels; derivatives beyond 16 repeats are shortened.
#[must_use]
#[inline]
pub fn longest_side(surface: &Surface, differences: &Differences) -> PixelLanes {
    let texels = surface.texels_per_repeat(0);
    let squared = |derivative: [PixelLanes; 2]| {
        let [u, v] = shortened(derivative);
        let (u, v) = (u * texels[0], v * texels[1]);
        u * u + v * v
    };
    squared(differences.dx).fast_max(squared(differences.dy)).sqrt()
}

fn bilinear(surface: &Surface, levels: &[usize; 8], place: [PixelLanes; 2]) -> [PixelLanes; 3] {
    let mut sizes = [[0_i32; 8]; 2];
    for (lane, &level) in levels.iter().enumerate() {
        let level = &surface.levels[level];
        (sizes[0][lane], sizes[1][lane]) = (level.width as i32, level.height as i32);
    }
    let repeats = surface.repeats_stored as f32;
    let at: [PixelLanes; 2] = std::array::from_fn(|axis| {
        let texels_per_repeat = PixelLanes::from_i32x8(i32x8::new(sizes[axis])) / repeats;
        place[axis] * texels_per_repeat - 0.5
    });
    let floors = at.map(PixelLanes::floor);
    let [fx, fy] = [at[0] - floors[0], at[1] - floors[1]];
    let bound = PixelLanes::splat(FARTHEST);
    let [x, y] = floors.map(|floor| floor.fast_max(-bound).fast_min(bound).fast_trunc_int().to_array());
    // Two by two texels, row by row, of two planes.
    let mut words = [[[0_u32; 8]; 4]; 2];
    for lane in 0..8 {
        let level = &surface.levels[levels[lane]];
        let stride = level.stride();
        let start = level.run_start(x[lane]);
        for row in 0..2 {
            let run = &level.row(y[lane] + row as i32)[start..start + stride + 2];
            for plane in 0..2 {
                words[plane][2 * row][lane] = run[plane * stride];
                words[plane][2 * row + 1][lane] = run[plane * stride + 1];
            }
        }
    }
    let [red_green, blue] = words.map(|words| words.map(u32x8::new));
    let mix = |texels: [PixelLanes; 4]| {
        let [a, b, c, d] = texels;
        let (above, below) = (a + (b - a) * fx, c + (d - c) * fx);
        above + (below - above) * fy
    };
    [mix(red_green.map(low_half)), mix(red_green.map(high_half)), mix(blue.map(low_half))]
}
