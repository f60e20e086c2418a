//! The mean of all texels of an ellipse, in one pass over the rows that it takes.

use super::gaussian::gaussian;
use super::sums::WideSums;
use crate::filter::texel_set::lane_columns;
use crate::filter::{Ellipse, FARTHEST, Filtered, Footprint, MAX_TEXELS, isotropic, level_within_budget};
use crate::settings::{Formulas, Settings};
use crate::simd::{LineLanes, from_words, join, join_words, line_indices, pick, u32x8, u32x16, words};
use crate::texture::{APRON, Level, Surface};
use std::f32::consts::FRAC_1_PI;

/// Shorter half axis of the ellipse in texels of the level that is taken, at least: the Gaussian's standard deviation, half
/// of that, is then 0.7 texels, below which their grid undersamples it. At most twice as much.
const LEAST_SHORT: f32 = 1.4;

/// Rows whose places are found at once.
const ROWS: usize = 16;

/// The mean of all texels of the ellipse, and how many were in the batches that were read: one pass over the rows of the
/// coarsest level on which the Gaussian is sampled well, or of the base level where `texel_budget` is 0. The normal is left
/// out where it is not asked for.
#[must_use]
pub fn mean(surface: &Surface, footprint: &Footprint, settings: &Settings, with_normal: bool) -> (Filtered, u64) {
    let (index, ellipse) = choose_level(surface, footprint, settings);
    let texels = surface.texels_per_repeat(index);
    let place = [0, 1].map(|i| footprint.center[i] * texels[i] - 0.5);
    // Rows along the longer side: fewer of them.
    let (levels, ellipse, place) = if ellipse.a > ellipse.c {
        (&surface.transposed, Ellipse { a: ellipse.c, c: ellipse.a, ..ellipse }, [place[1], place[0]])
    } else {
        (&surface.levels, ellipse, place)
    };
    let level = &levels[index];
    let (mean, num_read) = match (with_normal && level.has_normals(), settings.cut > 1.0) {
        (false, false) => scan::<false, false>(level, &ellipse, place, 1.0),
        (false, true) => scan::<false, true>(level, &ellipse, place, settings.cut),
        (true, false) => scan::<true, false>(level, &ellipse, place, 1.0),
        (true, true) => scan::<true, true>(level, &ellipse, place, settings.cut),
    };
    (mean.unwrap_or_else(|| isotropic::bilinear(surface, index, footprint.center)), num_read)
}

/// The level and the ellipse in its texels.
#[inline(always)]
pub(super) fn choose_level(surface: &Surface, footprint: &Footprint, settings: &Settings) -> (usize, Ellipse) {
    let Settings { formulas, max_anisotropy, texel_budget, .. } = *settings;
    if texel_budget == 0 || formulas == Formulas::Printed {
        return level_within_budget(surface, footprint, settings);
    }
    let base = surface.texels_per_repeat(0);
    let inverse_base = base.map(|texels| 1.0 / texels);
    let (ellipse, [short, long]) = Ellipse::new(footprint, base, formulas).bounded_with_axes(max_anisotropy);
    let most = (texel_budget as f32).min(MAX_TEXELS);
    let (mut index, last) = (0, surface.levels.len() - 1);
    // Square texels of the base level in one of the level.
    let mut area = 1.0;
    let is_wide = |area: f32| short > LEAST_SHORT * LEAST_SHORT * 4.0 * area;
    let wide = (short + settings.texel_kernel) * (long + settings.texel_kernel);
    let holds_more = |area: f32| wide > (most * area) * (most * area) * (FRAC_1_PI * FRAC_1_PI);
    while index < last && (is_wide(area) || holds_more(area)) {
        (index, area) = (index + 1, area * 4.0);
    }
    let texels = surface.texels_per_repeat(index);
    let [su, sv] = [texels[0] * inverse_base[0], texels[1] * inverse_base[1]];
    let kernel = kernel(area, settings.texel_kernel);
    let (a, b, c) = (ellipse.a * sv * sv + kernel, ellipse.b * su * sv, ellipse.c * su * su + kernel);
    (index, Ellipse { a, b, c, f: a * c - b * b * 0.25 })
}

/// What is added to the squares of an ellipse's axes on a level with texels of that area: the texels' own kernel, less what
/// averaging into the level has done to them (variance 1/12 of a texel, 1/12 of a base texel for the base level).
fn kernel(area: f32, texel_kernel: f32) -> f32 {
    (texel_kernel + 1.0 / 3.0) / area - 1.0 / 3.0
}

/// The mean over the ellipse around `place`, texel centres at whole numbers, cut at radius `cut`; `None` if it holds none.
#[inline(always)]
fn scan<const HAS_NORMALS: bool, const IS_WIDE: bool>(
    level: &Level,
    ellipse: &Ellipse,
    [x0, y0]: [f32; 2],
    cut: f32,
) -> (Option<Filtered>, u64) {
    let Ellipse { a, b, c, f } = *ellipse;
    // r^2 = (a (U + s V)^2 + (det / a) V^2) / f, where det is f but for a printed f.
    let (inverse_f, s) = (1.0 / f, b * 0.5 / a);
    let det = (a * c - b * b * 0.25).max(f32::MIN_POSITIVE);
    let [half_width, half_height] = [f / a, a * (f / det)].map(|square| cut * square.sqrt());
    if !(half_width.max(half_height) < 1e6 && f > 0.0) {
        return (None, 0);
    }
    // Rows of equal length, so that no branch depends on a row, and two rows at a time: what lies outside weighs nothing.
    let num = (half_width * 0.25) as i32 + 1;
    let num_rows = 2 * (half_height as i32 + 1);
    let first = (y0 - half_height).clamp(-FARTHEST, FARTHEST).ceil() as i32;
    let end = first + num_rows;
    let mut sums = WideSums::<HAS_NORMALS>::default();
    let limit = LineLanes::splat(cut * cut);
    let [a, b, c] = [a, b, c].map(|coefficient| coefficient * inverse_f);
    let columns = join([lane_columns(0); 2]);
    // What rows need is found for sixteen of them at once.
    for first in (first..end).step_by(ROWS) {
        let v = line_indices() + (first as f32 - y0);
        let starts = (LineLanes::splat(x0 - half_width) - v * s).ceil();
        let (from, linear, constant) = (starts - x0, v * b, v * v * c);
        let bound = LineLanes::splat(FARTHEST);
        let starts = starts.fast_max(-bound).fast_min(bound).fast_trunc_int();
        let mut two = join_words([u32x8::ZERO, u32x8::ONE]);
        for i in (0..(end - first).min(ROWS as i32)).step_by(2) {
            let of_two = |lanes: LineLanes| from_words(pick(words(lanes), two));
            let (u, linear, constant) = (of_two(from) + columns, of_two(linear), of_two(constant));
            let starts = [0, 1].map(|row| starts.as_array()[i as usize + row]);
            let rows = [level.row_start(first + i), level.row_start(first + i + 1)];
            // What the apron repeats lies in one piece.
            for block in (0..num).step_by(APRON / 8) {
                let runs = [0, 1].map(|i| rows[i] + level.run_start(starts[i] + 8 * block));
                for j in block..num.min(block + (APRON / 8) as i32) {
                    let u = u + (8 * j) as f32;
                    let r2 = ((u * a + linear) * u + constant).fast_max(LineLanes::ZERO);
                    let weight = gaussian::<IS_WIDE>(r2.fast_min(limit)) & r2.simd_le(limit);
                    sums.add_runs(level, runs.map(|run| run + 8 * (j - block) as usize), weight);
                }
            }
            two += u32x16::splat(2);
        }
    }
    (sums.mean(), num_rows as u64 * num as u64 * 8)
}
