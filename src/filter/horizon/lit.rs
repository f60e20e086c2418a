//! The light of a patch of a curved surface: what shines on each texel that its lines see.
//!
//! Over a patch the frame of the surface turns a little. What its lights are at a seen place is
//! taken for linear in the place, fitted to the patch's pixels; a texel shows the light of the
//! polygon's point that it is seen over.

use super::near_light::PatchPoint;
use super::pixels::PixelOnLines;
use crate::light::{Curved, CurvedSun, LinearSky, NORMAL_PLANE, NUM_AZIMUTHS, SKY_PLANE, Slant};
use crate::relief::directions::diamond_angle;
use crate::simd::{BETWEEN_SCALE, Between, LineLanes, u32x16};
use crate::texture::Rows;
use glam::Vec3;

/// A number that is linear in the line and the seen place.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Linear {
    pub(super) middle: f32,
    per_line: f32,
    per_row: f32,
}

/// The lights of a patch.
#[derive(Clone, Debug)]
pub(super) struct PatchLight<'a> {
    /// The horizons of the patch's level.
    pub(super) rows: &'a Rows,
    /// The `xi` and `q` around which numbers are linear.
    middle: [f32; 2],
    suns: Vec<PatchSun>,
    points: Vec<PatchPoint>,
    sky: Option<PatchSky>,
}

/// What the sky sends, linear in the direction.
#[derive(Clone, Copy, Debug)]
struct PatchSky {
    constant: [f32; 3],
    /// Along u, along v and off the surface; `None` where it is the same from everywhere.
    slopes: Option<[[f32; 3]; 3]>,
    /// How much brighter it is at a place than in the middle.
    gain: Linear,
}

/// Greatest share of the sky's constant that slopes are left out for: half of a byte's step.
const LEAST_SLOPE: f32 = 1.0 / 512.0;

impl PatchSky {
    fn new(curved: &Curved, picks: &[u8], fit: &Fit) -> Self {
        let share = 1.0 / picks.len() as f32;
        let mean = LinearSky::blend(picks.iter().map(|pick| (*curved.sky(*pick), share)));
        let axes = curved.mean_axes(picks);
        let light = |sky: &LinearSky, normal: Vec3| sky.irradiance(normal).element_sum();
        let inverse = 1.0 / light(&mean, axes[2]).max(f32::MIN_POSITIVE);
        let gain = |pick: &u8| light(curved.sky(*pick), curved.normal(*pick)) * inverse;
        let gain = fit.linear(picks.iter().map(gain));
        let local = mean.turned(axes);
        let most = local.slopes.iter().fold(0.0_f32, |most, s| most.max(s.abs().max_element()));
        let is_even = most <= LEAST_SLOPE * local.constant.max_element();
        let slopes = local.slopes.map(|slope| slope.to_array());
        Self { constant: local.constant.to_array(), slopes: (!is_even).then_some(slopes), gain }
    }
}

#[derive(Clone, Copy, Debug)]
struct PatchSun {
    intensity: [f32; 3],
    to_light: [Linear; 3],
    height: Linear,
    /// 1 over how far its disc reaches in height.
    inverse_width: f32,
    /// The azimuths between which it stands: the planes of their horizons and the bits in them.
    azimuths: [(usize, u32); 2],
    part: Linear,
}

/// Least part of a height over which a sun rises: two steps of a byte.
const LEAST_WIDTH: f32 = 1.0 / 128.0;

/// A sun that stands lower than this behind all pixels of a patch lights no place of it.
const LEAST_DARK: f32 = 1.0 / 16.0;

impl PatchSun {
    fn new(curved: &Curved, sun: usize, picks: &[u8], fit: &Fit) -> Self {
        let at = |pick: &u8| (curved.slant(usize::from(pick / 8), sun), usize::from(pick % 8));
        let of = |of: &dyn Fn(&Slant, usize) -> f32| {
            fit.linear(picks.iter().map(|pick| {
                let (slant, lane) = at(pick);
                of(slant, lane)
            }))
        };
        let along = |slant: &Slant, lane: usize| slant.along.map(|c| c.as_array()[lane]);
        let [x, y] = picks.iter().fold([0.0_f32; 2], |[x, y], pick| {
            let (slant, lane) = at(pick);
            let [dx, dy] = along(slant, lane);
            [x + dx, y + dy]
        });
        let first = azimuth(x, y).floor();
        let part = of(&|slant, lane| {
            let [x, y] = along(slant, lane);
            // The nearer way round.
            let (part, half) = (azimuth(x, y) - first, NUM_AZIMUTHS as f32 * 0.5);
            part - if part > half {
                2.0 * half
            } else if part < -half {
                -2.0 * half
            } else {
                0.0
            }
        });
        let azimuths = [0, 1].map(|next| {
            let azimuth = (first as usize + next) % NUM_AZIMUTHS;
            (azimuth / 4, (azimuth % 4 * 8) as u32)
        });
        let height = of(&|slant, lane| slant.height.as_array()[lane]);
        let c = height.middle.clamp(0.0, 1.0);
        let CurvedSun { intensity, radius } = curved.suns[sun];
        // Of the elevation e, dc/de = 1 / (cos + sin)^2 = c^2 + (1 - c)^2.
        let width = 2.0 * radius * (c * c + (1.0 - c) * (1.0 - c));
        Self {
            intensity: intensity.to_array(),
            to_light: [0, 1, 2].map(|c| of(&|slant, lane| slant.to_light[c].as_array()[lane])),
            height,
            inverse_width: 1.0 / width.max(LEAST_WIDTH),
            azimuths,
            part,
        }
    }
}

/// Where a direction along the texture lies among the azimuths.
pub(super) fn azimuth(x: f32, y: f32) -> f32 {
    diamond_angle(x, y) * (NUM_AZIMUTHS as f32 * 0.25)
}

impl<'a> PatchLight<'a> {
    /// The lights of picked pixels, which lie so on the lines of a patch.
    pub(super) fn new(
        curved: &Curved<'a>,
        rows: &'a Rows,
        picks: &[u8],
        pixels: &[PixelOnLines],
    ) -> Self {
        let fit = Fit::new(pixels);
        let shines = |sun: &usize| {
            let height = |pick: &u8| {
                curved.slant(usize::from(pick / 8), *sun).height.as_array()[usize::from(pick % 8)]
            };
            picks.iter().any(|pick| height(pick) > -LEAST_DARK)
        };
        let suns = (0..curved.suns.len()).filter(shines);
        let suns = suns.map(|sun| PatchSun::new(curved, sun, picks, &fit)).collect();
        let sky = (!curved.skies.is_empty()).then(|| PatchSky::new(curved, picks, &fit));
        let point = |point: usize| PatchPoint::new(curved, point, picks, &fit);
        let points = (0..curved.points.len()).map(point).collect();
        Self { rows, middle: fit.middle, suns, points, sky }
    }

    /// What a white surface shows of the lights where lines cross a row whose words of horizons
    /// begin at `start`, and have the stored heights `height`.
    #[inline(always)]
    pub(super) fn at(
        &self,
        start: usize,
        between: &Between,
        [xi, p, height]: [LineLanes; 3],
    ) -> [LineLanes; 3] {
        let (words, stride) = (self.rows.words(), self.rows.stride());
        let [xi, p] = [xi - self.middle[0], p - self.middle[1]];
        let mut sums = [LineLanes::ZERO; 3];
        let unit = 1.0 / (255.0 * BETWEEN_SCALE);
        let part = |word: [u32x16; 2], i: u32| between.bits_of(word, 8 * i, 0xff) * unit;
        let signed = |word: [u32x16; 2], i: u32| part(word, i) * 2.0 - 1.0;
        let normals = between.words_at(words, start + NORMAL_PLANE * stride);
        if let Some(sky) = &self.sky {
            let gain = sky.gain.at(xi, p).fast_max(LineLanes::ZERO);
            let all = part(normals, 3) * gain;
            (0..3).for_each(|c| sums[c] = all * sky.constant[c]);
            if let Some(slopes) = &sky.slopes {
                let word = between.words_at(words, start + SKY_PLANE * stride);
                let t = [signed(word, 0) * gain, signed(word, 1) * gain, part(word, 2) * gain];
                for c in 0..3 {
                    let more = t[0] * slopes[0][c] + t[1] * slopes[1][c] + t[2] * slopes[2][c];
                    sums[c] = (sums[c] + more).fast_max(LineLanes::ZERO);
                }
            }
        }
        if self.suns.is_empty() && self.points.is_empty() {
            return sums;
        }
        let normal = [0, 1, 2].map(|i| signed(normals, i));
        for sun in &self.suns {
            let [l0, l1, l2] = sun.to_light.map(|l| l.at(xi, p));
            let n_l = normal[0] * l0 + normal[1] * l1 + normal[2] * l2;
            // No cosine is above 1, whatever the fit makes of places beyond its pixels.
            let n_l = n_l.fast_max(LineLanes::ZERO).fast_min(LineLanes::ONE);
            let [(plane, shift), (next_plane, next_shift)] = sun.azimuths;
            let word = between.words_at(words, start + plane * stride);
            let next = if plane == next_plane {
                word
            } else {
                between.words_at(words, start + next_plane * stride)
            };
            let a = between.bits_of(word, shift, 0xff);
            let b = between.bits_of(next, next_shift, 0xff);
            let part = sun.part.at(xi, p).fast_max(LineLanes::ZERO).fast_min(LineLanes::ONE);
            let root = (a + (b - a) * part) * unit;
            let lit = (sun.height.at(xi, p) - root * root) * sun.inverse_width + 0.5;
            let lit = n_l * lit.fast_max(LineLanes::ZERO).fast_min(LineLanes::ONE);
            (0..3).for_each(|c| sums[c] += lit * sun.intensity[c]);
        }
        for point in &self.points {
            let shown = point.at((self.rows, start, between), normal, [xi, p, height]);
            (0..3).for_each(|c| sums[c] += shown[c]);
        }
        sums
    }
}

impl Linear {
    #[inline(always)]
    pub(super) fn at(&self, xi: LineLanes, p: LineLanes) -> LineLanes {
        xi * self.per_line + p * self.per_row + self.middle
    }
}

/// How far pixels must lie apart for a slope to be told from them, in the squares of their ellipses'
/// half axes: those of a picture's patch lie hundreds of times as far.
const LEAST_SPREAD: f32 = 0.02;

/// Least squares over the places of pixels.
pub(super) struct Fit<'a> {
    pixels: &'a [PixelOnLines],
    middle: [f32; 2],
    /// The inverse of the matrix of second moments: xx, xq, qq.
    inverse: [f32; 3],
}

impl<'a> Fit<'a> {
    fn new(pixels: &'a [PixelOnLines]) -> Self {
        let num = 1.0 / pixels.len() as f32;
        let middle = pixels.iter().fold([0.0; 2], |sum, p| [sum[0] + p.xi, sum[1] + p.q]);
        let middle = middle.map(|sum: f32| sum * num);
        let mut moments = [0.0_f32; 3];
        for p in pixels {
            let [x, q] = [p.xi - middle[0], p.q - middle[1]];
            moments = [moments[0] + x * x, moments[1] + x * q, moments[2] + q * q];
        }
        // A little more on the diagonal leaves pixels in one line the least slope, and those that all
        // but share a place none: at an edge their lights may be far apart.
        let more = 1e-4 * (moments[0] + moments[2]);
        let size = |of: fn(&PixelOnLines) -> f32| {
            pixels.iter().map(|p| of(p) * of(p)).sum::<f32>() * LEAST_SPREAD
        };
        let [xx, xq, qq] = [
            moments[0] + more + size(|p| p.half_width),
            moments[1],
            moments[2] + more + size(|p| p.half_height),
        ];
        let determinant = xx * qq - xq * xq;
        let inverse = if determinant > 0.0 {
            [qq / determinant, -xq / determinant, xx / determinant]
        } else {
            [0.0; 3]
        };
        Self { pixels, middle, inverse }
    }

    pub(super) fn linear(&self, values: impl Iterator<Item = f32> + Clone) -> Linear {
        let middle = values.clone().sum::<f32>() / self.pixels.len() as f32;
        let [mut x, mut q] = [0.0_f32; 2];
        for (p, value) in self.pixels.iter().zip(values) {
            x += (p.xi - self.middle[0]) * (value - middle);
            q += (p.q - self.middle[1]) * (value - middle);
        }
        let [xx, xq, qq] = self.inverse;
        Linear { middle, per_line: xx * x + xq * q, per_row: xq * x + qq * q }
    }
}
