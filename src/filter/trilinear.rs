//! Trilinear look-ups of eight pixels at once, to the bits of
//! [`points::trilinear`](super::points::trilinear).
//!
//! Levels and places may differ from pixel to pixel. Lanes are pixels.

use super::batch::{Batch, Filtered, each_covered};
use super::corners::{Corners, corners};
use super::points;
use super::queue;
use crate::footprint::Footprints;
use crate::footprint::levels::{longest_sides, of_sizes};
use crate::simd::{
    LineLanes, PixelLanes, high_halves, i32x8, join, lanes, low_halves, split, u32x16,
};
use crate::texture::{FARTHEST, Rows, Surface};

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

/// The mean colours of a batch's pixels; with lights, their mean normals too.
pub(super) fn colors(surface: &Surface, batch: &Batch, out: &mut [Filtered]) {
    if batch.is_lit() {
        // Of the lanes' look-ups only colours are made.
        return each_covered(batch, out, |pixels, lane| {
            let size = longest_sides(surface.base(), pixels).as_array()[lane];
            points::trilinear(surface, pixels.lane(lane).hit, size)
        });
    }
    let places = |pixels: &Footprints| {
        let [u, v] = pixels.hit;
        [u, v, longest_sides(surface.base(), pixels)]
    };
    queue::look_up_all(batch, out, places, |queue, out| {
        look_up(surface, queue.groups(), |group, found| queue.hand_out(group, found, out));
    });
}

/// The mean colours of groups of eight pixels: their places (u and v in repeats, within 1e6) and
/// the lengths of their footprints in base texels. `sink` gets each group's index and colours.
#[inline(always)]
pub fn look_up(
    surface: &Surface,
    groups: &[[PixelLanes; 3]],
    mut sink: impl FnMut(usize, [PixelLanes; 3]),
) {
    let Some(first) = groups.first() else { return };
    // The next group's places are found before this one's texels are read: neither waits for the
    // other. Both stay where they are made: a copy would wait for what was just written.
    let mut levels = TwoLevels::new(surface, 0);
    let mut in_turn = [(); 2].map(|()| (Spots::new(surface, &mut levels, first), levels));
    for (index, group) in groups.iter().enumerate() {
        let [even, odd] = &mut in_turn;
        let (this, next) = if index % 2 == 0 { (even, odd) } else { (odd, even) };
        let ahead = groups.get(index + 1).unwrap_or(group);
        *next = (Spots::new(surface, &mut levels, ahead), levels);
        let (spots, of_spots) = this;
        let is_blended = spots.blend.simd_gt(PixelLanes::ZERO).any();
        let [fine, coarse] = [0, 1].map(|i| (of_spots.rows[i], &spots.spots[i]));
        let color = |(rows, spot): (&Rows, &Spot)| spot.color(rows);
        // Read the coarser level only where a pixel has a share of it.
        let [red, green, blue] = match (spots.is_same, is_blended) {
            (false, _) => {
                // Taken apart: the result of a call lies in memory, and the other ways' would, too.
                let [red, green, blue] = on_several_levels(surface, group);
                [red, green, blue]
            }
            (true, true) => mixed(&color(fine), &color(coarse), spots.blend),
            (true, false) => color(fine),
        };
        sink(index, [red, green, blue]);
    }
}

/// A level and the next coarser one, or itself where there is none, and their texels a repeat:
/// neighbouring pixels have the same.
#[derive(Clone, Copy)]
struct TwoLevels<'a> {
    index: usize,
    rows: [&'a Rows; 2],
    texels: [[f32; 2]; 2],
}

impl<'a> TwoLevels<'a> {
    fn new(surface: &'a Surface, index: usize) -> Self {
        let levels =
            [index, (index + 1).min(surface.last_level())].map(|index| &surface.levels()[index]);
        Self {
            index,
            rows: levels.map(|level| level.rows(false)),
            texels: levels.map(|l| l.texels_per_repeat()),
        }
    }
}

impl Spots {
    /// Sets `levels` to the first pixel's.
    #[inline(always)]
    fn new<'a>(
        surface: &'a Surface,
        levels: &mut TwoLevels<'a>,
        &[u, v, size]: &[PixelLanes; 3],
    ) -> Self {
        let (numbers, blend) = of_sizes(size, surface.last_level());
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
    let (levels, blend) = of_sizes(size, surface.last_level());
    let [mut fine, mut coarse] = [[PixelLanes::ZERO; 3]; 2];
    for (index, level) in surface.levels().iter().enumerate() {
        let at = |index: i32| lanes(levels.simd_eq(i32x8::splat(index)));
        let is_fine = at(index as i32);
        let is_coarse = at(index as i32 - 1) & blend.simd_gt(PixelLanes::ZERO);
        let is_on = is_fine | is_coarse;
        // Look all lanes up on a level that any of them is on, and keep those. The others go where
        // the first of those is, so that they read no texels that are not needed.
        if is_on.any() {
            let first = is_on.to_bitmask().trailing_zeros() as usize;
            let place = [u, v].map(|c| is_on.select(c, PixelLanes::splat(c.as_array()[first])));
            let found = Spot::new(level.texels_per_repeat(), place).color(level.rows(false));
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

impl Spot {
    #[inline(always)]
    fn new(texels: [f32; 2], place: [PixelLanes; 2]) -> Self {
        let at = [place[0] * texels[0] - 0.5, place[1] * texels[1] - 0.5];
        let floors = [at[0].floor(), at[1].floor()];
        let bound = PixelLanes::splat(FARTHEST);
        let corner = |floor: PixelLanes| floor.fast_max(-bound).fast_min(bound).fast_trunc_int();
        // Taken from the floor before its bound, the part is 0 to 1 at any place.
        let part = [at[0] - floors[0], at[1] - floors[1]];
        Self { corner: [corner(floors[0]), corner(floors[1])], part }
    }

    /// Interpolated between the four texels around each place.
    #[inline(always)]
    fn color(&self, rows: &Rows) -> [PixelLanes; 3] {
        let [x, y] = self.corner;
        let [red_green, blue] = corners(rows, x, y);
        // Blend the rows first: left and right texels lie in one vector.
        let part = join([self.part[1], self.part[1]]);
        let mix = |channel: fn(u32x16) -> LineLanes, Corners { above, below }: Corners| {
            let [above, below] = [channel(above), channel(below)];
            let [left, right] = split(above + (below - above) * part);
            left + (right - left) * self.part[0]
        };
        [mix(low_halves, red_green), mix(high_halves, red_green), mix(low_halves, blue)]
    }
}
