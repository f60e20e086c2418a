//! glTF 2.0: a `.gltf` file with its buffers and images, or a `.glb` that has them within.
//!
//! `document` reads the files, `accessor` numbers out of buffers, `nodes` walks the tree,
//! `primitives` makes triangles of what stands in it, `materials` finds colours and images, and
//! `tangents` the frames of normal maps. JSON types are those of the `gltf` crate; its own readers
//! trust the file, so that none of them is used.

mod accessor;
mod document;
mod materials;
mod nodes;
mod primitives;
mod tangents;
mod uri;

use super::files::Folder;
use super::given::{self, Given};
use super::images::Images;
use super::model::Model;
use super::normals;
use super::options::{LoadOptions, MaterialOptions, NormalY};
use super::plan::{DEFAULT_DEPTH, Kind, Map, Numbers, Plan, height_kind};
use crate::decode::Channel;
use crate::error::{Error, Result};
use crate::scene::{Camera, Material, Mesh};
use crate::texture::Wrap;
use document::{Document, Reasoned};
use glam::{Vec2, Vec3};
use materials::{GltfMaterial, Height, Picture, TextureRef};
use nodes::{Instance, Placed};
use primitives::Piece;
use rayon::prelude::*;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::{Path, PathBuf};
use tangents::with_frames;

/// The crease angle that glTF demands where a file has no normals: flat faces.
const FLAT: f32 = 0.0;

/// Whether a file's name says that it is glTF.
pub fn is_gltf(path: &Path) -> bool {
    let is = |known: &str| path.extension().is_some_and(|ext| ext.eq_ignore_ascii_case(known));
    is("gltf") || is("glb")
}

/// Reads a file with its buffers; images are found, but not read.
///
/// # Errors
/// Names the file and what is wrong with it, or the option or limit that refuses it.
pub(super) fn read(path: &Path, folder: &Folder, options: &LoadOptions) -> Result<Model> {
    model(Document::open(path, folder.clone(), options)?, options)
}

/// [`read`] of a file in memory.
pub(super) fn read_bytes(bytes: &[u8], folder: &Folder, options: &LoadOptions) -> Result<Model> {
    let path = Path::new("scene.gltf");
    model(Document::from_bytes(bytes.to_vec(), path, folder.clone(), options)?, options)
}

fn model(mut document: Document, options: &LoadOptions) -> Result<Model> {
    let path = document.path.clone();
    let refuse = |reason: String| Error::file(&path, reason);
    let materials = document.materials().map_err(refuse)?;
    let placed = document.place().map_err(refuse)?;
    name_unmoved(&mut document, &placed);
    let mut pieces = pieces(&mut document, &placed, &materials, options)?;
    let given = Given::new(options)?;
    let is_none = |material: &GltfMaterial| {
        let is_cut = given.of(&material.plain.name).cut_out != Some(false);
        let is_thin = material.cut.is_some_and(|[opacity, cut]| opacity < cut);
        material.albedo.is_none() && is_cut && is_thin
    };
    let num = pieces.len();
    pieces.retain(|piece| !is_none(&materials[piece.mesh.material]));
    if pieces.len() < num {
        document.warn("has materials of little opacity; left out");
    }
    if pieces.is_empty() {
        return Err(Error::file(&path, "has no triangles"));
    }
    let mut planner = Planner { document, images: Images::default(), given, options };
    let choices = given::choices(options);
    let plans = planner.plans(&materials, &pieces)?;
    let Planner { document, images, .. } = planner;
    let meshes = meshes(pieces, &plans, options).map_err(refuse)?;
    let camera = placed.camera.map(|camera| aimed(camera, &meshes));
    let given = |material: GltfMaterial| {
        let own = options.materials.get(&material.plain.name).cloned().unwrap_or_default();
        let plain = overridden(material.plain, &own.or(&options.all));
        if material.is_unlit && options.keep_normals { unlit(plain) } else { plain }
    };
    let materials = materials.into_iter().map(given).zip(plans).collect();
    let warnings = document.warnings;
    Ok(Model { meshes, materials, images, camera, lights: placed.lights, choices, warnings })
}

/// Names what would move the vertices of what is drawn.
fn name_unmoved(document: &mut Document, placed: &Placed) {
    let root = &document.root;
    let of_meshes = |instance: &Instance| {
        let mesh = root.get(instance.mesh);
        mesh.is_some_and(|mesh| mesh.primitives.iter().any(|primitive| primitive.targets.is_some()))
    };
    let has_skin =
        |instance: &Instance| root.get(instance.node).is_some_and(|node| node.skin.is_some());
    let found = [
        ("skins", placed.instances.iter().any(has_skin)),
        ("morph targets", placed.instances.iter().any(of_meshes)),
        ("animations", !root.animations.is_empty()),
    ];
    let found: Vec<_> = found.into_iter().filter(|(_, is)| *is).map(|(what, _)| what).collect();
    if !found.is_empty() {
        let text = format!("{} are not supported; meshes stand still", found.join(", "));
        document.warn(text);
    }
}

/// The triangles of all instances, within the limits.
fn pieces(
    document: &mut Document,
    placed: &Placed,
    materials: &[GltfMaterial],
    options: &LoadOptions,
) -> Result<Vec<Piece>> {
    let placements: Vec<_> = materials.iter().map(GltfMaterial::placement).collect();
    // Instances share what is read of a mesh.
    let mut of_meshes: HashMap<usize, Vec<Piece>> = HashMap::new();
    let mut pieces = Vec::new();
    let (mut num_triangles, mut num_vertices) = (0, 0);
    let path = document.path.clone();
    for Instance { mesh, node, to_world } in &placed.instances {
        let refuse = |reason| Error::file(&path, reason);
        let of_mesh = match of_meshes.entry(mesh.value()) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => new.insert(document.pieces(*mesh, &placements).map_err(refuse)?),
        };
        let name = document.root.get(*node).and_then(|node| node.name.as_ref());
        for piece in of_mesh {
            let mut piece = piece
                .placed(to_world)
                .map_err(|reason| refuse(format!("mesh {mesh} of node {node} {reason}")))?;
            piece.mesh.name = name.unwrap_or(&piece.mesh.name).clone();
            num_triangles += piece.mesh.triangles.len() as u64;
            num_vertices += piece.mesh.positions.len() as u64;
            for (num, what) in [(num_triangles, "triangles"), (num_vertices, "vertices")] {
                if num > options.max_triangles {
                    let reason = format!("more than {} {what}", options.max_triangles);
                    return Err(Error::limit(&path, reason, "max_triangles"));
                }
            }
            pieces.push(piece);
        }
    }
    Ok(pieces)
}

/// Makes missing normals and the frames of textures.
fn meshes(
    pieces: Vec<Piece>,
    plans: &[Option<Plan>],
    options: &LoadOptions,
) -> Reasoned<Vec<Mesh>> {
    let (mut meshes, tangents): (Vec<_>, Vec<_>) =
        pieces.into_iter().map(|piece| (piece.mesh, piece.tangents)).unzip();
    normals::make(&mut meshes, options.crease_angle.unwrap_or(FLAT))?;
    let pieces = meshes.into_par_iter().zip(tangents);
    Ok(pieces
        .map(|(mesh, tangents)| {
            let is_mapped = plans[mesh.material].as_ref().is_some_and(Plan::has_only_normals);
            with_frames(Piece { mesh, tangents }, is_mapped)
        })
        .collect())
}

/// A camera whose target lies as far away as the middle of what is there.
fn aimed(camera: Camera, meshes: &[Mesh]) -> Camera {
    let points = meshes.iter().flat_map(|mesh| &mesh.positions);
    let (min, max) = points
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), p| (min.min(*p), max.max(*p)));
    let forward = camera.axes()[2];
    let least = (camera.target - camera.eye).length();
    let distance = ((min + max) * 0.5 - camera.eye).dot(forward).max(least);
    Camera { target: camera.eye + forward * distance, ..camera }
}

/// Decides what the surfaces of materials are made from.
struct Planner<'a> {
    document: Document,
    images: Images,
    given: Given<'a>,
    options: &'a LoadOptions,
}

impl Planner<'_> {
    /// The maps of each material that is drawn with texture coordinates.
    fn plans(&mut self, materials: &[GltfMaterial], pieces: &[Piece]) -> Result<Vec<Option<Plan>>> {
        let mut leaves = vec![None; materials.len()];
        for Piece { mesh, .. } in pieces.iter().filter(|piece| !piece.mesh.tex_coords.is_empty()) {
            let [u, v] = leaves[mesh.material].get_or_insert([false; 2]);
            let [of_u, of_v] = leaves_texture(&mesh.tex_coords);
            (*u, *v) = (*u || of_u, *v || of_v);
        }
        let of_one = materials.iter().zip(leaves);
        of_one
            .map(|(material, leaves)| leaves.map_or(Ok(None), |leaves| self.plan(material, leaves)))
            .collect()
    }

    fn plan(&mut self, material: &GltfMaterial, leaves: [bool; 2]) -> Result<Option<Plan>> {
        let given = self.given.of(&material.plain.name).clone();
        let mut pictures = Pictures { planner: self, wraps: None };
        let color = |path| Map { path, kind: Kind::Color };
        let albedo = pictures.path(&given.albedo, &material.albedo)?.map(color);
        let height = pictures.height(&given, material)?;
        let mut maps = [albedo, height, None];
        let mut numbers = Numbers::default();
        let cut = material.cut.filter(|_| given.cut_out != Some(false));
        let opacity = maps[0].as_ref().zip(cut);
        let opacity = opacity.map(|(albedo, [factor, threshold])| Map {
            path: albedo.path.clone(),
            kind: Kind::Opacity {
                channel: Some(Channel::Matte),
                range: [0.0, factor].map(f32::to_bits),
                threshold: threshold.to_bits(),
                may_be_unused: false,
            },
        });
        if pictures.planner.options.keep_normals {
            if material.is_unlit {
                // It sends out its colour, and does nothing with light.
                numbers.emissive = maps[0].take();
            } else {
                maps[2] = pictures.normal(&given, material)?;
                numbers = pictures.numbers(&given, material)?;
            }
        }
        numbers.opacity = opacity;
        let wraps = pictures.wraps;
        let wrap = given.wrap.unwrap_or_else(|| self.wrap(material, wraps, leaves));
        let depth = given.relief_depth.or(material.relief_depth).unwrap_or(DEFAULT_DEPTH);
        let plan = Plan::new(maps, numbers, wrap, depth);
        let has_maps = plan.maps().next().is_some();
        Ok(has_maps.then_some(plan))
    }

    /// One wrap for both directions: that of the direction in which the mesh leaves the texture.
    fn wrap(
        &mut self,
        material: &GltfMaterial,
        wraps: Option<[Wrap; 2]>,
        leaves: [bool; 2],
    ) -> Wrap {
        let [along_u, along_v] = wraps.unwrap_or_default();
        if along_u != along_v && leaves == [true; 2] {
            let name = material.plain.name.escape_debug();
            self.document
                .warn(format_args!("material '{name}': its texture wraps as along u along v, too"));
        }
        if leaves[0] { along_u } else { along_v }
    }
}

/// Finds the images of a material, and how the first of them wraps.
struct Pictures<'a, 'b> {
    planner: &'a mut Planner<'b>,
    wraps: Option<[Wrap; 2]>,
}

impl Pictures<'_, '_> {
    /// The image that the caller gives, or that of the file.
    fn path(
        &mut self,
        given: &Option<PathBuf>,
        texture: &Option<TextureRef>,
    ) -> Result<Option<PathBuf>> {
        let (None, Some(texture)) = (given, texture) else { return Ok(given.clone()) };
        let Planner { document, images, .. } = &mut *self.planner;
        let found = document.picture(texture.index, images)?;
        Ok(found.map(|Picture { path, wraps }| {
            self.wraps.get_or_insert(wraps);
            path
        }))
    }

    fn height(&mut self, given: &MaterialOptions, material: &GltfMaterial) -> Result<Option<Map>> {
        let path = match &material.height {
            Some(Height::File(name)) if given.height.is_none() => {
                self.planner.document.file(name)?
            }
            Some(Height::Texture(texture)) => self.path(&given.height, &Some(texture.clone()))?,
            _ => given.height.clone(),
        };
        let sense = given.height_sense.unwrap_or_default();
        let kind = height_kind(sense, None, [0.0, 1.0], false);
        Ok(path.map(|path| Map { path, kind }))
    }

    fn normal(&mut self, given: &MaterialOptions, material: &GltfMaterial) -> Result<Option<Map>> {
        let strength = if given.normal.is_some() { 1.0 } else { material.normal_scale };
        let is_green_down = given.normal_y == Some(NormalY::Down);
        let kind = Kind::Normal { strength: strength.to_bits(), is_green_down };
        let path = self.path(&given.normal, &material.normal)?;
        Ok(path.map(|path| Map { path, kind }))
    }

    /// Textures of numbers; one that the caller gives is gray.
    fn numbers(&mut self, given: &MaterialOptions, material: &GltfMaterial) -> Result<Numbers> {
        let strength = material.occlusion_strength;
        let of_occlusion = [1.0 - strength, strength];
        let mut gray = |given: &Option<PathBuf>, texture, channel, range: [f32; 2]| {
            let (channel, range) =
                if given.is_some() { (None, [0.0, 1.0]) } else { (Some(channel), range) };
            let kind = Kind::Gray { channel, range: range.map(f32::to_bits) };
            let path = self.path(given, texture)?;
            Ok::<_, Error>(path.map(|path| Map { path, kind }))
        };
        let metal_rough = &material.metal_rough;
        let (metallic, roughness) = (&given.metallic_map, &given.roughness_map);
        let metallic = gray(metallic, metal_rough, Channel::Blue, [0.0, 1.0])?;
        let roughness = gray(roughness, metal_rough, Channel::Green, [0.0, 1.0])?;
        let occlusion = (&given.occlusion_map, &material.occlusion);
        let occlusion = gray(occlusion.0, occlusion.1, Channel::Red, of_occlusion)?;
        let emissive = self.path(&given.emissive_map, &material.emissive)?;
        let emissive = emissive.map(|path| Map { path, kind: Kind::Color });
        Ok(Numbers { metallic, roughness, occlusion, emissive, opacity: None })
    }
}

/// Whether coordinates lie beyond the texture's edges, along u and along v.
fn leaves_texture(tex_coords: &[Vec2]) -> [bool; 2] {
    // Rounding may place what lies on an edge beyond it.
    const SLACK: f32 = 1e-3;
    let beyond = |c: f32| !(-SLACK..=1.0 + SLACK).contains(&c);
    tex_coords.iter().fold([false; 2], |[u, v], at| [u || beyond(at.x), v || beyond(at.y)])
}

/// A material with what the caller says of it.
fn overridden(plain: Material, given: &MaterialOptions) -> Material {
    Material {
        base_color: given.base_color.unwrap_or(plain.base_color),
        specular: given.specular.unwrap_or(plain.specular),
        metallic: given.metallic.unwrap_or(plain.metallic),
        roughness: given.roughness.unwrap_or(plain.roughness),
        emissive: given.emissive.unwrap_or(plain.emissive),
        ..plain
    }
}

/// A material that shows its colour whatever the light.
fn unlit(plain: Material) -> Material {
    let (name, emissive) = (plain.name, plain.base_color);
    Material { name, base_color: Vec3::ZERO, emissive, ..Material::default() }
}
