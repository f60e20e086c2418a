//! The mean over an ellipse from the texels next to its longer axis, on a level about as coarse as
//! its shorter one.
//!
//! The longer axis is a line through the texels of that level. Along it weighs the Gaussian; across
//! it, in each column that it crosses, a triangle, which is interpolation or as much wider as the
//! ellipse asks for: what the level averages has a variance of `(4^l - 1) / 12` square base texels
//! on level l, the triangle a sixth of its half width's square. So an ellipse takes few texels, in
//! runs that lie in a few rows.

use super::sums::WideSums;
use crate::footprint::levels::{DISC_VARIANCE, for_lines};
use crate::footprint::{Ellipses, Footprints};
use crate::settings::Ewa;
use crate::simd::{LineLanes, PixelLanes, i32x8, lanes, line_indices, mask};
use crate::texture::{APRON, RowStarts, Rows, Surface, Texel};

/// The disc's Gaussian seen from the side: its integral along lines at a distance t from the
/// middle, over that at t = 0, is about `z (c0 + c1 z + c2 z^2)` with `z = 1 - t^2`, off by 0.02.
const PROFILE: [f32; 3] = [0.740_760_27, -0.603_611_7, 0.863_908_9];

/// The profile's half length in standard deviations.
const HALF_LENGTH: f32 = 1.0 / 0.412_934_7;

/// Least variance along the line, in square texels: that of interpolation.
const LEAST_VARIANCE: f32 = 1.0 / 6.0;

/// Texel coordinates are clamped to so far from the pattern's first: beyond, an f32 cannot tell
/// neighbours apart, and they and some beyond fit an i32.
const FARTHEST: f32 = (1 << 29) as f32;

/// Texel budgets that lines tell apart: fewer than the first leave no line, more than the last
/// nothing to gain.
const LEAST_BUDGET: f32 = 16.0;
const MOST_BUDGET: f32 = 4096.0;

/// Columns of a line for each texel of the budget: two or three rows of texels are read for each
/// column.
const COLUMNS_PER_TEXEL: f32 = 0.4;

/// Columns that are read at once.
const COLUMNS: usize = 16;

/// The longer axes of eight pixels' ellipses, each in the texels of its level, with rows along v
/// where it is steep.
#[derive(Clone, Copy, Debug)]
pub struct LongAxes {
    level: i32x8,
    /// Whether rows run along v.
    is_turned: i32x8,
    /// The middle along and across the rows, texel centres at whole numbers.
    place: [PixelLanes; 2],
    /// Rows from column to column, -1 to 1.
    slope: PixelLanes,
    /// 1 over half the columns that the line crosses.
    inverse_reach: PixelLanes,
    /// The first column, and how many there are.
    columns: [i32x8; 2],
    /// From the middle to the first column.
    start: PixelLanes,
    /// How far from the line texels count, in rows, at least 1.
    width: PixelLanes,
}

impl LongAxes {
    /// For pixels around their hits.
    pub fn new(surface: &Surface, pixels: &Footprints, ewa: &Ewa) -> Self {
        let ellipses =
            Ellipses::new(pixels, surface.base().texels_per_repeat(), ewa.max_anisotropy);
        // Two or three rows of a line's columns are within the budget.
        let most = (ewa.texel_budget as f32).clamp(LEAST_BUDGET, MOST_BUDGET)
            * (COLUMNS_PER_TEXEL * 0.5 / HALF_LENGTH);
        // Find the variances that are wanted. Base texels add 1/4 to the disc's: 1/6 by
        // interpolation, 1/12 by their own width. A level's texels bring their 1/12 along.
        let along = ellipses.long * DISC_VARIANCE + 0.25;
        let level = for_lines(&ellipses, most, surface.last_level());
        // Square texels of the level in one of the base level.
        // It is 4^-level: an exponent, written as such, and exact.
        let per_texel = lanes((i32x8::splat(127) - level - level) << 23_i32);
        let variance = (along * per_texel - 1.0 / 12.0).fast_max(PixelLanes::splat(LEAST_VARIANCE));
        let across = (ellipses.short * DISC_VARIANCE + 0.25) * per_texel - 1.0 / 12.0;
        // The direction of the longer axis: the eigenvector of [[C, -B/2], [-B/2, A]].
        let (is_wide, half_b) = (ellipses.c.simd_gt(ellipses.a), ellipses.b * -0.5);
        // Either row of the matrix gives it; of the one taken no difference cancels.
        let x = is_wide.select(ellipses.long - ellipses.a, half_b);
        let y = is_wide.select(half_b, ellipses.long - ellipses.c);
        // Count columns along the side that the axis is nearer to: the slope is 1 at most.
        let is_turned = y.abs().simd_gt(x.abs());
        let (x, y) = (is_turned.select(y, x), is_turned.select(x, y));
        // A circle has no direction, and takes its row.
        let is_round = x.simd_eq(PixelLanes::ZERO);
        let slope = is_round.select(PixelLanes::ZERO, y / is_round.select(PixelLanes::ONE, x));
        let reach = (variance / (slope * slope + 1.0)).sqrt() * HALF_LENGTH;
        // Rows meet a slanted line aslant.
        // A triangle of half width w has the variance w^2 / 6, and below 1 it could miss all rows.
        let width = (across * (slope * slope + 1.0) * 6.0).fast_max(PixelLanes::ONE).sqrt();
        let texels = texels_a_repeat(surface, level);
        let bounded = |place: PixelLanes| {
            place.fast_max(PixelLanes::splat(-FARTHEST)).fast_min(PixelLanes::splat(FARTHEST))
        };
        let place = [0, 1].map(|i| bounded(pixels.hit[i] * texels[i] - 0.5));
        let place = [is_turned.select(place[1], place[0]), is_turned.select(place[0], place[1])];
        // With a reach of 1 a column lies on the line, wherever the middle is.
        let reach = reach.fast_max(PixelLanes::ONE);
        let [first, last] = [(place[0] - reach).ceil(), (place[0] + reach).floor()];
        Self {
            level,
            is_turned: mask(is_turned),
            place,
            slope,
            inverse_reach: PixelLanes::ONE / reach,
            columns: [first.fast_trunc_int(), (last - first).fast_trunc_int() + 1],
            start: first - place[0],
            width,
        }
    }

    /// The mip level that a pixel's texels are of.
    pub fn level(&self, lane: usize) -> usize {
        self.level.as_array()[lane] as usize
    }

    /// The mean of a pixel, and how many texels were read. Only surfaces that have normals may be
    /// asked for them.
    #[inline(always)]
    pub fn mean<const HAS_NORMALS: bool>(&self, surface: &Surface, lane: usize) -> (Texel, u64) {
        let is_turned = self.is_turned.as_array()[lane] != 0;
        let rows = surface.levels()[self.level(lane)].rows(is_turned);
        let at = |lanes: &PixelLanes| lanes.as_array()[lane];
        let [y0, slope, start, width] =
            [&self.place[1], &self.slope, &self.start, &self.width].map(at);
        // Texels count within `width` rows of the line, which climbs or falls by `slope` rows a
        // column. Here the width is 1, the slope 0.36; * is the texel next to the line:
        //
        //     columns   first                  last
        //     lowest    *  *  #  .  .  .  .  .  .  .
        //       rows    #  #  *  *  #  #  .  .  .  .
        //        |      .  .  .  #  *  *  *  #  #  .
        //        v      .  .  .  .  .  .  #  *  *  *
        //     highest   .  .  .  .  .  .  .  .  .  #
        //
        // A block is sixteen columns, and each of its rows one load a plane.
        let inverse_width = LineLanes::splat(1.0 / width);
        let inverse_reach = LineLanes::splat(at(&self.inverse_reach));
        let [first, num] = self.columns.map(|columns| columns.as_array()[lane]);
        let mut sums = WideSums::<HAS_NORMALS>::default();
        let mut num_rows = 0;
        for block in (0..num).step_by(COLUMNS) {
            let start = start + block as f32;
            // Weigh the columns by the disc's profile.
            let u = line_indices() + start;
            let t = u * inverse_reach;
            let z = (LineLanes::ONE - t * t).fast_max(LineLanes::ZERO);
            let weight = ((z * PROFILE[2] + PROFILE[1]) * z + PROFILE[0]) * z;
            // Find the rows near the line between its first column and its last.
            let length = (COLUMNS as i32).min(num - block) - 1;
            let ends = [start * slope + y0, (start + length as f32) * slope + y0];
            let lowest = floor(ends[0].min(ends[1]) - width) + 1;
            let num_more = floor(ends[0].max(ends[1]) + width) - lowest - 2;
            let y = u * slope + (y0 - lowest as f32);
            let column = rows.run_start(first + block);
            let starts = rows.row_starts(lowest);
            let mut near = NearRows { rows, column, starts, y, inverse_width, weight };
            // Nearly every block needs three rows: unrolled, they take no mispredicted branch.
            // Where two would do, the third weighs nothing.
            for _ in 0..3 {
                near.add_next(&mut sums);
            }
            for _ in 0..num_more {
                near.add_next(&mut sums);
            }
            num_rows += 3 + num_more.max(0) as u64;
        }
        // The column next to the middle always weighs something.
        (sums.mean().unwrap_or_default(), num_rows * COLUMNS as u64)
    }
}

/// The rows near a line in sixteen columns.
struct NearRows<'a> {
    rows: &'a Rows,
    /// Where the first column's texels start in a row.
    column: usize,
    starts: RowStarts<'a>,
    /// The line's place in each column, in rows from the next one.
    y: LineLanes,
    inverse_width: LineLanes,
    weight: LineLanes,
}

impl NearRows<'_> {
    #[inline(always)]
    fn add_next<const HAS_NORMALS: bool>(&mut self, sums: &mut WideSums<HAS_NORMALS>) {
        let part = (LineLanes::ONE - self.y.abs() * self.inverse_width).fast_max(LineLanes::ZERO);
        sums.add_run(self.rows, self.starts.next() + self.column, self.weight * part);
        self.y -= 1.0;
    }
}

/// The floor of a number within 2^30.
#[inline(always)]
fn floor(y: f32) -> i32 {
    PixelLanes::splat(y).floor().fast_trunc_int().as_array()[0]
}

const _: () = assert!(COLUMNS <= APRON, "a run of columns is one load");

/// Texels a repeat of a level for each lane.
fn texels_a_repeat(surface: &Surface, levels: i32x8) -> [PixelLanes; 2] {
    // Where all are on one level, one look-up serves.
    let level = levels.as_array()[0];
    if levels.simd_eq(i32x8::splat(level)).all() {
        return surface.levels()[level as usize].texels_per_repeat().map(PixelLanes::splat);
    }
    let mut texels = [[0.0; 8]; 2];
    for (lane, &level) in levels.as_array().iter().enumerate() {
        [texels[0][lane], texels[1][lane]] = surface.levels()[level as usize].texels_per_repeat();
    }
    texels.map(PixelLanes::new)
}
