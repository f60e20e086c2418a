//! The lines and bins of a sweep, and what the lines see in each bin.
//!
//! ```text
//!            line 0  1  2  3  ...   spacing texels apart, sixteen to a group
//!   bin 2   | mean | mean | ...     step rows long; a mean of every channel
//!   bin 1   | mean | mean |
//!   bin 0   | mean | mean |         begins at the seen place `begin`
//! ```

use super::pixels::PixelOnLines;
use super::sweep_frame::SweepFrame;
use crate::simd::LineLanes;

/// Most lines of a grid.
pub(super) const MOST_LINES: usize = 64;

/// Lines that are swept together, as lanes.
pub(super) const GROUP: usize = 16;

/// A kernel's vector of lines may begin at any line of the grid.
const WIDTH: usize = MOST_LINES + GROUP;

/// A value of each line.
pub(super) type Row = [f32; WIDTH];

/// A row before anything is seen.
pub(super) const EMPTY_ROW: Row = [0.0; WIDTH];

/// Lines and bins of a sweep.
#[derive(Clone, Debug)]
pub(super) struct Grid<'a> {
    pub(super) frame: &'a SweepFrame<'a>,
    /// How much farther apart than in the middle lines are at most.
    pub(super) most_scale: f32,
    /// `xi` of the first line, and how far apart lines are; below 1 texel.
    pub(super) first: f32,
    pub(super) spacing: f32,
    /// 1 over `spacing`.
    pub(super) inverse_spacing: f32,
    pub(super) num_lines: usize,
    /// The seen place where bins begin, and the length of a bin, in rows from the middle.
    pub(super) begin: f32,
    pub(super) step: f32,
    /// 1 over `step`.
    pub(super) inverse_step: f32,
    pub(super) num_bins: usize,
    /// Whether lines are read half way between rows, too.
    pub(super) has_halves: bool,
}

/// What the lines of a grid see: the mean of each line in each bin. Channels are colour, then
/// normal.
#[derive(Clone, Debug, Default)]
pub(super) struct Profile<const CHANNELS: usize> {
    pub(super) bins: Vec<[Row; CHANNELS]>,
}

impl Grid<'_> {
    /// The seen places that the pixels ask of each group of lines: first and last; the first is
    /// greater where none asks.
    pub(super) fn ranges(&self, kernels: &[PixelOnLines]) -> [[f32; 2]; MOST_LINES / GROUP] {
        let mut ranges = [[f32::MAX, f32::MIN]; MOST_LINES / GROUP];
        let inverse = self.inverse_spacing * (1.0 / GROUP as f32);
        for kernel in kernels {
            let PixelOnLines { xi, q, half_width, half_height, .. } = *kernel;
            let [from, to] =
                [xi - half_width, xi + half_width].map(|xi| (xi - self.first) * inverse);
            // Bounded by 0 before the casts, ellipses beside the grid ask for none of its groups.
            let last = to.min((self.num_lines - 1) as f32 * (1.0 / GROUP as f32));
            for range in
                ranges.iter_mut().take((last + 1.0).max(0.0) as usize).skip(from.max(0.0) as usize)
            {
                *range = [range[0].min(q - half_height), range[1].max(q + half_height)];
            }
        }
        ranges
    }
}

/// Sixteen lanes of a row of line values.
#[inline(always)]
pub(super) fn load(row: &Row, at: usize) -> LineLanes {
    let lanes: &[f32; GROUP] = row[at..at + GROUP].try_into().expect("a slice of sixteen");
    LineLanes::new(*lanes)
}
