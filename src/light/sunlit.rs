//! Texels in the light of a sun as they are seen from near.
//!
//! Light kept at texels is interpolated between them, and so are the edges of shadows: an edge is a
//! texel wide, and a wall that rises from one texel to the next is lit from its foot to its top or
//! not at all. From near, where texels are larger than pixels, more is seen. So here a texel keeps
//! what makes its light, each of which is linear between texels:
//!
//! ```text
//! colour = a (E + I s max(0, n.l) / |n| V)        V = clamp(1/2 + (h - m) / w, 0, 1)
//! ```
//!
//! with its albedo `a`, its normal `n` and its height `h`; `m` the height above which the sun's light
//! reaches it and `w` the height over which its shadow fades (see `relief::shadow::edge`); `E` the
//! light of the sky, and `s` the share that the texel shows of the sun's.

use super::texel_light::{ShadowEdges, SunLight};
use super::vectors::dot;
use crate::simd::Lanes;
use crate::texture::{FULL, Rows, Surface};
use glam::Vec3;
use rayon::prelude::*;
use std::sync::Arc;

/// What a sun and the sky light each texel of a surface's base level to.
#[derive(Clone, Debug)]
pub struct SunlitTexels {
    /// The surface before it was lit.
    surface: Arc<Surface>,
    /// Of texels along u and along v. Words, from the lowest bit: `m`, the root of `w` from bit 16 on,
    /// `s` from bit 24 on; `E` in [`SKY`] bits a channel.
    rows: Arc<[Rows; 2]>,
    /// The mean direction to the sun, as normals are, and what it lights a texel to that faces it.
    pub to_sun: Vec3,
    pub intensity: Vec3,
    /// The greatest channel of all `E`.
    pub brightest: f32,
}

/// Places of a surface in the light of a sun and the sky, one of each.
#[derive(Clone, Copy, Debug)]
pub struct Sunlit<L> {
    /// Colours in any unit.
    pub albedo: [L; 3],
    /// Normals in the frame of the texture, of any length.
    pub normal: [L; 3],
    /// How high they lie above the middle of the shadow's edge, `h - m`, and how wide that is, `w`.
    pub above: L,
    pub width: L,
    /// `s`, the part of the sun's light that they show.
    pub share: L,
    /// `E`, 1 for the brightest.
    pub sky: [L; 3],
}

/// A sun and a sky as places show them, in some unit.
#[derive(Clone, Copy, Debug)]
pub struct Sunlight {
    to_sun: Vec3,
    intensity: [f32; 3],
    brightest: f32,
}

/// Least length of a mean normal that is divided by.
const LEAST_LENGTH: f32 = 1e-3;

/// Where heights of edges begin as they are stored; they end at the polygon.
const LOWEST: f32 = ShadowEdges::LOWEST;

/// Least and greatest width of an edge; the greatest is the root's unit, too.
const WIDTHS: [f32; 2] = [1.0 / 512.0, 1.0];

/// Greatest numbers of what is stored of widths and of shares.
const WIDTH: u32 = 0xff;
const SHARE: u32 = 0x7f;

/// Bits of the sky's red, green and blue.
const SKY: [u32; 3] = [11, 11, 10];

impl SunlitTexels {
    /// Of a surface with relief under a sun. `sky` gives the light of the sky on a white texel, and `share`
    /// how much a texel shows of the sun's.
    pub(super) fn new(
        surface: Arc<Surface>,
        sun: &SunLight,
        sky: impl Fn(usize, usize) -> [f32; 3] + Sync,
        share: impl Fn(usize, usize) -> f32 + Sync,
    ) -> Self {
        let [width, height] = surface.base().size();
        let by_rows = |y: usize| (0..width).flat_map(|x| sky(x, y)).fold(0.0, f32::max);
        // A maximum is the same in any order.
        let brightest = (0..height).into_par_iter().map(by_rows).reduce(|| 0.0, f32::max);
        let inverse = if brightest > 0.0 { 1.0 / brightest } else { 0.0 };
        let stored = |c: f32, most: u32| ((c * most as f32 + 0.5) as u32).min(most);
        let mut texels = vec![[0; 2]; width * height];
        texels.par_chunks_exact_mut(width).enumerate().for_each(|(y, texels)| {
            for (x, texel) in texels.iter_mut().enumerate() {
                let [middle, wide] = sun.edges.at(x, y);
                let middle = stored((middle - LOWEST) * (1.0 / (1.0 - LOWEST)), FULL);
                let wide = stored(wide.clamp(WIDTHS[0], WIDTHS[1]).sqrt(), WIDTH);
                let share = stored(share(x, y), SHARE);
                let colors = sky(x, y).into_iter().zip(SKY).rev();
                let colors = colors
                    .fold(0, |word, (c, bits)| word << bits | stored(c * inverse, most(bits)));
                *texel = [middle | wide << 16 | share << 24, colors];
            }
        });
        let rows = Rows::new(width, height, surface.wrap(), 2, &texels);
        let turned = rows.turned();
        let SunLight { to_sun, intensity, .. } = *sun;
        Self { surface, rows: Arc::new([rows, turned]), to_sun, intensity, brightest }
    }

    /// The same without the sky.
    pub fn of_sun(&self) -> Self {
        Self { brightest: 0.0, ..self.clone() }
    }

    /// The same without the sun.
    pub fn of_sky(&self) -> Self {
        Self { intensity: Vec3::ZERO, ..self.clone() }
    }

    /// The light, for colours in units of a lit surface's.
    pub fn light(&self, lit: &Surface) -> Sunlight {
        let unit = self.surface.color_scale() / lit.color_scale();
        let intensity = (self.intensity * unit).to_array();
        Sunlight { to_sun: self.to_sun, intensity, brightest: self.brightest * unit }
    }

    /// The surface before it was lit.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// Row by row: along u, or along v where they are wanted turned.
    pub(crate) fn rows(&self, is_turned: bool) -> &Rows {
        &self.rows[usize::from(is_turned)]
    }
}

impl<L: Lanes> Sunlit<L> {
    /// Places of a surface with such colours, normals and heights, 0 to 1. `part` gives a number that is
    /// stored for them in a plane of [`SunlitTexels::rows`], by its first bit and greatest value, as a part
    /// of that.
    #[inline(always)]
    pub(crate) fn new(
        [albedo, normal]: [[L; 3]; 2],
        height: L,
        part: impl Fn(usize, u32, u32) -> L,
    ) -> Self {
        let middle = part(0, 0, FULL) * L::splat(1.0 - LOWEST) + L::splat(LOWEST);
        let root = part(0, 16, WIDTH);
        let mut first = 0;
        Self {
            albedo,
            normal,
            above: height - middle,
            width: root * root,
            share: part(0, 24, SHARE),
            sky: SKY.map(|bits| {
                first += bits;
                part(1, first - bits, most(bits))
            }),
        }
    }

    /// At a part of the way to others.
    #[inline(always)]
    pub(crate) fn mix(&self, next: &Self, part: L) -> Self {
        let mix = |a: L, b: L| a + (b - a) * part;
        Self {
            albedo: std::array::from_fn(|i| mix(self.albedo[i], next.albedo[i])),
            normal: std::array::from_fn(|i| mix(self.normal[i], next.normal[i])),
            above: mix(self.above, next.above),
            width: mix(self.width, next.width),
            share: mix(self.share, next.share),
            sky: std::array::from_fn(|i| mix(self.sky[i], next.sky[i])),
        }
    }

    /// `V`, the part of the sun that is seen.
    #[inline(always)]
    fn sun_seen(&self) -> L {
        (self.above / self.width + L::splat(0.5)).at_least(0.0).at_most(1.0)
    }

    /// What they show.
    #[inline(always)]
    pub(crate) fn shown(&self, light: &Sunlight) -> [L; 3] {
        let to_sun = light.to_sun.to_array().map(L::splat);
        let cosine = dot(&self.normal, &to_sun).at_least(0.0);
        let length = dot(&self.normal, &self.normal).sqrt().at_least(LEAST_LENGTH);
        let sun = cosine * self.sun_seen() * self.share / length;
        std::array::from_fn(|i| {
            let of_sky = self.sky[i] * L::splat(light.brightest);
            self.albedo[i] * (of_sky + sun * L::splat(light.intensity[i]))
        })
    }
}

/// The greatest number of so many bits.
const fn most(bits: u32) -> u32 {
    (1 << bits) - 1
}
