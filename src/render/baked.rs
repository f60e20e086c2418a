//! The flat pieces of a scene, each with its surface lit for good.
//!
//! Under suns and a sky all of a flat piece is lit alike, whatever the camera does. So its light is
//! baked into the colours of its surface once (see [`crate::light::baked`]), and frames draw that
//! surface unlit. Pieces of one material that lie in the same directions, such as all triangles of
//! a floor, share one. Curved meshes are lit place by place.

use super::prepared::PreparedScene;
use crate::filter::Prepared;
use crate::light::{TextureFrame, baked};
use crate::scene::{Material, Mesh, Scene};
use glam::Vec3;

/// Most texels of all baked surfaces of a scene together, some hundred MiB. Pieces beyond, in the
/// order of the meshes, are lit place by place.
const MOST_TEXELS: usize = 1 << 24;

/// Most pieces of one mesh: what has more is taken for curved.
const MOST_PIECES: usize = 8;

/// Greatest difference between axes that lie in the same direction, as a share of their length:
/// what averaging over triangles leaves of equal ones.
const SAME: f32 = 1e-4;

/// No piece.
const NONE: u32 = u32::MAX;

/// The lit surfaces of a scene's flat pieces.
#[derive(Debug, Default)]
pub(crate) struct Baked {
    /// The piece of each mesh's triangles.
    of_mesh: Vec<OfMesh>,
    pieces: Vec<Piece>,
}

/// The pieces of a mesh.
#[derive(Debug)]
enum OfMesh {
    /// All triangles are of one, or of none.
    All(u32),
    /// One for each triangle.
    Each(Vec<u32>),
}

/// Triangles of one material in the same frame.
#[derive(Debug)]
struct Piece {
    material: usize,
    frame: TextureFrame,
    /// As it is seen from the front and from behind, where it is seen so.
    sides: [Option<Prepared>; 2],
}

impl Baked {
    /// Finds the pieces of a scene; [`Self::light`] lights them.
    pub(crate) fn new(scene: &Scene) -> Self {
        let mut all = Self::default();
        let mut left = MOST_TEXELS;
        for mesh in &scene.meshes {
            let of_mesh = all.add(mesh, &scene.materials[mesh.material], &mut left);
            all.of_mesh.push(of_mesh.unwrap_or(OfMesh::All(NONE)));
        }
        all
    }

    /// Adds a mesh's pieces, unless it has none or too many.
    fn add(&mut self, mesh: &Mesh, material: &Material, left: &mut usize) -> Option<OfMesh> {
        let surface = material.surface.as_ref()?;
        if mesh.tex_coords.is_empty() || mesh.triangles.is_empty() {
            return None;
        }
        let (num_before, left_before) = (self.pieces.len(), *left);
        let num_texels = surface.base().size().iter().product();
        let mut piece_of = |triangle: &[u32; 3]| {
            let frame = flat_frame(mesh, triangle)?;
            let is_same = |p: &Piece| p.material == mesh.material && is_same(&p.frame, &frame);
            if let Some(found) = self.pieces.iter().position(is_same) {
                return Some(found as u32);
            }
            *left = left.checked_sub(num_texels)?;
            self.pieces.push(Piece { material: mesh.material, frame, sides: [None, None] });
            (self.pieces.len() - num_before <= MOST_PIECES).then_some(self.pieces.len() as u32 - 1)
        };
        let Some(each) = mesh.triangles.iter().map(&mut piece_of).collect::<Option<Vec<u32>>>()
        else {
            self.pieces.truncate(num_before);
            *left = left_before;
            return None;
        };
        let is_one = each.iter().all(|piece| *piece == each[0]);
        Some(if is_one { OfMesh::All(each[0]) } else { OfMesh::Each(each) })
    }

    /// Lights the sides of pieces that the scene's camera sees, those that are not lit yet.
    pub(crate) fn light(&mut self, scene: &Scene, prepared: &PreparedScene, has_relief: bool) {
        let mut is_seen = vec![[false; 2]; self.pieces.len()];
        for (m, mesh) in scene.meshes.iter().enumerate() {
            for triangle in 0..mesh.triangles.len() as u32 {
                if let Some((piece, side)) = self.seen(scene, [m as u32, triangle]) {
                    is_seen[piece][side] = true;
                }
            }
        }
        for (piece, is_seen) in self.pieces.iter_mut().zip(is_seen) {
            let Some(unlit) = prepared.of_material(piece.material, has_relief) else { continue };
            for side in 0..2 {
                if !is_seen[side] || piece.sides[side].is_some() {
                    continue;
                }
                let TextureFrame { tangents, normal } = piece.frame;
                let frame =
                    TextureFrame { tangents, normal: if side == 0 { normal } else { -normal } };
                piece.sides[side] = frame.beams(&scene.lights, &scene.sky).map(|beams| {
                    let lit = baked(unlit.surface(), &beams, unlit.field().is_some());
                    unlit.recolored(lit)
                });
            }
        }
    }

    /// All lit surfaces.
    pub(crate) fn surfaces(&self) -> impl Iterator<Item = &Prepared> {
        self.pieces.iter().flat_map(|piece| piece.sides.iter().flatten())
    }

    /// The group of a triangle, by the index of its mesh and in it: 0 where it is not baked.
    pub(crate) fn group(&self, scene: &Scene, triangle: [u32; 2]) -> u32 {
        self.seen(scene, triangle).map_or(0, |(piece, side)| (2 * piece + side) as u32 + 1)
    }

    /// The lit surface of a [group](Self::group).
    pub(crate) fn of_group(&self, group: usize) -> Option<&Prepared> {
        let index = group.checked_sub(1)?;
        self.pieces[index / 2].sides[index % 2].as_ref()
    }

    /// A triangle's piece, and which side the camera sees: 0 for the front.
    fn seen(&self, scene: &Scene, [mesh, triangle]: [u32; 2]) -> Option<(usize, usize)> {
        let piece = match self.of_mesh.get(mesh as usize)? {
            OfMesh::All(piece) => *piece,
            OfMesh::Each(pieces) => pieces[triangle as usize],
        };
        let piece = (piece != NONE).then_some(piece as usize)?;
        let mesh = &scene.meshes[mesh as usize];
        let corner = mesh.positions[mesh.triangles[triangle as usize][0] as usize];
        let to_eye = scene.camera.eye - corner;
        Some((piece, usize::from(self.pieces[piece].frame.normal.dot(to_eye) < 0.0)))
    }
}

/// The frame that all corners of a triangle share.
fn flat_frame(mesh: &Mesh, triangle: &[u32; 3]) -> Option<TextureFrame> {
    let [a, b, c] = triangle.map(|i| TextureFrame {
        tangents: mesh.tangents[i as usize],
        normal: mesh.normals[i as usize].normalize_or(Vec3::Z),
    });
    (is_same(&a, &b) && is_same(&a, &c)).then_some(a)
}

fn is_same(a: &TextureFrame, b: &TextureFrame) -> bool {
    let axes = |frame: &TextureFrame| [frame.tangents[0], frame.tangents[1], frame.normal];
    let close = |(a, b): (Vec3, Vec3)| {
        let difference = (a - b).length_squared();
        difference <= SAME * SAME * a.length_squared().min(b.length_squared())
    };
    axes(a).into_iter().zip(axes(b)).all(close)
}
