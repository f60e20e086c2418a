//! Which rows of texels the ellipses of eight pixels take, and the mean over them.

use super::gaussian::gaussian;
use super::sums::PairSums;
use super::{EllipseMeans, power_of_4, texels_a_repeat};
use crate::filter::texel_set::lane_columns;
use crate::filter::{Filtered, MAX_TEXELS, PixelFootprints, level_within_budget};
use crate::settings::{Formulas, Settings};
use crate::simd::{LineLanes, PixelLanes, TexelLanes, i32x8, join, lanes, mask};
use crate::texture::{APRON, Level, Surface};
use std::f32::consts::FRAC_1_PI;

/// Shorter half axis of the ellipse in texels of the level that is taken, at least: the Gaussian's standard deviation, half
/// of that, is then 0.7 texels, below which their grid undersamples it. At most twice as much.
const LEAST_SHORT: f32 = 1.4;

/// Ellipses `a U^2 + b U V + c V^2 = 1` of eight pixels, each in the texels of its level, transposed where its rows then run
/// along its longer side, and the texels they take: rows of equal length, so that no branch depends on a row.
#[derive(Clone, Copy, Debug)]
pub struct Scans {
    center: [PixelLanes; 2],
    level: i32x8,
    /// Whether rows run along v.
    is_turned: i32x8,
    a: PixelLanes,
    b: PixelLanes,
    c: PixelLanes,
    /// How far a row's middle moves from row to row.
    slope: PixelLanes,
    /// The middle along and across the rows, texel centres at whole numbers.
    place: [PixelLanes; 2],
    half_width: PixelLanes,
    /// The first row, and how many pairs of rows.
    rows: [i32x8; 2],
    /// Eight texels each.
    num_batches: i32x8,
    /// Square of the greatest distance, in pixels.
    limit: f32,
}

impl EllipseMeans for Scans {
    /// For pixels in repeats; of the settings those count that `Ewa` names.
    fn new(surface: &Surface, pixels: &PixelFootprints, settings: &Settings) -> Self {
        let cut = settings.cut;
        let Placed { level, texels, a, b, c, f } =
            if settings.texel_budget == 0 || settings.formulas == Formulas::Printed {
                Placed::one_by_one(surface, pixels, settings)
            } else {
                Placed::coarsest(surface, pixels, settings)
            };
        let place = [0, 1].map(|i| pixels.center[i] * texels[i] - 0.5);
        // Rows along the longer side: fewer of them.
        let is_turned = a.simd_gt(c);
        let swapped =
            |[first, second]: [PixelLanes; 2]| [is_turned.select(second, first), is_turned.select(first, second)];
        let ([a, c], place) = (swapped([a, c]), swapped(place));
        // r^2 = (a (U + s V)^2 + (det / a) V^2) / f, where det is f but for a printed f.
        let determinant = (a * c - b * b * 0.25).fast_max(PixelLanes::splat(f32::MIN_POSITIVE));
        let [half_width, half_height] = [f / a, a * (f / determinant)].map(|square| square.sqrt() * cut);
        let is_small = half_width.fast_max(half_height).simd_lt(PixelLanes::splat(1e6)) & f.simd_gt(PixelLanes::ZERO);
        let first = (place[1] - half_height).ceil().fast_trunc_int();
        let last = (place[1] + half_height).floor().fast_trunc_int();
        let inverse_f = PixelLanes::ONE / f;
        Self {
            center: pixels.center,
            level,
            is_turned: mask(is_turned),
            a: a * inverse_f,
            b: b * inverse_f,
            c: c * inverse_f,
            slope: b * 0.5 / a,
            place,
            half_width,
            rows: [first, ((last - first + 2) >> 1_i32) & mask(is_small)],
            num_batches: (half_width * 0.25).fast_min(PixelLanes::splat(1e6)).fast_trunc_int() + 1,
            limit: cut * cut,
        }
    }

    #[inline(always)]
    fn mean<const HAS_NORMALS: bool>(&self, surface: &Surface, lane: usize) -> (Filtered, u64) {
        let is_turned = self.is_turned.as_array()[lane] != 0;
        let index = self.level.as_array()[lane] as usize;
        let level = if is_turned { &surface.transposed[index] } else { &surface.levels[index] };
        let sums: PairSums<HAS_NORMALS> =
            if self.limit > 1.0 { self.scan::<true, _>(level, lane) } else { self.scan::<false, _>(level, lane) };
        let num_pairs = self.rows[1].as_array()[lane].max(0);
        let num_read = 16 * u64::from(num_pairs.unsigned_abs() * self.num_batches.as_array()[lane].unsigned_abs());
        let center = [0, 1].map(|i| self.center[i].as_array()[lane]);
        (sums.mean().unwrap_or_else(|| super::between_texels(surface, index, center)), num_read)
    }
}

impl Scans {
    /// Sums over the rows of one pixel, two rows at a time: what lies outside the ellipse weighs nothing.
    #[inline(always)]
    fn scan<const IS_WIDE: bool, const HAS_NORMALS: bool>(&self, level: &Level, lane: usize) -> PairSums<HAS_NORMALS> {
        let at = |lanes: &PixelLanes| lanes.as_array()[lane];
        let [a, b, c, slope, half_width] = [&self.a, &self.b, &self.c, &self.slope, &self.half_width].map(at);
        let [x0, y0] = self.place.each_ref().map(at);
        let [first_row, num_pairs] = self.rows.map(|rows| rows.as_array()[lane]);
        let num = self.num_batches.as_array()[lane];
        let limit = LineLanes::splat(self.limit);
        let mut sums = PairSums::default();
        for pair in 0..num_pairs {
            let y = first_row + 2 * pair;
            let v = [0.0, 1.0].map(|row| y as f32 + row - y0);
            let starts = v.map(|v| (x0 - slope * v - half_width).ceil());
            let u = join(starts.map(|start| lane_columns(0) + (start - x0)));
            let linear = join(v.map(|v| TexelLanes::splat(b * v)));
            let constant = join(v.map(|v| TexelLanes::splat(c * v * v)));
            let rows = [level.row_start(y), level.row_start(y + 1)];
            // What the apron repeats lies in one piece.
            for first in (0..num).step_by(APRON / 8) {
                let runs = [0, 1].map(|i| rows[i] + level.run_start(starts[i] as i32 + 8 * first));
                for i in first..num.min(first + (APRON / 8) as i32) {
                    let u = u + (8 * i) as f32;
                    let r2 = ((u * a + linear) * u + constant).fast_max(LineLanes::ZERO);
                    let weight = gaussian::<IS_WIDE>(r2.fast_min(limit)) & r2.simd_le(limit);
                    sums.add(level, runs.map(|run| run + 8 * (i - first) as usize), weight);
                }
            }
        }
        sums
    }
}

/// Eight ellipses in the texels of their levels.
struct Placed {
    level: i32x8,
    /// Texels a repeat.
    texels: [PixelLanes; 2],
    a: PixelLanes,
    b: PixelLanes,
    c: PixelLanes,
    f: PixelLanes,
}

impl Placed {
    /// On the coarsest levels whose texels sample the Gaussian, and that hold no more texels than the budget.
    fn coarsest(surface: &Surface, pixels: &PixelFootprints, settings: &Settings) -> Self {
        let Settings { max_anisotropy, texel_budget, texel_kernel, .. } = *settings;
        let base = surface.texels_per_repeat(0);
        let conics = pixels.conics(base, max_anisotropy);
        let most = (texel_budget as f32).min(MAX_TEXELS) * FRAC_1_PI;
        // The square of the short axis falls by 4 with each level, the square of the area by 16.
        let for_width = power_of_4(conics.short * (1.0 / (LEAST_SHORT * LEAST_SHORT)));
        let area = (conics.short + texel_kernel) * (conics.long + texel_kernel);
        let for_budget = power_of_4((area * (16.0 / (most * most))).sqrt());
        let last = surface.levels.len() as i32 - 1;
        let level = for_width.max(for_budget).max(i32x8::ZERO).min(i32x8::splat(last));
        let texels = texels_a_repeat(surface, level);
        let [su, sv] = [texels[0] * (1.0 / base[0]), texels[1] * (1.0 / base[1])];
        // Square texels of the base level in one of the level.
        let per_texel = lanes((i32x8::splat(127) - level - level) << 23_i32);
        let kernel = per_texel * (texel_kernel + 1.0 / 3.0) - 1.0 / 3.0;
        let (a, b, c) = (conics.a * sv * sv + kernel, conics.b * su * sv, conics.c * su * su + kernel);
        Self { level, texels, a, b, c, f: a * c - b * b * 0.25 }
    }

    /// On the finest levels within the budget, or on the base level, by either reading of formula (1).
    fn one_by_one(surface: &Surface, pixels: &PixelFootprints, settings: &Settings) -> Self {
        let found: [_; 8] = std::array::from_fn(|lane| level_within_budget(surface, &pixels.footprint(lane), settings));
        let level = i32x8::new(found.map(|(level, _)| level as i32));
        let [a, b, c, f] = [
            found.map(|(_, ellipse)| ellipse.a),
            found.map(|(_, ellipse)| ellipse.b),
            found.map(|(_, ellipse)| ellipse.c),
            found.map(|(_, ellipse)| ellipse.f),
        ]
        .map(PixelLanes::new);
        Self { level, texels: texels_a_repeat(surface, level), a, b, c, f }
    }
}
