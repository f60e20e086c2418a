//! Light from far away as beams: directions in the frame of a flat piece's texture.
//!
//! A sun is a disc, the sky a half space; each is as many directions as its shadows need.

use super::disc::{Disc, spiral};
use super::surface_point::unit_axes;
use crate::relief::MAX_SLOPE;
use crate::scene::{Light, Sky};
use glam::Vec3;

/// Directions that the sky is seen in, over the half space above a polygon: each stands for the
/// same share of what lights it.
const SKY_DIRECTIONS: usize = 128;

/// Points of a sun's disc for each half degree of its size, and the most of them. A shadow of the
/// real sun goes in so many steps from light to dark, each of which is as wide as what cuts it off
/// at the texels.
const SUN_POINTS: [f32; 2] = [16.0, 64.0];

/// The frame of a texture on a flat piece of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureFrame {
    /// dP/du and dP/dv, in world units a repeat.
    pub tangents: [Vec3; 2],
    /// Unit normal on the side that is seen.
    pub normal: Vec3,
}

/// Light from one direction, as a texture sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// Unit direction to the light: along u, along v, off the surface.
    pub to_light: Vec3,
    /// Repeats that light moves along the texture for each repeat that it goes down.
    pub slope: [f32; 2],
    /// Linear RGB; a white texel that faces 1 is white.
    pub intensity: Vec3,
}

impl TextureFrame {
    /// A direction as the axes see it, u and v of unit length: what normals are held against.
    pub(super) fn local(&self, direction: Vec3) -> Vec3 {
        Vec3::from(unit_axes(self.tangents, self.normal).map(|axis| axis.dot(direction)))
    }

    /// The direction that the axes see so.
    pub(super) fn world(&self, local: Vec3) -> Vec3 {
        let [x, y, z] = unit_axes(self.tangents, self.normal);
        x * local.x + y * local.y + z * local.z
    }

    /// Light from a unit direction; `None` from behind the surface.
    pub fn beam(&self, to_light: Vec3, intensity: Vec3) -> Option<Beam> {
        let [u, v] = self.tangents;
        // Cramer's rule, as for views: to_light = alpha U + beta V + up s N.
        let across = u.cross(v);
        let volume = self.normal.dot(across);
        let up = across.dot(to_light) / (across.length().sqrt() * volume);
        let local = self.local(to_light);
        if local.z <= 0.0 || intensity == Vec3::ZERO {
            return None;
        }
        let along = [v.cross(self.normal), self.normal.cross(u)].map(|w| w.dot(to_light) / volume);
        let slope = along.map(|along| -along / up.abs());
        let steepness = (slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
        // As views are, so that no walk is longer than what they walk.
        let scale = if steepness > MAX_SLOPE { MAX_SLOPE / steepness } else { 1.0 };
        let slope = slope.map(|slope| slope * scale);
        let is_finite = slope.iter().all(|slope| slope.is_finite());
        Some(Beam { to_light: local, slope: if is_finite { slope } else { [0.0; 2] }, intensity })
    }

    /// Beams from points spread evenly over a sun's disc; none of a point, which comes from another
    /// direction at each place.
    pub fn sun(&self, light: &Light) -> Vec<Beam> {
        let Light::Sun { to_light, intensity, angular_size } = *light else { return Vec::new() };
        let [per_half, most] = SUN_POINTS;
        let num = (angular_size * 2.0 * per_half).ceil().clamp(1.0, most) as usize;
        let points = Disc::new(to_light.normalize_or_zero(), angular_size).points(num);
        points.filter_map(|to_light| self.beam(to_light, intensity / num as f32)).collect()
    }

    /// Beams from all over the sky.
    pub fn sky(&self, sky: &Sky) -> Vec<Beam> {
        let beams =
            self.half_space().map(|(to_light, share)| (to_light, sky.radiance(to_light) * share));
        beams.filter_map(|(to_light, intensity)| self.beam(to_light, intensity)).collect()
    }

    /// Directions all over the half space above the surface, as dense as their cosine to it, each with
    /// the part of that space that it stands for, over pi: one that is `cos` off the normal stands for
    /// `1 / cos` of what a texel sees that faces it. They come in pairs that lie opposite each other, so
    /// that what a slope gains by one it loses by the other.
    pub(super) fn half_space(&self) -> impl Iterator<Item = (Vec3, f32)> {
        let [x, y] = <[Vec3; 2]>::from(self.normal.any_orthonormal_pair());
        spiral(SKY_DIRECTIONS / 2).flat_map(move |(turn, share)| {
            let ([cos, sin], share) = (turn.map(|c| c as f32), share as f32);
            let up = (1.0 - share).sqrt();
            [[cos, sin], [-cos, -sin]].map(|[cos, sin]| {
                let direction = (x * cos + y * sin) * share.sqrt() + self.normal * up;
                (direction, 1.0 / (SKY_DIRECTIONS as f32 * up))
            })
        })
    }
}
