//! The light that reaches a pixel's hit, and the relief along its way.

use super::cut::Cut;
use super::ground::QuadPixel;
use crate::filter::Prepared;
use crate::light::exact::{Clearance, ExactLight, Hit, Reaching, Spot};
use crate::light::{SurfacePoint, TextureFrame};
use crate::scene::{Light, Material};
use glam::Vec3;

/// Rays to each light and to the sky.
pub(super) const RAYS: u32 = 64;

/// The light that reaches a pixel's hit.
#[derive(Clone, Debug)]
pub struct PixelLight {
    /// What gets there, by 64 rays to each light and to the sky.
    pub reaching: Reaching,
    /// The index of the light that sends most; `None` where none sends any.
    pub main: Option<usize>,
    /// The full texture's relief along the main light's way to the hit, as that light sweeps it: the
    /// ray is the light's, and what is visible is lit. `None` without relief or main light.
    pub cut: Option<Cut>,
}

/// What light sees of a pixel's hit on a texture.
pub(super) fn hit_of<'a>(
    material: &Material,
    prepared: &'a Prepared,
    seen: &QuadPixel,
    point: SurfacePoint,
) -> Hit<'a> {
    let surface = prepared.surface();
    let [x, y] = seen.texel(surface);
    let normal = Vec3::from(surface.base().texel(x, y).normal);
    let place = seen.ray.hit;
    // Where the ray was followed, the point is that of the polygon above.
    let base = if seen.past.is_some() { place } else { seen.ray.base };
    let relief = prepared.field();
    let spot = Spot { relief, base, place, albedo: Vec3::ONE, normal };
    let (finish, clearance) = (material.finish(|map| map.at(place)), Clearance::default());
    Hit { point, clearance, finish, spot }
}

/// What light sees of a place without a texture.
pub(super) fn plain_hit(material: &Material, point: SurfacePoint) -> Hit<'static> {
    let (base, place) = ([0.0; 2], [0.0; 2]);
    let spot = Spot { relief: None, base, place, albedo: Vec3::ONE, normal: Vec3::Z };
    Hit { point, clearance: Clearance::default(), finish: material.plain_finish(), spot }
}

impl PixelLight {
    /// Of a pixel and what it sees.
    pub(super) fn new(
        exact: &ExactLight,
        prepared: &Prepared,
        (seen, hit): (&QuadPixel, &Hit),
        max_anisotropy: f32,
    ) -> Self {
        let reaching = exact.reaching(hit, RAYS);
        let (main, point) = (reaching.main(), &hit.point);
        let cut = main.zip(prepared.field()).and_then(|(main, field)| {
            let to_light = match exact.scene.lights[main] {
                Light::Sun { to_light, .. } => to_light,
                Light::Point { position, .. } => position - point.position,
            };
            let [_, _, normal] = point.axes();
            let frame = TextureFrame { tangents: point.tangents, normal };
            let beam = frame.beam(to_light.normalize_or_zero(), Vec3::ONE)?;
            let displacement = beam.slope.map(|slope| slope * field.relief_depth);
            Some(Cut::of_light(prepared.surface(), seen, displacement, max_anisotropy))
        });
        Self { reaching, main, cut }
    }
}
