//! What is reflected of a sun or of the sky, texel by texel.
//!
//! A rough surface shows of a sun what the lobe around each seen normal holds. The sun lies in one
//! direction over a flat piece of a surface, and the eye in nearly one over a few pixels, or over
//! all that a table of the far field stands for. So the lobe is taken of each texel where it is
//! swept, and what is averaged is highlights, not normals. It is the same with the sky.

use super::beams::TextureFrame;
use super::reflection::{LEAST_COSINE, alpha};
use super::sky_lobe::SkyLobe;
use super::sky_shares::Layer;
use super::skylines::{Skyline, Skylines};
use super::vectors::dot;
use crate::simd::Lanes;
use glam::Vec3;

/// Least square of a half vector's length: of an eye and a light that lie opposite each other.
const LEAST_HALF: f32 = 1e-12;

/// A sun or the sky over a flat piece of a rough surface, in the frame of its texture: x along u, y
/// along v, z off the surface.
#[derive(Clone, Debug)]
pub struct Gloss {
    shine: Shine,
    /// `a^2` of the roughness; `None` where texels have their own, in the [length](rough_length) of
    /// their normals.
    alpha_squared: Option<f32>,
    /// How far a view goes for each repeat along u and along v that it moves while it goes down one.
    along: [Vec3; 2],
    /// And how far it goes down.
    down: f32,
    relief_depth: f32,
}

/// What is reflected.
#[derive(Clone, Debug)]
enum Shine {
    /// Unit direction to a sun.
    Sun(Vec3),
    /// The sky, and the scale of the colours that it is seen in.
    Sky(SkyLobe, f32),
    /// Nothing: colours are the diffuse layer's, which shows what is not reflected above it.
    Layer(Layer),
}

impl Gloss {
    /// Of a sun in a direction of any length; `relief_depth` is in repeats.
    pub fn of_sun(
        frame: &TextureFrame,
        to_sun: Vec3,
        roughness: Option<f32>,
        relief_depth: f32,
    ) -> Self {
        let to_light = frame.local(to_sun.normalize_or_zero());
        Self::new(frame, Shine::Sun(to_light), roughness, relief_depth)
    }

    /// Of the sky, in colours of some scale.
    pub fn of_sky(
        frame: &TextureFrame,
        (sky, color_scale): (SkyLobe, f32),
        roughness: Option<f32>,
        relief_depth: f32,
    ) -> Self {
        Self::new(frame, Shine::Sky(sky, color_scale), roughness, relief_depth)
    }

    /// Of a diffuse layer under what reflects light.
    pub fn of_layer(frame: &TextureFrame, layer: Layer, relief_depth: f32) -> Self {
        Self::new(frame, Shine::Layer(layer), Some(1.0), relief_depth)
    }

    /// Whether a light is reflected: what is seen of that changes faster than colours do.
    pub(crate) fn is_shiny(&self) -> bool {
        !matches!(self.shine, Shine::Layer(_))
    }

    fn new(frame: &TextureFrame, shine: Shine, roughness: Option<f32>, relief_depth: f32) -> Self {
        let [u, v] = frame.tangents;
        Self {
            shine,
            alpha_squared: roughness.map(|roughness| alpha(roughness) * alpha(roughness)),
            along: [u, v].map(|along| frame.local(along)),
            down: u.cross(v).length().sqrt(),
            relief_depth,
        }
    }

    /// The unit direction to the eye of a view that moves so many repeats down to the deepest
    /// relief.
    pub fn to_eye(&self, displacement: [f32; 2]) -> Vec3 {
        let [u, v] = displacement.map(|d| d / self.relief_depth);
        (Vec3::Z * self.down - self.along[0] * u - self.along[1] * v).normalize_or(Vec3::Z)
    }

    /// What texels see of the sky, where that is what they reflect.
    pub(crate) fn skylines(&self) -> Option<&Skylines> {
        match &self.shine {
            Shine::Sun(_) | Shine::Layer(_) => None,
            Shine::Sky(sky, _) => Some(sky.skylines()),
        }
    }

    /// What texels with such normals and skylines show to an eye in a direction, red, green and blue; those
    /// of coarser levels than the base are means. Their colours are `full` where they are the surface's
    /// colour scale.
    #[inline(always)]
    pub(crate) fn shown<L: Lanes>(
        &self,
        (color, full): ([L; 3], f32),
        [normal, to_eye]: [[L; 3]; 2],
        skyline: &Skyline<L>,
        (is_base, spread): (bool, L),
    ) -> [L; 3] {
        let a = spread_square(self.alpha_squared, normal, (is_base, spread));
        match &self.shine {
            Shine::Sun(to_light) => {
                let shown = lobes(normal, [to_light.to_array().map(L::splat), to_eye], a);
                color.map(|color| color * shown)
            }
            Shine::Sky(sky, scale) => {
                sky.shown((color, full / scale), [normal, to_eye], skyline, a)
            }
            Shine::Layer(layer) => {
                let passed = layer.passed(normal, to_eye);
                color.map(|color| color * passed)
            }
        }
    }
}

/// Least `a^2` that is told from lengths, which are rounded.
const LEAST_OWN: f32 = 1e-4;

/// `a^2` of a roughness, if texels do not have their own, and of how much normals differ: how short those
/// are that are means of others says so, and of single ones `spread` does.
#[inline(always)]
pub(crate) fn spread_square<L: Lanes>(
    alpha_squared: Option<f32>,
    normal: [L; 3],
    (is_base, spread): (bool, L),
) -> L {
    let spread = if is_base && alpha_squared.is_some() {
        spread
    } else {
        let square = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
        let inverse = L::splat(1.0) / square.at_least(1e-6).sqrt();
        (inverse + inverse - L::splat(2.0)).at_least(0.0)
    };
    (L::splat(alpha_squared.unwrap_or(LEAST_OWN)) + spread).at_most(1.0)
}

/// The length of a normal that stands for a roughness, so that a mean of normals of some roughness
/// is as rough as they are and their directions differ: `a^2 = 2 (1 - |n|) / |n|`.
pub fn rough_length(roughness: f32) -> f32 {
    let a = alpha(roughness);
    2.0 / (2.0 + a * a)
}

/// `pi D V n.l` as [`lobe`](super::reflection::lobe), of normals in lanes, of any length above 0,
/// and an `a^2` up to 1. A normal that faces away from the eye shows as
/// if the eye stood just above its plane, as in the truth.
#[inline(always)]
pub(crate) fn lobes<L: Lanes>(normal: [L; 3], [to_light, to_eye]: [[L; 3]; 2], a: L) -> L {
    let one = L::splat(1.0);
    let inverse = one / dot(&normal, &normal).at_least(1e-6).sqrt();
    let n_l = dot(&normal, &to_light) * inverse;
    let n_v = dot(&normal, &to_eye) * inverse;
    let l_v = dot(&to_light, &to_eye);
    // The eye, moved along the normal by what it lacks: its cosines are divided by its length.
    let lacks = (L::splat(LEAST_COSINE) - n_v).at_least(0.0);
    let length = one / (one + lacks * (n_v + n_v + lacks)).sqrt();
    let n_v = (n_v + lacks) * length;
    let l_v = (l_v + lacks * n_l) * length;
    let n_h = (n_l + n_v) / (one + one + l_v + l_v).at_least(LEAST_HALF).sqrt();
    let n_l = n_l.at_least(0.0);
    let t = n_h * n_h * (a - one) + one;
    let d = a / (t * t).at_least(1e-14);
    let masked = |x: L, y: L| x * (y * y * (one - a) + a).sqrt();
    d * n_l * L::splat(0.5) / (masked(n_l, n_v) + masked(n_v, n_l)).at_least(1e-14)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::reflection::lobe;
    use crate::simd::PixelLanes;

    #[test]
    fn lobes_in_lanes_are_those_of_single_normals() {
        let splat = |v: Vec3| v.to_array().map(PixelLanes::splat);
        for i in 0..200 {
            let at = |k: i32| ((i * k % 37) as f32 - 18.0) / 18.0;
            let normal = Vec3::new(at(5), at(7), 0.6);
            let to_light = Vec3::new(at(11), at(3), 0.8).normalize();
            let to_eye = Vec3::new(at(13), at(17), 0.7).normalize();
            let a = 0.01 + 0.9 * (i as f32 / 200.0);
            let n = normal.normalize();
            let lacks = (LEAST_COSINE - n.dot(to_eye)).max(0.0);
            let seen_by = (to_eye + n * lacks).normalize();
            let half = (to_light + seen_by).normalize();
            let alone = lobe(a, n.dot(seen_by), n.dot(to_light), n.dot(half));
            let found = lobes(splat(normal), [to_light, to_eye].map(splat), PixelLanes::splat(a));
            let found = found.to_array()[3];
            assert!((found - alone).abs() <= 2e-3 * alone + 1e-4, "{found} {alone}");
        }
    }

    #[test]
    fn the_eye_lies_against_the_view() {
        let tangents = [Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 0.0, -2.0)];
        let frame = TextureFrame { tangents, normal: Vec3::Y };
        let gloss = Gloss::of_sun(&frame, Vec3::Y, Some(0.5), 0.05);
        // One repeat along u, two world units, for each repeat down.
        let to_eye = gloss.to_eye([0.05, 0.0]);
        assert!(to_eye.distance(Vec3::new(-1.0, 0.0, 1.0).normalize()) < 1e-6, "{to_eye}");
    }
}
