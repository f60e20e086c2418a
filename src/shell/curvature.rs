//! Where rays may pass a relief: how flat they must go, from how the mesh bends.
//!
//! A ray that enters a relief of depth `T` over a surface of normal curvature `k`, with the cosine
//! `c` between the normal and the ray, gets `(1 - sqrt(1 - c^2)) / k` deep before it rises again. If
//! that is more than `T`, it hits whatever the relief is. Between their corners polygons lie below the
//! surface that they stand for, by up to `k l^2 / 8` over a length `l`: so much is added to `T`.

use super::neighbors::NONE;
use crate::scene::Mesh;
use glam::Vec3;

/// What the square of the cosine may be greater by and a ray still be followed: curvature is known
/// only at vertices.
const MARGIN: f32 = 1.05;

/// Most triangles that the curvature of a vertex is looked for around it.
const MOST_RINGS: usize = 32;

/// Of each triangle, seen from the front and from behind, the square of the cosine below which a ray
/// may pass the relief; 0 where none does.
pub(super) fn limits(mesh: &Mesh, offsets: &[Vec3], neighbors: &[[u32; 3]]) -> Vec<[f32; 2]> {
    let mut bends: Vec<[f32; 2]> = mesh
        .triangles
        .iter()
        .map(|triangle| bend(mesh, offsets, triangle.map(|i| i as usize)))
        .collect();
    // A ray that enters at one triangle may leave past another one.
    for _ in 0..rings(mesh, offsets, &bends) {
        bends = (0..bends.len())
            .map(|i| {
                let around = neighbors[i].into_iter().filter(|edge| *edge != NONE);
                around.fold(bends[i], |most, edge| {
                    let other = bends[edge as usize / 3];
                    [most[0].max(other[0]), most[1].max(other[1])]
                })
            })
            .collect();
    }
    // On a circle: `1 - c^2 = (1 - k T)^2` where the ray is deepest.
    let limit = |k: f32| MARGIN * if k < 1.0 { (2.0 - k) * k } else { 1.0 };
    bends.into_iter().map(|bend| bend.map(limit)).collect()
}

/// The greatest curvature along a triangle's edges, of its front and of its back, in units of one
/// over the relief's depth; 0 where it is flat or hollow.
fn bend(mesh: &Mesh, offsets: &[Vec3], triangle: [usize; 3]) -> [f32; 2] {
    let depth = triangle.iter().fold(0.0_f32, |most, i| most.max(offsets[*i].length()));
    let mut most = [0.0_f32; 2];
    for (i, j) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (triangle[a], triangle[b])) {
        let edge = mesh.positions[j] - mesh.positions[i];
        let turn = mesh.normals[j] - mesh.normals[i];
        // What rounding makes of equal normals bends nothing.
        if turn.length_squared() < 1e-10 {
            continue;
        }
        let curvature = turn.dot(edge) / edge.length_squared();
        let sag = curvature.abs() * edge.length_squared() * 0.125;
        let k = curvature * (depth + sag);
        if k.is_finite() {
            most = [most[0].max(k), most[1].max(-k)];
        }
    }
    most
}

/// How many triangles a ray may pass on its way through the relief.
fn rings(mesh: &Mesh, offsets: &[Vec3], bends: &[[f32; 2]]) -> usize {
    let mut most = 0.0_f32;
    for (triangle, bend) in mesh.triangles.iter().zip(bends) {
        let k = bend[0].max(bend[1]);
        if k > 0.0 {
            let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
            let depth = offsets[triangle[0] as usize].length();
            // Half of the longest chord within the relief, in edges of the triangle's mean size.
            let reach = depth * (2.0 / k).sqrt();
            let side = (b - a).cross(c - a).length().sqrt();
            most = most.max(reach / side.max(f32::MIN_POSITIVE));
        }
    }
    (most.ceil() as usize).min(MOST_RINGS)
}
