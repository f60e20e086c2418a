//! The floating horizon filter: the visible relief of a footprint in one sweep.
//!
//! A texel at `t` and depth `d` is seen over the base coordinate `t - d D`, with the displacement `D` down to the deepest
//! relief. Along a line in the direction of `D`, walked from its near end, the eye sees the part of the relief where the
//! projected place makes a new record, and nothing else. So with the places `p_i` of the line's texels:
//!
//! ```text
//! M = entry of the line into the ellipse of formula (2)
//! for each texel i:  w_i = G(min(p_i, exit)) - G(M) if that is positive;  M = max(M, p_i);  stop when M >= exit
//! ```
//!
//! where `G` is the integral of the kernel `exp(-2 r^2)` along the line, so the weights of a line sum to its share of the
//! ellipse whatever the relief. The segment between two texels is linear: its colour is taken at the middle of its
//! visible part. (The floating horizon: a hidden-surface algorithm for functions of two variables, here run inside a
//! texture footprint; the weight is exact where the classic algorithm draws lines.)
//!
//! Rows run across the longer axis of `D`, on a transposed copy of the texels where that is u. The lines are the lanes:
//! in the sheared frame `xi = x - e y`, `e = D_x / D_y`, a line is a column, and with `eta` the row from the middle
//!
//! ```text
//! r^2 = A' xi^2 + B' xi eta + C' eta^2 = (A' - B'^2 / 4C') xi^2 + z^2,   z = sqrt(C') (eta + B' xi / 2C')
//! ```
//!
//! so that every line has one Gaussian in `z`, its own middle, and the weight `exp(-2 (A' - B'^2 / 4C') xi^2)`.

use super::{Ellipse, FarField, Filtered, Footprint, isotropic};
use crate::settings::{Formulas, Settings};
use crate::shade::LocalLights;
use crate::simd::{Blend, TexelLanes, as_unsigned, exp_negative, high_half, low_half, sum, u32x8};
use crate::texture::{FULL_F32, Level, Surface};
use glam::Vec3;

/// Most rows of a sweep; a longer one takes a coarser level. Bounds the time of a pixel for any input.
pub const MAX_ROWS: f32 = 512.0;

/// Footprints narrower than this many texels take eight lines less than a texel apart, interpolated between texels;
/// eight such lines and their neighbours span at most eight texels.
const NARROW: f32 = 4.5;

/// Displacements shorter than this many texels do not hide anything that a texel could show.
const FLAT: f32 = 1.0 / 64.0;

/// The mean of the visible texels of a footprint whose centre is the base coordinate, and the number of rows swept.
#[must_use]
pub fn visible_mean(
    surface: &Surface,
    footprint: &Footprint,
    displacement: [f32; 2],
    settings: &Settings,
    lights: Option<&LocalLights>,
) -> (Filtered, u64) {
    // Under lights no table helps where a level loses what hides behind fine ridges: take one level finer instead.
    let lines = if lights.is_some() { 2 * settings.lines } else { settings.lines };
    swept_mean(surface, footprint, displacement, (settings, lines as f32), lights)
}

/// As [`visible_mean`], from the tables of the seen colour where the footprint is large.
#[must_use]
pub fn near_or_far_mean(
    surface: &Surface,
    far: &FarField,
    footprint: &Footprint,
    displacement: [f32; 2],
    settings: &Settings,
) -> (Filtered, u64) {
    let share = far.share(surface, footprint, settings);
    if share >= 1.0 {
        return (far.mean(surface, footprint, displacement, settings), 0);
    }
    let texels = surface.texels_per_repeat(0);
    let bias = far.level_bias([displacement[0] * texels[0], displacement[1] * texels[1]]);
    let lines = (settings.lines << bias) as f32;
    let (near, num_rows) = swept_mean(surface, footprint, displacement, (settings, lines), None);
    if share == 0.0 {
        return (near, num_rows);
    }
    (near.lerp(&far.mean(surface, footprint, displacement, settings), share), num_rows)
}

fn swept_mean(
    surface: &Surface,
    footprint: &Footprint,
    displacement: [f32; 2],
    (settings, lines): (&Settings, f32),
    lights: Option<&LocalLights>,
) -> (Filtered, u64) {
    let index = choose_level(surface, footprint, displacement, (settings, lines));
    let texels = surface.texels_per_repeat(index);
    let ellipse = widened(footprint, texels, settings);
    let displacement = [displacement[0] * texels[0], displacement[1] * texels[1]];
    let center = [footprint.center[0] * texels[0] - 0.5, footprint.center[1] * texels[1] - 0.5];
    let runs_along_u = if displacement[0].abs().max(displacement[1].abs()) < FLAT {
        ellipse.a < ellipse.c
    } else {
        displacement[0].abs() > displacement[1].abs()
    };
    let sweep = if runs_along_u {
        let turned = Ellipse { a: ellipse.c, c: ellipse.a, ..ellipse };
        Sweep::new(&surface.transposed[index], &turned, [center[1], center[0]], [displacement[1], displacement[0]])
    } else {
        Sweep::new(&surface.levels[index], &ellipse, center, displacement)
    };
    let (mean, num_rows) = sweep.run(lights);
    (mean.unwrap_or_else(|| isotropic::bilinear(surface, index, footprint.center)), num_rows)
}

fn widened(footprint: &Footprint, texels: [f32; 2], settings: &Settings) -> Ellipse {
    let ellipse = Ellipse::new(footprint, texels, Formulas::Meant);
    ellipse.bounded(settings.max_anisotropy)
}

/// The finest level on which the footprint is at most `lines` texels across its shorter axis and its sweep short enough.
fn choose_level(
    surface: &Surface,
    footprint: &Footprint,
    displacement: [f32; 2],
    (settings, lines): (&Settings, f32),
) -> usize {
    let last = surface.levels.len() - 1;
    let fits = |level: &usize| {
        let texels = surface.texels_per_repeat(*level);
        let ellipse = widened(footprint, texels, settings);
        let [short, long] = ellipse.squared_axes().map(f32::sqrt);
        let walk = (displacement[0] * texels[0]).abs().max((displacement[1] * texels[1]).abs());
        2.0 * short <= lines && 2.0 * long + walk <= MAX_ROWS
    };
    (0..last).find(fits).unwrap_or(last)
}

/// A sweep over one level: rows along y, lines as lanes.
struct Sweep<'a> {
    level: &'a Level,
    /// Middle of the ellipse; texel centres lie at whole numbers.
    center: [f32; 2],
    /// Texels along y down to the deepest relief, and texels along x per row.
    depth: f32,
    shear: f32,
    /// Half the width over xi and half the height over eta of the ellipse.
    half: [f32; 2],
    /// `sqrt(C')`, `B' / 2C'`, `A' - B'^2 / 4C'`.
    along: f32,
    skew: f32,
    across: f32,
}

impl<'a> Sweep<'a> {
    fn new(level: &'a Level, ellipse: &Ellipse, center: [f32; 2], displacement: [f32; 2]) -> Self {
        let [dx, dy] = displacement;
        let is_flat = dy.abs() < FLAT;
        let (depth, e) = if is_flat { (0.0, 0.0) } else { (dy, dx / dy) };
        let Ellipse { a, b, c, f } = *ellipse;
        // F = A C - B^2 / 4, which the shear keeps: so A' - B'^2 / 4C' is 1 / C F, without a difference that cancels.
        let (b, c) = (2.0 * a * e + b, ((a * e + b) * e + c).max(f / a));
        let half = [c.sqrt(), a.sqrt()];
        Self { level, center, depth, shear: e, half, along: (c / f).sqrt(), skew: b / (2.0 * c), across: 1.0 / c }
    }

    fn run(&self, lights: Option<&LocalLights>) -> (Option<Filtered>, u64) {
        let width = 2.0 * self.half[0];
        let (is_narrow, num_blocks) = (width < NARROW, (width * 0.125).ceil().max(1.0) as i32);
        let spacing = if is_narrow { width * 0.125 } else { 1.0 };
        let mut total = Totals::default();
        let mut num_rows = 0;
        for block in 0..num_blocks {
            let first = spacing * ((8 * block - 4 * num_blocks) as f32 + 0.5);
            num_rows += match (is_narrow, lights) {
                (true, None) => self.lines::<true, false>(first, spacing, &LocalLights::default(), &mut total),
                (false, None) => self.lines::<false, false>(first, spacing, &LocalLights::default(), &mut total),
                (true, Some(lights)) => self.lines::<true, true>(first, spacing, lights, &mut total),
                (false, Some(lights)) => self.lines::<false, true>(first, spacing, lights, &mut total),
            };
        }
        (total.mean(lights.is_some()), num_rows)
    }

    /// Sweeps eight lines, the first at `xi = first`, and adds their sums to `total`. Returns the number of rows.
    fn lines<const NARROW: bool, const LIT: bool>(
        &self,
        first: f32,
        spacing: f32,
        lights: &LocalLights,
        total: &mut Totals,
    ) -> u64 {
        let xi = lane_indices() * spacing + first;
        let outside = (xi * xi * self.across).fast_min(TexelLanes::ONE);
        let end = (TexelLanes::ONE - outside).sqrt();
        let toward = if self.depth < 0.0 { -1.0 } else { 1.0 };
        let (per_row, rise) = (self.along, self.along * self.depth.abs() * (1.0 / FULL_F32));
        // No relief of the first row can be seen within the ellipse: the record begins at its edge.
        let first_row = (toward * self.center[1] - self.half[1]).floor() - 1.0;
        let num_rows = (2.0 * self.half[1] + self.depth.abs()).ceil() as i32 + 3;
        let eta = toward * first_row - self.center[1];
        // z of the deepest relief in the first row, seen in the walking direction.
        let mut deepest = xi * (self.skew * self.along * toward) + (self.along * (toward * eta - self.depth.abs()));
        let mut x = self.center[0] + first + self.shear * eta;
        let mut y = (toward * first_row) as i32;
        let start_weight = integral(-end);
        let mut lines = Lines::starting(-end, start_weight);
        let mut swept = 0;
        while swept < num_rows {
            let texel = self.fetch::<NARROW, LIT>(x, y, spacing);
            lines.add::<LIT>(texel.height * rise + deepest, end, texel, lights);
            swept += 1;
            if lines.horizon.simd_ge(end).all() {
                break;
            }
            deepest += per_row;
            x += self.shear * toward;
            y += toward as i32;
        }
        total.add::<LIT>(&lines, exp_negative(outside + outside), start_weight);
        swept as u64
    }

    /// The texels of the eight lines in row `y`, the first line at `x`.
    #[inline(always)]
    fn fetch<const NARROW: bool, const LIT: bool>(&self, x: f32, y: i32, spacing: f32) -> Texels {
        let row = self.level.row(y);
        let stride = self.level.stride();
        let left = x.floor();
        let start = self.level.run_start(left as i32);
        let place = lane_indices() * spacing + (x - left);
        let cell = place.fast_trunc_int();
        let part = if NARROW { place - TexelLanes::from_i32x8(cell) } else { TexelLanes::splat(x - left) };
        let blend = Blend::new(part);
        let pick = |plane: usize| {
            if NARROW {
                let lanes = as_unsigned(cell);
                let run = Level::run(row, start + plane * stride);
                [run.shuffle(lanes), run.shuffle(lanes + u32x8::splat(1))]
            } else {
                [Level::run(row, start + plane * stride), Level::run(row, start + plane * stride + 1)]
            }
        };
        let (red_green, blue_height) = (blend.mix(pick(0)), blend.mix(pick(1)));
        let color = [low_half(red_green), high_half(red_green), low_half(blue_height)];
        let mut normal = [TexelLanes::ZERO; 3];
        if LIT && self.level.has_normals() {
            let [near, far] = pick(2).map(super::unpack_normals);
            normal = std::array::from_fn(|i| near[i] + (far[i] - near[i]) * part);
        } else if LIT {
            normal[2] = TexelLanes::ONE;
        }
        Texels { color, normal, height: high_half(blue_height) }
    }
}

/// Eight texels, one of each line.
#[derive(Clone, Copy, Default)]
struct Texels {
    color: [TexelLanes; 3],
    normal: [TexelLanes; 3],
    height: TexelLanes,
}

fn lane_indices() -> TexelLanes {
    TexelLanes::new([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
}

/// `G(z)`, the integral of `exp(-2 z^2)` from 0, for z within -1 to 1: the integral of the even polynomial of degree 8
/// that is nearest to the kernel, off by at most 0.0002.
fn integral(z: TexelLanes) -> TexelLanes {
    let s = z * z;
    ((((s * 0.028_880_1 - 0.148_824_7) * s + 0.381_363_6) * s - 0.663_076_2) * s + 0.999_799) * z
}

/// Eight lines on their way.
struct Lines {
    /// M, the record so far, and `G(M)`.
    horizon: TexelLanes,
    weight: TexelLanes,
    /// The last row's place and texels.
    place: TexelLanes,
    texel: Texels,
    color: [TexelLanes; 3],
    normal: [TexelLanes; 3],
}

impl Lines {
    fn starting(horizon: TexelLanes, weight: TexelLanes) -> Self {
        let zero = [TexelLanes::ZERO; 3];
        Self { horizon, weight, place: TexelLanes::splat(-1e9), texel: Texels::default(), color: zero, normal: zero }
    }

    /// Adds the segments from the last row's texels to these, at the projected places `z`.
    #[inline(always)]
    fn add<const LIT: bool>(&mut self, z: TexelLanes, end: TexelLanes, texel: Texels, lights: &LocalLights) {
        let record = z.fast_min(end).fast_max(self.horizon);
        let weight = integral(record);
        let visible = weight - self.weight;
        // Where the middle of the visible part lies between the last texel (0) and this one (1).
        let length = (z - self.place).fast_max(TexelLanes::splat(1e-6));
        let middle = ((record + self.horizon) * 0.5 - self.place) / length;
        let at = |from: TexelLanes, to: TexelLanes| from + (to - from) * middle;
        let mut color: [TexelLanes; 3] = std::array::from_fn(|i| at(self.texel.color[i], texel.color[i]));
        if LIT {
            let normal = std::array::from_fn(|i| at(self.texel.normal[i], texel.normal[i]));
            let light = diffuse(lights, &normal);
            (0..3).for_each(|i| color[i] *= light[i]);
            (0..3).for_each(|i| self.normal[i] += normal[i] * visible);
        }
        (0..3).for_each(|i| self.color[i] += color[i] * visible);
        (self.horizon, self.weight, self.place, self.texel) = (record, weight, z, texel);
    }
}

/// [`LocalLights::diffuse`] of eight normals.
fn diffuse(lights: &LocalLights, normal: &[TexelLanes; 3]) -> [TexelLanes; 3] {
    let mut sums = lights.ambient.to_array().map(TexelLanes::splat);
    for (to_light, intensity) in &lights.lights {
        let Vec3 { x, y, z } = *to_light;
        let cosine = (normal[0] * x + normal[1] * y + normal[2] * z).fast_max(TexelLanes::ZERO);
        (0..3).for_each(|i| sums[i] += cosine * intensity[i]);
    }
    sums
}

/// Weighted sums.
#[derive(Default)]
struct Totals {
    weight: TexelLanes,
    color: [TexelLanes; 3],
    normal: [TexelLanes; 3],
}

impl Totals {
    /// Adds the sums of eight lines, each times its share.
    fn add<const LIT: bool>(&mut self, lines: &Lines, share: TexelLanes, start_weight: TexelLanes) {
        self.weight += (lines.weight - start_weight) * share;
        (0..3).for_each(|i| self.color[i] += lines.color[i] * share);
        if LIT {
            (0..3).for_each(|i| self.normal[i] += lines.normal[i] * share);
        }
    }

    fn mean(&self, lit: bool) -> Option<Filtered> {
        let weight = sum(self.weight);
        let mean = |lanes: [TexelLanes; 3]| lanes.map(|lanes| sum(lanes) / weight);
        let normal = if lit { mean(self.normal) } else { [0.0, 0.0, 1.0] };
        (weight > 0.0).then(|| Filtered { color: mean(self.color), normal })
    }
}
