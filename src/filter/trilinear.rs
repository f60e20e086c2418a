//! Trilinear look-ups of eight pixels at once, to the bits of [`isotropic::trilinear`](super::isotropic::trilinear).
//!
//! Levels and places may differ from pixel to pixel. Lanes are pixels.

use super::corners::{Corners, corners};
use super::{Differences, FARTHEST};
use crate::simd::{LineLanes, PixelLanes, high_halves, i32x8, join, lanes, low_halves, mask, split, u32x16};
use crate::texture::{Level, Surface};

/// Eight places in a level's texels.
#[derive(Clone, Copy)]
struct Spot {
    /// The texel to the upper left.
    corner: [i32x8; 2],
    /// How far a place is from its centre to that of the next one, 0 to 1.
    part: [PixelLanes; 2],
}

/// Eight places in the two levels next to their size, and the share of the coarser one.
struct Spots {
    /// Whether all are in the same levels.
    is_same: bool,
    spots: [Spot; 2],
    blend: PixelLanes,
}

/// The mean colours of groups of eight pixels: their places (u and v in repeats, within 1e6) and the lengths of their
/// footprints in base texels. `sink` gets each group's index and colours.
#[inline(always)]
pub fn colors(surface: &Surface, groups: &[[PixelLanes; 3]], mut sink: impl FnMut(usize, [PixelLanes; 3])) {
    let Some(first) = groups.first() else { return };
    // The next group's places are found before this one's texels are read: neither waits for the other.
    let mut levels = TwoLevels::new(surface, 0);
    let mut next = Spots::new(surface, &mut levels, first);
    for (index, group) in groups.iter().enumerate() {
        let (spots, of_spots) = (next, levels);
        next = Spots::new(surface, &mut levels, groups.get(index + 1).unwrap_or(group));
        let is_blended = spots.blend.simd_gt(PixelLanes::ZERO).any();
        let [fine, coarse] = [0, 1].map(|i| (of_spots.levels[i], &spots.spots[i]));
        let color = |(level, spot): (&Level, &Spot)| spot.color(level);
        let color = match (spots.is_same, is_blended) {
            (false, _) => on_several_levels(surface, group),
            (true, true) => mixed(&color(fine), &color(coarse), spots.blend),
            (true, false) => color(fine),
        };
        sink(index, color);
    }
}

/// A level and the next coarser one, or itself where there is none, and their texels a repeat: neighbouring pixels have the
/// same.
#[derive(Clone, Copy)]
struct TwoLevels<'a> {
    index: usize,
    levels: [&'a Level; 2],
    texels: [[f32; 2]; 2],
}

impl<'a> TwoLevels<'a> {
    fn new(surface: &'a Surface, index: usize) -> Self {
        let indices = [index, (index + 1).min(surface.levels.len() - 1)];
        let levels = indices.map(|index| &surface.levels[index]);
        Self { index, levels, texels: indices.map(|index| surface.texels_per_repeat(index)) }
    }
}

impl Spots {
    /// Sets `levels` to the first pixel's.
    #[inline(always)]
    fn new<'a>(surface: &'a Surface, levels: &mut TwoLevels<'a>, &[u, v, size]: &[PixelLanes; 3]) -> Self {
        let (numbers, blend) = levels_of_sizes(size, surface.levels.len() - 1);
        let index = numbers.as_array()[0];
        if index as usize != levels.index {
            *levels = TwoLevels::new(surface, index as usize);
        }
        let is_same = numbers.simd_eq(i32x8::splat(index)).all();
        Self { is_same, spots: levels.texels.map(|texels| Spot::new(texels, [u, v])), blend }
    }
}

/// The mean colours of pixels on different levels.
#[inline(never)]
fn on_several_levels(surface: &Surface, &[u, v, size]: &[PixelLanes; 3]) -> [PixelLanes; 3] {
    let (levels, blend) = levels_of_sizes(size, surface.levels.len() - 1);
    let [mut fine, mut coarse] = [[PixelLanes::ZERO; 3]; 2];
    for index in 0..surface.levels.len() {
        let at = |index: i32| lanes(levels.simd_eq(i32x8::splat(index)));
        let is_fine = at(index as i32);
        let is_coarse = at(index as i32 - 1) & blend.simd_gt(PixelLanes::ZERO);
        if (is_fine | is_coarse).any() {
            let found = Spot::new(surface.texels_per_repeat(index), [u, v]).color(&surface.levels[index]);
            fine = [0, 1, 2].map(|c| is_fine.select(found[c], fine[c]));
            coarse = [0, 1, 2].map(|c| is_coarse.select(found[c], coarse[c]));
        }
    }
    mixed(&fine, &coarse, blend)
}

#[inline(always)]
fn mixed(fine: &[PixelLanes; 3], coarse: &[PixelLanes; 3], blend: PixelLanes) -> [PixelLanes; 3] {
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
    let Differences { dx, dy } = differences.shortened();
    let squared = |[u, v]: [PixelLanes; 2]| {
        let (u, v) = (u * texels[0], v * texels[1]);
        u * u + v * v
    };
    squared(dx).fast_max(squared(dy)).sqrt()
}

impl Spot {
    #[inline(always)]
    fn new(texels: [f32; 2], place: [PixelLanes; 2]) -> Self {
        let at = [place[0] * texels[0] - 0.5, place[1] * texels[1] - 0.5];
        let floors = [at[0].floor(), at[1].floor()];
        let bound = PixelLanes::splat(FARTHEST);
        let corner = |floor: PixelLanes| floor.fast_max(-bound).fast_min(bound).fast_trunc_int();
        let part = [at[0] - floors[0], at[1] - floors[1]];
        Self { corner: [corner(floors[0]), corner(floors[1])], part }
    }

    /// Interpolated between the four texels around each place.
    #[inline(always)]
    fn color(&self, level: &Level) -> [PixelLanes; 3] {
        let [x, y] = self.corner;
        let [red_green, blue] = corners(level, x, y);
        let part = join([self.part[1], self.part[1]]);
        let mix = |channel: fn(u32x16) -> LineLanes, Corners { above, below }: Corners| {
            let [above, below] = [channel(above), channel(below)];
            let [left, right] = split(above + (below - above) * part);
            left + (right - left) * self.part[0]
        };
        [mix(low_halves, red_green), mix(high_halves, red_green), mix(low_halves, blue)]
    }
}
