//! Filtered albedo and normal with lights to a colour.

use super::reflection::{self, Fresnel, LEAST_COSINE, Reflectance};
use super::sky_lobe::WIDE;
use super::surface_point::SurfacePoint;
use crate::scene::{Eye, Finish, Light, Sky};
use glam::Vec3;

/// How far a lobe's middle lies toward the normal for each `a`: where what a mirror shows is taken
/// from, and what lies around that. Measured with [`WIDE`], a sphere of metal under gradient skies against
/// 256 samples, by roughness: 48.2 dB at 0.1, 41.3 at 0.3, 39.6 at 0.5, 46.4 at 0.8, 39.0 at 1; not bent and
/// with 1 in place of [`WIDE`] 50.4, 39.2, 30.7, 28.4 and 31.0.
const BEND: [f32; 2] = [0.5, 3.0];

/// The lights as one place of a surface sees them, in the frame of its texture: x along u, y along
/// v, z off the surface.
#[derive(Clone, Debug)]
pub struct LocalLights {
    /// What the sky lights a white surface to that lies in the polygon.
    pub ambient: Vec3,
    /// How much of the sky gets here, red, green and blue, 0 to 1: part of `ambient` already.
    pub occlusion: Vec3,
    /// In the order of the scene.
    pub lights: Vec<LocalLight>,
    /// Unit direction to the eye.
    pub to_eye: Vec3,
    /// The frame's axes in the world.
    pub axes: [Vec3; 3],
}

/// A light as one place of a surface sees it.
#[derive(Clone, Copy, Debug)]
pub struct LocalLight {
    /// Unit direction towards it.
    pub to_light: Vec3,
    /// Its intensity here.
    pub intensity: Vec3,
    /// Whether it is a point.
    pub is_point: bool,
}

/// What a pixel reflects of lights and of the sky, where it was seen texel by texel.
#[derive(Clone, Copy, Debug, Default)]
pub struct SeenGloss {
    /// What that is, linear RGB.
    pub color: Vec3,
    /// Whether all suns are in it, all points, and the sky.
    pub has_suns: bool,
    pub has_points: bool,
    pub has_sky: bool,
}

/// What light does with a surface: what the diffuse layer shows, and what comes on top of it.
#[derive(Clone, Copy, Debug)]
pub struct Reflected {
    /// The part of light that is not reflected before it gets to the diffuse layer.
    pub passed: f32,
    /// What is reflected of lights and sky, and what the surface sends out by itself.
    pub added: Vec3,
}

impl LocalLights {
    /// The lights at a point seen from `eye`. A surface seen from behind is lit on that side.
    pub fn at(point: &SurfacePoint, eye: Eye, lights: &[Light], sky: &Sky) -> Self {
        let axes = point.axes();
        let [u, v, normal] = axes;
        let local = |w: Vec3| Vec3::new(u.dot(w), v.dot(w), normal.dot(w));
        let lights = lights.iter().map(|light| {
            let (to_light, intensity) = match *light {
                Light::Sun { to_light, intensity, .. } => (to_light.normalize_or_zero(), intensity),
                Light::Point { position, intensity } => {
                    let way = position - point.position;
                    // The least distance keeps a light on the surface finite.
                    (way.normalize_or_zero(), intensity / way.length_squared().max(1e-12))
                }
            };
            let is_point = matches!(light, Light::Point { .. });
            LocalLight { to_light: local(to_light), intensity, is_point }
        });
        let to_eye = local(eye.seen_from(point.position).normalize_or_zero());
        let (ambient, lights) = (sky.irradiance(normal), lights.collect());
        Self { ambient, occlusion: Vec3::ONE, lights, to_eye, axes }
    }

    /// Leaves so much of the sky, red, green and blue, 0 to 1.
    pub fn occlude(&mut self, share: Vec3) {
        self.ambient *= share;
        self.occlusion *= share;
    }

    /// What an albedo of 1 is multiplied with under a normal.
    pub fn diffuse(&self, normal: Vec3, sky: &Sky) -> Vec3 {
        let ambient = if sky.is_uniform() {
            self.ambient
        } else {
            sky.irradiance(self.in_world(normal)) * self.occlusion
        };
        self.lights
            .iter()
            .fold(ambient, |sum, light| sum + light.intensity * normal.dot(light.to_light).max(0.0))
    }

    /// What a pixel shows of a light's highlights that are 1 of light that comes straight, by what
    /// the surface reflects of that.
    pub fn shown(&self, light: usize, fresnel: &Fresnel) -> Vec3 {
        let LocalLight { to_light, intensity, .. } = self.lights[light];
        let half = (to_light + self.to_eye).normalize_or_zero();
        let straight = fresnel.straight.max(Vec3::splat(1e-6));
        intensity * (fresnel.at(half.dot(self.to_eye)) / straight)
    }

    /// What a material of base colour `base` does with the light under a mean normal; of what it reflects
    /// what was seen, else that of the mean normal.
    pub fn reflected(
        &self,
        mean_normal: Vec3,
        (finish, base): (&Finish, Vec3),
        sky: &Sky,
        reflectance: &Reflectance,
        seen: SeenGloss,
    ) -> Reflected {
        // Normals that cancel out leave no length to divide by, and rounding may make a mean too
        // long.
        let length = mean_normal.length().clamp(1e-3, 1.0);
        let normal = mean_normal / length;
        let alpha = reflection::alpha(finish.roughness);
        let alpha_squared = (alpha * alpha + 2.0 * (1.0 - length) / length).min(1.0);
        let n_v = normal.dot(self.to_eye).max(LEAST_COSINE);
        let fresnel = Fresnel::new(finish, base);
        let of_sky = reflectance.at(n_v, alpha_squared.sqrt());
        let mut added = finish.emissive + seen.color;
        if !seen.has_sky {
            added += fresnel.of_sky(of_sky) * self.mirrored(normal, alpha_squared, sky);
        }
        let is_seen =
            |light: &LocalLight| if light.is_point { seen.has_points } else { seen.has_suns };
        for light in self.lights.iter().filter(|light| !is_seen(light)) {
            let half = (light.to_light + self.to_eye).normalize_or_zero();
            let share = fresnel.at(half.dot(self.to_eye));
            let n_l = normal.dot(light.to_light);
            let lobe = reflection::lobe(alpha_squared, n_v, n_l, normal.dot(half));
            added += light.intensity * share * lobe;
        }
        let passed = 1.0 - Fresnel::of_dielectric(finish).of_sky(of_sky).x;
        Reflected { passed, added }
    }

    /// The sky that a surface reflects, a blend of what a mirror shows and, the rougher, of all
    /// that lies around that. What goes into the surface is not part of a lobe, so its middle lies
    /// nearer to the normal, the more the wider it is ([`BEND`]).
    fn mirrored(&self, normal: Vec3, alpha_squared: f32, sky: &Sky) -> Vec3 {
        if sky.is_uniform() {
            return self.ambient;
        }
        let alpha = alpha_squared.sqrt();
        let direction = normal * (2.0 * normal.dot(self.to_eye)) - self.to_eye;
        let [sharp, wide] = BEND.map(|bend| self.in_world(direction + normal * (alpha * bend)));
        let (sharp, wide) = (sky.radiance(sharp), sky.irradiance(wide));
        (sharp + (wide - sharp) * (WIDE * alpha).min(1.0)) * self.occlusion
    }

    /// A direction of the frame in the world.
    fn in_world(&self, direction: Vec3) -> Vec3 {
        let [u, v, n] = self.axes;
        (u * direction.x + v * direction.y + n * direction.z).normalize_or(n)
    }
}
