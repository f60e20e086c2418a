//! Where a surface is in the world, and how it lies.

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
    /// Whether its polygon is seen from behind. At an outline smooth normals turn away from the eye
    /// where the polygon does not.
    pub is_back: bool,
}

impl SurfacePoint {
    /// The unit axes of the texture's frame in the world: along u, along v, and off the surface on
    /// the side that is seen. u and v may be oblique.
    pub(crate) fn axes(&self) -> [Vec3; 3] {
        let normal = self.normal.normalize_or(Vec3::Z);
        unit_axes(self.tangents, if self.is_back { -normal } else { normal })
    }
}

/// Axes of unit length along u, along v and a unit normal.
pub fn unit_axes(tangents: [Vec3; 2], normal: Vec3) -> [Vec3; 3] {
    // Take off what interpolated tangents have along the normal.
    let [u, v] = tangents.map(|t| (t - normal * t.dot(normal)).normalize_or_zero());
    [u, v, normal]
}
