//! The sweep: what is seen along each line of a patch, bin by bin.
//!
//! Each line keeps `M`, the farthest place seen so far. A row's texel at place `p` makes the part from `M` to `p` visible,
//! if there is one; the segment between two rows is linear, so the colour of that part is the one at its middle. Bins cut
//! the seen places into equal parts. A line that passes the end of a bin writes the bin's mean and goes on with the next.

use super::frame::Frame;
use super::kernel::Kernel;
use crate::filter::unpack_normals;
use crate::simd::{
    LineBlend, LineLanes, TexelLanes, halves, high_halves, i32x16, join, line_lanes, line_mask, low_halves, pick_words,
};
use crate::texture::FULL_F32;

/// Most lines of a grid.
pub(super) const MOST_LINES: usize = 64;

/// Most rows that are read before what they show is looked at.
const READ_AHEAD: usize = 32;

/// Lines that are swept together, as lanes.
pub(super) const GROUP: usize = 16;

/// A kernel's vector of eight may begin at any line of the grid.
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
    /// The seen places that the pixels ask of each group of lines: first and last; the first is greater where none
    /// asks.
    pub(super) fn ranges(&self, kernels: &[Kernel]) -> [[f32; 2]; MOST_LINES / GROUP] {
        let mut ranges = [[f32::MAX, f32::MIN]; MOST_LINES / GROUP];
        let inverse = 1.0 / (GROUP as f32 * self.spacing);
        for kernel in kernels {
            let Kernel { xi, q, half_width, half_height, .. } = *kernel;
            let [from, to] = [xi - half_width, xi + half_width].map(|xi| (xi - self.first) * inverse);
            let last = to.min((self.num_lines - 1) as f32 * (1.0 / GROUP as f32));
            for range in ranges.iter_mut().take((last + 1.0).max(0.0) as usize).skip(from.max(0.0) as usize) {
                *range = [range[0].min(q - half_height), range[1].max(q + half_height)];
            }
        }
        ranges
    }
}

/// Texels of a group of lines, one of each.
#[derive(Clone, Copy)]
struct Texels<const CHANNELS: usize> {
    values: [LineLanes; CHANNELS],
    place: LineLanes,
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

fn line_indices() -> LineLanes {
    LineLanes::new(std::array::from_fn(|i| i as f32))
}

impl<const CHANNELS: usize> Profile<CHANNELS> {
    /// Sweeps the lines of a group over the bins between two seen places. Returns the number of rows.
    pub(super) fn sweep(&mut self, grid: &Grid, group: usize, [entry, exit]: [f32; 2]) -> u64 {
        if self.bins.len() < grid.num_bins {
            self.bins.resize(grid.num_bins, [[0.0; WIDTH]; CHANNELS]);
        }
        let bin_at = |place: f32| (place - grid.begin) / grid.step;
        let first_bin = bin_at(entry).max(0.0) as usize;
        let end_bin = (bin_at(exit).ceil() as usize).clamp(first_bin + 1, grid.num_bins);
        let lines = Lines::new(grid, group * GROUP);
        let [start, end] = [first_bin, end_bin].map(|bin| grid.begin + bin as f32 * grid.step);
        let mut walk = Walk::<CHANNELS>::new(grid, group * GROUP, [first_bin, end_bin]);
        let first_row = lines.row_before(start);
        // The deepest relief of the last row is seen behind all bins.
        let end_row = first_row + lines.rows_between(start, end);
        let mut last = lines.texels::<CHANNELS>(first_row, lines.start_of(first_row));
        let mut row = first_row + 1;
        // Rows are read ahead, so that no branch on what they show waits for memory. None of the first ones can be the last.
        let mut read = [last; READ_AHEAD];
        let mut num_read = ((end - start) as usize).clamp(1, READ_AHEAD);
        while !walk.is_done && row < end_row {
            lines.read(row, &mut read[..num_read]);
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

/// A group of lines on its way.
struct Walk<const CHANNELS: usize> {
    /// `M`, and the end of each line's bin.
    record: LineLanes,
    bin_end: LineLanes,
    /// Colour times length seen in the bin.
    sums: [LineLanes; CHANNELS],
    bins: i32x16,
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
        let num_lines = (grid.num_lines - at).min(GROUP);
        let (mut bin_end, mut bins) = ([f32::MAX; GROUP], [end_bin as i32; GROUP]);
        bin_end[..num_lines].fill(start + grid.step);
        bins[..num_lines].fill(first_bin as i32);
        Self {
            // No relief of the first row is seen beyond it.
            record: LineLanes::splat(start),
            bin_end: LineLanes::new(bin_end),
            sums: [LineLanes::ZERO; CHANNELS],
            bins: i32x16::new(bins),
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
        let inverse = LineLanes::ONE / (next.place - last.place).fast_max(LineLanes::splat(1e-6));
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
    fn write(&mut self, is_full: LineLanes, bins: &mut [[Row; CHANNELS]]) {
        let means = self.sums.map(|sum| sum * self.inverse_step);
        self.sums = self.sums.map(|sum| sum & !is_full);
        let mut left = is_full;
        let mut bits = left.to_bitmask();
        while bits != 0 {
            let number = self.bins.as_array()[bits.trailing_zeros() as usize & (GROUP - 1)];
            let is_same = line_lanes(self.bins.simd_eq(i32x16::splat(number))) & left;
            let bin = &mut bins[number as usize];
            for i in 0..CHANNELS {
                let row: &mut [f32; GROUP] = (&mut bin[i][self.at..self.at + GROUP]).try_into().expect("a slice of a group");
                *row = is_same.select(means[i], LineLanes::new(*row)).to_array();
            }
            left &= !is_same;
            bits = left.to_bitmask();
        }
        self.bins -= line_mask(is_full);
        let is_done = line_lanes(self.bins.simd_ge(i32x16::splat(self.end_bin)));
        self.bin_end =
            is_done.select(LineLanes::splat(f32::MAX), self.bin_end + (is_full & LineLanes::splat(self.step)));
        self.is_done = is_done.all();
    }

    /// Gives bins that rounding has left open the last colour.
    fn finish(&mut self, last: &Texels<CHANNELS>, bins: &mut [[Row; CHANNELS]]) {
        if self.is_done {
            return;
        }
        for lane in 0..GROUP {
            for bin in &mut bins[self.bins.as_array()[lane] as usize..self.end_bin as usize] {
                (0..CHANNELS).for_each(|i| bin[i][self.at + lane] = last.values[i].as_array()[lane]);
            }
        }
    }
}

/// A group of lines of a grid.
struct Lines<'a> {
    frame: &'a Frame<'a>,
    xi: LineLanes,
    /// Rows down to the deepest relief in the middle of each line.
    depth: LineLanes,
    /// The middle's row in the walking direction, and whether that is up (1) or down (-1).
    middle: f32,
    sign: i32,
}

impl<'a> Lines<'a> {
    fn new(grid: &Grid<'a>, first: usize) -> Self {
        let frame = grid.frame;
        let xi = (line_indices() + first as f32) * grid.spacing + grid.first;
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

    /// The texels of neighbouring rows from `first` on.
    #[inline(always)]
    fn read<const CHANNELS: usize>(&self, first: i32, read: &mut [Texels<CHANNELS>]) {
        let mut starts = [0; READ_AHEAD];
        let (words, stride) = (self.frame.level.words(), self.frame.level.stride());
        // One word of each plane first: many rows come from memory at once, where the long work on a row lets few.
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
        let Frame { origin, shear, spread, .. } = *self.frame;
        let q = row as f32 - self.middle;
        self.xi * (spread * q + 1.0) + (origin[0] + shear * q)
    }

    /// Where the run of texels around the lines in a row starts among the level's words.
    #[inline(always)]
    fn start_of(&self, row: i32) -> usize {
        let x = LineLanes::splat(self.columns(row).as_array()[0]);
        // By lanes, since the scalar conversion saturates.
        self.frame.level.start_at(x.floor().fast_trunc_int().as_array()[0], row * self.sign)
    }

    /// The texels of a row.
    #[inline(always)]
    fn texels<const CHANNELS: usize>(&self, row: i32, start: usize) -> Texels<CHANNELS> {
        let Frame { level, growth, .. } = *self.frame;
        let q = row as f32 - self.middle;
        let x = self.columns(row);
        let place = x - LineLanes::splat(x.as_array()[0]).floor();
        let (words, stride) = (level.words(), level.stride());
        let cell = place.fast_trunc_int();
        let part = place - LineLanes::from_i32x16(cell);
        let pick = |plane: usize| pick_words(words, start + plane * stride, cell);
        let blend = LineBlend::new(part);
        let (red_green, blue_height) = (blend.mix(pick(0)), blend.mix(pick(1)));
        let color = [low_halves(red_green), high_halves(red_green), low_halves(blue_height)];
        let mut values = [LineLanes::ZERO; CHANNELS];
        values[..3].copy_from_slice(&color);
        if CHANNELS > 3 && level.has_normals() {
            let [near, far] = pick(2).map(|words| {
                let [a, b] = halves(words).map(unpack_normals);
                [0, 1, 2].map(|i| join([a[i], b[i]]))
            });
            (3..CHANNELS).for_each(|i| values[i] = near[i - 3] + (far[i - 3] - near[i - 3]) * part);
        } else if CHANNELS > 3 {
            values[CHANNELS - 1] = LineLanes::ONE;
        }
        let down = LineLanes::ONE - high_halves(blue_height) * (1.0 / FULL_F32);
        let place = (LineLanes::splat(q) - down * self.depth) / (down * growth + 1.0);
        Texels { values, place }
    }
}
