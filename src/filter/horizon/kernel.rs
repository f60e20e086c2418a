//! A pixel's mean over what the lines of a patch see, under its own Gaussian.

use super::grid::{GROUP, Grid, MOST_LINES, Profile, Row, load};
use super::pixels::PixelOnLines;
use crate::light::{LocalLight, LocalLights};
use crate::simd::{BETWEEN_SCALE, LineLanes, exp_negative, join, line_indices, split, sums};
use crate::texture::Texel;
use glam::Vec3;

/// `G(z)`, the integral of `exp(-2 z^2)` from 0, for z within -1 to 1: the integral of the even
/// polynomial of degree 8 that is nearest to the kernel, off by at most 0.0002.
#[inline(always)]
fn integral(z: LineLanes) -> LineLanes {
    let s = z * z;
    ((((s * 0.028_880_1 - 0.148_824_7) * s + 0.381_363_6) * s - 0.663_076_2) * s + 0.999_799) * z
}

/// What bins add to the square of an ellipse's half height, in squares of their length: four times
/// the variance of a mean over a bin that is then weighed by a mean over it, 1/12 each.
const BIN_BLUR: f32 = 4.0 / 6.0;

/// A line through the middle of an ellipse weighs about 1; rounding, 1e-7.
const LEAST_WEIGHT: f32 = 1e-5;

/// Weighted sums.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Totals {
    weight: LineLanes,
    color: [LineLanes; 3],
    normal: [LineLanes; 3],
}

impl Totals {
    /// Adds the part of a pixel that lies on the lines of a grid.
    #[inline(never)]
    pub(super) fn add<const CHANNELS: usize>(
        &mut self,
        profile: &Profile<CHANNELS>,
        grid: &Grid,
        pixel: &PixelOnLines,
        lights: Option<&LocalLights>,
    ) {
        let PixelOnLines { xi, q, half_width, half_height, .. } = *pixel;
        // Find the lines that cross the ellipse. One that only touches it weighs nothing.
        let line_at = |xi: f32| (xi - grid.first) * grid.inverse_spacing;
        let lines = (line_at(xi - half_width).floor() as i32 + 1).max(0) as usize
            ..(line_at(xi + half_width).ceil() as i32).clamp(0, grid.num_lines as i32) as usize;
        // Find the bins under the ellipse. Bounded below by 0, places are safe to cast.
        let bin_at = |place: f32| ((place - grid.begin) * grid.inverse_step).max(0.0);
        let from = bin_at(q - half_height) as usize;
        let to = (bin_at(q + half_height).ceil() as usize).min(grid.num_bins);
        let bins = &profile.bins[from.min(to)..to];
        for line in lines.step_by(GROUP) {
            self.add_lines(bins, grid, pixel, [line, from], lights);
        }
    }

    #[inline(always)]
    fn add_lines<const CHANNELS: usize>(
        &mut self,
        bins: &[[Row; CHANNELS]],
        grid: &Grid,
        pixel: &PixelOnLines,
        [line, first_bin]: [usize; 2],
        lights: Option<&LocalLights>,
    ) {
        assert!(line <= MOST_LINES, "a line of the grid");
        let PixelOnLines { q, skew, across, .. } = *pixel;
        // Bins blur by themselves, so the ellipse is made lower by as much.
        let bin = grid.step * pixel.along;
        let along = pixel.along / (1.0 - BIN_BLUR * (bin * bin)).sqrt();
        let xi = (line_indices() + line as f32) * grid.spacing + (grid.first - pixel.xi);
        // Lines of the next grid count there.
        let is_here = line_indices().simd_lt(LineLanes::splat((grid.num_lines - line) as f32));
        // Take r^2 apart, across the lines and along them. Lanes that do not count are 1 across,
        // where no length along is left.
        let outside = is_here.select((xi * xi * across).fast_min(LineLanes::ONE), LineLanes::ONE);
        let most = (LineLanes::ONE - outside).sqrt();
        let slant = xi * (skew * along);
        // Weigh the bins by the pixel's kernel: each by the difference of one integral at its ends,
        // so that the weights of a line sum to its whole, however bins cut it.
        let start_weight = -integral(most);
        let mut last_weight = start_weight;
        let mut all = [LineLanes::ZERO; CHANNELS];
        let mut end = (grid.begin - q + (first_bin + 1) as f32 * grid.step) * along;
        for bin in bins {
            let z = (slant + end).fast_max(-most).fast_min(most);
            let weight = integral(z);
            let visible = weight - last_weight;
            if let (Some(lights), true) = (lights, CHANNELS > 3) {
                // Light what is seen before it is averaged: the mean is of products.
                let normal = [3, 4, 5].map(|i| load(&bin[i.min(CHANNELS - 1)], line));
                let light = diffuse(lights, &normal);
                (0..3).for_each(|i| all[i] += load(&bin[i], line) * light[i] * visible);
                (3..CHANNELS).for_each(|i| all[i] += normal[i - 3] * visible);
            } else {
                (0..CHANNELS).for_each(|i| all[i] += load(&bin[i], line) * visible);
            }
            last_weight = weight;
            end += grid.step * along;
        }
        // What r^2 is across is the same all along a line: its factor comes once.
        let share = join(split(outside + outside).map(exp_negative));
        self.weight += (last_weight - start_weight) * share;
        (0..3).for_each(|i| self.color[i] += all[i] * share);
        (3..CHANNELS).for_each(|i| self.normal[i - 3] += all[i] * share);
    }

    /// Takes what was added for so many parts, which show their sum.
    pub(super) fn are_parts(&mut self, num: usize) {
        self.weight *= 1.0 / num as f32;
    }

    /// The mean; `None` where no more was added than the rounding of [`integral`]'s differences
    /// makes.
    pub(super) fn mean(&self, is_lit: bool) -> Option<Texel> {
        // Sum the lanes in one fixed order, for the same bytes on every machine.
        let halves = |lanes: LineLanes| {
            let [near, far] = split(lanes);
            near + far
        };
        let sums_of = |[x, y, z]: [LineLanes; 3]| {
            let [weight, x, y, z] = sums([self.weight, x, y, z].map(halves));
            (weight, [x, y, z])
        };
        let (weight, color) = sums_of(self.color);
        let mean = |sums: [f32; 3]| sums.map(|sum| sum / weight);
        let normal = if is_lit { mean(sums_of(self.normal).1) } else { Texel::UP };
        // A difference of 0 may be rounded below.
        let color = mean(color).map(|c| c.max(0.0) * (1.0 / BETWEEN_SCALE));
        (weight > LEAST_WEIGHT).then_some(Texel { color, normal })
    }
}

/// [`LocalLights::diffuse`] of sixteen normals.
fn diffuse(lights: &LocalLights, normal: &[LineLanes; 3]) -> [LineLanes; 3] {
    let mut sums = lights.ambient.to_array().map(LineLanes::splat);
    for LocalLight { to_light, intensity, .. } in &lights.lights {
        let Vec3 { x, y, z } = *to_light;
        let cosine = (normal[0] * x + normal[1] * y + normal[2] * z).fast_max(LineLanes::ZERO);
        (0..3).for_each(|i| sums[i] += cosine * intensity[i]);
    }
    sums
}
