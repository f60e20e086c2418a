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
        let first_row = lines.row_before(start);
        // The deepest relief of the last row is seen behind all bins.
        let end_row = first_row + lines.rows_between(start, end);
        let mut last = lines.texels::<CHANNELS>(first_row, lines.start_of(first_row));
        let mut row = first_row + 1;
        // Read rows ahead, so that no branch on what they show waits for memory. A texel is never
        // seen beyond its own row, so the first `end - start` rows cannot reach the exit: they are
        // read in one block.
        let mut read = [last; READ_AHEAD];
        let mut num_read = ((end - start) as usize).clamp(1, READ_AHEAD);
        while !walk.is_done() && row < end_row {
            lines.read(row, &mut read[..num_read]);
            let mut before = &last;
            for next in &read[..num_read] {
                walk.pass(before, next, &mut self.bins);
                before = next;
            }
            last = read[num_read - 1];
            row += num_read as i32;
            // Toward the exit any row may be the last: smaller blocks waste less.
            num_read = READ_AHEAD / 4;
        }
        walk.finish(&last, &mut self.bins);
        (row - first_row) as u64
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

    /// The texels of neighbouring rows from `first` on.
    #[inline(always)]
    fn read<const CHANNELS: usize>(&self, first: i32, read: &mut [Texels<CHANNELS>]) {
        let mut starts = [0; READ_AHEAD];
        let (words, stride) = (self.frame.rows.words(), self.frame.rows.stride());
        // Touch one word of each plane first, so that cache misses of many rows overlap: the work
        // on a row is too long for the processor to look ahead.
        let mut touched = 0;
        for (start, row) in starts[..read.len()].iter_mut().zip(first..) {
            *start = self.start_of(row);
            touched |= words[*start] | words[*start + stride];
        }
        std::hint::black_box(touched);
        for ((read, start), row) in read.iter_mut().zip(starts).zip(first..) {
            *read = self.texels(row, start);
        }
    }

    /// Where the lines lie in a row, in texels.
    #[inline(always)]
    fn columns(&self, row: i32) -> LineLanes {
        let SweepFrame { origin, shear, spread, .. } = *self.frame;
        let q = row as f32 - self.middle;
        // Rows that are read ahead may lie where lines would run together, or farther apart than a
        // run of texels reaches.
        self.xi * (spread * q + 1.0).clamp(0.0, self.most_scale) + (origin[0] + shear * q)
    }

    /// Where the run of texels around the lines in a row starts among the level's words.
    #[inline(always)]
    fn start_of(&self, row: i32) -> usize {
        let x = LineLanes::splat(self.columns(row).as_array()[0]);
        // By lanes, since the scalar conversion saturates.
        self.frame.rows.start_at(x.floor().fast_trunc_int().as_array()[0], row * self.sign)
    }

    /// The texels of a row.
    #[inline(always)]
    fn texels<const CHANNELS: usize>(&self, row: i32, start: usize) -> Texels<CHANNELS> {
        let SweepFrame { rows, growth, .. } = *self.frame;
        let q = row as f32 - self.middle;
        let x = self.columns(row);
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
        // Find where each texel is seen: p = (q - d D) / (1 + d c), in bins.
        let down = LineLanes::ONE - high_halves(blue_height) * (1.0 / FULL_F32);
        let place = (LineLanes::splat(q * self.scale) - down * self.depth_bins)
            / (down * growth + 1.0)
            - self.begin;
        Texels { values, place }
    }
}
