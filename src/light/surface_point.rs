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
    /// The axes of the texture's frame in the world, see [`unit_axes`], on the side that is seen.
    pub(crate) fn axes(&self) -> [Vec3; 3] {
        let normal = self.normal.normalize_or(Vec3::Z);
        unit_axes(self.tangents, if self.is_back { -normal } else { normal })
    }

    /// A normal of the texture's frame in the world.
    pub(crate) fn in_world(&self, [x, y, z]: [f32; 3]) -> Vec3 {
        let [u, v, normal] = self.axes();
        (u * x + v * y + normal * z).normalize_or(normal)
    }
}

/// The axes that a texture's normals are held against: along u, across it on the side of v, and the
/// unit normal.
///
/// They stand at right angles even where u and v do not, as in glTF 2.0: only then are cosines
/// between directions of the frame those of the world. Without a texture any axes do.
pub fn unit_axes([u, v]: [Vec3; 2], normal: Vec3) -> [Vec3; 3] {
    // Take off what interpolated tangents have along the normal.
    let u = (u - normal * u.dot(normal)).try_normalize();
    let u = u.unwrap_or_else(|| normal.any_orthonormal_vector());
    let across = normal.cross(u);
    [u, if across.dot(v) < 0.0 { -across } else { across }, normal]
}
