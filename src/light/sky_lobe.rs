//! What texels of a rough surface reflect of the sky.
//!
//! A texel reflects the sky around the direction in which a mirror would, the wider the rougher it is,
//! as far as its [skyline](super::skylines) lets it: the part of the lobe above that is a ramp in the
//! angle between the two, as wide as the lobe. How much of light it reflects depends on the angle of
//! the eye to its normal.

use super::beams::TextureFrame;
use super::curved::LinearSky;
use super::disc::spiral;
use super::reflection::Reflectance;
use super::sky_shares::SkyShares;
use super::skylines::{Skyline, Skylines};
use super::surface_point::unit_axes;
use super::vectors::dot;
use crate::scene::Sky;
use crate::simd::Lanes;
use glam::{Vec3, Vec4};
use std::sync::Arc;

/// A sky over a flat piece of a rough surface, in the frame of its texture.
#[derive(Clone, Debug)]
pub struct SkyLobe {
    sky: LocalSky,
    shares: SkyShares,
    skylines: Arc<Skylines>,
}

/// The light of the half space, by direction, for lanes.
#[derive(Clone, Debug)]
struct LocalSky {
    /// The world's up.
    up: [f32; 3],
    /// What a mirror shows: by 1, `u` and `|u|`, with `u` how far a direction goes up.
    sharp: [[f32; 3]; 3],
    /// The mean around a direction, weighed by the cosine to it: by 1, x, y and z.
    wide: [[f32; 3]; 4],
    /// The share of that in what is reflected, and how much it grows with `a`; 0 twice where the sky is the
    /// same everywhere.
    share_of_wide: [f32; 2],
}

/// The share of what lies all around in what a lobe shows of a gradient, for each `a`.
pub(super) const WIDE: f32 = 1.5;

impl SkyLobe {
    /// Of a sky on a surface of some roughness, 0 to 1, that reflects so much of light along it.
    pub fn new(
        (sky, frame): (&Sky, &TextureFrame),
        finish: (f32, f32),
        reflectance: &Reflectance,
        skylines: Arc<Skylines>,
    ) -> Self {
        let shares = SkyShares::new(finish, reflectance);
        Self { sky: LocalSky::new(sky, frame), shares, skylines }
    }

    /// What texels see of the half space.
    pub(crate) fn skylines(&self) -> &Skylines {
        &self.skylines
    }

    /// What texels with such normals and skylines, and with an `a^2` up to 1, show to an eye in a direction.
    /// Of light that comes straight they reflect `straight`, which is `full` where it is all.
    #[inline(always)]
    pub(crate) fn shown<L: Lanes>(
        &self,
        (straight, full): ([L; 3], f32),
        directions: [[L; 3]; 2],
        skyline: &Skyline<L>,
        a: L,
    ) -> [L; 3] {
        let alpha = a.sqrt();
        let ([x, y], direction) = self.shares.lobe(directions, skyline, alpha);
        let light = self.sky.at(direction, alpha);
        let y = y * L::splat(full);
        [0, 1, 2].map(|c| (straight[c] * x + y) * light[c].at_least(0.0))
    }
}

impl LocalSky {
    fn new(sky: &Sky, frame: &TextureFrame) -> Self {
        let axes = unit_axes(frame.tangents, frame.normal);
        let wide = wide(sky, frame.normal);
        let local = wide.turned(axes);
        let [x, y, z] = local.slopes;
        let wide = [local.constant, x, y, z].map(|term| term.to_array());
        let (up, sharp, share_of_wide) = match sky {
            Sky::Color(color) => ([0.0; 3], [*color, Vec3::ZERO, Vec3::ZERO], [0.0; 2]),
            Sky::Gradient { top, horizon, ground } => {
                let (mean, slope) = ((*top + *ground) * 0.5, (*top - *ground) * 0.5);
                let up = axes.map(|axis| axis.y);
                (up, [*horizon, slope, mean - *horizon], [0.0, WIDE])
            }
            // Texels have no time to look into a picture.
            Sky::Environment(_) => ([0.0; 3], [Vec3::ZERO; 3], [1.0, 0.0]),
        };
        Self { up, sharp: sharp.map(|term| term.to_array()), wide, share_of_wide }
    }

    /// What comes from around a direction, the wider the greater `alpha` is.
    #[inline(always)]
    fn at<L: Lanes>(&self, direction: [L; 3], alpha: L) -> [L; 3] {
        if self.share_of_wide == [0.0; 2] {
            return self.sharp[0].map(L::splat);
        }
        let [x, y, z] = direction;
        let u = dot(&self.up.map(L::splat), &direction);
        let above = u.at_least(0.0);
        let size = above + above - u;
        let [least, more] = self.share_of_wide.map(L::splat);
        let share = (least + more * alpha).at_most(1.0);
        [0, 1, 2].map(|c| {
            let (s, w) = (self.sharp.map(|term| term[c]), self.wide.map(|term| term[c]));
            let (s, w) = (s.map(L::splat), w.map(L::splat));
            let sharp = s[0] + s[1] * u + s[2] * size;
            let wide = w[0] + w[1] * x + w[2] * y + w[3] * z;
            sharp + (wide - sharp) * share
        })
    }
}

/// The mean of the sky in the half space around a normal, weighed by the cosine to a direction: linear in
/// that.
fn wide(sky: &Sky, normal: Vec3) -> LinearSky {
    const PAIRS: usize = 256;
    let [x, y] = <[Vec3; 2]>::from(normal.any_orthonormal_pair());
    let lights = spiral(PAIRS).flat_map(|([cos, sin], height)| {
        let (height, turn) = (height as f32, [cos as f32, sin as f32]);
        let across = (1.0 - height * height).max(0.0).sqrt();
        [1.0, -1.0].map(|sign| {
            let along = (x * turn[0] + y * turn[1]) * (across * sign);
            let direction = along + normal * height;
            (direction, sky.radiance(direction))
        })
    });
    let lights: Vec<(Vec3, Vec3)> = lights.collect();
    LinearSky::new(normal, |direction| {
        let weighed = lights.iter().fold(Vec4::ZERO, |sum, (from, light)| {
            sum + light.extend(1.0) * from.dot(direction).max(0.0)
        });
        weighed.truncate() / weighed.w
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::reflection::alpha;
    use crate::light::skylines::NUM_TERMS;
    use crate::simd::PixelLanes;
    use crate::texture::{Surface, SurfaceMaps};

    fn lobe(sky: &Sky, roughness: f32) -> SkyLobe {
        let surface = Surface::new(SurfaceMaps::default()).unwrap();
        let frame = TextureFrame { tangents: [Vec3::X, Vec3::NEG_Z], normal: Vec3::Y };
        let skylines = Arc::new(Skylines::new(&surface, &frame));
        SkyLobe::new((sky, &frame), (roughness, 1.0), &Reflectance::new(), skylines)
    }

    /// A skyline that goes so high all round, and by so much higher toward one side than to the other.
    fn skyline(height: f32, side: f32) -> Skyline<PixelLanes> {
        let mut terms = [0.0; NUM_TERMS];
        [terms[0], terms[1]] = [height, side];
        Skyline::new(terms.map(PixelLanes::splat))
    }

    /// What a texel with such a normal shows to an eye that reflects `straight` of light that comes straight.
    fn shown(
        lobe: &SkyLobe,
        (roughness, straight): (f32, f32),
        directions: [Vec3; 2],
        skyline: &Skyline<PixelLanes>,
    ) -> [f32; 3] {
        let lanes = directions.map(|d| d.to_array().map(PixelLanes::splat));
        let a = PixelLanes::splat(alpha(roughness) * alpha(roughness));
        let shown = lobe.shown(([PixelLanes::splat(straight); 3], 1.0), lanes, skyline, a);
        shown.map(|lanes| lanes.as_array()[0])
    }

    fn eye(cosine: f32) -> Vec3 {
        Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine)
    }

    #[test]
    fn what_lies_open_reflects_all_that_it_can() {
        let reflectance = Reflectance::new();
        for roughness in [0.1, 0.3, 0.6, 1.0] {
            let lobe = lobe(&Sky::Color(Vec3::splat(2.0)), roughness);
            for cosine in [0.1, 0.4, 0.7, 1.0] {
                let [x, y] = reflectance.at(cosine, alpha(roughness));
                for straight in [0.04, 1.0] {
                    let directions = [Vec3::Z, eye(cosine)];
                    let found =
                        shown(&lobe, (roughness, straight), directions, &skyline(0.0, 0.0))[0];
                    let expected = 2.0 * (straight * x + y);
                    assert!(
                        (found - expected).abs() < 0.05,
                        "{roughness} {cosine}: {found} {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn no_texel_shows_more_than_a_white_sky() {
        for roughness in [0.1, 0.4, 0.8] {
            let lobe = lobe(&Sky::Color(Vec3::ONE), roughness);
            for i in 0..500 {
                let at = |k: usize| ((i * k % 41) as f32 - 20.0) / 20.0;
                let normal = Vec3::new(at(7), at(11), 0.8).normalize();
                let directions = [normal, eye(at(17) * 0.5 + 0.5)];
                let found = shown(&lobe, (roughness, 1.0), directions, &skyline(at(13), at(3)));
                assert!(found.iter().all(|c| (0.0..1.0 + 1e-5).contains(c)), "{found:?}");
            }
        }
    }

    #[test]
    fn a_narrow_opening_hides_what_lies_beside_it() {
        let sky = Sky::Color(Vec3::ONE);
        let smooth = lobe(&sky, 0.1);
        // A skyline 60 degrees high all round.
        let high = skyline(0.75_f32.sqrt(), 0.0);
        let shown = |cosine: f32| shown(&smooth, (0.1, 1.0), [Vec3::Z, eye(cosine)], &high)[0];
        let (within, edge, beyond) = (shown(0.98), shown(0.75_f32.sqrt()), shown(0.5));
        assert!(
            within > 0.97 && (0.4..0.6).contains(&edge) && beyond < 0.03,
            "{within} {edge} {beyond}"
        );
    }

    #[test]
    fn a_gradient_shows_its_upper_half_alone() {
        let sky = Sky::Gradient { top: Vec3::X, horizon: Vec3::Y, ground: Vec3::Z };
        let lobe = lobe(&sky, 0.1);
        let of = |cosine: f32| shown(&lobe, (0.1, 1.0), [Vec3::Z, eye(cosine)], &skyline(0.0, 0.0));
        let (up, level) = (of(1.0), of(0.02));
        assert!(up[0] > 0.95 && up[1] < 0.05, "{up:?}");
        assert!(level[1] > 0.9 && level[0] < 0.05 && level[2] == 0.0, "{level:?}");
    }
}
