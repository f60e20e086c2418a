//! Which triangles of a mesh meet at an edge.

use crate::scene::Mesh;
use glam::{BVec3, DVec3, I64Vec3, Vec3};
use std::collections::HashMap;

/// No neighbour: the border of the mesh, or a crease.
pub(super) const NONE: u32 = u32::MAX;

/// Least cosine between the normals on both sides of an edge that is smooth: beyond 60 degrees it is
/// a crease.
const SMOOTH: f32 = 0.5;

/// How far apart vertices may lie on both sides of a seam, as a share of the greatest coordinate: what
/// is computed twice, as the first and the last point of a circle, is rounded twice.
const SEAM: f64 = 1e-6;

/// Across each edge of each triangle, the other triangle times three plus its edge, or [`NONE`].
/// Vertices in one place count as one: texture coordinates often end within a smooth surface.
pub(super) fn find(mesh: &Mesh) -> Vec<[u32; 3]> {
    let mut places = places(mesh);
    let neighbors = joined(mesh, &places);
    let edges = neighbors.iter().zip(&mesh.triangles).flat_map(|(neighbors, triangle)| {
        (0..3).filter(|i| neighbors[*i] == NONE).map(|i| [triangle[i], triangle[(i + 1) % 3]])
    });
    let mut border: Vec<u32> = edges.flatten().map(|i| places[i as usize]).collect();
    border.sort_unstable();
    border.dedup();
    let welded = weld(mesh, &border);
    if welded.is_empty() {
        return neighbors;
    }
    for place in &mut places {
        *place = welded.get(place).copied().unwrap_or(*place);
    }
    joined(mesh, &places)
}

/// The neighbours across edges whose ends are in the same places.
fn joined(mesh: &Mesh, places: &[u32]) -> Vec<[u32; 3]> {
    let ends = |edge: u32| {
        let triangle = mesh.triangles[edge as usize / 3].map(|i| i as usize);
        let (i, j) = (edge as usize % 3, (edge as usize + 1) % 3);
        [triangle[i], triangle[j]]
    };
    // A triangle without area lies between two others, as at the poles of spheres: they are
    // neighbours.
    let has_area = |edge: &u32| {
        let [a, b, c] = mesh.triangles[*edge as usize / 3].map(|i| places[i as usize]);
        a != b && b != c && c != a
    };
    let mut edges: Vec<([u32; 2], u32)> = (0..3 * mesh.triangles.len() as u32)
        .filter(has_area)
        .map(|edge| {
            let [a, b] = ends(edge).map(|i| places[i]);
            ([a.min(b), a.max(b)], edge)
        })
        .collect();
    edges.sort_unstable();
    let mut neighbors = vec![[NONE; 3]; mesh.triangles.len()];
    for pair in edges.chunk_by(|a, b| a.0 == b.0) {
        // Where three meet, nobody can say which goes on in which.
        let &[(_, a), (_, b)] = pair else { continue };
        let ([a0, a1], [b0, b1]) = (ends(a), ends(b));
        // Neighbours of one orientation go along their edge in opposite directions.
        let is_whole =
            places[a0] == places[b1] && places[a1] == places[b0] && places[a0] != places[a1];
        let is_smooth = |i: usize, j: usize| mesh.normals[i].dot(mesh.normals[j]) >= SMOOTH;
        if is_whole && is_smooth(a0, b1) && is_smooth(a1, b0) {
            neighbors[a as usize / 3][a as usize % 3] = b;
            neighbors[b as usize / 3][b as usize % 3] = a;
        }
    }
    neighbors
}

/// For vertices of the border that are nearly in the place of one before them, that one.
fn weld(mesh: &Mesh, border: &[u32]) -> HashMap<u32, u32> {
    let mut welded = HashMap::new();
    let most = |most: f32, position: &Vec3| most.max(position.abs().max_element());
    let reach = f64::from(mesh.positions.iter().fold(0.0, most)) * SEAM;
    if !(reach > 0.0 && reach.is_finite()) {
        return welded;
    }
    // What is near lies in the cells of the eight corners of a box around it: each is twice as wide.
    let cell = |place: DVec3| (place / (2.0 * reach)).floor().as_i64vec3();
    let mut firsts: HashMap<_, Vec<u32>> = HashMap::new();
    for &i in border {
        let place = mesh.positions[i as usize].as_dvec3();
        let is_near =
            |first: &u32| mesh.positions[*first as usize].as_dvec3().distance(place) <= reach;
        let [low, high] = [-reach, reach].map(|reach| cell(place + reach));
        let corners = (0..8).map(|corner| {
            let is_high = BVec3::new(corner & 1 != 0, corner & 2 != 0, corner & 4 != 0);
            I64Vec3::select(is_high, high, low)
        });
        let near = corners.filter_map(|cell| firsts.get(&cell)).flatten().filter(|i| is_near(i));
        if let Some(first) = near.min() {
            welded.insert(i, *first);
        } else {
            firsts.entry(cell(place)).or_default().push(i);
        }
    }
    welded
}

/// A number for each vertex that those in one place share.
fn places(mesh: &Mesh) -> Vec<u32> {
    // Added to 0, both zeros are one.
    let key = |i: u32| mesh.positions[i as usize].to_array().map(|c| (c + 0.0).to_bits());
    let mut order: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    order.sort_unstable_by_key(|i| (key(*i), *i));
    let mut places = vec![0; order.len()];
    for same in order.chunk_by(|a, b| key(*a) == key(*b)) {
        same.iter().for_each(|i| places[*i as usize] = same[0]);
    }
    places
}
