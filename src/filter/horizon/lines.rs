//! A group of lines on its way: where it crosses rows of texels, and what it reads there.
//!
//! A step is a row or, where half rows are read too, half of one. Steps are read in blocks. Where
//! the lines cross them is found for sixteen steps at once:
//!
//! ```text
//!   step i     |     |  o  |  o  |  o  |  o   texels, and where lines cross the row
//!              ^     ^--^
//!        the run     `- offset of the first line; the others follow at equal distances
//! ```

use super::grid::Grid;
use super::sweep_frame::SweepFrame;
use crate::relief::SEEN_DEPTH;
use crate::simd::{BETWEEN_SCALE, Between, LineLanes, halves, i32x16, join, line_indices};
use crate::texture::{FULL_F32, Rows, unpack_normals};

/// Most steps of a block: their numbers, and that of the step before, are bits of a word.
pub(super) const MOST_STEPS: usize = 31;

/// And the step before.
const SLOTS: usize = MOST_STEPS + 1;

/// A block of steps, and in slot 0 the step before it.
pub(super) struct Steps {
    /// The number of the step before.
    before: i32,
    /// Steps of the block.
    pub(super) num: usize,
    /// Where the lines' texels are seen, in bins from the grid's first.
    pub(super) places: [LineLanes; SLOTS],
    /// Distances from the middle, in rows.
    q: [f32; SLOTS],
    /// How much farther apart than in the middle lines are, and how far the first lies from its
    /// run's first texel.
    scales: [f32; SLOTS],
    offsets: [f32; SLOTS],
    /// Where the runs of texels start among the level's words; half way between rows there are two.
    starts: [[usize; SLOTS]; 2],
    /// The same among the words of what else is read, where texels are lit.
    others: [[usize; SLOTS]; 2],
}

impl Steps {
    /// No steps yet; the next is `first`.
    pub(super) fn new(first: i32) -> Self {
        Self {
            before: first - 1,
            num: 0,
            places: [LineLanes::ZERO; SLOTS],
            q: [0.0; SLOTS],
            scales: [0.0; SLOTS],
            offsets: [0.0; SLOTS],
            starts: [[0; SLOTS]; 2],
            others: [[0; SLOTS]; 2],
        }
    }
}

/// A group of lines of a grid. `HALVES`: they are read half way between rows, too.
pub(super) struct Lines<'a, const HALVES: bool> {
    grid: &'a Grid<'a>,
    frame: &'a SweepFrame<'a>,
    most_scale: f32,
    /// The first line's `xi`, and how far from it the others lie.
    xi: f32,
    others: LineLanes,
    /// Most rows down to the deepest relief.
    depth: f32,
    /// The middle's row in the walking direction, and whether that is up (1) or down (-1).
    middle: f32,
    sign: i32,
    seen: SeenAt,
}

/// Where heights are seen, `p = (q - d D - d (d - s) B) / (1 + d c)` in bins from the grid's first, with
/// the depth `d = 1 - h`, the bow `B` and the depth `s` for which displacements are right:
/// `(scale q - constant + h (slope - h square)) / (whole - h part)`.
struct SeenAt {
    scale: f32,
    constant: LineLanes,
    slope: LineLanes,
    square: f32,
    whole: f32,
    part: f32,
}

impl SeenAt {
    fn new(grid: &Grid, xi: LineLanes) -> Self {
        let SweepFrame { tilt, depth, growth, bow, .. } = *grid.frame;
        let (scale, unit) = (grid.inverse_step, 1.0 / (FULL_F32 * BETWEEN_SCALE));
        let depth = (xi * tilt + depth) * scale;
        let (begin, bow) = (grid.begin * scale, bow * scale);
        Self {
            scale,
            constant: depth + (begin * (1.0 + growth) + bow * (1.0 - SEEN_DEPTH)),
            slope: (depth + (begin * growth + bow * (2.0 - SEEN_DEPTH))) * unit,
            square: bow * (unit * unit),
            whole: 1.0 + growth,
            part: growth * unit,
        }
    }

    #[inline(always)]
    fn place(&self, q: f32, height: LineLanes) -> LineLanes {
        let slope = self.slope - height * self.square;
        (LineLanes::splat(q * self.scale) - self.constant + height * slope)
            / (LineLanes::splat(self.whole) - height * self.part)
    }
}

impl<'a, const HALVES: bool> Lines<'a, HALVES> {
    /// Steps a row.
    pub(super) const STEPS: i32 = if HALVES { 2 } else { 1 };

    pub(super) fn new(grid: &'a Grid<'a>, first: usize) -> Self {
        let frame = grid.frame;
        let others = line_indices() * grid.spacing;
        let xi = first as f32 * grid.spacing + grid.first;
        let deepest = frame.depth + frame.bow.max(0.0) * (1.0 - SEEN_DEPTH);
        let depths = (others + xi) * frame.tilt + deepest;
        Self {
            grid,
            frame,
            most_scale: grid.most_scale,
            xi,
            others,
            depth: depths.to_array().into_iter().fold(0.0, f32::max),
            middle: frame.toward * frame.origin[1],
            sign: frame.toward as i32,
            seen: SeenAt::new(grid, others + xi),
        }
    }

    /// The last step at or before a seen place, in the walking direction, and the number of steps
    /// after which the deepest relief is seen behind another.
    pub(super) fn steps_between(&self, start: f32, end: f32) -> (i32, usize) {
        let last = (end * (1.0 + self.frame.growth) + self.depth).max(end);
        let num_rows = last as i32 - start as i32 + 4;
        ((self.middle + start).floor() as i32 * Self::STEPS, (num_rows * Self::STEPS) as usize)
    }

    /// Reads the heights of the next steps. Returns a bit for each in which a line sees what lies
    /// beyond its bound and all before; bit 0 is the step before them.
    #[inline(always)]
    pub(super) fn read(
        &self,
        steps: &mut Steps,
        num: usize,
        others: Option<&Rows>,
        mut bound: LineLanes,
    ) -> u32 {
        steps.places[0] = steps.places[steps.num];
        steps.before += steps.num as i32;
        steps.num = num;
        self.find(steps, others);
        let mut seen = 0;
        for i in 1..=num {
            let place = self.seen.place(steps.q[i], self.heights(steps, i));
            seen |= u32::from(place.simd_gt(bound).any()) << i;
            bound = bound.fast_max(place);
            steps.places[i] = place;
        }
        seen
    }

    /// Finds where the lines cross the steps of a block.
    #[inline(always)]
    fn find(&self, steps: &mut Steps, others: Option<&Rows>) {
        let SweepFrame { origin, shear, spread, rows, .. } = *self.frame;
        for first in (0..=steps.num).step_by(16) {
            let numbers =
                line_indices().fast_trunc_int() + i32x16::splat(steps.before + first as i32);
            let q = LineLanes::from_i32x16(numbers) * (1.0 / Self::STEPS as f32) - self.middle;
            // Rows that are read ahead may lie where lines would run together, or farther apart
            // than a run of texels reaches.
            let scale = (q * spread + 1.0)
                .fast_max(LineLanes::ZERO)
                .fast_min(LineLanes::splat(self.most_scale));
            let straight = scale * self.xi + (q * shear + origin[0]);
            let x =
                if self.frame.sway == 0.0 { straight } else { straight + self.frame.sway_at(q) };
            let left = x.floor();
            steps.q[first..first + 16].copy_from_slice(q.as_array());
            steps.scales[first..first + 16].copy_from_slice(scale.as_array());
            steps.offsets[first..first + 16].copy_from_slice((x - left).as_array());
            let columns = left.fast_trunc_int();
            let starts = |rows: &Rows, i: usize| {
                let numbers =
                    if HALVES { (numbers + i32x16::splat(i as i32)) >> 1_i32 } else { numbers };
                rows.starts_at(columns, numbers * i32x16::splat(self.sign))
            };
            for i in 0..Self::STEPS as usize {
                steps.starts[i][first..first + 16].copy_from_slice(&starts(rows, i));
                if let Some(rows) = others {
                    steps.others[i][first..first + 16].copy_from_slice(&starts(rows, i));
                }
            }
        }
    }

    /// Where the lines lie in the run of texels of a step.
    #[inline(always)]
    fn between(&self, steps: &Steps, i: usize) -> Between {
        Between::new(self.others * steps.scales[i] + steps.offsets[i])
    }

    /// The heights of a step.
    #[inline(always)]
    fn heights(&self, steps: &Steps, i: usize) -> LineLanes {
        let (between, rows) = (self.between(steps, i), self.frame.rows);
        let of_row =
            |starts: &[usize; SLOTS]| between.halves_at(rows.words(), starts[i] + rows.stride())[1];
        let [near, far] = &steps.starts;
        // Every other step is a row: a branch that is foreseen.
        if HALVES && near[i] != far[i] { (of_row(near) + of_row(far)) * 0.5 } else { of_row(near) }
    }

    /// One of the steps that are read.
    #[inline(always)]
    pub(super) fn step<'s>(&'s self, steps: &'s Steps, i: usize) -> Step<'s, HALVES> {
        Step { lines: self, steps, i, between: self.between(steps, i) }
    }
}

/// A step where a group of lines crosses it.
pub(super) struct Step<'a, const HALVES: bool> {
    lines: &'a Lines<'a, HALVES>,
    steps: &'a Steps,
    i: usize,
    /// Where the lines lie in the run of texels.
    pub(super) between: Between,
}

impl<const HALVES: bool> Step<'_, HALVES> {
    /// Colours, and normals where there are channels for them, and heights: colours and heights in
    /// units of 1 / [`BETWEEN_SCALE`]. Half way between rows they are means of both.
    #[inline(always)]
    pub(super) fn values<const CHANNELS: usize>(&self) -> ([LineLanes; CHANNELS], LineLanes) {
        let ([near, _], far) = self.starts();
        let (mut values, mut height) = self.values_at::<CHANNELS>(near);
        if let Some([far, _]) = far {
            let (others, far_height) = self.values_at::<CHANNELS>(far);
            (0..CHANNELS).for_each(|i| values[i] = (values[i] + others[i]) * 0.5);
            height = (height + far_height) * 0.5;
        }
        (values, height)
    }

    /// The same of a row that starts at a word.
    #[inline(always)]
    pub(super) fn values_at<const CHANNELS: usize>(
        &self,
        start: usize,
    ) -> ([LineLanes; CHANNELS], LineLanes) {
        let (rows, between) = (self.lines.frame.rows, &self.between);
        let (words, stride) = (rows.words(), rows.stride());
        let mut values = [LineLanes::ZERO; CHANNELS];
        let [red, green] = between.halves_at(words, start);
        let [blue, height] = between.halves_at(words, start + stride);
        values[..3].copy_from_slice(&[red, green, blue]);
        if CHANNELS > 3 && rows.has_normals() {
            let [near, far] = between.words_at(words, start + 2 * stride).map(|words| {
                let [a, b] = halves(words).map(unpack_normals);
                [0, 1, 2].map(|i| join([a[i], b[i]]))
            });
            (3..CHANNELS).for_each(|i| values[i] = between.mix(near[i - 3], far[i - 3]));
        } else if CHANNELS > 3 {
            values[CHANNELS - 1] = LineLanes::ONE;
        }
        (values, height)
    }

    /// The square of how much normals change from one line to the next.
    #[inline(always)]
    pub(super) fn normals_across(&self) -> LineLanes {
        let Lines { frame, grid, .. } = self.lines;
        let rows = frame.rows;
        if !rows.has_normals() {
            return LineLanes::ZERO;
        }
        let start = self.steps.starts[0][self.i] + 2 * rows.stride();
        let [near, far] = self.between.words_at(rows.words(), start).map(|words| {
            let [a, b] = halves(words).map(unpack_normals);
            [0, 1, 2].map(|i| join([a[i], b[i]]))
        });
        let distance = (grid.spacing * self.steps.scales[self.i]).min(1.0);
        let [x, y, z] = [0, 1, 2].map(|i| far[i] - near[i]);
        (x * x + y * y + z * z) * (distance * distance)
    }

    /// Where the runs of texels start among the words of its row, and among what else is read of
    /// it; and the same of the row behind, if it lies half way between rows.
    #[inline(always)]
    pub(super) fn starts(&self) -> ([usize; 2], Option<[usize; 2]>) {
        let Steps { starts, others, .. } = self.steps;
        let [near, far] = [0, 1].map(|row| [starts[row][self.i], others[row][self.i]]);
        (near, (HALVES && near[0] != far[0]).then_some(far))
    }

    /// Where the run starts among the words of what else is read; half way between rows of the one
    /// before.
    #[inline(always)]
    pub(super) fn other(&self) -> usize {
        self.steps.others[0][self.i]
    }

    /// The lines, and where the texels are seen on them, in rows from the middle.
    #[inline(always)]
    pub(super) fn seen_at(&self) -> [LineLanes; 2] {
        let Lines { grid, others, xi, .. } = self.lines;
        [*others + *xi, self.steps.places[self.i] * grid.step + grid.begin]
    }

    /// Its distance from the middle, in rows.
    #[inline(always)]
    pub(super) fn q(&self) -> f32 {
        self.steps.q[self.i]
    }
}
