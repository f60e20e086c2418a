//! What a patch of a curved surface reflects: of suns, points and the sky, texel by texel as its lines see
//! them, as far as they get there over the relief.
//!
//! Lights are those that shine on it ([`PatchLight`]). The eye is seen from each texel's own frame:
//! its direction is linear over the patch, as those to suns are.
//!
//! What a texel sees of the half space is told by what it shows of the sky, `t0` and `t`: of a cone
//! whose axis is `d` the opening is `d t0 / (n.d)`, and `t` lies along that axis or near it.

use super::fit::{Fit, Linear};
use super::lit::PatchLight;
use super::pixels::PixelOnLines;
use crate::light::{Layer, Luster, Vectors, dot, lobes, spread_square};
use crate::simd::{Between, LineLanes};
use crate::texture::FULL_F32;

/// Least cosine between a texel's normal and the middle of what it sees of the sky.
const LEAST_OPEN: f32 = 0.05;

/// The way to the eye over a patch, from each texel's own frame.
#[derive(Clone, Copy, Debug)]
struct PatchEye {
    /// Along u, along v and off the surface: of about unit length.
    to_eye: [Linear; 3],
}

impl PatchEye {
    /// Of picked pixels, which lie so on the lines of a patch.
    fn new(to_eyes: &[Vectors], (picks, pixels): (&[u8], &[PixelOnLines])) -> Self {
        let fit = Fit::new(pixels);
        let to_eye = [0, 1, 2].map(|c| {
            let of =
                |pick: &u8| to_eyes[usize::from(pick / 8)][c].as_array()[usize::from(pick % 8)];
            fit.linear(picks.iter().map(of))
        });
        Self { to_eye }
    }

    #[inline(always)]
    fn at(&self, xi: LineLanes, q: LineLanes) -> [LineLanes; 3] {
        unit(self.to_eye.each_ref().map(|c| c.at(xi, q)))
    }
}

/// The light of a patch's diffuse layer, through what lies above.
#[derive(Clone, Debug)]
pub(super) struct PatchLayer<'a> {
    pub(super) light: &'a PatchLight<'a>,
    layer: Layer,
    eye: PatchEye,
}

impl<'a> PatchLayer<'a> {
    pub(super) fn new(
        light: &'a PatchLight<'a>,
        (layer, to_eyes): (&Layer, &[Vectors]),
        with: (&[u8], &[PixelOnLines]),
    ) -> Self {
        Self { light, layer: *layer, eye: PatchEye::new(to_eyes, with) }
    }

    /// The part of light that gets through to texels on row `q` with such normals.
    #[inline(always)]
    pub(super) fn passed(&self, normal: [LineLanes; 3], xi: LineLanes, q: f32) -> LineLanes {
        let [x, y] = self.light.middle;
        self.layer.passed(normal, self.eye.at(xi - x, LineLanes::splat(q - y)))
    }
}

/// What a patch reflects.
#[derive(Clone, Debug)]
pub(super) struct PatchShine<'a> {
    pub(super) light: &'a PatchLight<'a>,
    luster: Luster,
    /// The stored colour that reflects all.
    full: f32,
    eye: PatchEye,
    /// Whether normals are single ones: those of the base level.
    is_base: bool,
}

impl<'a> PatchShine<'a> {
    /// Of the lights of picked pixels, which lie so on the lines of a patch; colours come in units of 1
    /// over `unit`.
    pub(super) fn new(
        light: &'a PatchLight<'a>,
        (luster, to_eyes): (&Luster, &[Vectors]),
        with: (&[u8], &[PixelOnLines]),
        (unit, is_base): (f32, bool),
    ) -> Self {
        let full = FULL_F32 * unit / luster.color_scale;
        Self { light, luster: *luster, full, eye: PatchEye::new(to_eyes, with), is_base }
    }

    /// What texels with such colours and normals, whose words of horizons begin at a place of the
    /// rows, show to the eye: see [`PatchLight::at`].
    #[inline(always)]
    pub(super) fn at(
        &self,
        (start, between): (usize, &Between),
        [color, normal]: [[LineLanes; 3]; 2],
        [xi, p, height]: [LineLanes; 3],
        q: f32,
    ) -> [LineLanes; 3] {
        let PatchLight { middle, rows, suns, points, sky } = self.light;
        let [xi, p] = [xi - middle[0], p - middle[1]];
        let q = LineLanes::splat(q - middle[1]);
        let to_eye = self.eye.at(xi, q);
        let a = spread_square(self.luster.alpha_squared, normal, self.is_base);
        let grazing = LineLanes::splat(self.luster.grazing * self.full);
        let mut sums = [LineLanes::ZERO; 3];
        let mut add = |way: [LineLanes; 3], share: LineLanes, intensity: &[f32; 3]| {
            let to_light = unit(way);
            let shown = lobes(normal, [to_light, to_eye], a) * share;
            // Schlick's share, by the cosine to the half vector.
            let cosine = (dot(&to_light, &to_eye) * 0.5 + 0.5).fast_max(LineLanes::ZERO).sqrt();
            let c = (LineLanes::ONE - cosine).fast_max(LineLanes::ZERO);
            let schlick = c * c * (c * c) * c;
            for i in 0..3 {
                let reflected = color[i] + (grazing - color[i]) * schlick;
                sums[i] += reflected * shown * intensity[i];
            }
        };
        for sun in suns {
            let to_light = sun.to_light.each_ref().map(|c| c.at(xi, q));
            add(to_light, sun.lit_part((rows, start, between), [xi, q]), &sun.intensity);
        }
        for point in points {
            let (way, square, lit) = point.reaching((rows, start, between), [xi, p, height]);
            add(way, lit / square, &point.intensity);
        }
        if let Some(sky) = sky {
            let (t0, t) = self.light.sky_seen(start, between);
            let n = unit(normal);
            let along = dot(&n, &t).fast_max(dot(&t, &t).sqrt() * LEAST_OPEN);
            let by = t0 / along.fast_max(LineLanes::splat(1e-3));
            let opening = t.map(|c| c * by);
            let ([x, y], from) = self.luster.sky.lobe([n, opening, to_eye], a.sqrt());
            let light = sky.from(from, [xi, q]);
            (0..3).for_each(|i| sums[i] += (color[i] * x + y * self.full) * light[i]);
        }
        sums
    }
}

#[inline(always)]
fn unit(way: [LineLanes; 3]) -> [LineLanes; 3] {
    let inverse = LineLanes::ONE / dot(&way, &way).fast_max(LineLanes::splat(1e-12)).sqrt();
    way.map(|c| c * inverse)
}
