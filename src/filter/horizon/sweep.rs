//! The sweep: what is seen along each line of a patch, bin by bin.
//!
//! Bins cut the seen places into equal parts. Sixteen lines at a time are walked from the near end
//! to the far one, a block of steps after the other: first the heights of all its steps are read
//! ([`lines`](super::lines)), which tells where anything is seen, then the colours of these steps
//! alone. What is seen of them, and so the mean of each bin, is found in [`walk`](super::walk).
//!
//! ```text
//!   step      0   1   2   3   4   5   6   7   8      0 is the last one of the block before
//!   seen              *   *           *              some line sets a record there
//!   colours       +   +   +       +   +              read where a segment that is seen begins or ends
//! ```

use super::grid::{EMPTY_ROW, GROUP, Grid, Profile};
use super::lines::{Lines, MOST_STEPS, Steps};
use super::show::Show;
use super::walk::{Seen, Walk};
use crate::simd::{LineLanes, set_bits};

/// Steps of a block where any may be the last: short ones waste less.
const FEW_STEPS: usize = 8;

impl<const CHANNELS: usize> Profile<CHANNELS> {
    /// Sweeps the lines of a group over the bins between two seen places. Returns the number of
    /// steps.
    pub(super) fn sweep(
        &mut self,
        show: &impl Show<CHANNELS>,
        grid: &Grid,
        group: usize,
        range: [f32; 2],
    ) -> u64 {
        if grid.has_halves {
            self.sweep_by::<_, true>(show, grid, group, range)
        } else {
            self.sweep_by::<_, false>(show, grid, group, range)
        }
    }

    #[inline(never)]
    fn sweep_by<S: Show<CHANNELS>, const HALVES: bool>(
        &mut self,
        show: &S,
        grid: &Grid,
        group: usize,
        [entry, exit]: [f32; 2],
    ) -> u64 {
        if self.bins.len() < grid.num_bins {
            self.bins.resize(grid.num_bins, [EMPTY_ROW; CHANNELS]);
        }
        // Widen the range to whole bins, at least one: a bin holds the mean of all that it shows.
        let bin_at = |place: f32| (place - grid.begin) * grid.inverse_step;
        let first_bin = bin_at(entry).max(0.0) as usize;
        let end_bin = (bin_at(exit).ceil() as usize).clamp(first_bin + 1, grid.num_bins);
        let [start, end] = [first_bin, end_bin].map(|bin| grid.begin + bin as f32 * grid.step);
        let lines = Lines::<HALVES>::new(grid, group * GROUP);
        let mut walk = Walk::<CHANNELS>::new(grid.num_lines, group * GROUP, [first_bin, end_bin]);
        let (first, most) = lines.steps_between(start, end);
        let mut steps = Steps::new(first);
        lines.read(&mut steps, 1, show.others(), walk.bound());
        let mut num_read = 1;
        // A texel is never seen beyond its own row, so what lies before the exit cannot reach it:
        // these steps are read in long blocks.
        let num_before = ((end - start) as i32 * Lines::<HALVES>::STEPS) as usize;
        while !walk.is_done() && num_read < most {
            let num = num_before.saturating_sub(num_read).clamp(FEW_STEPS, MOST_STEPS);
            let is_seen = lines.read(&mut steps, num, show.others(), walk.bound());
            let mut last = Seen { values: S::NONE, place: LineLanes::ZERO };
            // A segment that is seen asks for the colours of both its ends.
            for i in set_bits(is_seen | is_seen >> 1) {
                let next = seen(show, &lines, &steps, i);
                last.place = steps.places[i.saturating_sub(1)];
                walk.pass(show, [last, next], &mut self.bins);
                last = next;
            }
            num_read += num;
        }
        if !walk.is_done() {
            // The deepest relief is seen behind all bins, unless rounding left some of them open.
            let last = seen(show, &lines, &steps, steps.num);
            walk.pass(show, [last, last.moved_to(walk.end)], &mut self.bins);
        }
        num_read as u64
    }
}

/// What lines see in a step that is read.
#[inline(always)]
fn seen<const CHANNELS: usize, const HALVES: bool, S: Show<CHANNELS>>(
    show: &S,
    lines: &Lines<HALVES>,
    steps: &Steps,
    i: usize,
) -> Seen<S::Values> {
    Seen { values: show.read(&lines.step(steps, i)), place: steps.places[i] }
}
