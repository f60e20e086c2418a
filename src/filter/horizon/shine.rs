//! What a patch of a curved surface reflects: of suns, points and the sky, texel by texel as its lines see
//! them, as far as they get there over the relief.
//!
//! Lights are those that shine on it ([`PatchLight`]). The eye is seen from each texel's own frame:
//! its direction is linear over the patch, as those to suns are.

use super::fit::{Fit, Linear};
use super::glossy::spread;
use super::lines::Step;
use super::lit::PatchLight;
use super::pixels::PixelOnLines;
use super::show::{Part, Show, ShowTexels};
use crate::light::{Layer, Luster, SKYLINE_PLANE, Skyline, Vectors, dot, lobes, spread_square};
use crate::simd::{Between, LineLanes};
use crate::texture::{FULL_F32, Rows};

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

/// What lights shine on its texels, through what lies above each.
impl ShowTexels<3> for &PatchLayer<'_> {
    #[inline(always)]
    fn others(&self) -> Option<&Rows> {
        Some(self.light.rows)
    }

    #[inline(always)]
    fn read<const HALVES: bool>(&self, step: &Step<'_, HALVES>) -> [LineLanes; 3] {
        let ([_, _, _, x, y, z], _) = step.values();
        let passed = self.passed([x, y, z], step.seen_at()[0], step.q());
        self.light.read(step).map(|shown| shown * passed)
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
}

/// Texels of a group of lines, one of each, and where their words of horizons are.
#[derive(Clone, Copy)]
pub(super) struct Shone {
    color: [LineLanes; 3],
    normal: [LineLanes; 3],
    /// The square of how much normals change from one line to the next.
    across: LineLanes,
    /// The lines, where the texels are seen on them, and the stored heights.
    place: [LineLanes; 3],
    /// The row.
    q: f32,
    start: usize,
    between: Between,
}

impl Shone {
    /// With such colours and normals, on the patch's middle row.
    pub(super) fn new(
        [color, normal]: [[LineLanes; 3]; 2],
        place: [LineLanes; 3],
        (start, between): (usize, Between),
    ) -> Self {
        Self { color, normal, across: LineLanes::ZERO, place, q: 0.0, start, between }
    }
}

/// What a curved surface reflects of lights, on each segment that is seen: what gets there is that of its two
/// texels, in their shares.
impl Show<3> for PatchShine<'_> {
    type Values = Shone;

    const NONE: Shone = Shone {
        color: [LineLanes::ZERO; 3],
        normal: [LineLanes::ZERO; 3],
        across: LineLanes::ZERO,
        place: [LineLanes::ZERO; 3],
        q: 0.0,
        start: 0,
        between: Between::NONE,
    };

    #[inline(always)]
    fn others(&self) -> Option<&Rows> {
        Some(self.light.rows)
    }

    #[inline(always)]
    fn read<const HALVES: bool>(&self, step: &Step<'_, HALVES>) -> Shone {
        let ([r, g, b, x, y, z], height) = step.values();
        let [xi, p] = step.seen_at();
        Shone {
            color: [r, g, b],
            normal: [x, y, z],
            across: step.normals_across(),
            place: [xi, p, height],
            q: step.q(),
            start: step.other(),
            between: step.between,
        }
    }

    #[inline(never)]
    fn between(&self, [last, next]: [&Shone; 2], part: &Part) -> [LineLanes; 3] {
        let PatchLight { middle, rows, suns, points, sky } = self.light;
        let Part { middle: at, length } = part.within();
        let mix = |a: LineLanes, b: LineLanes| a + (b - a) * at;
        let mix3 = |a: &[LineLanes; 3], b: &[LineLanes; 3]| -> [LineLanes; 3] {
            std::array::from_fn(|i| mix(a[i], b[i]))
        };
        let color = mix3(&last.color, &next.color);
        let normal = mix3(&last.normal, &next.normal);
        let spread = spread([&last.normal, &next.normal], mix(last.across, next.across), length);
        let alpha_squared =
            spread_square(self.luster.alpha_squared, normal, (self.is_base, spread));
        // What gets to the texels.
        let xi = next.place[0] - middle[0];
        let ends = [last, next].map(|texel| {
            let [_, p, height] = texel.place;
            let q = LineLanes::splat(texel.q - middle[1]);
            ((*rows, texel.start, &texel.between), [xi, q], [xi, p - middle[1], height])
        });
        let q = mix(ends[0].1[1], ends[1].1[1]);
        let to_eye = self.eye.at(xi, q);
        let grazing = LineLanes::splat(self.luster.grazing * self.full);
        let mut sums = [LineLanes::ZERO; 3];
        let mut add = |way: [LineLanes; 3], share: LineLanes, intensity: &[f32; 3]| {
            let to_light = unit(way);
            let shown = lobes(normal, [to_light, to_eye], alpha_squared) * share;
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
            let [a, b] = ends.map(|(words, at, _)| sun.lit_part(words, at));
            add(to_light, mix(a, b), &sun.intensity);
        }
        for point in points {
            let [a, b] = ends.map(|(words, _, place)| point.reaching(words, place));
            add(mix3(&a.0, &b.0), mix(a.2 / a.1, b.2 / b.1), &point.intensity);
        }
        if let Some(sky) = sky {
            let [a, b] = ends.map(|((_, start, between), ..)| {
                Skyline::<LineLanes>::at(rows, start + SKYLINE_PLANE * rows.stride(), between)
            });
            let skyline = a.mix(&b, at);
            let lobe = self.luster.sky.lobe([normal, to_eye], &skyline, alpha_squared.sqrt());
            let ([x, y], from) = lobe;
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
