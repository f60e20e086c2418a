//! What texels of a rough surface reflect of a sky, as far as it is open to them.
//!
//! A lobe of GGX around the direction in which a mirror would reflect is cut by a texel's
//! skyline (`skylines`), and how much of light is reflected depends on the angle of the eye to the
//! normal.

use super::reflection::{LEAST_COSINE, Reflectance, alpha};
use super::skylines::Skyline;
use super::vectors::dot;
use crate::simd::Lanes;
use glam::{DMat4, DVec4};

/// What a rough surface reflects of a sky of 1, `F0 x + F90 y`: `x` and `F90 y` by 1, `m`, `m^2` and
/// `m^5`, with `m` one minus the cosine to the eye.
#[derive(Clone, Copy, Debug)]
pub struct SkyShares([[f32; 4]; 2]);

/// How wide the part of a lobe above an edge is spread over the angle to it, for each `a`: the distribution
/// of a slope. Measured on a floor of metal, roughness 0.3 and 0.6: 1.8 has 40.3 dB both times, 2 41.1 and 40.1,
/// 2.2 41.2 and 38.8.
const EDGE: f32 = 2.0;

impl SkyShares {
    /// Of a surface of some roughness, 0 to 1, that reflects so much of light along it.
    pub fn new((roughness, grazing): (f32, f32), reflectance: &Reflectance) -> Self {
        let [x, y] = shares(alpha(roughness), reflectance);
        Self([x, y.map(|term| term * grazing)])
    }

    /// `x` and `F90 y` of the part of a lobe that is open to a texel with such a normal and skyline, seen
    /// by an eye in a direction; and the direction around which that part lies.
    #[inline(always)]
    pub(crate) fn lobe<L: Lanes>(
        &self,
        [normal, to_eye]: [[L; 3]; 2],
        skyline: &Skyline<L>,
        alpha: L,
    ) -> ([L; 2], [L; 3]) {
        let one = L::splat(1.0);
        let inverse = one / dot(&normal, &normal).at_least(1e-6).sqrt();
        let normal = normal.map(|c| c * inverse);
        let n_v = dot(&normal, &to_eye).at_least(LEAST_COSINE).at_most(1.0);
        let reflected = [0, 1, 2].map(|i| normal[i] * (n_v + n_v) - to_eye[i]);
        // Find by how far the lobe's middle is within what is open, and above the polygon, under which all
        // is relief.
        let width = alpha * L::splat(EDGE);
        let within = skyline.above(reflected, width);
        let within = within - (within - reflected[2]).at_least(0.0);
        // The part of the lobe there is `(1 + d / (d^2 + w^2)^(1/2)) / 2`. What goes into the texel's own
        // plane is not among what it reflects.
        let length = |distance: L| (distance * distance + width * width).sqrt();
        let (to_edge, to_plane) = (length(within), length(n_v));
        let part = (to_edge + within) * to_plane / (to_edge * (to_plane + n_v));
        let part = part.at_most(1.0);
        // What is hidden moves the middle of the rest toward what is open: all of it, by the lobe's width.
        let (moved, middle) = ((one - part) * width, skyline.middle());
        let [x, y, z] = [0, 1, 2].map(|i| reflected[i] + middle[i] * moved);
        // And what it shows.
        (self.at(n_v).map(|share| share * part), [x, y, z.at_least(0.0)])
    }

    /// `x` and `F90 y` at a cosine of the eye to the normal.
    #[inline(always)]
    pub(super) fn at<L: Lanes>(&self, n_v: L) -> [L; 2] {
        let m = L::splat(1.0) - n_v;
        let m2 = m * m;
        let m5 = m2 * m2 * m;
        self.0.map(|terms| {
            let [all, of_m, of_m2, of_m5] = terms.map(L::splat);
            (all + of_m * m + of_m2 * m2 + of_m5 * m5).at_least(0.0)
        })
    }
}

/// What reflects light above a diffuse layer.
#[derive(Clone, Copy, Debug)]
pub struct Layer {
    /// How much it reflects of light from all around.
    pub shares: SkyShares,
    /// And of light that comes straight.
    pub straight: f32,
}

impl Layer {
    /// The part of light from around that gets below it, to an eye in a direction.
    #[inline(always)]
    pub(crate) fn passed<L: Lanes>(&self, normal: [L; 3], to_eye: [L; 3]) -> L {
        let inverse = L::splat(1.0) / dot(&normal, &normal).at_least(1e-6).sqrt();
        let n_v = dot(&normal, &to_eye) * inverse;
        let [x, y] = self.shares.at(n_v.at_least(LEAST_COSINE).at_most(1.0));
        (L::splat(1.0) - x * L::splat(self.straight) - y).at_least(0.0)
    }
}

/// `x` and `y` of [`SkyShares`]: least squares over the cosine to the eye, within 0.02.
fn shares(alpha: f32, reflectance: &Reflectance) -> [[f32; 4]; 2] {
    const POINTS: usize = 32;
    let basis = |i: usize| {
        let m = i as f64 / POINTS as f64;
        DVec4::new(1.0, m, m * m, m * m * m * m * m)
    };
    let (mut squares, mut products) = (DMat4::ZERO, [DVec4::ZERO; 2]);
    for i in 0..POINTS {
        let at = basis(i);
        squares += DMat4::from_cols_array_2d(&at.to_array().map(|c| (at * c).to_array()));
        let shares = reflectance.at(1.0 - at.y as f32, alpha);
        products.iter_mut().zip(shares).for_each(|(sum, share)| *sum += at * f64::from(share));
    }
    let inverse = squares.inverse();
    let found = products.map(|product| inverse * product);
    // No surface reflects more than all.
    let most = (0..=POINTS).map(|i| (found[0] + found[1]).dot(basis(i))).fold(1.0, f64::max);
    found.map(|terms| (terms / most).as_vec4().to_array())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::PixelLanes;
    use glam::Vec3;

    #[test]
    fn what_is_reflected_does_not_get_below() {
        let reflectance = Reflectance::new();
        for roughness in [0.2, 0.5, 1.0] {
            let (straight, grazing) = (0.04, 1.0);
            let shares = SkyShares::new((roughness, grazing), &reflectance);
            for i in 1..=20 {
                let n_v = i as f32 / 20.0;
                let to_eye = Vec3::new((1.0 - n_v * n_v).sqrt(), 0.0, n_v);
                let [normal, to_eye] =
                    [Vec3::Z * 0.7, to_eye].map(|v| v.to_array().map(PixelLanes::splat));
                let passed = Layer { shares, straight }.passed(normal, to_eye).to_array()[0];
                let [x, y] = reflectance.at(n_v, alpha(roughness));
                let expected = 1.0 - straight * x - grazing * y;
                assert!(
                    (passed - expected).abs() < 0.03,
                    "{roughness}, {n_v}: {passed} {expected}"
                );
            }
        }
    }
}
