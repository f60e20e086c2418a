//! Filtered albedo and normal with lights to a colour: sky, Lambert and Blinn-Phong.
//!
//! ```text
//! colour = albedo (sky(n) + sum I max(0, n.l)) + specular sum I f (n.h)^s     h = normalize(l + v), where n.l > 0
//! ```
//!
//! Where a pixel holds many normals, `n` is their mean, and the highlight is widened by how much
//! shorter than one it is: `s' = f' s`, `f' = |n| / (|n| + s (1 - |n|))`, with the lobe's height
//! scaled by `f = (1 + s') / (1 + s)` (Toksvig 2005, "Mipmapping normal maps").

mod bake;

use crate::scene::{Light, Material, Sky};
use glam::Vec3;

pub use bake::{Beam, TextureFrame, baked};

/// The lights as one place of a surface sees them, in the frame of its texture: x along u, y along
/// v, z off the surface.
#[derive(Clone, Debug, Default)]
pub struct LocalLights {
    /// What the sky lights a white surface to that lies in the polygon.
    pub ambient: Vec3,
    /// Unit direction towards each light, and its intensity here.
    pub lights: Vec<(Vec3, Vec3)>,
    /// Unit direction to the eye.
    pub to_eye: Vec3,
    /// The frame's axes in the world; u and v may be oblique.
    pub axes: [Vec3; 3],
}

/// World-space place and frame of a surface point.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Position.
    pub position: Vec3,
    /// Normal, of any length.
    pub normal: Vec3,
    /// dP/du and dP/dv, of any length.
    pub tangents: [Vec3; 2],
}

impl LocalLights {
    /// The lights at a point seen from `eye`. A surface seen from behind is lit on that side.
    pub fn at(point: &SurfacePoint, eye: Vec3, lights: &[Light], sky: &Sky) -> Self {
        let to_eye = (eye - point.position).normalize_or_zero();
        let normal = point.normal.normalize_or(Vec3::Z);
        let normal = if normal.dot(to_eye) < 0.0 { -normal } else { normal };
        // Take off what interpolated tangents have along the normal; u and v may stay oblique.
        let [u, v] = point.tangents.map(|t| (t - normal * t.dot(normal)).normalize_or_zero());
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
            (local(to_light), intensity)
        });
        let (lights, axes) = (lights.collect(), [u, v, normal]);
        Self { ambient: sky.irradiance(normal), lights, to_eye: local(to_eye), axes }
    }

    /// What an albedo of 1 is multiplied with under a normal.
    pub fn diffuse(&self, normal: Vec3, sky: &Sky) -> Vec3 {
        let ambient = if sky.is_uniform() {
            self.ambient
        } else {
            let [u, v, n] = self.axes;
            sky.irradiance((u * normal.x + v * normal.y + n * normal.z).normalize_or(n))
        };
        self.lights.iter().fold(ambient, |sum, (to_light, intensity)| {
            sum + *intensity * normal.dot(*to_light).max(0.0)
        })
    }

    /// The highlights of a mean normal.
    pub fn specular(&self, mean_normal: Vec3, material: &Material) -> Vec3 {
        if material.specular == Vec3::ZERO {
            return Vec3::ZERO;
        }
        // Normals that cancel out leave no length to divide by, and rounding may make a mean too
        // long.
        let length = mean_normal.length().clamp(1e-3, 1.0);
        let normal = mean_normal / length;
        let toksvig = length / (length + material.shininess * (1.0 - length));
        let shininess = toksvig * material.shininess;
        let scale = (1.0 + shininess) / (1.0 + material.shininess);
        let lobes = self.lights.iter().filter(|(to_light, _)| normal.dot(*to_light) > 0.0);
        lobes.fold(Vec3::ZERO, |sum, (to_light, intensity)| {
            let half = (*to_light + self.to_eye).normalize_or_zero();
            sum + *intensity * (scale * power(normal.dot(half), shininess))
        }) * material.specular
    }
}

/// `x` to the power `s`, for `x` up to 1 and `s` of 0 or more, by exact operations alone: the same
/// on every machine.
pub fn power(x: f32, s: f32) -> f32 {
    if x <= 0.0 {
        return if s == 0.0 { 1.0 } else { 0.0 };
    }
    // x = m 2^e with m within 0.75 to 1.5; ln m by the series of atanh.
    let bits = f64::from(x).to_bits();
    let (mut exponent, mut m) =
        ((bits >> 52) as i64 - 1023, f64::from_bits(bits & ((1 << 52) - 1) | 1023 << 52));
    if m > 1.5 {
        (exponent, m) = (exponent + 1, m * 0.5);
    }
    let z = (m - 1.0) / (m + 1.0);
    let series = (0..10).rev().fold(0.0, |sum, i| sum * z * z + 1.0 / f64::from(2 * i + 1));
    let ln = 2.0 * z * series + exponent as f64 * std::f64::consts::LN_2;
    // e^-60 is black in any picture, and a 64th of 60 is little enough for twelve terms.
    let y = (ln * f64::from(s)).max(-60.0);
    // exp(y) by a 64th of y in Taylor's series, then six squarings.
    let part = y / 64.0;
    let exp = (1..=12).rev().fold(1.0, |sum, i| 1.0 + sum * part / f64::from(i));
    (0..6).fold(exp, |e, _| e * e) as f32
}
