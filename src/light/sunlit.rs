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
use crate::simd::{BETWEEN_SCALE, Between, LineLanes, u32x16};
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

/// What lights texels where lines cross a row.
#[derive(Clone, Copy, Debug)]
pub struct SunlitLanes {
    /// `m` and `w`.
    pub edge: [LineLanes; 2],
    /// `s`.
    pub share: LineLanes,
    /// `E`, 1 for the brightest.
    pub sky: [LineLanes; 3],
}

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

    /// The surface before it was lit.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// Row by row: along u, or along v where they are wanted turned.
    pub(crate) fn rows(&self, is_turned: bool) -> &Rows {
        &self.rows[usize::from(is_turned)]
    }
}

impl SunlitLanes {
    /// Where lines cross a row of [`SunlitTexels`], whose run of texels begins at a word.
    #[inline(always)]
    pub(crate) fn new(rows: &Rows, start: usize, between: &Between) -> Self {
        let [edges, colors] =
            [0, 1].map(|plane| between.words_at(rows.words(), start + plane * rows.stride()));
        let part = |words: [u32x16; 2], first: u32, most: u32| {
            between.bits_of(words, first, most) * (1.0 / (most as f32 * BETWEEN_SCALE))
        };
        let root = part(edges, 16, WIDTH);
        let mut first = 0;
        Self {
            edge: [part(edges, 0, FULL) * (1.0 - LOWEST) + LOWEST, root * root],
            share: part(edges, 24, SHARE),
            sky: SKY.map(|bits| {
                first += bits;
                part(colors, first - bits, most(bits))
            }),
        }
    }
}

/// The greatest number of so many bits.
const fn most(bits: u32) -> u32 {
    (1 << bits) - 1
}
