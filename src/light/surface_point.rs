//! Where a surface is in the world, and how it lies.

use crate::scene::Eye;
use glam::Vec3;

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

impl SurfacePoint {
    /// The unit axes of the texture's frame in the world: along u, along v, and off the surface on
    /// the eye's side. u and v may be oblique.
    pub(crate) fn axes(&self, eye: Eye) -> [Vec3; 3] {
        let normal = self.normal.normalize_or(Vec3::Z);
        let normal = if normal.dot(eye.seen_from(self.position)) < 0.0 { -normal } else { normal };
        unit_axes(self.tangents, normal)
    }
}

/// Axes of unit length along u, along v and a unit normal.
pub fn unit_axes(tangents: [Vec3; 2], normal: Vec3) -> [Vec3; 3] {
    // Take off what interpolated tangents have along the normal.
    let [u, v] = tangents.map(|t| (t - normal * t.dot(normal)).normalize_or_zero());
    [u, v, normal]
}
