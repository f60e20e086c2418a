//! Elliptical weighted average (Heckbert 1989): the mean of a set of texels with the weight `exp(-2 r^2)`, a Gaussian
//! over the disc of radius one pixel, `r^2 = (A U^2 + B U V + C V^2) / F <= 1`.

use super::texel_set::{RowQuadric, lane_columns};
use super::{Ellipse, Filtered, Footprint, MAX_TEXELS, TexelSet, isotropic};
use crate::settings::{Formulas, Settings};
use crate::simd::{
    LineLanes, TexelLanes, exp_negative, halves, high_half, high_halves, join, join_words, low_half, low_halves, split,
    sum,
};
use crate::texture::{APRON, Level, Surface};
use std::f32::consts::FRAC_1_PI;

/// Shorter half axis of the ellipse in texels of the level that is taken, at least: the Gaussian's standard deviation, half
/// of that, is then 0.7 texels, below which their grid undersamples it. At most twice as much.
const LEAST_SHORT: f32 = 1.4;

/// Coefficients of [`gaussian`], from the constant one on.
const GAUSSIAN: [f32; 8] =
    [0.999_980_3, -1.998_874_1, 1.989_238_6, -1.293_264_7, 0.591_073_8, -0.185_189_3, 0.035_439_05, -0.003_077_990_3];

/// The mean of all texels of the ellipse, and how many were in the batches that were read: one pass over the rows of the
/// coarsest level on which the Gaussian is sampled well, or of the base level where `texel_budget` is 0.
#[must_use]
pub fn mean(surface: &Surface, footprint: &Footprint, settings: &Settings) -> (Filtered, u64) {
    let (index, ellipse) = choose_level(surface, footprint, settings);
    let texels = surface.texels_per_repeat(index);
    let place = [0, 1].map(|i| footprint.center[i] * texels[i] - 0.5);
    // Rows along the longer side: fewer of them.
    let (levels, ellipse, place) = if ellipse.a > ellipse.c {
        (&surface.transposed, Ellipse { a: ellipse.c, c: ellipse.a, ..ellipse }, [place[1], place[0]])
    } else {
        (&surface.levels, ellipse, place)
    };
    let (sums, num_read) = scan(&levels[index], &ellipse, place, settings.cut);
    let mean = sums.mean(levels[index].has_normals());
    (mean.unwrap_or_else(|| isotropic::bilinear(surface, index, footprint.center)), num_read)
}

/// The level and the ellipse in its texels.
fn choose_level(surface: &Surface, footprint: &Footprint, settings: &Settings) -> (usize, Ellipse) {
    let Settings { formulas, max_anisotropy, texel_budget, .. } = *settings;
    if texel_budget == 0 || formulas == Formulas::Printed {
        return super::level_within_budget(surface, footprint, settings);
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

/// Weighted sums over the ellipse around `place`, texel centres at whole numbers, cut at radius `cut`.
fn scan(level: &Level, ellipse: &Ellipse, [x0, y0]: [f32; 2], cut: f32) -> (Sums, u64) {
    let Ellipse { a, b, c, f } = *ellipse;
    let mut sums = PairSums::default();
    // r^2 = (a (U + s V)^2 + (det / a) V^2) / f, where det is f but for a printed f.
    let (inverse_f, s) = (1.0 / f, b * 0.5 / a);
    let det = (a * c - b * b * 0.25).max(f32::MIN_POSITIVE);
    let [half_width, half_height] = [f / a, a * (f / det)].map(|square| cut * square.sqrt());
    if !(half_width.max(half_height) < 1e6 && f > 0.0) {
        return (Sums::default(), 0);
    }
    // Rows of equal length, so that no branch depends on a row, and two rows at a time: what lies outside weighs nothing.
    let num = (half_width * 0.25) as i32 + 1;
    let limit = LineLanes::splat(cut * cut);
    let [a, b, c] = [a, b, c].map(|coefficient| coefficient * inverse_f);
    let rows = (y0 - half_height).ceil() as i32..=(y0 + half_height).floor() as i32;
    let num_read = rows.clone().count() as u64 * num as u64 * 8;
    for y in rows.step_by(2) {
        let v = [0.0, 1.0].map(|row| y as f32 + row - y0);
        let starts = v.map(|v| (x0 - s * v - half_width).ceil());
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
                let weight = gaussian(r2.fast_min(limit)) & r2.simd_le(limit);
                sums.add(level, runs.map(|run| run + 8 * (i - first) as usize), weight);
            }
        }
    }
    (sums.folded(), num_read)
}

/// `exp(-2 s)` for s within 0 to 2.25, off by at most 2e-5: the polynomial through its values at the roots of Chebyshev's
/// polynomial, in pairs, since the next row's work waits for it.
fn gaussian(s: LineLanes) -> LineLanes {
    let s2 = s * s;
    let low = (s * GAUSSIAN[1] + GAUSSIAN[0]) + (s * GAUSSIAN[3] + GAUSSIAN[2]) * s2;
    let high = (s * GAUSSIAN[5] + GAUSSIAN[4]) + (s * GAUSSIAN[7] + GAUSSIAN[6]) * s2;
    high * (s2 * s2) + low
}

/// Weighted sums over two rows at a time, eight texels of each.
#[derive(Default)]
struct PairSums {
    weight: LineLanes,
    color: [LineLanes; 3],
    normal: [LineLanes; 3],
}

impl PairSums {
    #[inline(always)]
    fn add(&mut self, level: &Level, runs: [usize; 2], weight: LineLanes) {
        let pair = |plane: usize| join_words(runs.map(|run| Level::run(level.words(), run + plane * level.stride())));
        let (red_green, blue_height) = (pair(0), pair(1));
        self.weight += weight;
        self.color[0] += low_halves(red_green) * weight;
        self.color[1] += high_halves(red_green) * weight;
        self.color[2] += low_halves(blue_height) * weight;
        if level.has_normals() {
            let normals = halves(pair(2)).map(super::unpack_normals);
            (0..3).for_each(|i| self.normal[i] += join(normals.map(|normal| normal[i])) * weight);
        }
    }

    /// The sums of both rows.
    fn folded(&self) -> Sums {
        let fold = |lanes: LineLanes| {
            let [a, b] = split(lanes);
            a + b
        };
        Sums { weight: fold(self.weight), color: self.color.map(fold), normal: self.normal.map(fold) }
    }
}

/// The weighted mean of the texels of `set` in the ellipse around `center` (in texels); `None` for an empty set.
#[must_use]
pub fn average(level: &Level, set: &TexelSet, ellipse: &Ellipse, center: [f32; 2]) -> Option<Filtered> {
    let [x0, y0] = center.map(|c| c - 0.5);
    let mut sums = Sums::default();
    for row in &set.rows {
        let quadric = RowQuadric::new(ellipse, row.y as f32 - y0);
        let start = level.row_start(row.y);
        let [first, num] = row.batches;
        for (i, &bits) in set.bits[first..first + num].iter().enumerate() {
            if bits != 0 {
                let x = row.x + 8 * i as i32;
                let r2 = quadric.at(lane_columns(x) - x0).fast_max(TexelLanes::ZERO).fast_min(TexelLanes::ONE);
                sums.add(level, start + level.run_start(x), exp_negative(r2 + r2) & lane_mask(bits));
            }
        }
    }
    sums.mean(level.has_normals())
}

/// All bits of the lanes whose bit is set.
fn lane_mask(bits: u8) -> TexelLanes {
    TexelLanes::new(std::array::from_fn(|lane| f32::from_bits(if bits >> lane & 1 == 1 { u32::MAX } else { 0 })))
}

/// Weighted sums, texels in lanes.
#[derive(Default)]
struct Sums {
    weight: TexelLanes,
    color: [TexelLanes; 3],
    normal: [TexelLanes; 3],
}

impl Sums {
    #[inline(always)]
    fn add(&mut self, level: &Level, start: usize, weight: TexelLanes) {
        let words = level.words();
        let red_green = Level::run(words, start);
        let blue_height = Level::run(words, start + level.stride());
        self.weight += weight;
        self.color[0] += low_half(red_green) * weight;
        self.color[1] += high_half(red_green) * weight;
        self.color[2] += low_half(blue_height) * weight;
        if level.has_normals() {
            let normal = super::unpack_normals(Level::run(words, start + 2 * level.stride()));
            (0..3).for_each(|i| self.normal[i] += normal[i] * weight);
        }
    }

    fn mean(&self, has_normals: bool) -> Option<Filtered> {
        let weight = sum(self.weight);
        let mean = |lanes: [TexelLanes; 3]| lanes.map(|lanes| sum(lanes) / weight);
        let normal = if has_normals { mean(self.normal) } else { [0.0, 0.0, 1.0] };
        (weight > 0.0).then(|| Filtered { color: mean(self.color), normal })
    }
}
