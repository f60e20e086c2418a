//! The light of a hit by rays: to each light, and to the sky.

use super::occluders::{LightRay, Occluders};
use super::sequence::Sequence;
use crate::light::reflection::{self, Fresnel, LEAST_COSINE};
use crate::light::surface_point::SurfacePoint;
use crate::relief::{Climb, HeightField};
use crate::scene::angle::cos_sin;
use crate::scene::{Finish, Light, Scene};
use crate::shell::Outlined;
use glam::{DMat3, DVec3, Vec3};

/// What rounding takes from a position, as a share of its numbers: they went through f32 planes.
const ROUNDING: f64 = 1e-5;

/// Lights a scene's surfaces by rays.
#[derive(Clone, Copy, Debug)]
pub struct ExactLight<'a> {
    /// What is lit, with its lights, sky and eye.
    pub scene: &'a Scene,
    /// The same scene's triangles.
    pub occluders: &'a Occluders,
    /// Its meshes that throw the shadow of their relief; those of all others, and of all where this is
    /// `None`, are those of their polygons.
    pub outlined: Option<&'a Outlined<'a>>,
}

/// What a view ray met.
#[derive(Clone, Copy, Debug)]
pub struct Hit<'a> {
    /// The polygon where the ray passed it.
    pub point: SurfacePoint,
    /// Where light leaves it from, without relief.
    pub clearance: Clearance,
    /// What it does with light.
    pub finish: Finish,
    /// Where it is on the texture, and what is there.
    pub spot: Spot<'a>,
}

/// How light gets clear of polygons that stand for a smooth surface.
#[derive(Clone, Copy, Debug, Default)]
pub struct Clearance {
    /// From the polygon to where light meets the surface.
    pub lift: Vec3,
    /// How far a place may lie below a polygon that belongs to it: a pixel's places are in the plane of
    /// the polygon that its centre sees, which neighbours rise above.
    pub reach: f32,
}

/// A place on a texture.
#[derive(Clone, Copy, Debug)]
pub struct Spot<'a> {
    /// Its relief, if it has any.
    pub relief: Option<&'a HeightField>,
    /// Where the ray passed the polygon and where it met the relief, in repeats of the texture.
    pub base: [f32; 2],
    /// See `base`.
    pub place: [f32; 2],
    /// The base colour there.
    pub albedo: Vec3,
    /// The normal there in the frame of the texture, of any length.
    pub normal: Vec3,
}

/// A hit as light sees it, in the world.
pub(super) struct Ground<'a> {
    exact: ExactLight<'a>,
    position: DVec3,
    pub(super) normal: DVec3,
    to_eye: DVec3,
    /// The polygon's normal on the eye's side.
    pub(super) side: DVec3,
    reach: f64,
    is_turned: bool,
    relief: Option<(&'a HeightField, [f32; 2])>,
    /// The world's directions in the texture's frame, in repeats; up in world lengths of one.
    texture_from_world: DMat3,
}

impl ExactLight<'_> {
    /// The light that a hit sends to the eye, in linear RGB, by sample `i` of its pixel.
    pub fn shade(&self, hit: &Hit, sequence: &Sequence, i: u32) -> Vec3 {
        let ground = Ground::new(*self, hit);
        let [mirror, other] = sequence.points(i);
        let (finish, to_eye) = (&hit.finish, ground.to_eye);
        let alpha = reflection::alpha(finish.roughness);
        let fresnel = Fresnel::new(finish, hit.spot.albedo);
        // Draw what is reflected to the eye.
        let frame = frame_around(ground.normal);
        let local_eye = frame.transpose() * to_eye;
        let (reflected, v_h, shown) = reflection::reflected(f64::from(alpha), local_eye, mirror);
        let shown = shown as f32;
        let mut sum = finish.emissive;
        if shown > 0.0 {
            let sky = ground.sky(frame * reflected) * finish.occlusion;
            sum += fresnel.at(v_h as f32) * shown * sky;
        }
        let kept = 1.0 - Fresnel::of_dielectric(finish).at(v_h as f32).x * shown;
        let diffuse = hit.spot.albedo * (kept * (1.0 - finish.metallic));
        // One direction of the sky around the normal, as dense as its cosine.
        sum += diffuse * ground.sky(frame * cosine_direction(other)) * finish.occlusion;
        for light in &self.scene.lights {
            let (to_light, distance, intensity) = ground.towards(light, other);
            let n_l = to_light.dot(ground.normal) as f32;
            if n_l <= 0.0 || intensity == Vec3::ZERO || !ground.sees(to_light, distance) {
                continue;
            }
            let half = (to_light + to_eye).normalize_or_zero();
            let [n_v, n_h, v_h] =
                [to_eye.dot(ground.normal), half.dot(ground.normal), half.dot(to_eye)]
                    .map(|c| c as f32);
            let lobe = reflection::lobe(alpha * alpha, n_v, n_l, n_h);
            sum += intensity * (diffuse * n_l + fresnel.at(v_h) * lobe);
        }
        sum
    }
}

impl<'a> Ground<'a> {
    pub(super) fn new(exact: ExactLight<'a>, hit: &Hit<'a>) -> Self {
        let SurfacePoint { position, tangents, is_back, .. } = hit.point;
        let (camera, eye) = (&exact.scene.camera, exact.scene.camera.viewpoint());
        let [u, v, n] = hit.point.axes().map(|axis| axis.as_dvec3());
        let local = hit.spot.normal.as_dvec3();
        let position = position.as_dvec3() + hit.clearance.lift.as_dvec3();
        let far = position.abs().max_element() + (position - camera.eye.as_dvec3()).length();
        let mut ground = Self {
            exact,
            position,
            normal: (u * local.x + v * local.y + n * local.z).normalize_or(n),
            to_eye: DVec3::ZERO,
            side: n,
            reach: far * ROUNDING + f64::from(hit.clearance.reach),
            is_turned: is_back,
            relief: None,
            texture_from_world: DMat3::ZERO,
        };
        let [du, dv] = tangents.map(|tangent| tangent.as_dvec3());
        // The world length of a repeat: relief is as deep in it as in the texture.
        let repeat = du.cross(dv).length().sqrt();
        let world_from_texture = DMat3::from_cols(du, dv, n * repeat);
        let is_frame =
            world_from_texture.determinant().abs() > 1e-6 * du.length() * dv.length() * repeat;
        if let Some(field) = hit.spot.relief.filter(|_| is_frame) {
            ground.texture_from_world = world_from_texture.inverse();
            ground.relief = Some((field, hit.spot.place));
            let depth = 1.0 - {
                let [u, v] = [0, 1].map(|i| hit.spot.place[i] * field.texels_per_repeat[i]);
                field.height_at(f64::from(u), f64::from(v))
            };
            let down = f64::from(field.relief_depth);
            let moved = [0, 1].map(|i| f64::from(hit.spot.place[i] - hit.spot.base[i]));
            ground.position += world_from_texture * DVec3::new(moved[0], moved[1], -depth * down);
            // Twice the depth, since a neighbour that turns towards the light rises a little.
            ground.reach += 2.0 * down * repeat;
        }
        ground.to_eye = above(eye.seen_from_exact(ground.position).normalize_or(n), ground.normal);
        ground
    }

    /// What comes from the sky along a unit direction.
    fn sky(&self, direction: DVec3) -> Vec3 {
        let color = self.exact.scene.sky.radiance(direction.as_vec3());
        let is_seen = color != Vec3::ZERO && self.sees(direction, f64::INFINITY);
        if is_seen { color } else { Vec3::ZERO }
    }

    /// Whether nothing lies between the hit and a light, or the sky, at a distance.
    pub(super) fn sees(&self, direction: DVec3, distance: f64) -> bool {
        if direction.dot(self.side) <= 0.0 {
            return false;
        }
        if let Some((field, place)) = self.relief {
            let local = self.texture_from_world * direction;
            let Some(climb) = Climb::new(field, place, local.to_array()) else { return false };
            let most = distance * local.z / f64::from(field.relief_depth);
            if !climb.is_free(field, most) {
                return false;
            }
        }
        let (from, reach, is_turned) = (self.position, self.reach, self.is_turned);
        let ray = LightRay { from, direction, distance, reach, is_turned };
        !self.exact.occluders.hide(&ray, self.exact.outlined)
    }

    /// The direction to a point of a light, how far it is, and its intensity here.
    pub(super) fn towards(&self, light: &Light, point: [f64; 2]) -> (DVec3, f64, Vec3) {
        match *light {
            Light::Sun { to_light, intensity, angular_size } => {
                let middle = to_light.as_dvec3().normalize_or(DVec3::Y);
                let [cos, sin] = cos_sin(f64::from(angular_size) / 720.0);
                let radius = sin / cos * point[0].sqrt();
                let [x, y] = cos_sin(point[1]);
                let across = frame_around(middle) * DVec3::new(radius * x, radius * y, 1.0);
                (across.normalize(), f64::INFINITY, intensity)
            }
            Light::Point { position, intensity } => {
                let way = position.as_dvec3() - self.position;
                let squared = way.length_squared().max(1e-12);
                let direction = way.normalize_or(self.side);
                (direction, squared.sqrt(), intensity / squared as f32)
            }
        }
    }
}

/// A direction around z, as dense as its cosine to it.
pub(super) fn cosine_direction([x, y]: [f64; 2]) -> DVec3 {
    let radius = x.sqrt();
    let [cos, sin] = cos_sin(y);
    DVec3::new(radius * cos, radius * sin, (1.0 - x).sqrt())
}

/// Unit axes whose last one is `z`, a unit vector.
pub(super) fn frame_around(z: DVec3) -> DMat3 {
    let (x, y) = z.any_orthonormal_pair();
    DMat3::from_cols(x, y, z)
}

/// A direction to the eye, turned up to where a seen surface can lie: interpolated normals may face
/// away.
fn above(to_eye: DVec3, normal: DVec3) -> DVec3 {
    let lacks = f64::from(LEAST_COSINE) - to_eye.dot(normal);
    if lacks > 0.0 { (to_eye + normal * lacks).normalize() } else { to_eye }
}
