//! Where rays may pass a relief: how flat they must go, from how the mesh bends; and where it bends so
//! unevenly that they cannot be told from the triangle by which they come in.
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

/// How much the curvatures of neighbours may differ: a share of the greater one, and, in units of one
/// over the relief's depth, what nobody sees.
const EVEN: [f32; 2] = [0.1, 0.01];

/// How much of a repeat texture coordinates may differ on both sides of an edge where the texture goes on.
const SAME_PLACE: f32 = 1e-3;

/// What is known of rays through a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limits {
    /// Seen from the front and from behind, the square of the cosine between normal and ray below which
    /// a ray may pass the relief; 0 where none does.
    pub(super) squares: [f32; 2],
    /// Whether such a ray may get to where the mesh bends by more or less.
    pub(super) is_uneven: bool,
    /// How many triangles away the nearest break is, an edge beyond which the texture goes on elsewhere;
    /// [`NO_BREAK`] where there is none.
    pub(super) to_break: u8,
}

/// No break, or so far away that no ray gets there.
pub(super) const NO_BREAK: u8 = u8::MAX;

/// Of each triangle.
pub(super) fn limits(mesh: &Mesh, offsets: &[Vec3], neighbors: &[[u32; 3]]) -> Vec<Limits> {
    let bends: Vec<[f32; 2]> = mesh
        .triangles
        .iter()
        .map(|triangle| bend(mesh, offsets, triangle.map(|i| i as usize)))
        .collect();
    let is_at = |found: &dyn Fn([usize; 2]) -> bool, i: usize| {
        let edges = neighbors[i].into_iter().enumerate().filter(|(_, other)| *other != NONE);
        edges.map(|(edge, other)| [3 * i + edge, other as usize]).any(found)
    };
    let to_break = to_breaks(neighbors, |i| is_at(&|edges| is_break(mesh, edges), i));
    let mut all: Vec<_> =
        (0..bends.len()).map(|i| (bends[i], is_at(&|edges| differ(&bends, edges), i))).collect();
    // A ray that enters at one triangle may leave past another one.
    for _ in 0..rings(mesh, offsets, &bends) {
        all = (0..all.len())
            .map(|i| {
                let around = neighbors[i].into_iter().filter(|edge| *edge != NONE);
                around.map(|edge| all[edge as usize / 3]).fold(
                    all[i],
                    |(most, is_uneven), other| {
                        let ([a, b], [c, d]) = (most, other.0);
                        ([a.max(c), b.max(d)], is_uneven | other.1)
                    },
                )
            })
            .collect();
    }
    // On a circle: `1 - c^2 = (1 - k T)^2` where the ray is deepest.
    let limit = |k: f32| MARGIN * if k < 1.0 { (2.0 - k) * k } else { 1.0 };
    let all = all.into_iter().zip(to_break);
    all.map(|((bend, is_uneven), to_break)| Limits {
        squares: bend.map(limit),
        is_uneven,
        to_break,
    })
    .collect()
}

/// Of each triangle, how many others lie between it and one that is at a break.
fn to_breaks(neighbors: &[[u32; 3]], is_at_break: impl Fn(usize) -> bool) -> Vec<u8> {
    let mut all = vec![NO_BREAK; neighbors.len()];
    let mut last: Vec<usize> = (0..neighbors.len()).filter(|i| is_at_break(*i)).collect();
    last.iter().for_each(|i| all[*i] = 0);
    for far in 1..NO_BREAK {
        let mut next = Vec::new();
        for edge in last.iter().flat_map(|i| neighbors[*i]).filter(|edge| *edge != NONE) {
            let i = edge as usize / 3;
            if all[i] == NO_BREAK {
                all[i] = far;
                next.push(i);
            }
        }
        last = next;
    }
    all
}

/// Whether two triangles, known by the edges at which they meet, bend by more and less.
fn differ(bends: &[[f32; 2]], edges: [usize; 2]) -> bool {
    let [a, b] = edges.map(|edge| bends[edge / 3]);
    (0..2).any(|i| (a[i] - b[i]).abs() > EVEN[0] * a[i].max(b[i]) + EVEN[1])
}

/// Whether the texture of one does not go on in the other.
fn is_break(mesh: &Mesh, [edge, other]: [usize; 2]) -> bool {
    let uv = |edge: usize, end: usize| {
        mesh.tex_coords[mesh.triangles[edge / 3][(edge + end) % 3] as usize]
    };
    // Neighbours go along their edge in opposite directions; whole repeats are the same place.
    (0..2).any(|end| {
        let apart = uv(edge, end) - uv(other, 1 - end);
        (apart - apart.round()).abs().max_element() > SAME_PLACE
    })
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
