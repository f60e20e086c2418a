//! The mean over an ellipse from the texels next to its longer axis, on a level about as coarse as
//! its shorter one.
//!
//! The longer axis is a line through the texels of that level. Along it weighs the Gaussian; across
//! it, in each column that it crosses, a triangle, which is interpolation or as much wider as the
//! ellipse asks for: what the level averages has a variance of `(4^l - 1) / 12` square base texels
//! on level l, the triangle a sixth of its half width's square. So an ellipse takes few texels, in
//! runs that lie in a few rows.

use super::sums::{PairSums, WEIGHT_SCALE, WideSums};
use crate::footprint::levels::{DISC_VARIANCE, for_lines};
use crate::footprint::{Ellipses, Footprints};
use crate::settings::Ewa;
use crate::simd::{LineLanes, PixelLanes, i32x8, lanes, line_indices};
use crate::texture::{APRON, RowStarts, Rows, Surface};

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

/// Of the variance across the line, what a triangle is given: it has none of the Gaussian's tails.
/// Measured: 1 loses 0.1 to 0.3 dB.
const SHARPENED: f32 = 0.9;

/// With so many lines the texel budget is as it is given; twice as many make it 2.8 times as
/// large.
const USUAL_LINES: f32 = 12.0;

/// Texel budgets that lines tell apart: fewer than the first leave no line, more than the last
/// nothing to gain.
const LEAST_BUDGET: f32 = 16.0;
const MOST_BUDGET: f32 = 4096.0;

/// Columns of a line for each texel of the budget: four or five rows of texels are read for each
/// column.
const COLUMNS_PER_TEXEL: f32 = 0.23;

/// Most rows to each side of a line: more are only asked for where the last level, a single texel,
/// is too fine, and all texels are alike.
const MOST_WIDTH: f32 = 64.0;

/// Columns that are read at once.
const COLUMNS: usize = 16;

/// The longer axes of eight pixels' ellipses, each in the texels of its level, with rows along v
/// where it is steep.
///
/// All that leads to a pixel's first texels is found here for eight at once: their steps overlap,
/// and a pixel need not wait for its own.
#[derive(Clone, Copy, Debug)]
pub struct LongAxes<'a> {
    level: i32x8,
    /// Where the first columns' lowest rows lie.
    starts: [RowStarts<'a>; 8],
    /// The first column, and how many there are.
    columns: [i32x8; 2],
    /// 1 over half the columns that the line crosses.
    inverse_reach: PixelLanes,
    /// From the middle to the first column.
    start: PixelLanes,
    /// Rows from column to column, -1 to 1.
    slope: PixelLanes,
    /// The line's place in the first column, in rows.
    place: PixelLanes,
    /// Below which no texel of the first sixteen columns counts, in rows.
    low_end: PixelLanes,
    /// 1 over how far from the line texels count, in rows.
    inverse_width: PixelLanes,
    /// Pairs of rows that hold the texels of sixteen columns next to any of the eight lines: one
    /// number for all, which the processor can foresee.
    num_pairs: usize,
}

impl<'a> LongAxes<'a> {
    /// For pixels around their hits.
    pub fn new(surface: &'a Surface, pixels: &Footprints, ewa: &Ewa) -> Self {
        let ellipses =
            Ellipses::new(pixels, surface.base().texels_per_repeat(), ewa.max_anisotropy);
        // All rows of a line's columns are within the budget.
        let times = ewa.lines as f32 / USUAL_LINES;
        let most = (ewa.texel_budget as f32 * times * times.sqrt())
            .clamp(LEAST_BUDGET, MOST_BUDGET)
            * (COLUMNS_PER_TEXEL * 0.5 / HALF_LENGTH);
        // Find the variances that are wanted. Base texels add 1/4 to the disc's: 1/6 by
        // interpolation, 1/12 by their own width. A level's texels bring their 1/12 along.
        let along = ellipses.long * DISC_VARIANCE + 0.25;
        let level = for_lines(&ellipses, ewa.lines, most, surface.last_level());
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
        let width =
            (across * (slope * slope + 1.0) * (6.0 * SHARPENED)).fast_max(PixelLanes::ONE).sqrt();
        let width = width.fast_min(PixelLanes::splat(MOST_WIDTH));
        let texels = texels_a_repeat(surface, level);
        let bounded = |place: PixelLanes| {
            place.fast_max(PixelLanes::splat(-FARTHEST)).fast_min(PixelLanes::splat(FARTHEST))
        };
        let place = [0, 1].map(|i| bounded(pixels.hit[i] * texels[i] - 0.5));
        let place = [is_turned.select(place[1], place[0]), is_turned.select(place[0], place[1])];
        // With a reach of 1 a column lies on the line, wherever the middle is.
        let reach = reach.fast_max(PixelLanes::ONE);
        let [first, last] = [(place[0] - reach).ceil(), (place[0] + reach).floor()];
        // Rows strictly within a length are one more than whole ones fit it, at the most.
        let length = (last - first).fast_min(PixelLanes::splat(COLUMNS as f32 - 1.0));
        let num_rows = (length * slope.abs() + width * 2.0).fast_trunc_int() + 1;
        let num_rows = num_rows.to_array().into_iter().fold(0, i32::max);
        let start = first - place[0];
        let place = start * slope + place[1];
        let low_end = length * slope.fast_min(PixelLanes::ZERO) + place - width;
        let lowest = low_end.floor().fast_trunc_int() + 1;
        let columns = [first.fast_trunc_int(), (last - first).fast_trunc_int() + 1];
        let is_turned = is_turned.to_bitmask();
        let starts = std::array::from_fn(|lane| {
            let level = &surface.levels()[level.as_array()[lane] as usize];
            level.rows(is_turned >> lane & 1 != 0).row_starts(lowest.as_array()[lane])
        });
        Self {
            level,
            starts,
            columns,
            inverse_reach: PixelLanes::ONE / reach,
            start,
            slope,
            place,
            low_end,
            inverse_width: PixelLanes::ONE / width,
            num_pairs: (num_rows as usize).div_ceil(2),
        }
    }

    /// The mip level that a pixel's texels are of.
    pub fn level(&self, lane: usize) -> usize {
        self.level.as_array()[lane] as usize
    }

    /// The sums over a pixel's texels, and how many texels were read. Only surfaces that have
    /// normals may be asked for them.
    #[inline(always)]
    pub(super) fn sums<const HAS_NORMALS: bool>(
        &self,
        lane: usize,
    ) -> (WideSums<HAS_NORMALS>, u64) {
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
        let at = |lanes: &PixelLanes| lanes.as_array()[lane];
        let [start, slope, place, low_end] =
            [&self.start, &self.slope, &self.place, &self.low_end].map(at);
        let [inverse_width, inverse_reach] = [&self.inverse_width, &self.inverse_reach].map(at);
        let [first, num] = self.columns.map(|columns| columns.as_array()[lane]);
        let mut starts = self.starts[lane];
        let rows = starts.rows();
        let mut sums = WideSums::<HAS_NORMALS>::default();
        for block in (0..num).step_by(COLUMNS) {
            let rise = block as f32 * slope;
            if block > 0 {
                starts = rows.row_starts(floor(low_end + rise) + 1);
            }
            let weight = profile((line_indices() + (start + block as f32)) * inverse_reach);
            let y = line_indices() * slope + (place + rise - starts.row() as f32);
            let mut near = NearRows {
                column: rows.run_start(first + block),
                starts,
                y: y * inverse_width,
                step: LineLanes::splat(inverse_width),
                weight: weight * (inverse_width * WEIGHT_SCALE),
            };
            // A row too many weighs nothing.
            let mut block = PairSums::<HAS_NORMALS>::default();
            for _ in 0..self.num_pairs {
                near.add_pair(rows, &mut block);
            }
            sums.add_block(&block);
        }
        let num_blocks = (num as u64).div_ceil(COLUMNS as u64);
        (sums, num_blocks * (2 * self.num_pairs * COLUMNS) as u64)
    }
}

/// The weight of a column at a distance from the middle: the disc's Gaussian seen from the side.
#[inline(always)]
fn profile(t: LineLanes) -> LineLanes {
    let z = (LineLanes::ONE - t * t).fast_max(LineLanes::ZERO);
    ((z * PROFILE[2] + PROFILE[1]) * z + PROFILE[0]) * z
}

/// The rows near a line in sixteen columns.
struct NearRows<'a> {
    /// Where the first column's texels start in a row.
    column: usize,
    starts: RowStarts<'a>,
    /// The line's place in each column, in widths from the next row.
    y: LineLanes,
    /// A row in widths.
    step: LineLanes,
    weight: LineLanes,
}

impl NearRows<'_> {
    /// Adds the next two rows.
    #[inline(always)]
    fn add_pair<const HAS_NORMALS: bool>(&mut self, rows: &Rows, sums: &mut PairSums<HAS_NORMALS>) {
        let part = |y: LineLanes| (LineLanes::ONE - y.abs()).fast_max(LineLanes::ZERO);
        let below = self.y - self.step;
        let weights = [part(self.y) * self.weight, part(below) * self.weight];
        let starts = [self.starts.next() + self.column, self.starts.next() + self.column];
        sums.add_rows(rows, starts, weights);
        self.y = below - self.step;
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
