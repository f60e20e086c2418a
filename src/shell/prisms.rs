//! What is known of a mesh with relief before a ray comes.

use super::{curvature, neighbors};
use crate::scene::{Eye, Mesh};
use glam::Vec3;

/// The prisms of a mesh's relief.
#[derive(Clone, Debug)]
pub struct Shell {
    /// From each vertex down to the deepest relief, in world units.
    pub(super) offsets: Vec<Vec3>,
    /// Across each of a triangle's edges, `[i, i + 1]` for edge `i`, the triangle times three plus
    /// its edge; or [`NONE`](neighbors::NONE).
    pub(super) neighbors: Vec<[u32; 3]>,
    /// Of each triangle, seen from the front and from behind: the square of the cosine between
    /// normal and ray below which a ray may pass the relief.
    limits: Vec<[f32; 2]>,
    is_curved: bool,
}

impl Shell {
    /// Of a mesh with texture coordinates and a relief of some depth in repeats.
    pub fn new(mesh: &Mesh, relief_depth: f32) -> Self {
        let offset = |(normal, [u, v]): (&Vec3, &[Vec3; 2])| {
            let down = *normal * -(u.cross(*v).length().sqrt() * relief_depth);
            // Squares of huge tangents overflow; such a mesh has no relief to speak of.
            if down.is_finite() { down } else { Vec3::ZERO }
        };
        let offsets: Vec<_> = mesh.normals.iter().zip(&mesh.tangents).map(offset).collect();
        let neighbors = neighbors::find(mesh);
        let limits = curvature::limits(mesh, &offsets, &neighbors);
        let is_curved = limits.iter().flatten().any(|limit| *limit > 0.0);
        Self { offsets, neighbors, limits, is_curved }
    }

    /// Whether rays may pass any of its relief.
    pub fn is_curved(&self) -> bool {
        self.is_curved
    }

    /// Whether a ray from the eye through a triangle may pass its relief.
    pub fn may_be_passed(&self, mesh: &Mesh, triangle: u32, eye: Eye) -> bool {
        let limits = self.limits[triangle as usize];
        if limits == [0.0; 2] {
            return false;
        }
        let cosines = mesh.triangles[triangle as usize].map(|i| {
            let to_eye = eye.seen_from(mesh.positions[i as usize]).normalize_or_zero();
            to_eye.dot(mesh.normals[i as usize])
        });
        let [least, most] =
            cosines.iter().fold([f32::MAX, f32::MIN], |[a, b], c| [a.min(*c), b.max(*c)]);
        if least > 0.0 {
            least * least < limits[0]
        } else if most < 0.0 {
            most * most < limits[1]
        } else {
            true
        }
    }

    /// Where the corners of a triangle have their deepest relief, as it is seen from the eye.
    pub fn deepest(&self, mesh: &Mesh, triangle: u32, eye: Eye) -> [Vec3; 3] {
        let corners = mesh.triangles[triangle as usize].map(|i| i as usize);
        let side = if is_seen_from_behind(mesh, triangle, eye) { -1.0 } else { 1.0 };
        corners.map(|i| mesh.positions[i] + self.offsets[i] * side)
    }
}

/// Whether a triangle of a mesh is seen from behind.
pub fn is_seen_from_behind(mesh: &Mesh, triangle: u32, eye: Eye) -> bool {
    let [a, b, c] =
        mesh.triangles[triangle as usize].map(|i| mesh.positions[i as usize].as_dvec3());
    (b - a).cross(c - a).dot(eye.seen_from_exact(a)) < 0.0
}
