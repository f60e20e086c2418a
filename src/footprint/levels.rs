//! All rules by which a mip level is chosen. They differ because they price different work:
//!
//! | rule | who uses it | the level is | what it pays for |
//! |---|---|---|---|
//! | [`of_size`], [`of_sizes`] | `trilinear`, `parallax` | the two whose texels are next to a length, blended | four texels, whatever the level: only blur against aliasing counts |
//! | [`longest_sides`] | `trilinear` | that length: the footprint's longer derivative | never aliases |
//! | [`parallax_sizes`] | `parallax` | that length: the shorter derivative, a sixteenth of the longer at least, less for many samples | as graphics cards do it |
//! | [`within_budget`] | `visible`, `ewa` by the letter | the finest whose ellipse holds at most so many texels | a test, or a ray, a texel |
//! | [`for_gaussian`] | `ewa` of every texel | as coarse as samples the Gaussian well, and within the budget | a weight a texel |
//! | [`for_lines`] | `ewa` along its axis | as coarse as the shorter axis allows, so that two or three rows hold the ellipse | a run of texels a row |
//! | [`for_sweep`] | `horizon` near by | the finest with at most so many texels across, less what the level would lose in occlusion | rows of sixteen lines |
//! | [`for_tables`] | `horizon` far away | the finest of the tables with at most so many texels across and along | four tables' texels |
//!
//! Levels are counted from the finest, 0. A level's texels are twice as large as the next finer
//! one's.

use super::{Ellipse, Ellipses, Footprint, Footprints};
use crate::settings::{Ewa, Formulas, Horizon, RECONSTRUCTION};
use crate::simd::{PixelLanes, i32x8, lanes, mask};
use crate::texture::{Level, Surface};
use std::f32::consts::FRAC_1_PI;

/// Most texels of an ellipse, whatever the budget: larger ones take a coarser level, so that a
/// pixel's time is bounded.
pub const MAX_TEXELS: f32 = (1 << 20) as f32;

/// Texels across a footprint at the most for so many `lines`: a finer level pays better than more
/// lines, and above 4 of them the more so. Measured, floor with shaded colours at 400x225, 12 lines:
/// 2 texels a line give 49.0 dB, and 44.0 in the rows where tables begin; 2.5 give 51.0 and 47.1 in
/// 1.09 of the time, and in the same time at 1280x720. With 4 lines 2 texels a line are right: 1.5 take
/// 3 to 4 dB from floor and torus, 2.5 take 1.1 of the time.
fn most_across(lines: u32) -> f32 {
    let lines = lines as f32;
    (2.75 * lines - 3.0).max(2.0 * lines)
}

/// Most rows of a pixel's sweep; a longer one takes a coarser level. Bounds the time of a pixel for
/// any input. Measured: with 512 the wall loses 0.4 dB, and thin high ridges 8 dB.
pub const MAX_ROWS: f32 = 1024.0;

/// The same of what is lit, of which a coarser level loses more: what faces the eye and what faces away
/// are not as bright. Tables take over soon beyond [`MAX_ROWS`]. Measured, an upright strip of the floor at
/// 1280x720 under suns 60, 30 and 10 degrees high: 46.0, 44.9, 42.5 dB, and 45.4, 42.1, 39.5 with 1024
/// rows; unlit frames gain 0.1 dB, and take 1.1 of the time.
pub const MAX_LIT_ROWS: f32 = 1536.0;

/// Greatest anisotropy of common practice.
const PARALLAX_ANISOTROPY: f32 = 16.0;

/// Shorter half axis of the ellipse in texels of the level that is taken, at least: the Gaussian's
/// standard deviation, half of that, is then 0.7 texels, below which their grid undersamples it. At
/// most twice as much.
const LEAST_SHORT: f32 = 1.4;

/// Variance of `exp(-2 r^2)` over the unit disc along a line through its middle.
pub const DISC_VARIANCE: f32 = 0.171_7;

/// The coarsest level is taken whose bilinear kernel has at most this many times the variance that
/// is wanted across the ellipse, with so many lines; sixteen times as many take a level finer.
/// Measured, 1280x720, floor, wall and torus: 0.99 gives 48.1, 47.9 and 42.9 dB, 1.4 gives 47.3, 47.6
/// and 42.4, 2.4 gives 44.4, 43.0 and 38.9, and at 3.4 the wall and the torus lose 5 more.
const MOST_BLUR: f32 = 1.4;
const LINES_OF_MOST_BLUR: f32 = 12.0;

/// Texels of a table across a footprint's shorter axis: at least this many, and less than twice as
/// many.
const TABLE_TEXELS_ACROSS: f32 = 3.0;

/// Most texels of a table along the longer axis, which bounds a pixel's time: a longer footprint
/// takes a coarser table. With 32 a street ends in flat rows, where the truth has streaks up to the
/// vanishing point; there 96 gives 47.0 dB and 256 49.6, in a fifth more time of a small frame.
const TABLE_TEXELS_ALONG: f32 = 256.0;

/// What the mean over a texel adds to the squares of an ellipse's half axes: four times the variance
/// of a square.
const TABLE_BOX: f32 = 1.0 / 3.0;

/// The finer level and the share of the coarser one for a texel size, in base texels: linear in
/// size between two levels.
pub fn of_size(size: f32) -> (usize, f32) {
    if size.is_nan() || size <= 1.0 {
        return (0, 0.0);
    }
    // The exponent of a float is the whole part of its logarithm.
    let exponent = (size.to_bits() >> 23) as i32 - 127;
    let mantissa = f32::from_bits(size.to_bits() & 0x007f_ffff | 0x3f80_0000);
    (exponent as usize, mantissa - 1.0)
}

/// [`of_size`] of eight sizes; none is beyond the last level.
#[inline]
pub fn of_sizes(size: PixelLanes, last: usize) -> (i32x8, PixelLanes) {
    let bits: i32x8 = mask(size);
    let is_large = mask(size.simd_gt(PixelLanes::ONE));
    let level = ((bits >> 23_i32) - 127) & is_large;
    let mantissa = lanes(bits & i32x8::splat(0x007f_ffff) | i32x8::splat(0x3f80_0000)) - 1.0;
    // Sizes up to 1 have level 0 and no share of the next: masks, and no branch.
    let last = i32x8::splat(last as i32);
    (level.min(last), mantissa & lanes(is_large & level.simd_lt(last)))
}

/// The longer derivatives of eight footprints in texels of the base level.
#[inline]
pub fn longest_sides(base: &Level, pixels: &Footprints) -> PixelLanes {
    let [x, y] = squared_sides(base, pixels);
    x.fast_max(y).sqrt()
}

/// Base texels per texel of the levels that common practice takes with so many samples a pixel.
#[inline]
pub fn parallax_sizes(base: &Level, pixels: &Footprints, num_samples: u32) -> PixelLanes {
    let [x, y] = squared_sides(base, pixels);
    let least = x.fast_max(y) * (1.0 / (PARALLAX_ANISOTROPY * PARALLAX_ANISOTROPY));
    (x.fast_min(y).fast_max(least) * (1.0 / num_samples as f32)).sqrt()
}

/// The squared derivatives of eight footprints along x and y, in texels of the base level.
#[inline(always)]
fn squared_sides(base: &Level, pixels: &Footprints) -> [PixelLanes; 2] {
    let texels = base.texels_per_repeat();
    [pixels.dx, pixels.dy].map(|[u, v]| {
        let (u, v) = (u * texels[0], v * texels[1]);
        u * u + v * v
    })
}

/// What the ellipses of the paper's method are bounded by.
#[derive(Clone, Copy, Debug)]
pub struct EllipseRule {
    /// As meant or as printed.
    pub formulas: Formulas,
    /// Most texels of an ellipse; 0: as many as there are at the base level, up to [`MAX_TEXELS`].
    pub texel_budget: u32,
    /// Longest axis over the shortest.
    pub max_anisotropy: f32,
}

impl EllipseRule {
    /// The ellipse of a footprint in texels of a level, with the texels' own kernel.
    pub fn ellipse(&self, footprint: &Footprint, level: &Level) -> Ellipse {
        let ellipse = Ellipse::new(footprint, level.texels_per_repeat(), self.formulas);
        ellipse.widened(self.max_anisotropy, self.formulas)
    }
}

/// The finest level on which the ellipse holds at most the budget's texels, and the ellipse in its
/// texels.
pub fn within_budget(
    surface: &Surface,
    footprint: &Footprint,
    rule: &EllipseRule,
) -> (usize, Ellipse) {
    let budget = if rule.texel_budget == 0 { MAX_TEXELS } else { rule.texel_budget as f32 };
    let at = |level: usize| rule.ellipse(footprint, &surface.levels()[level]);
    let last = surface.last_level();
    let level = (0..last).find(|&level| at(level).area() <= budget).unwrap_or(last);
    (level, at(level))
}

/// The level for the mean of all texels of an ellipse, and the ellipse in its texels, which have
/// their own kernel less what averaging into the level has done already.
#[inline(always)]
pub fn for_gaussian(surface: &Surface, footprint: &Footprint, ewa: &Ewa) -> (usize, Ellipse) {
    let Ewa { formulas, max_anisotropy, texel_budget, texel_kernel, .. } = *ewa;
    if texel_budget == 0 || formulas == Formulas::Printed {
        return within_budget(
            surface,
            footprint,
            &EllipseRule { formulas, texel_budget, max_anisotropy },
        );
    }
    let base = surface.base().texels_per_repeat();
    let inverse_base = base.map(|texels| 1.0 / texels);
    let (ellipse, [short, long]) =
        Ellipse::new(footprint, base, formulas).bounded_with_axes(max_anisotropy);
    let most = (texel_budget as f32).min(MAX_TEXELS);
    let (mut index, last) = (0, surface.last_level());
    // Square texels of the base level in one of the level.
    let mut area = 1.0;
    let is_wide = |area: f32| short > LEAST_SHORT * LEAST_SHORT * 4.0 * area;
    let wide = (short + texel_kernel) * (long + texel_kernel);
    let holds_more = |area: f32| wide > (most * area) * (most * area) * (FRAC_1_PI * FRAC_1_PI);
    // Coarsen while the ellipse is wider than sampling asks for, or holds too many texels. Areas
    // are compared as squares, which need no roots.
    while index < last && (is_wide(area) || holds_more(area)) {
        (index, area) = (index + 1, area * 4.0);
    }
    let texels = surface.levels()[index].texels_per_repeat();
    // Bring the ellipse to the level's texels, and add their kernel.
    let [su, sv] = [texels[0] * inverse_base[0], texels[1] * inverse_base[1]];
    let kernel = kernel(area, texel_kernel);
    let (a, b, c) =
        (ellipse.a * sv * sv + kernel, ellipse.b * su * sv, ellipse.c * su * su + kernel);
    (index, Ellipse { a, b, c, f: a * c - b * b * 0.25 })
}

/// What is added to the squares of an ellipse's axes on a level with texels of that area: the
/// texels' own kernel, less what averaging into the level has done to them (variance 1/12 of a
/// texel, 1/12 of a base texel for the base level).
fn kernel(area: f32, texel_kernel: f32) -> f32 {
    (texel_kernel + 1.0 / 3.0) / area - 1.0 / 3.0
}

/// The levels for lines of texels along the longer axes of ellipses in base texels: as coarse as
/// the shorter axes allow with so many `lines`, and so that at most so many texels lie along a line.
/// The greatest `n` with `4^n` up to a size is half the exponent of a float.
#[inline(always)]
pub fn for_lines(ellipses: &Ellipses, lines: u32, most_along: f32, last: usize) -> i32x8 {
    let power_of_4 = |size: PixelLanes| ((mask(size) >> 23_i32) - 127) >> 1_i32;
    let most_blur = MOST_BLUR * (LINES_OF_MOST_BLUR / lines as f32).sqrt();
    let for_width = power_of_4((ellipses.short * (4.0 * DISC_VARIANCE) + 1.0) * most_blur);
    let along = ellipses.long * DISC_VARIANCE + 0.25;
    let for_budget = power_of_4(along * (4.0 / (most_along * most_along)));
    for_width.max(for_budget).max(i32x8::ZERO).min(i32x8::splat(last as i32))
}

/// Extent of what a sweep reads, in base texels.
#[derive(Clone, Copy, Debug)]
pub struct SweepExtent {
    /// The shorter axis of the ellipses.
    pub across: f32,
    /// The longer axis of the ellipses.
    pub along: f32,
    /// Down to the deepest relief, along the longer axis of the displacement.
    pub depth: f32,
    /// Whether what it reads is lit.
    pub is_lit: bool,
}

/// The finest level on which a sweep of so many `lines` is at most 2 to 2.75 texels a line wide, and
/// short enough. What
/// the level loses in occlusion the caller has taken into account: each level finer doubles `lines`.
pub fn for_sweep(surface: &Surface, extent: &SweepExtent, lines: u32) -> usize {
    let base = surface.base().texels_per_repeat();
    let most_across = most_across(lines);
    let most_rows = if extent.is_lit { MAX_LIT_ROWS } else { MAX_ROWS };
    let fits = |level: &usize| {
        let texels = surface.levels()[*level].texels_per_repeat();
        // Sides may halve unevenly: the one with more texels counts.
        let scale = (texels[0] / base[0]).max(texels[1] / base[1]);
        extent.across * scale <= most_across && (extent.along + extent.depth) * scale <= most_rows
    };
    let last = surface.last_level();
    (0..last).find(fits).unwrap_or(last)
}

/// How many times too long the sweeps of eight pixels would be on the levels that their widths ask
/// for; `ellipses` are theirs in texels of the base level.
pub fn rows_in_excess(
    surface: &Surface,
    pixels: &Footprints,
    ellipses: &Ellipses,
    horizon: &Horizon,
) -> PixelLanes {
    let base = surface.base().texels_per_repeat();
    let [du, dv] = [0, 1].map(|i| pixels.displacement[i].abs() * base[i]);
    let rows = ellipses.long.sqrt() * 2.0 + du.fast_max(dv);
    let most_across = most_across(horizon.lines);
    let size = (ellipses.short.sqrt() * (2.0 / most_across)).fast_max(PixelLanes::ONE);
    rows / (size * MAX_ROWS)
}

/// The finest level, from the tables' first on, on which a footprint is at most so many texels
/// across and along, and the ellipse in its texels.
pub fn for_tables(
    surface: &Surface,
    first: usize,
    footprint: &Footprint,
    max_anisotropy: f32,
) -> (usize, Ellipse) {
    let at = |level: usize| {
        let texels = surface.levels()[level].texels_per_repeat();
        Ellipse::new(footprint, texels, Formulas::Meant).bounded(max_anisotropy)
    };
    let last = surface.last_level();
    let fits = |level: &usize| {
        let [short, long] = at(*level).squared_axes().map(f32::sqrt);
        2.0 * short < 2.0 * TABLE_TEXELS_ACROSS && 2.0 * long < TABLE_TEXELS_ALONG
    };
    let level = (first..last).find(fits).unwrap_or(last);
    let ellipse = at(level);
    let [short, long] = ellipse.squared_axes();
    // A thin ellipse may fall between texels: it gets their kernel.
    let kernel = RECONSTRUCTION * (2.0 - short).clamp(0.0, 1.0);
    // A table's texels are means of squares already: the ellipse is made narrower by as much.
    let kernel = kernel - TABLE_BOX.min(0.5 * short);
    let f = (short + kernel) * (long + kernel);
    (level, Ellipse { a: ellipse.a + kernel, b: ellipse.b, c: ellipse.c + kernel, f })
}
