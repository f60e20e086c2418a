//! The flat pieces of a scene, each with its surface lit for good.
//!
//! Under suns and a sky all of a flat piece is lit alike, whatever the camera does. So its light is
//! baked into the colours of its surface once (see [`crate::light::BakedLight`]), and frames draw that
//! surface unlit. Pieces of one material that lie in the same directions, such as all triangles of
//! a floor, share one. Curved meshes are lit place by place.

use super::gloss::{PieceGloss, gloss};
use super::ground::LitPiece;
use super::mapped::{layer, texel_finish};
use super::open_sky::{Facing, OpenSky, Plane};
use crate::filter::Prepared;
use crate::light::exact::Occluders;
use crate::light::reflection::Reflectance;
use crate::light::{BakedLight, Gloss, Part, SunlitTexels, TextureFrame};
use crate::scene::{Finish, Material, Mesh, Scene};
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
    sides: [Option<Side>; 2],
    /// How far its corners lie along the normal, the least and the greatest.
    range: [f32; 2],
    /// Where its triangles lie.
    planes: Vec<Plane>,
}

/// A lit side of a piece.
#[derive(Debug)]
struct Side {
    normal: Vec3,
    lit: Prepared,
    /// See [`LitPiece::apart`].
    apart: Vec<Prepared>,
    open_sky: Option<OpenSky>,
    /// See [`LitPiece::gloss`].
    gloss: Vec<PieceGloss>,
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
            let piece = self.pieces.iter().position(is_same);
            let piece = if let Some(piece) = piece {
                piece
            } else {
                *left = left.checked_sub(num_texels)?;
                let range = [f32::INFINITY, f32::NEG_INFINITY];
                let material = mesh.material;
                let (sides, planes) = Default::default();
                self.pieces.push(Piece { material, frame, sides, range, planes });
                self.pieces.len() - 1
            };
            let Piece { frame, range: [least, most], planes, .. } = &mut self.pieces[piece];
            Plane::add(planes, frame.normal, triangle.map(|i| mesh.positions[i as usize]));
            for corner in triangle {
                let along = frame.normal.dot(mesh.positions[*corner as usize]);
                (*least, *most) = (least.min(along), most.max(along));
            }
            (self.pieces.len() - num_before <= MOST_PIECES).then_some(piece as u32)
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

    /// Lights the sides of pieces that the scene's camera sees, those that are not lit yet. `unlit`
    /// gives the surface of a material.
    pub(crate) fn light<'a>(
        &mut self,
        scene: &Scene,
        occluders: impl Fn() -> &'a Occluders,
        (unlit, reflectance): (impl Fn(usize) -> Option<&'a Prepared>, &Reflectance),
    ) {
        let mut is_seen = vec![[false; 2]; self.pieces.len()];
        for (m, mesh) in scene.meshes.iter().enumerate() {
            for triangle in 0..mesh.triangles.len() as u32 {
                if let Some((piece, side)) = self.seen(scene, [m as u32, triangle]) {
                    is_seen[piece][side] = true;
                }
            }
        }
        for (piece, is_seen) in self.pieces.iter_mut().zip(is_seen) {
            let Some(unlit) = unlit(piece.material) else { continue };
            for (side, is_seen) in is_seen.into_iter().enumerate() {
                if !is_seen || piece.sides[side].is_some() {
                    continue;
                }
                piece.sides[side] =
                    Some(piece.light(side, (scene, &occluders), (unlit, reflectance)));
            }
        }
    }

    /// All lit surfaces.
    pub(crate) fn surfaces(&self) -> impl Iterator<Item = &Prepared> {
        let sides = self.pieces.iter().flat_map(|piece| piece.sides.iter().flatten());
        sides.flat_map(|side| std::iter::once(&side.lit).chain(&side.apart))
    }

    /// Whether meshes may throw shadows on a piece.
    pub(crate) fn has_shadows(&self) -> bool {
        let mut sides = self.pieces.iter().flat_map(|piece| piece.sides.iter().flatten());
        sides.any(|side| !side.apart.is_empty())
    }

    /// Whether a mesh, by its index, is not of flat pieces.
    pub(crate) fn is_curved(&self, mesh: usize) -> bool {
        matches!(self.of_mesh.get(mesh), Some(OfMesh::All(NONE)))
    }

    /// The meshes that are not of flat pieces.
    pub(crate) fn curved<'a>(&'a self, scene: &'a Scene) -> impl Iterator<Item = &'a Mesh> {
        let meshes = scene.meshes.iter().zip(&self.of_mesh);
        meshes.filter(|(_, of)| matches!(of, OfMesh::All(NONE))).map(|(mesh, _)| mesh)
    }

    /// The group of a triangle, by the index of its mesh and in it; `None` where it is not baked.
    pub(crate) fn group(&self, scene: &Scene, triangle: [u32; 2]) -> Option<u32> {
        self.seen(scene, triangle).map(|(piece, side)| (2 * piece + side) as u32)
    }

    /// The lit surface of a [group](Self::group).
    pub(crate) fn of_group(&self, group: usize) -> Option<(&Prepared, LitPiece<'_>)> {
        let Side { normal, lit, apart, open_sky, gloss } =
            self.pieces[group / 2].sides[group % 2].as_ref()?;
        Some((lit, LitPiece { normal: *normal, apart, open_sky: open_sky.as_ref(), gloss }))
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
        let to_eye = scene.camera.viewpoint().seen_from(corner);
        Some((piece, usize::from(self.pieces[piece].frame.normal.dot(to_eye) < 0.0)))
    }
}

impl Piece {
    /// Its side, 0 the front, in the scene's light.
    fn light<'a>(
        &self,
        side: usize,
        (scene, occluders): (&Scene, &impl Fn() -> &'a Occluders),
        (unlit, reflectance): (&Prepared, &Reflectance),
    ) -> Side {
        let normal = if side == 0 { self.frame.normal } else { -self.frame.normal };
        let frame = TextureFrame { normal, ..self.frame };
        let material = &scene.materials[self.material];
        let finish = |x, y| texel_finish(material, unlit, [x, y]);
        let shares = |x, y| {
            let Finish { metallic, occlusion, .. } = finish(x, y);
            let diffuse = if material.maps.metallic.is_some() { 1.0 - metallic } else { 1.0 };
            [diffuse, diffuse * occlusion]
        };
        let has_shares = material.maps.metallic.is_some() || material.maps.occlusion.is_some();
        let shares = has_shares.then_some(&shares as &(dyn Fn(_, _) -> _ + Sync));
        let (surface, lights) = (unlit.shared_surface(), (&*scene.lights, &scene.sky));
        let light = BakedLight::new(surface, &frame, lights, shares);
        let near = light.near();
        // A layer under what reflects light is seen through that.
        let layer = (!material.is_matte() && unlit.has_relief()).then(|| {
            let layer = layer(material, unlit, reflectance);
            Gloss::of_layer(&frame, layer, unlit.surface().relief_depth())
        });
        let lit = |part: Part, near: Vec<SunlitTexels>| {
            let lit = match &layer {
                Some(layer) => unlit.glossy(light.layer(part), layer.clone()),
                None => unlit.recolored(light.surface(part)),
            };
            lit.seen_near(near)
        };
        let (mut apart, mut open_sky) = (Vec::new(), None);
        if self.may_be_shaded(side, scene) {
            let sky = near.iter().flatten().next().map(SunlitTexels::of_sky);
            apart.push(lit(Part::Sky, sky.into_iter().collect()));
            for (sun, near) in near.iter().enumerate() {
                let near = near.iter().map(SunlitTexels::of_sun).collect();
                apart.push(lit(Part::Sun(sun), near));
            }
            open_sky = self.open_sky(side, (scene, occluders()), unlit);
        }
        let gloss = if material.is_matte() {
            Vec::new()
        } else {
            gloss(&frame, material, (scene, reflectance), unlit)
        };
        // The sky is seen with the first sun.
        let near = near.into_iter().flatten().enumerate();
        let near = near.map(|(i, near)| if i == 0 { near } else { near.of_sun() }).collect();
        Side { normal, lit: lit(Part::All, near), apart, open_sky, gloss }
    }

    /// What other meshes leave of the sky to that side.
    fn open_sky(
        &self,
        side: usize,
        with: (&Scene, &Occluders),
        unlit: &Prepared,
    ) -> Option<OpenSky> {
        let TextureFrame { tangents: [u, v], normal } = self.frame;
        let down = u.cross(v).length().sqrt() * unlit.surface().relief_depth();
        let is_turned = side == 1;
        let normal = if is_turned { -normal } else { normal };
        OpenSky::new(with, &Facing { normal, is_turned, down }, &self.planes)
    }

    /// Whether a corner of any mesh lies before a part of that side.
    fn may_be_shaded(&self, side: usize, scene: &Scene) -> bool {
        let [least, most] = self.range;
        let rounding = SAME * (least.abs() + most.abs() + most - least);
        let mut corners = scene.meshes.iter().flat_map(|mesh| &mesh.positions);
        let along = |corner: &Vec3| self.frame.normal.dot(*corner);
        corners.any(|corner| match side {
            0 => along(corner) > least + rounding,
            _ => along(corner) < most - rounding,
        })
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
