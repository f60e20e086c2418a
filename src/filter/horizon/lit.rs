//! The light of a patch of a curved surface: what shines on each texel that its lines see.
//!
//! Over a patch the frame of the surface turns a little. What its lights are at a seen place is
//! taken for linear in the place, fitted to the patch's pixels; a texel shows the light of its own
//! place, not that of the polygon's point that it is seen over: the surface has turned between the
//! two. Points, which may be near, shine on where it is.

use super::fit::{Fit, Linear, azimuth};
use super::near_light::PatchPoint;
use super::pixels::PixelOnLines;
use crate::light::{Curved, CurvedSun, LinearSky, NORMAL_PLANE, NUM_AZIMUTHS, SKY_PLANE, Slant};
use crate::simd::{BETWEEN_SCALE, Between, LineLanes, u32x16};
use crate::texture::Rows;
use glam::Vec3;

/// The lights of a patch.
#[derive(Clone, Debug)]
pub(super) struct PatchLight<'a> {
    /// The horizons of the patch's level.
    pub(super) rows: &'a Rows,
    /// The `xi` and `q` around which numbers are linear.
    pub(super) middle: [f32; 2],
    pub(super) suns: Vec<PatchSun>,
    pub(super) points: Vec<PatchPoint>,
    pub(super) sky: Option<PatchSky>,
}

/// What the sky sends, linear in the direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct PatchSky {
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

    /// What comes from directions.
    #[inline(always)]
    pub(super) fn from(
        &self,
        [x, y, z]: [LineLanes; 3],
        [xi, q]: [LineLanes; 2],
    ) -> [LineLanes; 3] {
        let gain = self.gain.at(xi, q).fast_max(LineLanes::ZERO);
        [0, 1, 2].map(|c| {
            let slopes = self.slopes.map(|[u, v, up]| x * u[c] + y * v[c] + z * up[c]);
            let sum = slopes.unwrap_or(LineLanes::ZERO) + self.constant[c];
            sum.fast_max(LineLanes::ZERO) * gain
        })
    }
}

/// A sun over a patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct PatchSun {
    pub(super) intensity: [f32; 3],
    pub(super) to_light: [Linear; 3],
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

    /// The part of its disc that texels see over the relief.
    #[inline(always)]
    pub(super) fn lit_part(
        &self,
        (rows, start, between): (&Rows, usize, &Between),
        [xi, q]: [LineLanes; 2],
    ) -> LineLanes {
        let (words, stride) = (rows.words(), rows.stride());
        let [(plane, shift), (next_plane, next_shift)] = self.azimuths;
        let word = between.words_at(words, start + plane * stride);
        let next = if plane == next_plane {
            word
        } else {
            between.words_at(words, start + next_plane * stride)
        };
        let a = between.bits_of(word, shift, 0xff);
        let b = between.bits_of(next, next_shift, 0xff);
        let part = self.part.at(xi, q).fast_max(LineLanes::ZERO).fast_min(LineLanes::ONE);
        let root = (a + (b - a) * part) * (1.0 / (255.0 * BETWEEN_SCALE));
        let lit = (self.height.at(xi, q) - root * root) * self.inverse_width + 0.5;
        lit.fast_max(LineLanes::ZERO).fast_min(LineLanes::ONE)
    }
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

    /// Whether nothing shines there.
    pub(super) fn is_dark(&self) -> bool {
        self.suns.is_empty() && self.points.is_empty() && self.sky.is_none()
    }

    /// What a white surface shows of the lights where lines cross row `q`, whose words of horizons
    /// begin at `start`, are seen over `p` and have the stored heights `height`.
    #[inline(always)]
    pub(super) fn at(
        &self,
        start: usize,
        between: &Between,
        [xi, p, height]: [LineLanes; 3],
        q: f32,
    ) -> [LineLanes; 3] {
        let (words, stride) = (self.rows.words(), self.rows.stride());
        let [xi, p] = [xi - self.middle[0], p - self.middle[1]];
        let q = LineLanes::splat(q - self.middle[1]);
        let mut sums = [LineLanes::ZERO; 3];
        let unit = 1.0 / (255.0 * BETWEEN_SCALE);
        let part = |word: [u32x16; 2], i: u32| between.bits_of(word, 8 * i, 0xff) * unit;
        let signed = |word: [u32x16; 2], i: u32| part(word, i) * 2.0 - 1.0;
        let normals = between.words_at(words, start + NORMAL_PLANE * stride);
        if let Some(sky) = &self.sky {
            let gain = sky.gain.at(xi, q).fast_max(LineLanes::ZERO);
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
            let [l0, l1, l2] = sun.to_light.map(|l| l.at(xi, q));
            let n_l = normal[0] * l0 + normal[1] * l1 + normal[2] * l2;
            // No cosine is above 1, whatever the fit makes of places beyond its pixels.
            let n_l = n_l.fast_max(LineLanes::ZERO).fast_min(LineLanes::ONE);
            let lit = n_l * sun.lit_part((self.rows, start, between), [xi, q]);
            (0..3).for_each(|c| sums[c] += lit * sun.intensity[c]);
        }
        for point in &self.points {
            let shown = point.at((self.rows, start, between), normal, [xi, p, height]);
            (0..3).for_each(|c| sums[c] += shown[c]);
        }
        sums
    }
}
