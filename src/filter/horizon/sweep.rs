//! The sweep: what is seen along each line of a patch, bin by bin.
//!
//! Each line keeps `M`, the farthest place seen so far. A row's texel at place `p` makes the part from `M` to `p` visible,
//! if there is one; the segment between two rows is linear, so the colour of that part is the one at its middle. Bins cut
//! the seen places into equal parts. A line that passes the end of a bin writes the bin's mean and goes on with the next.

use super::frame::Frame;
use super::kernel::Kernel;
use crate::filter::unpack_normals;
use crate::simd::{Blend, TexelLanes, as_unsigned, high_half, i32x8, lanes, low_half, mask, u32x8};
use crate::texture::{FULL_F32, Level};

/// Most lines of a grid.
pub(super) const MOST_LINES: usize = 64;

/// Most rows that are read before what they show is looked at.
const READ_AHEAD: usize = 32;

/// A line vector may begin at any line of the grid.
const WIDTH: usize = MOST_LINES + 8;

/// A value of each line.
pub(super) type Row = [f32; WIDTH];

/// Lines and bins of a sweep.
#[derive(Clone, Debug)]
pub(super) struct Grid<'a> {
    pub(super) frame: &'a Frame<'a>,
    /// `xi` of the first line, and how far apart lines are; below 1 texel.
    pub(super) first: f32,
    pub(super) spacing: f32,
    pub(super) num_lines: usize,
    /// The seen place where bins begin, and the length of a bin, in rows from the middle.
    pub(super) begin: f32,
    pub(super) step: f32,
    pub(super) num_bins: usize,
}

/// What the lines of a grid see: the mean of each line in each bin. Channels are colour, then normal.
#[derive(Clone, Debug, Default)]
pub(super) struct Profile<const CHANNELS: usize> {
    pub(super) bins: Vec<[Row; CHANNELS]>,
}

impl Grid<'_> {
    /// The seen places that the pixels ask of each group of eight lines: first and last; the first is greater where none
    /// asks.
    pub(super) fn ranges(&self, kernels: &[Kernel]) -> [[f32; 2]; MOST_LINES / 8] {
        let mut ranges = [[f32::MAX, f32::MIN]; MOST_LINES / 8];
        let inverse = 0.125 / self.spacing;
        for kernel in kernels {
            let Kernel { xi, q, half_width, half_height, .. } = *kernel;
            let [from, to] = [xi - half_width, xi + half_width].map(|xi| (xi - self.first) * inverse);
            let last = to.min((self.num_lines - 1) as f32 * 0.125);
            for range in ranges.iter_mut().take((last + 1.0).max(0.0) as usize).skip(from.max(0.0) as usize) {
                *range = [range[0].min(q - half_height), range[1].max(q + half_height)];
            }
        }
        ranges
    }
}

/// Texels of eight lines, one of each.
#[derive(Clone, Copy)]
struct Texels<const CHANNELS: usize> {
    values: [TexelLanes; CHANNELS],
    place: TexelLanes,
}

/// Eight lanes of a row of line values.
#[inline(always)]
pub(super) fn load(row: &Row, at: usize) -> TexelLanes {
    let lanes: &[f32; 8] = row[at..at + 8].try_into().expect("a slice of eight");
    TexelLanes::new(*lanes)
}

pub(super) fn lane_indices() -> TexelLanes {
    TexelLanes::new([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
}

impl<const CHANNELS: usize> Profile<CHANNELS> {
    /// Sweeps the eight lines of a group over the bins between two seen places. Returns the number of rows.
    pub(super) fn sweep(&mut self, grid: &Grid, group: usize, [entry, exit]: [f32; 2]) -> u64 {
        if self.bins.len() < grid.num_bins {
            self.bins.resize(grid.num_bins, [[0.0; WIDTH]; CHANNELS]);
        }
        let bin_at = |place: f32| (place - grid.begin) / grid.step;
        let first_bin = bin_at(entry).max(0.0) as usize;
        let end_bin = (bin_at(exit).ceil() as usize).clamp(first_bin + 1, grid.num_bins);
        let lines = Lines::new(grid, group * 8);
        let [start, end] = [first_bin, end_bin].map(|bin| grid.begin + bin as f32 * grid.step);
        let mut walk = Walk::<CHANNELS>::new(grid, group * 8, [first_bin, end_bin]);
        let first_row = lines.row_before(start);
        // The deepest relief of the last row is seen behind all bins.
        let end_row = first_row + lines.rows_between(start, end);
        let mut last = lines.texels::<CHANNELS>(first_row);
        let mut row = first_row + 1;
        // Rows are read ahead, so that no branch on what they show waits for memory. None of the first ones can be the last.
        let mut read = [last; READ_AHEAD];
        let mut num_read = ((end - start) as usize).clamp(1, READ_AHEAD);
        while !walk.is_done && row < end_row {
            read[..num_read].iter_mut().zip(row..).for_each(|(read, row)| *read = lines.texels::<CHANNELS>(row));
            for next in &read[..num_read] {
                walk.pass(&last, next, &mut self.bins);
                last = *next;
            }
            row += num_read as i32;
            num_read = READ_AHEAD / 4;
        }
        walk.finish(&last, &mut self.bins);
        (row - first_row) as u64
    }
}

/// Eight lines on their way.
struct Walk<const CHANNELS: usize> {
    /// `M`, and the end of each line's bin.
    record: TexelLanes,
    bin_end: TexelLanes,
    /// Colour times length seen in the bin.
    sums: [TexelLanes; CHANNELS],
    bins: i32x8,
    /// The first line's place in a row of the profile, the bin where lines end, and whether all have.
    at: usize,
    end_bin: i32,
    is_done: bool,
    step: f32,
    inverse_step: f32,
}

impl<const CHANNELS: usize> Walk<CHANNELS> {
    fn new(grid: &Grid, at: usize, [first_bin, end_bin]: [usize; 2]) -> Self {
        let start = grid.begin + first_bin as f32 * grid.step;
        // Lines beyond the grid's last see nothing.
        let num_lines = (grid.num_lines - at).min(8);
        let (mut bin_end, mut bins) = ([f32::MAX; 8], [end_bin as i32; 8]);
        bin_end[..num_lines].fill(start + grid.step);
        bins[..num_lines].fill(first_bin as i32);
        Self {
            // No relief of the first row is seen beyond it.
            record: TexelLanes::splat(start),
            bin_end: TexelLanes::new(bin_end),
            sums: [TexelLanes::ZERO; CHANNELS],
            bins: i32x8::new(bins),
            at,
            end_bin: end_bin as i32,
            is_done: false,
            step: grid.step,
            inverse_step: 1.0 / grid.step,
        }
    }

    /// Adds what is seen beyond the record of the segment between two rows.
    #[inline(always)]
    fn pass(&mut self, last: &Texels<CHANNELS>, next: &Texels<CHANNELS>, bins: &mut [[Row; CHANNELS]]) {
        let new_record = self.record.fast_max(next.place);
        let inverse = TexelLanes::ONE / (next.place - last.place).fast_max(TexelLanes::splat(1e-6));
        loop {
            let to = new_record.fast_min(self.bin_end);
            // Where the middle of the visible part lies between the last texel (0) and the next one (1).
            let middle = ((self.record + to) * 0.5 - last.place) * inverse;
            let length = to - self.record;
            for i in 0..CHANNELS {
                self.sums[i] += (last.values[i] + (next.values[i] - last.values[i]) * middle) * length;
            }
            self.record = to;
            let is_full = to.simd_ge(self.bin_end);
            if !is_full.any() {
                break;
            }
            self.write(is_full, bins);
        }
    }

    /// Writes the bins of the lines that have passed their end: neighbours that pass together are in the same bin mostly.
    #[inline(always)]
    fn write(&mut self, is_full: TexelLanes, bins: &mut [[Row; CHANNELS]]) {
        let means = self.sums.map(|sum| sum * self.inverse_step);
        self.sums = self.sums.map(|sum| sum & !is_full);
        let mut left = is_full;
        let mut bits = left.to_bitmask();
        while bits != 0 {
            let number = self.bins.as_array()[bits.trailing_zeros() as usize & 7];
            let is_same = lanes(self.bins.simd_eq(i32x8::splat(number))) & left;
            let bin = &mut bins[number as usize];
            for i in 0..CHANNELS {
                let row: &mut [f32; 8] = (&mut bin[i][self.at..self.at + 8]).try_into().expect("a slice of eight");
                *row = is_same.select(means[i], TexelLanes::new(*row)).to_array();
            }
            left &= !is_same;
            bits = left.to_bitmask();
        }
        self.bins -= mask(is_full);
        let is_done = lanes(self.bins.simd_ge(i32x8::splat(self.end_bin)));
        self.bin_end = is_done.select(TexelLanes::splat(f32::MAX), self.bin_end + (is_full & TexelLanes::splat(self.step)));
        self.is_done = is_done.all();
    }

    /// Gives bins that rounding has left open the last colour.
    fn finish(&mut self, last: &Texels<CHANNELS>, bins: &mut [[Row; CHANNELS]]) {
        if self.is_done {
            return;
        }
        for lane in 0..8 {
            for bin in &mut bins[self.bins.as_array()[lane] as usize..self.end_bin as usize] {
                (0..CHANNELS).for_each(|i| bin[i][self.at + lane] = last.values[i].as_array()[lane]);
            }
        }
    }
}

/// Eight lines of a grid.
struct Lines<'a> {
    frame: &'a Frame<'a>,
    xi: TexelLanes,
    /// Rows down to the deepest relief in the middle of each line.
    depth: TexelLanes,
    /// The middle's row in the walking direction, and whether that is up (1) or down (-1).
    middle: f32,
    sign: i32,
}

impl<'a> Lines<'a> {
    fn new(grid: &Grid<'a>, first: usize) -> Self {
        let frame = grid.frame;
        let xi = (lane_indices() + first as f32) * grid.spacing + grid.first;
        let depth = xi * frame.tilt + frame.depth;
        Self { frame, xi, depth, middle: frame.toward * frame.origin[1], sign: frame.toward as i32 }
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

    /// The texels of a row.
    #[inline(always)]
    fn texels<const CHANNELS: usize>(&self, row: i32) -> Texels<CHANNELS> {
        let Frame { level, origin, shear, spread, growth, .. } = *self.frame;
        let q = row as f32 - self.middle;
        let x = self.xi * (spread * q + 1.0) + (origin[0] + shear * q);
        // By lanes, since the scalar conversion saturates.
        let left = TexelLanes::splat(x.as_array()[0]).floor();
        let place = x - left;
        let words = level.row(row * self.sign);
        let (start, stride) = (level.run_start(left.fast_trunc_int().as_array()[0]), level.stride());
        let cell = place.fast_trunc_int();
        let part = place - TexelLanes::from_i32x8(cell);
        let lanes = as_unsigned(cell);
        let pick = |plane: usize| {
            let run = Level::run(words, start + plane * stride);
            [run.shuffle(lanes), run.shuffle(lanes + u32x8::splat(1))]
        };
        let blend = Blend::new(part);
        let (red_green, blue_height) = (blend.mix(pick(0)), blend.mix(pick(1)));
        let color = [low_half(red_green), high_half(red_green), low_half(blue_height)];
        let mut values = [TexelLanes::ZERO; CHANNELS];
        values[..3].copy_from_slice(&color);
        if CHANNELS > 3 && level.has_normals() {
            let [near, far] = pick(2).map(unpack_normals);
            (3..CHANNELS).for_each(|i| values[i] = near[i - 3] + (far[i - 3] - near[i - 3]) * part);
        } else if CHANNELS > 3 {
            values[CHANNELS - 1] = TexelLanes::ONE;
        }
        let down = TexelLanes::ONE - high_half(blue_height) * (1.0 / FULL_F32);
        let place = (TexelLanes::splat(q) - down * self.depth) / (down * growth + 1.0);
        Texels { values, place }
    }
}
