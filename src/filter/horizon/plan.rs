//! A planned patch: where its ellipses lie, how its lines are set, and the sweep over them.

use super::grid::{GROUP, Grid, MOST_LINES, Profile};
use super::kernel::Totals;
use super::pixels::PixelOnLines;
use super::show::Show;
use super::sweep_frame::SweepFrame;
use crate::light::LocalLights;
use crate::texture::Level;

/// Where texels are about as large as pixels, and lines lean by at least so much, they are read half
/// way between rows, too: a bilinear surface has a kink wherever a line crosses a column, and bends
/// between. 2.5 dB on the wall at 1280x720, for a tenth of its time.
const LEAST_SHEAR: f32 = 0.15;

/// Greatest half width, in texels, of an ellipse that shows such kinks.
const KINK_WIDTH: f32 = 4.0;

/// The same of one that shows what lies between texels under a sun. Measured on the floor, a sun 30 degrees
/// high: 3 has 0.3 dB more in 1.05 of the time, since the words of light do not stay in the caches.
const NEAR_WIDTH: f32 = 2.5;

/// Greatest distance between lines in texels: sixteen lines and their neighbours lie within 32
/// texels, two loads.
pub(super) const WIDEST: f32 = 1.99;

/// How much of a group lines may exceed whole groups by before there is one more.
const SLACK: f32 = 0.2;

/// A patch that one sweep can hold.
pub(super) struct Plan<'a> {
    pub(super) level: usize,
    pub(super) frame: SweepFrame<'a>,
    pub(super) extent: Extent,
    /// Greatest distance between lines over that in the middle.
    pub(super) most_scale: f32,
    /// Distance between lines in the middle, in texels.
    pub(super) spacing: f32,
    /// Length of a bin in rows.
    pub(super) step: f32,
}

/// How many times as long as it is along a line an ellipse may be taken for that stands aslant on the
/// lines, as its height says: bins must be shorter than it is along a line, or nothing of it is left
/// when their blur is taken off.
const MOST_SLANT: f32 = 1.6;

/// The extent of a patch: least and greatest `xi` and `q` of its ellipses, the greatest width and
/// the least height, as far as bins go by it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) xi: [f32; 2],
    pub(super) q: [f32; 2],
    pub(super) half_width: f32,
    pub(super) half_height: f32,
    /// Rows times lines of all pixels, each swept on its own.
    pub(super) area: f32,
}

/// The distance between lines nearest to `spacing` with which lines across `width` fill groups:
/// lanes that are left over cost as much as those that are not.
pub(super) fn in_whole_groups(width: f32, spacing: f32, widest: f32) -> f32 {
    let groups = width / (spacing * GROUP as f32);
    let fewest = width / (widest * GROUP as f32);
    width / (GROUP as f32 * (groups - SLACK).max(fewest).ceil().max(1.0))
}

impl Extent {
    /// Of pixels on lines that are walked so many rows down to the deepest relief.
    pub(super) fn of(pixels: &[PixelOnLines], depth: f32) -> Self {
        let mut extent = Self {
            xi: [f32::MAX, f32::MIN],
            q: [f32::MAX, f32::MIN],
            half_width: 0.0,
            half_height: f32::MAX,
            area: 0.0,
        };
        for pixel in pixels {
            let PixelOnLines { xi, q, along, half_width, half_height, .. } = *pixel;
            extent.xi = [extent.xi[0].min(xi - half_width), extent.xi[1].max(xi + half_width)];
            extent.q = [extent.q[0].min(q - half_height), extent.q[1].max(q + half_height)];
            extent.half_width = extent.half_width.max(half_width);
            extent.half_height = extent.half_height.min(half_height).min(MOST_SLANT / along);
            // By itself the pixel would be walked over its ellipse and down to the deepest relief.
            extent.area += 2.0 * half_width * (2.0 * half_height + depth);
        }
        extent
    }
}

impl Plan<'_> {
    /// Whether it is seen what lies between texels.
    pub(super) fn is_near(&self) -> bool {
        self.level == 0 && self.extent.half_width < NEAR_WIDTH
    }

    /// The same on the texels of another level with the same heights.
    pub(super) fn on<'b>(&'b self, level: &'b Level) -> Plan<'b> {
        let mut frame: SweepFrame<'b> = self.frame.clone();
        frame.rows = level.rows(frame.is_turned);
        Plan { frame, ..*self }
    }

    /// Sweeps all lines and adds what they see to the pixels. Returns the number of rows.
    pub(super) fn run<const CHANNELS: usize>(
        &self,
        show: &impl Show<CHANNELS>,
        profile: &mut Profile<CHANNELS>,
        (pixels, lights): (&[PixelOnLines], &[LocalLights]),
        totals: &mut [Totals],
    ) -> u64 {
        let Extent { xi, q, .. } = self.extent;
        let spacing = self.spacing;
        // Lines lie in the middles of as many strips, which cover the patch.
        let num_lines = ((xi[1] - xi[0]) / spacing).round() as usize;
        let first = xi[0] + spacing * 0.5;
        let num_bins = ((q[1] - q[0]) / self.step).ceil().max(1.0) as usize;
        let has_halves = self.level == 0
            && self.frame.shear.abs() > LEAST_SHEAR
            && self.extent.half_width < KINK_WIDTH;
        let mut num_rows = 0;
        // Sweep a grid at a time, and weigh it before the next: its bins are still in the cache.
        for line in (0..num_lines).step_by(MOST_LINES) {
            let grid = Grid {
                frame: &self.frame,
                most_scale: self.most_scale,
                first: first + line as f32 * spacing,
                spacing,
                inverse_spacing: 1.0 / spacing,
                num_lines: (num_lines - line).min(MOST_LINES),
                begin: q[0],
                step: self.step,
                inverse_step: 1.0 / self.step,
                num_bins,
                has_halves,
            };
            for (group, range) in grid.ranges(pixels).into_iter().enumerate() {
                if range[0] < range[1] {
                    num_rows += profile.sweep(show, &grid, group, range);
                }
            }
            // A pixel's lines may lie on several grids: the totals go on, in this order everywhere.
            for (i, (pixel, totals)) in pixels.iter().zip(totals.iter_mut()).enumerate() {
                totals.add(profile, &grid, pixel, lights.get(i));
            }
        }
        num_rows
    }
}
