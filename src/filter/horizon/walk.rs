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

use super::grid::{GROUP, Row};
use super::show::{Part, Show};
use crate::simd::{LineLanes, set_bits};

/// Least length of a segment, in bins, that a place in it is divided by: a shorter one shows one
/// colour.
const LEAST_SEGMENT: f32 = 1e-6;

/// What a group of lines reads in a step.
#[derive(Clone, Copy)]
pub(super) struct Seen<V> {
    pub(super) values: V,
    /// Where they are seen, in bins from the grid's first.
    pub(super) place: LineLanes,
}

impl<V> Seen<V> {
    /// The same, seen at another place if that is farther.
    pub(super) fn moved_to(self, place: LineLanes) -> Self {
        Self { place: self.place.fast_max(place), ..self }
    }
}

/// A group of lines on its way. Places are in bins.
pub(super) struct Walk<const CHANNELS: usize> {
    /// `M`, and the end of the bin that it lies in.
    record: LineLanes,
    bin_end: LineLanes,
    /// Colour times length seen in the bin.
    sums: [LineLanes; CHANNELS],
    /// The first line's place in a row of the profile, and the bin where lines end.
    at: usize,
    pub(super) end: LineLanes,
}

/// The segment between two steps.
#[derive(Clone, Copy)]
struct Segment<V> {
    last: Seen<V>,
    next: Seen<V>,
    /// Half of 1 over the length.
    half_inverse: LineLanes,
}

impl<V: Copy> Segment<V> {
    #[inline(always)]
    fn new(last: Seen<V>, next: Seen<V>) -> Self {
        let length = (next.place - last.place).fast_max(LineLanes::splat(LEAST_SEGMENT));
        Self { last, next, half_inverse: LineLanes::HALF / length }
    }

    /// Sums and what is shown times the length between two places.
    #[inline(always)]
    fn added_to<const CHANNELS: usize>(
        &self,
        show: &impl Show<CHANNELS, Values = V>,
        sums: [LineLanes; CHANNELS],
        [from, to]: [LineLanes; 2],
    ) -> [LineLanes; CHANNELS] {
        let Self { last, next, half_inverse } = self;
        // Where the middle lies between the last texel (0) and the next one (1).
        let middle = ((from - last.place) + (to - last.place)) * *half_inverse;
        let length = to - from;
        let part = Part { middle, length: length * (*half_inverse + *half_inverse) };
        show.added_to(sums, [&last.values, &next.values], &part, length)
    }

    /// What is shown on bins around places.
    #[inline(always)]
    fn at<const CHANNELS: usize>(
        &self,
        show: &impl Show<CHANNELS, Values = V>,
        place: LineLanes,
    ) -> [LineLanes; CHANNELS] {
        let Self { last, next, half_inverse } = self;
        let length = *half_inverse + *half_inverse;
        let part = Part { middle: (place - last.place) * length, length };
        show.between([&last.values, &next.values], &part)
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
            bin_end: record + 1.0,
            sums: [LineLanes::ZERO; CHANNELS],
            at,
            end: LineLanes::splat(end_bin as f32),
        }
    }

    /// Whether all bins of all lines are written.
    pub(super) fn is_done(&self) -> bool {
        self.bin_end.simd_gt(self.end).all()
    }

    /// What a texel must be seen beyond to be seen at all: nothing is where all bins are written.
    pub(super) fn bound(&self) -> LineLanes {
        self.record.simd_ge(self.end).select(LineLanes::splat(f32::MAX), self.record)
    }

    /// Adds what is seen beyond the record of the segment between two steps.
    #[inline(always)]
    pub(super) fn pass<S: Show<CHANNELS>>(
        &mut self,
        show: &S,
        [last, next]: [Seen<S::Values>; 2],
        bins: &mut [[Row; CHANNELS]],
    ) {
        let segment = Segment::new(last, next);
        // Move the record on, never back, and not beyond the last bin.
        let record = self.record.fast_max(next.place).fast_min(self.end);
        // Add what is seen within the lines' own bins.
        let is_full = record.simd_ge(self.bin_end);
        self.sums = segment.added_to(show, self.sums, [self.record, record.fast_min(self.bin_end)]);
        self.record = record;
        // One test of all lines spares the writing where none has filled its bin.
        let full = is_full.to_bitmask();
        if full != 0 {
            // A bin is 1 long, so its sum of colour times length is its mean.
            let own = (self.bin_end - 1.0).fast_trunc_int().to_array();
            let sums = self.sums.map(LineLanes::to_array);
            for lane in set_bits(full) {
                let bin = &mut bins[own[lane] as usize];
                (0..CHANNELS).for_each(|i| bin[i][self.at + lane] = sums[i][lane]);
            }
            let bin = record.floor();
            let long = bin.simd_gt(self.bin_end).to_bitmask() & full;
            if long != 0 {
                // A copy, so that what is used at each step needs not be in memory.
                fill(show, (long, self.at), [self.bin_end, bin], segment, bins);
            }
            // Begin the sums of the bins that the records lie in now.
            let rest = segment.added_to(show, [LineLanes::ZERO; CHANNELS], [bin, record]);
            (0..CHANNELS).for_each(|i| self.sums[i] = is_full.select(rest[i], self.sums[i]));
            self.bin_end = bin + 1.0;
        }
    }
}

/// Writes bins of some lanes that lie wholly in a segment: the colour at their middle is theirs.
#[inline(never)]
fn fill<const CHANNELS: usize, S: Show<CHANNELS>>(
    show: &S,
    (lanes, at): (u32, usize),
    [from, to]: [LineLanes; 2],
    segment: Segment<S::Values>,
    bins: &mut [[Row; CHANNELS]],
) {
    let mut number = from;
    let mut left = lanes;
    while left != 0 {
        let colors = segment.at(show, number + 0.5).map(LineLanes::to_array);
        let numbers = number.fast_trunc_int().to_array();
        for lane in set_bits(left) {
            let bin = &mut bins[numbers[lane] as usize];
            (0..CHANNELS).for_each(|i| bin[i][at + lane] = colors[i][lane]);
        }
        number += LineLanes::ONE;
        left &= number.simd_lt(to).to_bitmask();
    }
}
