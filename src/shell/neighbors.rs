//! Which triangles of a mesh meet at an edge.

use crate::scene::Mesh;

/// No neighbour: the border of the mesh, or a crease.
pub(super) const NONE: u32 = u32::MAX;

/// Least cosine between the normals on both sides of an edge that is smooth: beyond 60 degrees it is
/// a crease.
const SMOOTH: f32 = 0.5;

/// Across each edge of each triangle, the other triangle times three plus its edge, or [`NONE`].
/// Vertices in one place count as one: texture coordinates often end within a smooth surface.
pub(super) fn find(mesh: &Mesh) -> Vec<[u32; 3]> {
    let places = places(mesh);
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
