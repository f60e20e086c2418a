//! Normals for meshes whose files have none.
//!
//! A file holds a vertex once for each texture coordinate that meets there, and a model once for
//! each material. Where vertices have the same position they are therefore one *point* of the
//! surface here, and both sides of a seam of the texture get the same normal. An edge is smooth if
//! the faces that share it meet at no more than the crease angle. Around a point, faces that hang
//! together by smooth edges share one normal; a vertex is split where they do not.
//!
//! ```text
//!      \ A /        A, B and C meet at smooth edges: one normal, their mean.
//!    B  \ /  D      The edges beside D (==) are sharp: D keeps its own.
//!  ------*======    Each face counts by its angle at the point, so that it does not
//!     C   \\   D    matter how a polygon was cut into triangles.
//! ```

use crate::scene::Mesh;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::cmp::Ordering;
use std::collections::HashMap;

/// An edge of more faces than this is no part of a surface, and stays sharp: comparing each face
/// with each would take too long in a file that is made to do harm.
const MOST_FACES: usize = 64;
/// Cosines are compared with this tolerance, since faces that meet at exactly the crease angle are
/// smooth, and positions are rounded to f32.
const TOLERANCE: f64 = 1e-6;

/// Makes the normals that are zero in `meshes`, all together; vertices may be split.
///
/// # Errors
/// Says so when there are more corners than fit 32 bits.
pub(super) fn make(meshes: &mut [Mesh], crease_degrees: f32) -> Result<(), String> {
    let mut lacking: Vec<&mut Mesh> =
        meshes.iter_mut().filter(|mesh| mesh.normals.contains(&Vec3::ZERO)).collect();
    let num_corners: usize = lacking.iter().map(|mesh| mesh.triangles.len() * 3).sum();
    let num_vertices: usize = lacking.iter().map(|mesh| mesh.positions.len()).sum();
    if num_corners.max(num_vertices) > u32::MAX as usize {
        return Err("has too many triangles to make normals for them".into());
    }
    let normals = Faces::of(&lacking).normals(crease_degrees);
    let mut first = 0;
    for mesh in &mut lacking {
        let end = first + mesh.triangles.len() * 3;
        set_normals(mesh, &normals[first..end]);
        first = end;
    }
    Ok(())
}

/// Gives the vertices of `mesh` that lack a normal those of their corners; a vertex whose corners
/// differ is split.
fn set_normals(mesh: &mut Mesh, of_corners: &[Vec3]) {
    let is_missing: Vec<bool> = mesh.normals.iter().map(|normal| *normal == Vec3::ZERO).collect();
    let mut copies: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
    for (corner, &normal) in mesh.triangles.as_flattened_mut().iter_mut().zip(of_corners) {
        let vertex = *corner as usize;
        if !is_missing[vertex] || normal == Vec3::ZERO || mesh.normals[vertex] == normal {
            continue;
        }
        if mesh.normals[vertex] == Vec3::ZERO {
            mesh.normals[vertex] = normal;
            continue;
        }
        *corner =
            *copies.entry((*corner, normal.to_array().map(f32::to_bits))).or_insert_with(|| {
                mesh.positions.push(mesh.positions[vertex]);
                mesh.tex_coords.extend(mesh.tex_coords.get(vertex).copied());
                mesh.colors.extend(mesh.colors.get(vertex).copied());
                mesh.normals.push(normal);
                mesh.normals.len() as u32 - 1
            });
    }
    // Vertices of no face, or of faces without area.
    mesh.normals
        .iter_mut()
        .filter(|normal| **normal == Vec3::ZERO)
        .for_each(|normal| *normal = Vec3::Y);
}

/// The triangles of all meshes, with vertices counted through, and the point that each vertex lies
/// at.
struct Faces {
    positions: Vec<Vec3>,
    points: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

/// A corner of a face with an area.
struct Corner {
    /// Which one: three times the triangle, and 0 to 2.
    number: u32,
    /// The face's unit normal.
    normal: DVec3,
    /// In radians.
    angle: f64,
    /// The points at the other ends of the two edges that meet here.
    ends: [u32; 2],
}

impl Faces {
    fn of(meshes: &[&mut Mesh]) -> Self {
        let mut positions: Vec<Vec3> = Vec::new();
        let mut triangles = Vec::new();
        for mesh in meshes {
            let first = positions.len() as u32;
            positions.extend(&mesh.positions);
            triangles.extend(
                mesh.triangles.iter().map(|triangle| triangle.map(|vertex| first + vertex)),
            );
        }
        Self { points: points(&positions), positions, triangles }
    }

    /// The normal of each corner; zero where a face has no area.
    fn normals(&self, crease_degrees: f32) -> Vec<Vec3> {
        let corners = self.triangles.as_flattened();
        let mut by_point: Vec<(u32, u32)> = corners
            .iter()
            .zip(0..)
            .map(|(&vertex, number)| (self.points[vertex as usize], number))
            .collect();
        by_point.par_sort_unstable();
        let least_cos = f64::from(crease_degrees).to_radians().cos() - TOLERANCE;
        let around_points = by_point.par_chunk_by(|a, b| a.0 == b.0).fold(
            Around::default,
            |mut around, at_point| {
                around.corners.clear();
                around
                    .corners
                    .extend(at_point.iter().filter_map(|&(_, number)| self.corner(number)));
                around.add_normals(least_cos);
                around
            },
        );
        let found: Vec<Vec<(u32, Vec3)>> = around_points.map(|around| around.normals).collect();
        let mut normals = vec![Vec3::ZERO; corners.len()];
        found.into_iter().flatten().for_each(|(number, normal)| normals[number as usize] = normal);
        normals
    }

    fn corner(&self, number: u32) -> Option<Corner> {
        let triangle = self.triangles[number as usize / 3];
        let [a, b, c] = triangle.map(|vertex| self.positions[vertex as usize].as_dvec3());
        let normal = (b - a).cross(c - a).try_normalize()?;
        let (to_next, to_last, ends) = match number % 3 {
            0 => (b - a, c - a, [triangle[1], triangle[2]]),
            1 => (c - b, a - b, [triangle[2], triangle[0]]),
            _ => (a - c, b - c, [triangle[0], triangle[1]]),
        };
        // The last bits of an arc tangent differ from machine to machine; an f32 has none of them.
        let angle = to_next.cross(to_last).length().atan2(to_next.dot(to_last)) as f32;
        let ends = ends.map(|vertex| self.points[vertex as usize]);
        Some(Corner { number, normal, angle: angle.into(), ends })
    }
}

/// The point of each vertex: equal positions are one.
fn points(positions: &[Vec3]) -> Vec<u32> {
    // Adding 0 makes a negative zero positive.
    let bits = |position: &Vec3| position.to_array().map(|x| (x + 0.0).to_bits());
    let mut sorted: Vec<([u32; 3], u32)> = positions.iter().map(bits).zip(0..).collect();
    sorted.par_sort_unstable();
    let mut points = vec![0; positions.len()];
    for (point, vertices) in (0..).zip(sorted.chunk_by(|a, b| a.0 == b.0)) {
        vertices.iter().for_each(|&(_, vertex)| points[vertex as usize] = point);
    }
    points
}

/// What is found at one point after another.
#[derive(Default)]
struct Around {
    /// The corners at the point, and the first corner of the group that each is in.
    corners: Vec<Corner>,
    groups: Vec<usize>,
    /// The other end of each corner's edges, and the corner.
    edges: Vec<(u32, usize)>,
    /// For the first corner of a group, its faces' normals times their angles.
    sums: Vec<DVec3>,
    /// The normals of all corners so far, with their numbers.
    normals: Vec<(u32, Vec3)>,
}

impl Around {
    /// Finds the normals of the corners at a point.
    fn add_normals(&mut self, least_cos: f64) {
        // Sums are rounded: in this order they are the same whatever the order of the faces.
        self.corners.sort_unstable_by(Corner::by_value);
        self.group_by_smooth_edges(least_cos);
        self.sums.clear();
        self.sums.resize(self.corners.len(), DVec3::ZERO);
        for (i, corner) in self.corners.iter().enumerate() {
            self.sums[first_of_group(&mut self.groups, i)] += corner.normal * corner.angle;
        }
        for (i, corner) in self.corners.iter().enumerate() {
            let sum = self.sums[first_of_group(&mut self.groups, i)];
            // Faces of two sides may cancel each other.
            let normal = if sum.length() > TOLERANCE { sum.normalize() } else { corner.normal };
            self.normals.push((corner.number, normal.as_vec3()));
        }
    }

    /// Corners that hang together by smooth edges become one group.
    fn group_by_smooth_edges(&mut self, least_cos: f64) {
        let Self { corners, groups, edges, .. } = self;
        edges.clear();
        edges.extend(
            corners.iter().enumerate().flat_map(|(i, corner)| corner.ends.map(|end| (end, i))),
        );
        edges.sort_unstable();
        groups.clear();
        groups.extend(0..corners.len());
        for edge in edges.chunk_by(|a, b| a.0 == b.0).filter(|edge| edge.len() <= MOST_FACES) {
            for (i, &(_, a)) in edge.iter().enumerate() {
                for &(_, b) in &edge[..i] {
                    if corners[a].normal.dot(corners[b].normal) >= least_cos {
                        let [a, b] = [a, b].map(|corner| first_of_group(groups, corner));
                        groups[a.max(b)] = a.min(b);
                    }
                }
            }
        }
    }
}

/// Follows `groups` to the first corner of a group, and shortens the way for those who follow it
/// next.
fn first_of_group(groups: &mut [usize], mut corner: usize) -> usize {
    while groups[corner] != corner {
        groups[corner] = groups[groups[corner]];
        corner = groups[corner];
    }
    corner
}

impl Corner {
    /// An order that does not depend on where the face stands in the file.
    fn by_value(&self, other: &Self) -> Ordering {
        let key = |corner: &Self| [corner.normal.x, corner.normal.y, corner.normal.z, corner.angle];
        key(self)
            .iter()
            .zip(key(other))
            .map(|(a, b)| a.total_cmp(&b))
            .find(|order| order.is_ne())
            .unwrap_or(Ordering::Equal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;

    fn mesh(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Mesh {
        let (tex_coords, normals) =
            (vec![Vec2::ZERO; positions.len()], vec![Vec3::ZERO; positions.len()]);
        Mesh { positions, tex_coords, normals, triangles, ..Mesh::default() }
    }

    fn with_normals(mesh: &Mesh, crease_degrees: f32) -> Mesh {
        let mut meshes = [mesh.clone()];
        make(&mut meshes, crease_degrees).unwrap();
        let [made] = meshes;
        assert!(made.normals.iter().all(|normal| normal.is_normalized()));
        assert!(
            [made.normals.len(), made.tex_coords.len()]
                .iter()
                .all(|&num| num == made.positions.len())
        );
        made
    }

    /// The position and normal of each corner, triangle by triangle.
    fn corners(mesh: &Mesh) -> Vec<[Vec3; 2]> {
        let of_vertex = |&i: &u32| [mesh.positions[i as usize], mesh.normals[i as usize]];
        mesh.triangles.as_flattened().iter().map(of_vertex).collect()
    }

    /// From -1 to 1, every corner once.
    fn cube() -> Mesh {
        let sign = |i: u32, bit: u32| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
        let positions = (0..8).map(|i| Vec3::new(sign(i, 0), sign(i, 1), sign(i, 2))).collect();
        let quads =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        mesh(positions, quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
    }

    /// A tube of `num` sides around the y axis; its first and last vertices lie at the same places.
    fn tube(num: u32) -> Mesh {
        let at = |i: u32, y: f32| {
            let angle = (i % num) as f32 * std::f32::consts::TAU / num as f32;
            Vec3::new(angle.sin(), y, angle.cos())
        };
        let positions = (0..=num).flat_map(|i| [at(i, 0.0), at(i, 1.0)]).collect();
        mesh(
            positions,
            (0..num)
                .map(|i| 2 * i)
                .flat_map(|i| [[i, i + 2, i + 1], [i + 2, i + 3, i + 1]])
                .collect(),
        )
    }

    #[test]
    fn a_cube_is_hard_below_its_angle_and_round_above() {
        for crease in [0.0, 60.0, 89.0] {
            let made = with_normals(&cube(), crease);
            assert_eq!(made.positions.len(), 24, "crease at {crease}");
            for corners in corners(&made).as_chunks::<6>().0 {
                let [first, ..] = corners.map(|[_, normal]| normal);
                assert!(
                    first.max_element() == 1.0 || first.min_element() == -1.0,
                    "crease at {crease}: {first}"
                );
                assert!(
                    corners
                        .iter()
                        .all(|[position, normal]| *normal == first && position.dot(first) == 1.0)
                );
            }
        }
        for crease in [90.0, 180.0] {
            let made = with_normals(&cube(), crease);
            assert_eq!(made.positions.len(), 8, "crease at {crease}");
            assert!(
                corners(&made)
                    .iter()
                    .all(|[position, normal]| normal.abs_diff_eq(position.normalize(), 1e-6))
            );
        }
    }

    #[test]
    fn both_sides_of_a_seam_have_the_same_normal() {
        for num in [6, 7, 40] {
            let made = with_normals(&tube(num), 60.0);
            let num = num as usize;
            assert_eq!(made.positions.len(), 2 * num + 2, "{num} sides are smooth");
            assert_eq!(made.normals[..2], made.normals[2 * num..]);
            let outwards = |p: &Vec3| Vec3::new(p.x, 0.0, p.z);
            assert!(
                made.positions
                    .iter()
                    .zip(&made.normals)
                    .all(|(p, n)| n.abs_diff_eq(outwards(p), 1e-6))
            );
        }
    }

    #[test]
    fn meshes_that_touch_are_one_surface() {
        let whole = tube(12);
        let half = |triangles: &[[u32; 3]]| mesh(whole.positions.clone(), triangles.to_vec());
        let (left, right) = whole.triangles.split_at(12);
        let mut meshes = [half(left), half(right)];
        make(&mut meshes, 60.0).unwrap();
        assert_eq!(meshes.each_ref().map(corners).concat(), corners(&with_normals(&whole, 60.0)));
    }

    #[test]
    fn the_order_of_faces_changes_nothing() {
        let mut bumpy = tube(30);
        for (i, position) in (0..).zip(&mut bumpy.positions) {
            *position *= Vec3::new(1.0, 1.0 + 0.3 * (i % 5) as f32, 1.0);
        }
        bumpy.triangles.extend((1..29).map(|i| [0, 2 * i, 2 * i + 2]));
        let num = bumpy.triangles.len();
        for crease in [20.0, 60.0, 180.0] {
            let expected = corners(&with_normals(&bumpy, crease));
            // Every third one; the number is no multiple of 3.
            assert_ne!(num % 3, 0);
            let order: Vec<usize> = (0..num).map(|i| i * 3 % num).collect();
            let shuffled = order.iter().map(|&i| bumpy.triangles[i]).collect();
            let found =
                corners(&with_normals(&Mesh { triangles: shuffled, ..bumpy.clone() }, crease));
            for (&i, found) in order.iter().zip(found.as_chunks::<3>().0) {
                assert_eq!(found[..], expected[3 * i..3 * i + 3], "crease at {crease}");
            }
        }
    }

    #[test]
    fn faces_without_area_or_number_do_no_harm() {
        let clean = with_normals(&cube(), 60.0);
        let mut dirty = cube();
        dirty.positions.extend([Vec3::NAN, Vec3::INFINITY, Vec3::splat(3.0)]);
        let extra = [[0, 0, 1], [5, 5, 5], [0, 1, 8], [8, 9, 10], [2, 9, 3]];
        dirty.tex_coords.extend([Vec2::ZERO; 3]);
        dirty.normals.extend([Vec3::ZERO; 3]);
        dirty.triangles.extend(extra);
        let made = with_normals(&dirty, 60.0);
        assert_eq!(corners(&made)[..36], corners(&clean)[..]);
        // A sheet of two sides, smooth all over: the sides cancel each other.
        let sheet = mesh(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2], [0, 2, 1]]);
        assert_eq!(
            corners(&with_normals(&sheet, 180.0))
                .iter()
                .map(|[_, normal]| normal.z)
                .collect::<Vec<_>>(),
            [1.0, 1.0, 1.0, -1.0, -1.0, -1.0]
        );
        // More faces on one edge than are compared.
        let fan = (0..500).map(|i| Vec3::new(1.0, i as f32, 500.0 - i as f32));
        let fan = mesh(
            [Vec3::ZERO, Vec3::X].into_iter().chain(fan).collect(),
            (2..502).map(|i| [0, 1, i]).collect(),
        );
        with_normals(&fan, 180.0);
    }

    #[test]
    fn normals_that_are_there_stay() {
        let mut half = cube();
        half.normals[3] = Vec3::X;
        let made = with_normals(&half, 60.0);
        assert_eq!(made.normals[3], Vec3::X);
        assert!(corners(&made).iter().all(|[p, n]| *p != cube().positions[3] || *n == Vec3::X));
    }
}
