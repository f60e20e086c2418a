//! What of the sky gets past the meshes of a scene, at the vertices of curved ones.
//!
//! How much of the sky a mesh sees changes slowly over it. So rays are sent from few places alone,
//! once and when a pixel first asks for them, and a pixel blends those around it: the vertices, and in
//! a large triangle those of a lattice. What they find is kept as the nearest sky that is linear in the direction (see
//! [`LinearSky`]), which the relief's own occlusion is then multiplied with.

use crate::light::exact::Occluders;
use crate::light::{LinearSky, shares};
use crate::raster::QuadPair;
use crate::scene::{Mesh, Scene};
use glam::Vec3;
use std::sync::OnceLock;

/// What gets to both sides of curved meshes.
#[derive(Debug, Default)]
pub(crate) struct Skies {
    /// Nothing for a mesh that is not curved.
    of_mesh: Vec<OfMesh>,
}

/// Skies of a mesh, in the world's axes.
#[derive(Debug, Default)]
struct OfMesh {
    at_vertices: Vec<Sides>,
    /// From where each vertex is looked at: three times the first small triangle that it is a corner of,
    /// and which one.
    seen_from: Vec<u32>,
    /// Of each triangle that is large, the places along a side and where its lattice begins; 1 for
    /// those that are not.
    lattices: Vec<(u32, u32)>,
    on_lattices: Vec<Sides>,
}

/// The skies of the front and of the back, each found when it is first asked for.
type Sides = [OnceLock<LinearSky>; 2];

/// What hides the sky from a mesh.
#[derive(Clone, Copy)]
struct Surroundings<'a> {
    scene: &'a Scene,
    occluders: &'a Occluders,
    mesh: &'a Mesh,
}

/// Places on a mesh lie at most so far apart, as a share of its box's diagonal.
const SPACING: f32 = 1.0 / 40.0;

/// Most parts of a triangle's side.
const MOST_PARTS: f32 = 32.0;

/// How far places are moved from a triangle's corner to its middle: a corner may lie in what the
/// mesh stands on.
const INWARD: f32 = 0.02;

impl Skies {
    /// Of the meshes that `is_curved` tells by their indices.
    pub(crate) fn new(scene: &Scene, is_curved: impl Fn(usize) -> bool) -> Self {
        let of_mesh = scene
            .meshes
            .iter()
            .enumerate()
            .map(|(i, mesh)| if is_curved(i) { OfMesh::new(mesh) } else { OfMesh::default() });
        Self { of_mesh: of_mesh.collect() }
    }

    /// At the pixels of a pair; anything where none is covered. `None` where the mesh is not curved.
    pub(super) fn of_pair(
        &self,
        (scene, occluders): (&Scene, &Occluders),
        pair: &QuadPair,
    ) -> Option<[LinearSky; 8]> {
        let mut skies = [LinearSky::default(); 8];
        let lit = pair.lit()?;
        let is_back = lit.is_back.to_bitmask();
        for lane in pair.covered() {
            let [mesh, triangle] = pair.planes[lane / 4].triangle.map(|i| i as usize);
            let place = Vec3::from(lit.position.map(|axis| axis.as_array()[lane]));
            let side = usize::from(is_back >> lane & 1 == 1);
            let around = Surroundings { scene, occluders, mesh: &scene.meshes[mesh] };
            skies[lane] = self.of_mesh[mesh].at(around, (triangle, side), place)?;
        }
        Some(skies)
    }
}

impl OfMesh {
    fn new(mesh: &Mesh) -> Self {
        let (min, max) = mesh
            .positions
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |b, p| (b.0.min(*p), b.1.max(*p)));
        let spacing = (max - min).length() * SPACING;
        let mut seen_from = vec![u32::MAX; mesh.positions.len()];
        let mut num_places = 0;
        let lattices = mesh.triangles.iter().zip(0_u32..).map(|(triangle, index)| {
            let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
            let longest = (a - b).length().max((b - c).length()).max((c - a).length());
            let parts = (longest / spacing).ceil().clamp(1.0, MOST_PARTS) as u32;
            let first = num_places;
            if parts > 1 {
                num_places += (parts + 1) * (parts + 2) / 2;
            } else {
                // From a small triangle: in a large one the vertex is a place of its lattice.
                for (vertex, turn) in triangle.iter().zip(0..) {
                    let from = &mut seen_from[*vertex as usize];
                    *from = (*from).min(3 * index + turn);
                }
            }
            (parts, first)
        });
        let lattices = lattices.collect();
        let sides = |num: usize| (0..num).map(|_| Sides::default()).collect();
        Self {
            at_vertices: sides(mesh.positions.len()),
            seen_from,
            lattices,
            on_lattices: sides(num_places as usize),
        }
    }

    /// At a place on a side of a triangle.
    fn at(
        &self,
        around: Surroundings,
        (triangle, side): (usize, usize),
        place: Vec3,
    ) -> Option<LinearSky> {
        let &(parts, first) = self.lattices.get(triangle)?;
        let corners = around.mesh.triangles[triangle].map(|i| i as usize);
        let shares = shares(corners.map(|i| around.mesh.positions[i]), place);
        if parts == 1 {
            let of = corners.into_iter().zip(shares);
            let of = of.map(|(i, share)| (self.at_vertex(around, i, side), share));
            return Some(LinearSky::blend(of));
        }
        // Find the small triangle of the lattice: from the first corner rows of `parts - i + 1` places.
        let [x, y] = [shares[1], shares[2]].map(|share| share * parts as f32);
        let [i, j] = [x, y].map(|c| (c as u32).min(parts - 1));
        let [fx, fy] = [x - i as f32, y - j as f32];
        let at = |i: u32, j: u32| {
            let i = i.min(parts);
            let j = j.min(parts - i);
            let index = first + i * (parts + 1) - i * (i.max(1) - 1) / 2 + j;
            let shares = [parts - i - j, i, j].map(|n| n as f32 / parts as f32);
            *self.on_lattices[index as usize][side]
                .get_or_init(|| sky_at(around, (corners, shares), side))
        };
        let of = if fx + fy <= 1.0 {
            [(at(i, j), 1.0 - fx - fy), (at(i + 1, j), fx), (at(i, j + 1), fy)]
        } else {
            [(at(i + 1, j + 1), fx + fy - 1.0), (at(i, j + 1), 1.0 - fx), (at(i + 1, j), 1.0 - fy)]
        };
        Some(LinearSky::blend(of.into_iter()))
    }

    /// At a vertex of a small triangle.
    fn at_vertex(&self, around: Surroundings, vertex: usize, side: usize) -> LinearSky {
        *self.at_vertices[vertex][side].get_or_init(|| {
            let [triangle, turn] = [self.seen_from[vertex] / 3, self.seen_from[vertex] % 3];
            let corners = around.mesh.triangles[triangle as usize];
            let corners = [0, 1, 2].map(|i| corners[(i + turn as usize) % 3] as usize);
            sky_at(around, (corners, [1.0, 0.0, 0.0]), side)
        })
    }
}

/// A triangle's corners, by their indices, and their shares in a place on it.
type Place = ([usize; 3], [f32; 3]);

/// What the sky sends to a side of a place past all meshes.
fn sky_at(around: Surroundings, (corners, shares): Place, side: usize) -> LinearSky {
    let Surroundings { scene, occluders, mesh } = around;
    let inward = shares.map(|share| share * (1.0 - INWARD) + INWARD / 3.0);
    let blend = |of: &dyn Fn(usize) -> Vec3, shares: &[f32; 3]| {
        corners.iter().zip(shares).fold(Vec3::ZERO, |sum, (i, share)| sum + of(*i) * *share)
    };
    let position = blend(&|i| mesh.positions[i], &inward);
    let front = blend(&|i| mesh.normals[i].normalize_or_zero(), &shares).normalize_or(Vec3::Z);
    let surface = scene.materials[mesh.material].surface.as_ref();
    let down = match (mesh.tangents.get(corners[0]), surface) {
        (Some([u, v]), Some(surface)) => u.cross(*v).length().sqrt() * surface.relief_depth(),
        _ => 0.0,
    };
    let is_turned = side == 1;
    let normal = if is_turned { -front } else { front };
    // From half way down the relief: what it hides itself is told apart.
    let from = position - normal * (0.5 * down);
    LinearSky::new(normal, |direction| {
        let color = scene.sky.radiance(direction);
        let is_hidden = || occluders.hide_sky(from, direction, (down, is_turned));
        if color == Vec3::ZERO || is_hidden() { Vec3::ZERO } else { color }
    })
}
