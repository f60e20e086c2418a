//! The frames of normal maps: tangents of the file, or those that bakers of normal maps make.
//!
//! A relief needs the true derivatives `dP/du` and `dP/dv`, which `Mesh::new` makes. A normal map
//! alone is right only in the frame that it was baked in: at right angles to the normal, as the
//! file gives it or as `MikkTSpace` makes it. The axes keep the lengths of the derivatives.

use super::primitives::Piece;
use crate::decode::contain;
use crate::scene::Mesh;
use bevy_mikktspace::{Geometry, Ops, TangentSpace, generate_tangents};
use glam::{Vec3, Vec4};
use std::collections::HashMap;

/// The mesh of a piece with its frames; those of a normal map where `is_mapped`.
pub(super) fn with_frames(piece: Piece, is_mapped: bool) -> Mesh {
    let Piece { mesh, tangents } = piece;
    let is_mapped = is_mapped && !mesh.tex_coords.is_empty();
    let (mesh, tangents) = if is_mapped && tangents.len() != mesh.positions.len() {
        let of_corners = mikktspace(&mesh);
        split(mesh, &of_corners)
    } else {
        (mesh, tangents)
    };
    let Mesh { name, material, positions, tex_coords, normals, triangles, colors, .. } = mesh;
    let mut mesh =
        Mesh { name, material, colors, ..Mesh::new(positions, tex_coords, normals, triangles) };
    if is_mapped {
        let frames = mesh.tangents.iter_mut().zip(&mesh.normals).zip(&tangents);
        frames.for_each(|((frame, normal), tangent)| *frame = framed(*frame, *normal, *tangent));
    }
    mesh
}

/// The axes of a tangent with the lengths of `[u, v]`; those where there is none.
fn framed([u, v]: [Vec3; 2], normal: Vec3, tangent: Vec4) -> [Vec3; 2] {
    let axis = tangent.truncate();
    let side = normal.cross(axis) * tangent.w.signum();
    if side.length_squared() < 0.25 || !side.is_finite() {
        return [u, v];
    }
    [axis * u.length(), side * v.length()]
}

/// A tangent for each corner of each triangle.
fn mikktspace(mesh: &Mesh) -> Vec<Vec4> {
    let mut corners = Corners { mesh, tangents: vec![Vec4::ZERO; mesh.triangles.len() * 3] };
    // Where it gives up, the frames of the derivatives serve.
    match contain(|| generate_tangents::<_, ExactOps>(&mut corners)) {
        Some(Ok(())) => corners.tangents,
        _ => vec![Vec4::ZERO; mesh.triangles.len() * 3],
    }
}

struct Corners<'a> {
    mesh: &'a Mesh,
    tangents: Vec<Vec4>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[face][corner] as usize
    }
}

/// The same on every machine.
struct ExactOps;

impl Ops for ExactOps {
    fn sqrt(x: f32) -> f32 {
        x.sqrt()
    }

    fn acos(x: f32) -> f32 {
        // The last bits of an arc cosine differ from machine to machine; an f32 has none of them.
        f64::from(x).acos() as f32
    }
}

impl Geometry<ExactOps> for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, corner)].to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.mesh.tex_coords[self.vertex(face, corner)].to_array()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        if let Some(space) = space {
            self.tangents[face * 3 + corner] = space.tangent_encoded().into();
        }
    }
}

/// A mesh whose vertices have one tangent each: those whose corners differ are split.
fn split(mut mesh: Mesh, of_corners: &[Vec4]) -> (Mesh, Vec<Vec4>) {
    let mut tangents = vec![None; mesh.positions.len()];
    let mut copies: HashMap<(u32, [u32; 4]), u32> = HashMap::new();
    let Mesh { triangles, positions, tex_coords, normals, colors, .. } = &mut mesh;
    for (corner, &tangent) in triangles.as_flattened_mut().iter_mut().zip(of_corners) {
        let vertex = *corner as usize;
        if *tangents[vertex].get_or_insert(tangent) == tangent {
            continue;
        }
        let key = (*corner, tangent.to_array().map(f32::to_bits));
        *corner = *copies.entry(key).or_insert_with(|| {
            positions.push(positions[vertex]);
            tex_coords.push(tex_coords[vertex]);
            normals.push(normals[vertex]);
            colors.extend(colors.get(vertex).copied());
            tangents.push(Some(tangent));
            tangents.len() as u32 - 1
        });
    }
    (mesh, tangents.into_iter().map(Option::unwrap_or_default).collect())
}
