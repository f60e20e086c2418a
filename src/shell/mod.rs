//! The relief of a mesh in the world: what lies between its polygons and its deepest relief.
//!
//! Each vertex has an *offset*, from the polygon down to where relief of depth 1 is: along its
//! normal, as long as the relief is deep there, `O = -S W N`. Over a triangle it is linear, as
//! positions are. So each triangle stands on a prism, and neighbours share their sides: a point at
//! depth `t` with the shares `b` of the corners is at `sum b_i (P_i + t O_i)`, and its texture
//! coordinates are `sum b_i uv_i`.
//!
//! ```text
//!   eye o
//!        \  P0_______P1_____P2       polygons
//!         \ /\   |  /|      |\
//!          X  \  | / |      | \     a view ray goes from prism to prism: down while it sees
//!         / \  \ |/  |      |  \    triangles from the front, up where it sees them from behind.
//!            ---Q0---Q1-----Q2      It hits relief or leaves through a polygon: past the outline
//! ```

mod curvature;
mod follow;
mod neighbors;

pub use follow::{Met, ReliefHit, ViewRay};

use crate::scene::Mesh;
use glam::Vec3;

/// What is known of a mesh with relief before a ray comes.
#[derive(Clone, Debug)]
pub struct Shell {
    /// From each vertex down to the deepest relief, in world units.
    offsets: Vec<Vec3>,
    /// Across each of a triangle's edges, `[i, i + 1]` for edge `i`, the triangle times three plus
    /// its edge; or [`NONE`].
    neighbors: Vec<[u32; 3]>,
    /// Of each triangle, seen from the front and from behind: the square of the cosine between
    /// normal and ray below which a ray may pass the relief.
    limits: Vec<[f32; 2]>,
    is_curved: bool,
}

/// No neighbour: the border of the mesh, or a crease.
const NONE: u32 = u32::MAX;

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
    pub fn may_be_passed(&self, mesh: &Mesh, triangle: u32, eye: Vec3) -> bool {
        let limits = self.limits[triangle as usize];
        if limits == [0.0; 2] {
            return false;
        }
        let cosines = mesh.triangles[triangle as usize].map(|i| {
            let to_eye = (eye - mesh.positions[i as usize]).normalize_or_zero();
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
    pub fn deepest(&self, mesh: &Mesh, triangle: u32, eye: Vec3) -> [Vec3; 3] {
        let corners = mesh.triangles[triangle as usize].map(|i| i as usize);
        let side = if is_seen_from_behind(mesh, triangle, eye) { -1.0 } else { 1.0 };
        corners.map(|i| mesh.positions[i] + self.offsets[i] * side)
    }
}

/// Whether a triangle of a mesh is seen from behind.
pub fn is_seen_from_behind(mesh: &Mesh, triangle: u32, eye: Vec3) -> bool {
    let [a, b, c] =
        mesh.triangles[triangle as usize].map(|i| mesh.positions[i as usize].as_dvec3());
    (b - a).cross(c - a).dot(eye.as_dvec3() - a) < 0.0
}
