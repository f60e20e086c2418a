//! Trilinear look-ups of eight pixels at once, to the bits of [`isotropic::trilinear`](super::isotropic::trilinear).
//!
//! Neighbouring texels of a row lie next to each other, so a pixel's two by two texels of a level are two short loads a
//! plane; levels and places may differ from pixel to pixel. Lanes are pixels.

use super::Differences;
use super::corners::{Corners, corners};
use super::footprint::shortened;
use crate::simd::{LineLanes, PixelLanes, high_halves, i32x8, join, lanes, low_halves, mask, split, u32x16};
use crate::texture::Surface;

/// Farthest texel from the pattern's first: numbers up to there, and their neighbours, fit 32 bits.
const FARTHEST: f32 = (1 << 30) as f32;

/// The mean colours of eight pixels at `place` (repeats, within 1e6) whose footprints are `size` base texels long.
#[must_use]
#[inline]
pub fn colors(surface: &Surface, place: [PixelLanes; 2], size: PixelLanes) -> [PixelLanes; 3] {
    let last = surface.levels.len() - 1;
    let (levels, blend) = levels_of_sizes(size, last);
    let (mut fine, mut coarse) = ([PixelLanes::ZERO; 3], [PixelLanes::ZERO; 3]);
    // Most neighbours lie between the same two levels.
    let [first, end] = [i32::min, i32::max]
        .map(|choose| levels.as_array().iter().copied().fold(levels.as_array()[0], choose) as usize);
    for index in first..=last.min(end + 1) {
        let at = |index: usize| lanes(levels.simd_eq(i32x8::splat(index as i32)));
        let is_fine = at(index);
        let is_coarse = at(index.wrapping_sub(1)) & blend.simd_gt(PixelLanes::ZERO);
        if (is_fine | is_coarse).any() {
            let found = bilinear(surface, index, place);
            fine = [0, 1, 2].map(|c| is_fine.select(found[c], fine[c]));
            coarse = [0, 1, 2].map(|c| is_coarse.select(found[c], coarse[c]));
        }
    }
    [0, 1, 2].map(|c| fine[c] + (coarse[c] - fine[c]) * blend)
}

/// [`isotropic::level_of_size`](super::isotropic::level_of_size) of eight sizes; none is beyond the last level.
#[inline]
fn levels_of_sizes(size: PixelLanes, last: usize) -> (i32x8, PixelLanes) {
    let bits: i32x8 = mask(size);
    let is_large = mask(size.simd_gt(PixelLanes::ONE));
    let level = ((bits >> 23_i32) - 127) & is_large;
    let mantissa = lanes(bits & i32x8::splat(0x007f_ffff) | i32x8::splat(0x3f80_0000)) - 1.0;
    let last = i32x8::splat(last as i32);
    (level.min(last), mantissa & lanes(is_large & level.simd_lt(last)))
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

/// The four texels of a level around each place, interpolated.
#[inline]
fn bilinear(surface: &Surface, index: usize, place: [PixelLanes; 2]) -> [PixelLanes; 3] {
    let (level, texels) = (&surface.levels[index], surface.texels_per_repeat(index));
    let at = [place[0] * texels[0] - 0.5, place[1] * texels[1] - 0.5];
    let floors = at.map(PixelLanes::floor);
    let [fx, fy] = [at[0] - floors[0], at[1] - floors[1]];
    let bound = PixelLanes::splat(FARTHEST);
    let [x, y] = floors.map(|floor| floor.fast_max(-bound).fast_min(bound).fast_trunc_int());
    let [red_green, blue] = corners(level, x, y);
    let fy = join([fy, fy]);
    let mix = |channel: fn(u32x16) -> LineLanes, Corners { above, below }: Corners| {
        let [above, below] = [channel(above), channel(below)];
        let [left, right] = split(above + (below - above) * fy);
        left + (right - left) * fx
    };
    [mix(low_halves, red_green), mix(high_halves, red_green), mix(low_halves, blue)]
}
