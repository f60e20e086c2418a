//! What is known of a mesh with relief before a ray comes.

use super::curvature::{self, Limits};
use super::neighbors;
use crate::scene::{Eye, Mesh};
use glam::Vec3;

/// How much offsets at the corners of a triangle may differ for a piece to be straight, as a share
/// of their length: a sixteenth of a prism's side.
const STRAIGHT: f64 = 1.0 / 16.0;

/// Most pieces of a prism.
const MOST_PIECES: f64 = 16.0;

/// The prisms of a mesh's relief.
#[derive(Clone, Debug)]
pub struct Shell {
    /// From each vertex down to the deepest relief, in world units.
    pub(super) offsets: Vec<Vec3>,
    /// Across each of a triangle's edges, `[i, i + 1]` for edge `i`, the triangle times three plus
    /// its edge; or [`NONE`](neighbors::NONE).
    pub(super) neighbors: Vec<[u32; 3]>,
    /// Of each triangle, where rays through it may pass the relief.
    pub(super) limits: Vec<Limits>,
    /// Of each triangle, how many pieces a ray within its prism is cut into.
    pub(super) num_pieces: Vec<u8>,
    is_curved: bool,
}

/// Where a triangle is seen flat enough for a ray to pass its relief.
#[derive(Clone, Copy, Debug)]
pub struct Passable {
    /// At the corners, the normal on the side that is seen times the way to the eye.
    pub facing: [f32; 3],
    /// The cosine between both below which rays may pass.
    pub cosine: f32,
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
        let is_curved = limits.iter().any(|limits| limits.squares != [0.0; 2]);
        let num_pieces = mesh.triangles.iter().map(|triangle| num_pieces(&offsets, triangle));
        let num_pieces = num_pieces.collect();
        Self { offsets, neighbors, limits, num_pieces, is_curved }
    }

    /// Whether rays may pass any of its relief.
    pub fn is_curved(&self) -> bool {
        self.is_curved
    }

    /// Where rays from the eye through a triangle may pass its relief, if they may anywhere.
    pub fn passable(&self, mesh: &Mesh, triangle: u32, eye: Eye) -> Option<Passable> {
        let limits = self.limits[triangle as usize].squares;
        if limits == [0.0; 2] {
            return None;
        }
        let is_back = is_seen_from_behind(mesh, triangle, eye);
        let (side, limit) = if is_back { (-1.0, limits[1]) } else { (1.0, limits[0]) };
        let mut least = f32::MAX;
        let facing = mesh.triangles[triangle as usize].map(|i| {
            let to_eye = eye.seen_from(mesh.positions[i as usize]);
            let facing = to_eye.dot(mesh.normals[i as usize]) * side;
            least = least.min(facing / to_eye.length());
            facing
        });
        let may_be_passed = least <= 0.0 || least * least < limit;
        may_be_passed.then(|| Passable { facing, cosine: limit.sqrt() })
    }

    /// The square of the cosine between normal and ray below which a ray that sees the front of a triangle
    /// may pass the relief there; 0 where none does.
    pub(super) fn front_limit(&self, triangle: u32) -> f32 {
        self.limits[triangle as usize].squares[0]
    }

    /// How deep the relief is below a triangle, at most, in the world.
    pub(super) fn depth(&self, mesh: &Mesh, triangle: u32) -> f32 {
        let lengths = mesh.triangles[triangle as usize].map(|i| self.offsets[i as usize].length());
        lengths[0].max(lengths[1]).max(lengths[2])
    }

    /// What a distance in the world is, at a vertex, as a depth and in repeats along u and v.
    pub(super) fn around(&self, mesh: &Mesh, vertex: usize, distance: f64) -> (f64, [f64; 2]) {
        let [u, v] = mesh.tangents[vertex].map(|tangent| tangent.as_dvec3());
        let area = u.cross(v).length();
        let depth = distance / self.offsets[vertex].as_dvec3().length();
        (depth, [v, u].map(|other| distance * other.length() / area))
    }

    /// Where the corners of a triangle have their deepest relief, as it is seen from the eye.
    pub fn deepest(&self, mesh: &Mesh, triangle: u32, eye: Eye) -> [Vec3; 3] {
        let corners = mesh.triangles[triangle as usize].map(|i| i as usize);
        let side = if is_seen_from_behind(mesh, triangle, eye) { -1.0 } else { 1.0 };
        corners.map(|i| mesh.positions[i] + self.offsets[i] * side)
    }
}

/// How many pieces of a ray are straight in the texture within the prism of a triangle.
fn num_pieces(offsets: &[Vec3], triangle: &[u32; 3]) -> u8 {
    let [a, b, c] = triangle.map(|i| offsets[i as usize].as_dvec3());
    let bend = (b - a).length_squared().max((c - a).length_squared());
    let bend = (bend / a.length_squared().max(f64::MIN_POSITIVE)).sqrt();
    (bend / STRAIGHT).ceil().clamp(1.0, MOST_PIECES) as u8
}

/// Whether a triangle of a mesh is seen from behind.
pub fn is_seen_from_behind(mesh: &Mesh, triangle: u32, eye: Eye) -> bool {
    let [a, b, c] =
        mesh.triangles[triangle as usize].map(|i| mesh.positions[i as usize].as_dvec3());
    (b - a).cross(c - a).dot(eye.seen_from_exact(a)) < 0.0
}
