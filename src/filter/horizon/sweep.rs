//! The sweep: what is seen along each line of a patch, bin by bin.
//!
//! Bins cut the seen places into equal parts. Sixteen lines at a time read their texels row by row,
//! from the near end to the far one; what is seen of them, and so the mean of each bin, is found in
//! [`walk`](super::walk).

use super::grid::{EMPTY_ROW, GROUP, Grid, Profile, Texels};
use super::sweep_frame::SweepFrame;
use super::walk::Walk;
use crate::simd::{
    LineBlend, LineLanes, halves, high_halves, join, line_indices, low_halves, pick_words,
};
use crate::texture::{FULL_F32, unpack_normals};

/// Most rows that are read before what they show is looked at.
const READ_AHEAD: usize = 32;

impl<const CHANNELS: usize> Profile<CHANNELS> {
    /// Sweeps the lines of a group over the bins between two seen places. Returns the number of
    /// rows.
    pub(super) fn sweep(&mut self, grid: &Grid, group: usize, [entry, exit]: [f32; 2]) -> u64 {
        if self.bins.len() < grid.num_bins {
            self.bins.resize(grid.num_bins, [EMPTY_ROW; CHANNELS]);
        }
        // Widen the range to whole bins, at least one: a bin holds the mean of all that it shows.
        let bin_at = |place: f32| (place - grid.begin) / grid.step;
        let first_bin = bin_at(entry).max(0.0) as usize;
        let end_bin = (bin_at(exit).ceil() as usize).clamp(first_bin + 1, grid.num_bins);
        let lines = Lines::new(grid, group * GROUP);
        let [start, end] = [first_bin, end_bin].map(|bin| grid.begin + bin as f32 * grid.step);
        let mut walk = Walk::<CHANNELS>::new(grid.num_lines, group * GROUP, [first_bin, end_bin]);
        let steps = grid.steps_per_row;
        let first = lines.row_before(start) * steps;
        // The deepest relief of the last row is seen behind all bins.
        let end_step = first + lines.rows_between(start, end) * steps;
        let mut read =
            [Texels { values: [LineLanes::ZERO; CHANNELS], place: LineLanes::ZERO }; READ_AHEAD];
        lines.read(first, &mut read[..1]);
        let mut last = read[0];
        let mut step = first + 1;
        // Read rows ahead, so that no branch on what they show waits for memory. A texel is never
        // seen beyond its own row, so the first `end - start` rows cannot reach the exit: they are
        // read in one block.
        let mut num_read = ((end - start) as usize * steps as usize).clamp(1, READ_AHEAD);
        while !walk.is_done() && step < end_step {
            lines.read(step, &mut read[..num_read]);
            let mut before = &last;
            for next in &read[..num_read] {
                walk.pass(before, next, &mut self.bins);
                before = next;
            }
            last = read[num_read - 1];
            step += num_read as i32;
            // Toward the exit any row may be the last: smaller blocks waste less.
            num_read = READ_AHEAD / 4;
        }
        walk.finish(&last, &mut self.bins);
        (step - first) as u64
    }
}

/// A group of lines of a grid.
struct Lines<'a> {
    frame: &'a SweepFrame<'a>,
    most_scale: f32,
    xi: LineLanes,
    /// Rows down to the deepest relief in the middle of each line, and as many bins.
    depth: LineLanes,
    depth_bins: LineLanes,
    /// Bins a row, and bins from the middle to the first one.
    scale: f32,
    begin: f32,
    /// 2 where half rows are read, too.
    steps_per_row: i32,
    /// The middle's row in the walking direction, and whether that is up (1) or down (-1).
    middle: f32,
    sign: i32,
}

impl<'a> Lines<'a> {
    fn new(grid: &Grid<'a>, first: usize) -> Self {
        let frame = grid.frame;
        let xi = (line_indices() + first as f32) * grid.spacing + grid.first;
        let depth = xi * frame.tilt + frame.depth;
        let scale = 1.0 / grid.step;
        let (depth_bins, begin) = (depth * scale, grid.begin * scale);
        Self {
            frame,
            most_scale: grid.most_scale,
            xi,
            depth,
            depth_bins,
            scale,
            begin,
            steps_per_row: grid.steps_per_row,
            middle: frame.toward * frame.origin[1],
            sign: frame.toward as i32,
        }
    }

    /// The last texel row at or before a seen place, in the walking direction.
    fn row_before(&self, place: f32) -> i32 {
        (self.middle + place).floor() as i32
    }

    /// Rows after which the deepest relief is seen behind `end`.
    fn rows_between(&self, start: f32, end: f32) -> i32 {
        let depth = self.depth.to_array().into_iter().fold(0.0, f32::max);
        (end * (1.0 + self.frame.growth) + depth).max(end) as i32 - start as i32 + 4
    }

    /// The texels of neighbouring steps from `first` on.
    #[inline(always)]
    fn read<const CHANNELS: usize>(&self, first: i32, read: &mut [Texels<CHANNELS>]) {
        if self.steps_per_row > 1 {
            return read.iter_mut().zip(first..).for_each(|(read, step)| *read = self.half(step));
        }
        let mut starts = [0; READ_AHEAD];
        let (words, stride) = (self.frame.rows.words(), self.frame.rows.stride());
        // Touch one word of each plane first, so that cache misses of many rows overlap: the work
        // on a row is too long for the processor to look ahead.
        let mut touched = 0;
        for (start, row) in starts[..read.len()].iter_mut().zip(first..) {
            *start = self.start_of(row, self.columns(row as f32 - self.middle));
            touched |= words[*start] | words[*start + stride];
        }
        std::hint::black_box(touched);
        for ((read, start), row) in read.iter_mut().zip(starts).zip(first..) {
            let q = row as f32 - self.middle;
            *read = self.seen(q, self.values(start, self.columns(q)));
        }
    }

    /// A row or, at odd steps, what lies half way to the next one.
    #[inline(never)]
    fn half<const CHANNELS: usize>(&self, step: i32) -> Texels<CHANNELS> {
        let row = step.div_euclid(2);
        let q = step as f32 * 0.5 - self.middle;
        let x = self.columns(q);
        let (values, height) = self.values(self.start_of(row, x), x);
        if step % 2 == 0 {
            return self.seen(q, (values, height));
        }
        let (others, other_height) = self.values::<CHANNELS>(self.start_of(row + 1, x), x);
        let mean = |a: LineLanes, b: LineLanes| (a + b) * 0.5;
        let values = std::array::from_fn(|i| mean(values[i], others[i]));
        self.seen(q, (values, mean(height, other_height)))
    }

    /// Where the lines lie at a distance from the middle, in texels.
    #[inline(always)]
    fn columns(&self, q: f32) -> LineLanes {
        let SweepFrame { origin, shear, spread, .. } = *self.frame;
        // Rows that are read ahead may lie where lines would run together, or farther apart than a
        // run of texels reaches.
        self.xi * (spread * q + 1.0).clamp(0.0, self.most_scale) + (origin[0] + shear * q)
    }

    /// Where the run of texels around columns of a row starts among the level's words.
    #[inline(always)]
    fn start_of(&self, row: i32, x: LineLanes) -> usize {
        let x = LineLanes::splat(x.as_array()[0]);
        // By lanes, since the scalar conversion saturates.
        self.frame.rows.start_at(x.floor().fast_trunc_int().as_array()[0], row * self.sign)
    }

    /// The values and the heights at columns of a row, from where its run of texels starts.
    #[inline(always)]
    fn values<const CHANNELS: usize>(
        &self,
        start: usize,
        x: LineLanes,
    ) -> ([LineLanes; CHANNELS], LineLanes) {
        let rows = self.frame.rows;
        let place = x - LineLanes::splat(x.as_array()[0]).floor();
        let (words, stride) = (rows.words(), rows.stride());
        // Count each line's texel from the first line's, the start of the run.
        let cell = place.fast_trunc_int();
        let part = place - LineLanes::from_i32x16(cell);
        let pick = |plane: usize| pick_words(words, start + plane * stride, cell);
        // Interpolate between the texels on both sides of each line.
        let blend = LineBlend::new(part);
        let (red_green, blue_height) = (blend.mix(pick(0)), blend.mix(pick(1)));
        let color = [low_halves(red_green), high_halves(red_green), low_halves(blue_height)];
        let mut values = [LineLanes::ZERO; CHANNELS];
        values[..3].copy_from_slice(&color);
        if CHANNELS > 3 && rows.has_normals() {
            // Normals are packed in another way than `blend` mixes: unpack both sides first.
            let [near, far] = pick(2).map(|words| {
                let [a, b] = halves(words).map(unpack_normals);
                [0, 1, 2].map(|i| join([a[i], b[i]]))
            });
            (3..CHANNELS).for_each(|i| values[i] = near[i - 3] + (far[i - 3] - near[i - 3]) * part);
        } else if CHANNELS > 3 {
            values[CHANNELS - 1] = LineLanes::ONE;
        }
        (values, high_halves(blue_height))
    }

    /// Where values are seen: p = (q - d D) / (1 + d c), in bins.
    #[inline(always)]
    fn seen<const CHANNELS: usize>(
        &self,
        q: f32,
        (values, height): ([LineLanes; CHANNELS], LineLanes),
    ) -> Texels<CHANNELS> {
        let down = LineLanes::ONE - height * (1.0 / FULL_F32);
        let place = (LineLanes::splat(q * self.scale) - down * self.depth_bins)
            / (down * self.frame.growth + 1.0)
            - self.begin;
        Texels { values, place }
    }
}
