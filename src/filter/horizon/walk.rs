//! What lines see on their way: the floating horizon itself.
//!
//! Each line keeps `M`, the farthest place seen so far. A row's texel at place `p` makes the part
//! from `M` to `p` visible, if there is one; the segment between two rows is linear, so the colour
//! of that part is the one at its middle. A line that passes the end of a bin writes the bin's mean
//! and those of the bins that lie in the rest of the part.
//!
//! ```text
//!   bins        |     0     |     1     |     2     |     3     |
//!   last row              *                                        seen at its place p
//!   next row                                    *
//!   M before                 ^                                     relief nearer than the last row reaches to here
//!   seen now                 |==|===========|===|                  from M to the place of the next row
//!                             ^ added to the sum of bin 0, which is full and written
//!                                ^ all of bin 1 is seen: its colour at its middle is written
//!                                            ^ begins the sum of bin 2
//! ```

use super::grid::{GROUP, Row, Texels};
use crate::simd::LineLanes;

/// Least length of a segment, in bins, that a place in it is divided by: a shorter one shows one
/// colour.
const LEAST_SEGMENT: f32 = 1e-6;

/// A group of lines on its way. Places are in bins.
pub(super) struct Walk<const CHANNELS: usize> {
    /// `M`, and the bin that it lies in.
    record: LineLanes,
    bin: LineLanes,
    /// Colour times length seen in the bin.
    sums: [LineLanes; CHANNELS],
    /// The first line's place in a row of the profile, and the bin where lines end.
    at: usize,
    end: LineLanes,
}

/// The segment between two rows, whose colours are linear between its ends.
struct Segment<'a, const CHANNELS: usize> {
    last: &'a Texels<CHANNELS>,
    next: &'a Texels<CHANNELS>,
    /// 1 over the length.
    inverse: LineLanes,
}

impl<const CHANNELS: usize> Segment<'_, CHANNELS> {
    /// Colour times length between two places.
    #[inline(always)]
    fn between(&self, from: LineLanes, to: LineLanes) -> [LineLanes; CHANNELS] {
        let Self { last, next, inverse } = self;
        // Where the middle lies between the last texel (0) and the next one (1).
        let (middle, length) = (((from + to) * 0.5 - last.place) * *inverse, to - from);
        std::array::from_fn(|i| {
            (last.values[i] + (next.values[i] - last.values[i]) * middle) * length
        })
    }

    /// The colour of one line at a place.
    #[inline(always)]
    fn at(&self, lane: usize, place: f32) -> [f32; CHANNELS] {
        let of = |lanes: &LineLanes| lanes.as_array()[lane];
        let part = (place - of(&self.last.place)) * of(&self.inverse);
        std::array::from_fn(|i| {
            let [last, next] = [&self.last.values[i], &self.next.values[i]].map(of);
            last + (next - last) * part
        })
    }
}

impl<const CHANNELS: usize> Walk<CHANNELS> {
    /// Sixteen lines from line `at` on, of which those beyond `num_lines` see nothing, over a range
    /// of bins.
    pub(super) fn new(num_lines: usize, at: usize, [first_bin, end_bin]: [usize; 2]) -> Self {
        let mut bins = [end_bin as f32; GROUP];
        bins[..(num_lines - at).min(GROUP)].fill(first_bin as f32);
        // M starts at the first bin: the first row lies before it.
        let record = LineLanes::new(bins);
        Self {
            record,
            bin: record,
            sums: [LineLanes::ZERO; CHANNELS],
            at,
            end: LineLanes::splat(end_bin as f32),
        }
    }

    /// Whether all bins of all lines are written.
    pub(super) fn is_done(&self) -> bool {
        self.bin.simd_ge(self.end).all()
    }

    /// Adds what is seen beyond the record of the segment between two rows.
    #[inline(always)]
    pub(super) fn pass(
        &mut self,
        last: &Texels<CHANNELS>,
        next: &Texels<CHANNELS>,
        bins: &mut [[Row; CHANNELS]],
    ) {
        let inverse =
            LineLanes::ONE / (next.place - last.place).fast_max(LineLanes::splat(LEAST_SEGMENT));
        let segment = Segment { last, next, inverse };
        // Move the record on, never back, and not beyond the last bin.
        let record = self.record.fast_max(next.place).fast_min(self.end);
        // Add what is seen within the lines' own bins.
        let bin_end = self.bin + LineLanes::ONE;
        let is_full = record.simd_ge(bin_end);
        let seen = segment.between(self.record, record.fast_min(bin_end));
        (0..CHANNELS).for_each(|i| self.sums[i] += seen[i]);
        // One test of all lines spares the writing where none has filled its bin.
        let full = is_full.to_bitmask();
        if full != 0 {
            let bin = record.floor();
            self.write(full, bin, &segment, bins);
            // Begin the sums of the bins that the records lie in now.
            let rest = segment.between(bin, record);
            (0..CHANNELS).for_each(|i| self.sums[i] = is_full.select(rest[i], self.sums[i]));
            self.bin = bin;
        }
        self.record = record;
    }

    /// Writes the bins from each full line's own one up to `end`.
    #[inline(always)]
    fn write(
        &self,
        full: u32,
        end: LineLanes,
        segment: &Segment<CHANNELS>,
        bins: &mut [[Row; CHANNELS]],
    ) {
        let [from, to] = [self.bin, end].map(|bin| bin.fast_trunc_int().to_array());
        let mut left = full;
        while left != 0 {
            // The mask tells the compiler what is so anyway: no lane is out of bounds.
            let lane = left.trailing_zeros() as usize & (GROUP - 1);
            let bins = &mut bins[from[lane] as usize..to[lane] as usize];
            // A bin is 1 long, so its sum of colour times length is its mean. The bins after it
            // lie wholly in the segment, which is linear: the colour at their middle is theirs.
            if let Some((first, others)) = bins.split_first_mut() {
                (0..CHANNELS)
                    .for_each(|i| first[i][self.at + lane] = self.sums[i].as_array()[lane]);
                for (bin, number) in others.iter_mut().zip(from[lane] + 1..) {
                    let color = segment.at(lane, number as f32 + 0.5);
                    (0..CHANNELS).for_each(|i| bin[i][self.at + lane] = color[i]);
                }
            }
            left &= left - 1;
        }
    }

    /// Gives bins that rounding has left open the last colour.
    pub(super) fn finish(&mut self, last: &Texels<CHANNELS>, bins: &mut [[Row; CHANNELS]]) {
        let end = self.end.as_array()[0] as usize;
        for lane in 0..GROUP {
            for bin in &mut bins[self.bin.as_array()[lane] as usize..end] {
                (0..CHANNELS)
                    .for_each(|i| bin[i][self.at + lane] = last.values[i].as_array()[lane]);
            }
        }
    }
}
