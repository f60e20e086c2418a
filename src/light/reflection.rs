//! Reflection by a rough surface: the microfacets of GGX, as in glTF 2.0, appendix B.
//!
//! ```text
//! D = a^2 / (pi ((n.h)^2 (a^2 - 1) + 1)^2)                                   Trowbridge, Reitz 1975
//! V = 1 / (2 (n.l sqrt((n.v)^2 (1 - a^2) + a^2) + n.v sqrt((n.l)^2 (1 - a^2) + a^2)))    Heitz 2014
//! F = F0 + (F90 - F0) (1 - v.h)^5                                                    Schlick 1994
//! ```
//!
//! with `a` the square of the roughness; `F0` is 0.04 and `F90` 1 of a dielectric, both times its
//! `specular`, and the base colour and 1 of a metal ([`Fresnel`]).
//! What a surface reflects of a sky of 1 is `F0 x + F90 y`, and both depend on `n.v` and `a` only
//! ([`Reflectance`]). What is reflected does not get to the diffuse layer below.

use crate::scene::Finish;
use crate::scene::angle::cos_sin;
use glam::{DVec3, Vec3};

/// What a dielectric reflects of light that comes straight: an index of refraction of 1.5.
const DIELECTRIC: f32 = 0.04;

/// Least `a`: smoother surfaces would show a point light as a dot of any brightness.
const LEAST_ALPHA: f32 = 0.002;

/// Least `n.v`: a surface that is seen may have a mean normal that faces away.
pub const LEAST_COSINE: f32 = 1e-3;

/// `a` of a roughness, 0 to 1.
pub fn alpha(roughness: f32) -> f32 {
    (roughness * roughness).max(LEAST_ALPHA)
}

/// What a surface reflects of light, by where it comes from.
#[derive(Clone, Copy, Debug)]
pub struct Fresnel {
    /// Of light that comes straight, linear RGB: F0.
    pub straight: Vec3,
    /// Of light along the surface: F90.
    pub grazing: f32,
}

impl Fresnel {
    /// Of a material whose base colour is `base` at the place.
    pub fn new(finish: &Finish, base: Vec3) -> Self {
        let Self { straight, grazing } = Self::of_dielectric(finish);
        let metallic = finish.metallic;
        Self {
            straight: straight * (1.0 - metallic) + base * metallic,
            grazing: grazing * (1.0 - metallic) + metallic,
        }
    }

    /// Of what a material has of a dielectric.
    pub fn of_dielectric(finish: &Finish) -> Self {
        let specular = finish.specular;
        Self { straight: Vec3::splat(DIELECTRIC * specular), grazing: specular }
    }

    /// At a cosine to the half vector, after Schlick.
    pub fn at(&self, cosine: f32) -> Vec3 {
        let Self { straight, grazing: all } = *self;
        straight + (Vec3::splat(all) - straight) * grazing(cosine)
    }

    /// Of a sky of 1, by what [`Reflectance::at`] says.
    pub fn of_sky(&self, [x, y]: [f32; 2]) -> Vec3 {
        self.straight * x + self.grazing * y
    }
}

/// Schlick's `(1 - c)^5`.
fn grazing(cosine: f32) -> f32 {
    let c = (1.0 - cosine).clamp(0.0, 1.0);
    c * c * c * c * c
}

/// `pi D V n.l` of unit vectors: times `F`, what is reflected of a light whose intensity is 1. `n.v`
/// must be above 0.
pub fn lobe(alpha_squared: f32, n_v: f32, n_l: f32, n_h: f32) -> f32 {
    if n_l <= 0.0 {
        return 0.0;
    }
    let a = alpha_squared;
    let t = n_h * n_h * (a - 1.0) + 1.0;
    // The denominator is 0 only where rounding takes n.h beyond 1.
    let d = a / (t * t).max(1e-14);
    let masked = |x: f32, y: f32| x * (y * y * (1.0 - a) + a).sqrt();
    d * 0.5 / (masked(n_l, n_v) + masked(n_v, n_l)) * n_l
}

/// A direction that a rough surface, with z its normal, reflects light from to `to_eye`, drawn in
/// proportion to the microfacets that the eye sees; `(v.h, G2 / G1)` with it. It may go down: such
/// light comes from within the surface. By the cap of a sphere: Dupuy and Benyoub 2023.
pub fn reflected(alpha: f64, to_eye: DVec3, [x, y]: [f64; 2]) -> (DVec3, f64, f64) {
    let view = DVec3::new(to_eye.x * alpha, to_eye.y * alpha, to_eye.z).normalize();
    let z = 1.0 - x * (1.0 + view.z);
    let across = (1.0 - z * z).max(0.0).sqrt();
    let [cos, sin] = cos_sin(y);
    let half = DVec3::new(across * cos, across * sin, z) + view;
    let half = DVec3::new(half.x * alpha, half.y * alpha, half.z.max(0.0)).normalize_or(DVec3::Z);
    let v_h = to_eye.dot(half);
    let light = half * (2.0 * v_h) - to_eye;
    // Smith's masking, correlated in height: G2 / G1 = (1 + L(v)) / (1 + L(v) + L(l)).
    let lambda = |w: DVec3| {
        let slope = alpha * alpha * (w.x * w.x + w.y * w.y) / (w.z * w.z);
        ((1.0 + slope).sqrt() - 1.0) * 0.5
    };
    let of_view = lambda(to_eye);
    let shown = if light.z > 0.0 { (1.0 + of_view) / (1.0 + of_view + lambda(light)) } else { 0.0 };
    (light, v_h, shown)
}

/// How much of a sky of 1 a surface reflects.
#[derive(Clone, Debug)]
pub struct Reflectance {
    /// `[x, y]` of `F0 x + F90 y`, by roughness and `n.v`, each from 0 to 1.
    table: Vec<[f32; 2]>,
}

/// Entries of the table a side, and points that each is the mean of: `x + y` is within 0.002.
const SIDE: usize = 32;
const POINTS: u32 = 256;

impl Reflectance {
    /// Measures the table.
    pub fn new() -> Self {
        let entries = (0..SIDE * SIDE).map(|i| {
            let [cosine, roughness] = [i % SIDE, i / SIDE].map(|k| k as f64 / (SIDE - 1) as f64);
            let cosine = cosine.max(f64::from(LEAST_COSINE));
            measured(f64::from(alpha(roughness as f32)), cosine)
        });
        Self { table: entries.collect() }
    }

    /// `[x, y]` of `F0 x + F90 y`, at `n.v` and `a`.
    pub fn at(&self, n_v: f32, alpha: f32) -> [f32; 2] {
        let place = |c: f32| {
            let place = c.clamp(0.0, 1.0) * (SIDE - 1) as f32;
            let first = (place as usize).min(SIDE - 2);
            (first, place - first as f32)
        };
        let ((x, fx), (y, fy)) = (place(n_v), place(alpha.sqrt()));
        [0, 1].map(|i| {
            let entry = |dx: usize, dy: usize| self.table[x + dx + SIDE * (y + dy)][i];
            let low = entry(0, 0) + (entry(1, 0) - entry(0, 0)) * fx;
            let high = entry(0, 1) + (entry(1, 1) - entry(0, 1)) * fx;
            low + (high - low) * fy
        })
    }
}

impl Default for Reflectance {
    fn default() -> Self {
        Self::new()
    }
}

/// The mean of what is reflected over directions that the surface reflects from.
fn measured(alpha: f64, cosine: f64) -> [f32; 2] {
    let to_eye = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    let mut sums = [0.0; 2];
    for i in 0..POINTS {
        // Hammersley's points, with the golden ratio for the second.
        let x = (f64::from(i) + 0.5) / f64::from(POINTS);
        let (_, v_h, shown) = reflected(alpha, to_eye, [x, f64::from(i) * 0.618_033_988_749_894_9]);
        let grazing = f64::from(grazing(v_h as f32));
        sums[0] += shown * (1.0 - grazing);
        sums[1] += shown * grazing;
    }
    sums.map(|sum| (sum / f64::from(POINTS)) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lobe_and_drawn_directions_are_the_same_reflection() {
        // The lobe's sum over directions spread evenly is the mean over drawn ones.
        let reflectance = Reflectance::new();
        for roughness in [0.4, 0.7, 1.0] {
            for n_v in [0.2_f32, 0.5, 0.9] {
                let to_eye = Vec3::new((1.0 - n_v * n_v).sqrt(), 0.0, n_v);
                let (num, a) = (100_000, alpha(roughness));
                let mut sum = [0.0; 2];
                for i in 0..num {
                    let z = (i as f64 + 0.5) / f64::from(num);
                    let [cos, sin] = cos_sin(i as f64 * 0.381_966_011_250_105);
                    let across = (1.0 - z * z).sqrt();
                    let light = DVec3::new(across * cos, across * sin, z).as_vec3();
                    let half = (light + to_eye).normalize();
                    // Over the half sphere of 2 pi, of light of 1: pi times its intensity.
                    let lobe = f64::from(lobe(a * a, n_v, light.z, half.z)) * 2.0;
                    let grazing = f64::from(grazing(to_eye.dot(half)));
                    sum[0] += lobe * (1.0 - grazing) / f64::from(num);
                    sum[1] += lobe * grazing / f64::from(num);
                }
                let found = reflectance.at(n_v, a).map(f64::from);
                let error = (0..2).map(|i| (found[i] - sum[i]).abs()).fold(0.0, f64::max);
                assert!(error < 4e-3, "roughness {roughness}, n.v {n_v}: {found:?} {sum:?}");
            }
        }
    }

    #[test]
    fn nothing_reflects_more_than_all() {
        for [x, y] in Reflectance::new().table {
            assert!(x >= 0.0 && y >= 0.0 && x + y <= 1.0, "{x} {y}");
        }
    }
}
