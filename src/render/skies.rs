//! What of the sky gets past the meshes of a scene, at the vertices of curved ones.
//!
//! How much of the sky a mesh sees changes slowly over it. So rays are sent from few places alone,
//! once, and a pixel blends those around it: the vertices, and in a large triangle those of a
//! lattice. What they find is kept as the nearest sky that is linear in the direction (see
//! [`LinearSky`]), which the relief's own occlusion is then multiplied with.

use crate::light::exact::Occluders;
use crate::light::{FrameLanes, LinearSky};
use crate::raster::QuadPair;
use crate::scene::{Mesh, Scene};
use glam::Vec3;
use rayon::prelude::*;

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
    /// Of each triangle that is large, the places along a side and where its lattice begins; 1 for
    /// those that are not.
    lattices: Vec<(u32, u32)>,
    on_lattices: Vec<Sides>,
}

/// The skies of the front and of the back.
type Sides = [LinearSky; 2];

/// Places on a mesh lie at most so far apart, as a share of its box's diagonal.
const SPACING: f32 = 1.0 / 40.0;

/// Most parts of a triangle's side.
const MOST_PARTS: f32 = 32.0;

/// How far places are moved from a triangle's corner to its middle: a corner may lie in what the
/// mesh stands on.
const INWARD: f32 = 0.02;

impl Skies {
    /// Of the meshes that `is_curved` tells by their indices.
    pub(crate) fn new(
        scene: &Scene,
        occluders: &Occluders,
        is_curved: impl Fn(usize) -> bool,
    ) -> Self {
        let of_mesh = scene.meshes.iter().enumerate().map(|(i, mesh)| {
            if is_curved(i) { OfMesh::new(scene, occluders, mesh) } else { OfMesh::default() }
        });
        Self { of_mesh: of_mesh.collect() }
    }

    /// At the pixels of a pair; anything where none is covered.
    pub(super) fn of_pair(
        &self,
        scene: &Scene,
        pair: &QuadPair,
        frame: &FrameLanes,
    ) -> [LinearSky; 8] {
        let mut skies = [LinearSky::default(); 8];
        let Some(lit) = pair.lit() else { return skies };
        let is_back = frame.is_back.to_bitmask();
        for lane in pair.covered() {
            let [mesh, triangle] = pair.planes[lane / 4].triangle.map(|i| i as usize);
            let place = Vec3::from(lit.position.map(|axis| axis.as_array()[lane]));
            let side = usize::from(is_back >> lane & 1 == 1);
            skies[lane] = self.of_mesh[mesh].at(&scene.meshes[mesh], (triangle, side), place);
        }
        skies
    }
}

impl OfMesh {
    fn new(scene: &Scene, occluders: &Occluders, mesh: &Mesh) -> Self {
        let (min, max) = mesh
            .positions
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |b, p| (b.0.min(*p), b.1.max(*p)));
        let spacing = (max - min).length() * SPACING;
        let mut places = Vec::new();
        let lattices = mesh.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
            let longest = (a - b).length().max((b - c).length()).max((c - a).length());
            let parts = (longest / spacing).ceil().clamp(1.0, MOST_PARTS) as u32;
            let first = places.len() as u32;
            if parts > 1 {
                for i in 0..=parts {
                    for j in 0..=parts - i {
                        let shares = [parts - i - j, i, j].map(|n| n as f32 / parts as f32);
                        places.push((triangle.map(|i| i as usize), shares));
                    }
                }
            }
            (parts, first)
        });
        let lattices: Vec<_> = lattices.collect();
        // A vertex is looked at from a triangle that it is a corner of, if that is a small one.
        let mut corners = vec![None; mesh.positions.len()];
        for (triangle, (parts, _)) in mesh.triangles.iter().zip(&lattices) {
            for turn in 0..3 {
                let turned = [0, 1, 2].map(|i| triangle[(i + turn) % 3] as usize);
                if *parts == 1 {
                    corners[turned[0]].get_or_insert((turned, [1.0, 0.0, 0.0]));
                }
            }
        }
        let at = |place: &Place| sky_at(scene, occluders, mesh, place);
        Self {
            at_vertices: corners
                .par_iter()
                .map(|c| c.as_ref().map_or_else(Default::default, at))
                .collect(),
            lattices,
            on_lattices: places.par_iter().map(at).collect(),
        }
    }

    /// At a place on a triangle.
    fn at(&self, mesh: &Mesh, (triangle, side): (usize, usize), place: Vec3) -> LinearSky {
        let Some(&(parts, first)) = self.lattices.get(triangle) else {
            return LinearSky::default();
        };
        let corners = mesh.triangles[triangle].map(|i| i as usize);
        let shares = shares(corners.map(|i| mesh.positions[i]), place);
        if parts == 1 {
            let of = corners.into_iter().zip(shares);
            return LinearSky::blend(of.map(|(i, share)| (self.at_vertices[i][side], share)));
        }
        // Find the small triangle of the lattice: from the first corner rows of `parts - i + 1` places.
        let [x, y] = [shares[1], shares[2]].map(|share| share * parts as f32);
        let [i, j] = [x, y].map(|c| (c as u32).min(parts - 1));
        let [fx, fy] = [x - i as f32, y - j as f32];
        let at = |i: u32, j: u32| {
            let i = i.min(parts);
            let j = j.min(parts - i);
            self.on_lattices[(first + i * (parts + 1) - i * (i.max(1) - 1) / 2 + j) as usize][side]
        };
        let of = if fx + fy <= 1.0 {
            [(at(i, j), 1.0 - fx - fy), (at(i + 1, j), fx), (at(i, j + 1), fy)]
        } else {
            [(at(i + 1, j + 1), fx + fy - 1.0), (at(i, j + 1), 1.0 - fx), (at(i + 1, j), 1.0 - fy)]
        };
        LinearSky::blend(of.into_iter())
    }
}

/// A triangle's corners, by their indices, and their shares in a place on it.
type Place = ([usize; 3], [f32; 3]);

/// What the sky sends to a place past all meshes.
fn sky_at(scene: &Scene, occluders: &Occluders, mesh: &Mesh, (corners, shares): &Place) -> Sides {
    let inward = shares.map(|share| share * (1.0 - INWARD) + INWARD / 3.0);
    let blend = |of: &dyn Fn(usize) -> Vec3, shares: &[f32; 3]| {
        corners.iter().zip(shares).fold(Vec3::ZERO, |sum, (i, share)| sum + of(*i) * *share)
    };
    let position = blend(&|i| mesh.positions[i], &inward);
    let front = blend(&|i| mesh.normals[i].normalize_or_zero(), shares).normalize_or(Vec3::Z);
    let surface = scene.materials[mesh.material].surface.as_ref();
    let down = match (mesh.tangents.get(corners[0]), surface) {
        (Some([u, v]), Some(surface)) => u.cross(*v).length().sqrt() * surface.relief_depth(),
        _ => 0.0,
    };
    [front, -front].map(|normal| {
        // From half way down the relief: what it hides itself is told apart.
        let from = position - normal * (0.5 * down);
        let is_turned = normal != front;
        LinearSky::new(normal, |direction| {
            let color = scene.sky.radiance(direction);
            let is_hidden = || occluders.hide_sky(from, direction, (down, is_turned));
            if color == Vec3::ZERO || is_hidden() { Vec3::ZERO } else { color }
        })
    })
}

/// The shares of a triangle's corners in a place on it.
fn shares([a, b, c]: [Vec3; 3], place: Vec3) -> [f32; 3] {
    let normal = (b - a).cross(c - a);
    let scale = 1.0 / normal.length_squared().max(f32::MIN_POSITIVE);
    let share = |p: Vec3, q: Vec3| (p - place).cross(q - place).dot(normal) * scale;
    // A pixel's centre may lie beside its triangle.
    let of = [share(b, c), share(c, a), share(a, b)].map(|share| share.clamp(0.0, 1.0));
    let sum = (of[0] + of[1] + of[2]).max(f32::MIN_POSITIVE);
    of.map(|share| share / sum)
}
