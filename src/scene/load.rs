//! OBJ, MTL and images to a validated scene.
//!
//! `lines` cleans the text for tobj, `obj` and `mtl` read it, `plan` decides which image serves as what, `decode` and
//! `surfaces` make the textures, and [`load`] puts the scene together. Files are not trusted: every limit is a field of
//! [`LoadOptions`], and a panic of a decoder becomes an error.

use super::files::{self, Folder};
use super::mtl::{MtlFiles, MtlMaterial};
use super::obj::{self, Source};
use super::plan::{Plan, Planner};
use super::stage::{LoadStage, Report};
use super::{Camera, Light, Material, Mesh, Scene, locate, models, surfaces};
use crate::error::{Error, Result};
use crate::texture::Wrap;
use glam::Vec3;
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

/// Which end of a height map's range is high.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HeightSense {
    /// White lies on the polygon.
    #[default]
    WhiteHigh,
    /// White is deepest (a depth map).
    WhiteDeep,
}

/// Where a normal map's green points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NormalY {
    /// Upwards in the image, as OpenGL, glTF and Blender have it.
    #[default]
    Up,
    /// Downwards in the image, as DirectX and Unreal have it.
    Down,
}

/// What the caller says of materials in place of their file. `None`, the default, leaves it to the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MaterialOptions {
    /// Colour map for materials with texture coordinates.
    pub albedo: Option<PathBuf>,
    /// Height map for materials with texture coordinates.
    pub height: Option<PathBuf>,
    /// Normal map for materials with texture coordinates.
    pub normal: Option<PathBuf>,
    /// Which end of the height map is high; `None`: white.
    pub height_sense: Option<HeightSense>,
    /// Relief depth in texture repeats, 0 to 1; `None`: `-bm` of the height map in the MTL, else 0.05.
    pub relief_depth: Option<f32>,
    /// Where the normal map's green points; `None`: up.
    pub normal_y: Option<NormalY>,
    /// What lies beyond a texture's edges; `None`: clamp where the MTL says `-clamp on`, else repeat.
    pub wrap: Option<Wrap>,
    /// Diffuse colour, linear RGB, 0 to 1e6; `None`: `Kd`, else 1.
    pub diffuse: Option<Vec3>,
    /// Colour of highlights, linear RGB, 0 to 1e6; `None`: `Ks`, else 0.
    pub specular: Option<Vec3>,
    /// Blinn-Phong exponent, 0 to 1e4; `None`: `Ns`, else 32.
    pub shininess: Option<f32>,
}

impl MaterialOptions {
    /// These options, and those of `other` where these say nothing.
    #[must_use]
    pub fn or(self, other: &Self) -> Self {
        Self {
            albedo: self.albedo.or_else(|| other.albedo.clone()),
            height: self.height.or_else(|| other.height.clone()),
            normal: self.normal.or_else(|| other.normal.clone()),
            height_sense: self.height_sense.or(other.height_sense),
            relief_depth: self.relief_depth.or(other.relief_depth),
            normal_y: self.normal_y.or(other.normal_y),
            wrap: self.wrap.or(other.wrap),
            diffuse: self.diffuse.or(other.diffuse),
            specular: self.specular.or(other.specular),
            shininess: self.shininess.or(other.shininess),
        }
    }
}

/// How [`load`] reads a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadOptions {
    /// What is said of all materials. Default: nothing.
    pub all: MaterialOptions,
    /// What is said of single materials, by their names, before what is said of all. Default: nothing.
    pub materials: BTreeMap<String, MaterialOptions>,
    /// Whether surfaces keep normals, which only lighting needs. Default: `false`.
    pub keep_normals: bool,
    /// Whether files that lie outside the OBJ's folder, also by a link, may be read when a material names them.
    /// Files that the caller names may lie anywhere. Default: `false`.
    pub allow_outside: bool,
    /// Most texels a side of an image, 1 to 32768. Default: 32768.
    pub max_image_side: u32,
    /// Most memory, in MiB, that all textures may take together while they are decoded and packed, by an estimate from
    /// the heads of the files: about 60 bytes a texel. Default: 1024, room for one material of 4096 x 4096 texels.
    pub max_image_mib: u32,
    /// Most triangles, and most `v`, `vt` and `vn` lines each. Default: 50 million.
    pub max_triangles: u64,
    /// Most texture files. Default: 1024.
    pub max_textures: u32,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self {
            all: MaterialOptions::default(),
            materials: BTreeMap::new(),
            keep_normals: false,
            allow_outside: false,
            max_image_side: 32768,
            max_image_mib: 1024,
            max_triangles: 50_000_000,
            max_textures: 1024,
        }
    }
}

/// A scene and what its reader should know of how it was read.
#[derive(Clone, Debug, Default)]
pub struct Loaded {
    /// The scene. Its camera frames the bounding box; one light shines over the viewer's left shoulder.
    pub scene: Scene,
    /// What was chosen, such as which image serves as the height map: one line each.
    pub choices: Vec<String>,
    /// What was not supported or missing: one line each.
    pub warnings: Vec<String>,
}

/// Reads an OBJ file with its MTL files and images.
///
/// A missing MTL or texture that a file names is a warning, and the plain colour is drawn. Meshes without texture
/// coordinates are drawn in their plain colour too. Normals are made where the file has none.
///
/// # Errors
/// Names the file, and the line where one is wrong, or the option or limit that refuses it.
pub fn load(obj: &Path, options: &LoadOptions) -> Result<Loaded> {
    load_reporting(obj, options, &|_| ())
}

/// [`load`] that tells `report`, from any thread, what it is doing.
///
/// # Errors
/// As [`load`].
pub fn load_reporting(obj: &Path, options: &LoadOptions, report: &(dyn Fn(LoadStage) + Sync)) -> Result<Loaded> {
    files::open(obj)?;
    load_from(&ObjFile(obj), &Folder::of(obj, options.allow_outside), options, report)
}

struct ObjFile<'a>(&'a Path);

impl Source for ObjFile<'_> {
    fn path(&self) -> &Path {
        self.0
    }
    fn reader(&self) -> Result<Box<dyn BufRead + '_>> {
        Ok(Box::new(BufReader::with_capacity(1 << 18, files::open(self.0)?)))
    }
}

/// [`load_reporting`] from any source of text.
pub(super) fn load_from(
    source: &dyn Source,
    folder: &Folder,
    options: &LoadOptions,
    report: &Report,
) -> Result<Loaded> {
    let mut depths = options.materials.values().chain([&options.all]).map(|given| given.relief_depth);
    if depths.any(|depth| depth.is_some_and(|depth| !(0.0..=1.0).contains(&depth))) {
        return Err(Error::setting("relief_depth", "must be within 0 to 1 texture repeats"));
    }
    report(LoadStage::Model);
    let mtl = RefCell::new(MtlFiles::new(source.path(), folder));
    let models = obj::read(source, options.max_triangles, &mtl)?;
    let MtlFiles { mut materials, mut warnings, .. } = mtl.into_inner();
    let meshes = models::meshes(models, materials.len());
    if meshes.iter().any(models::has_bad_number) {
        return Err(
            locate::bad_number(source).unwrap_or_else(|| Error::file(source.path(), "has numbers out of range"))
        );
    }
    models::remark_placements(&materials, &mut warnings);
    let meshes = models::finish(meshes, &materials).map_err(|reason| Error::file(source.path(), reason))?;
    if meshes.iter().any(|mesh| mesh.material == materials.len()) {
        materials.push(MtlMaterial { name: "none".into(), ..MtlMaterial::default() });
    }
    check_names(options, &materials)?;
    let plans = plans(&meshes, &materials, folder, options)?;
    warnings.extend(plans.warnings);
    let surfaces = surfaces::build(&plans.plans.iter().flatten().cloned().collect(), options, report)?;
    let materials = materials.iter().zip(&plans.plans).map(|(material, plan)| {
        let surface = plan.as_ref().and_then(|plan| surfaces.get(plan)).cloned();
        let own = options.materials.get(&material.name).cloned().unwrap_or_default();
        Material { surface, ..plain_material(material, &own.or(&options.all)) }
    });
    let mut scene = Scene { meshes, materials: materials.collect(), ..Scene::default() };
    frame(&mut scene);
    scene.validate()?;
    let mut seen = HashSet::new();
    warnings.retain(|warning| seen.insert(warning.clone()));
    Ok(Loaded { scene, choices: plans.choices, warnings })
}

/// Refuses options for a material that is not there, which would be lost in silence.
fn check_names(options: &LoadOptions, materials: &[MtlMaterial]) -> Result<()> {
    let is_there = |name: &String| materials.iter().any(|material| material.name == *name);
    let Some(missing) = options.materials.keys().find(|name| !is_there(name)) else { return Ok(()) };
    let names: Vec<&str> = materials.iter().map(|material| material.name.as_str()).collect();
    let reason = format!("is not there; the model's materials are {}", names.join(", "));
    Err(Error::scene(format!("material {missing}"), reason))
}

/// What the surfaces are made from.
struct Plans {
    /// Of each material that has texture coordinates and maps.
    plans: Vec<Option<Plan>>,
    choices: Vec<String>,
    warnings: Vec<String>,
}

fn plans(meshes: &[Mesh], materials: &[MtlMaterial], folder: &Folder, options: &LoadOptions) -> Result<Plans> {
    let textured: BTreeSet<usize> = meshes.iter().filter(|m| !m.tex_coords.is_empty()).map(|m| m.material).collect();
    let used: Vec<&MtlMaterial> = textured.iter().map(|&i| &materials[i]).collect();
    let mut planner = Planner::new(options, folder, &used)?;
    let mut plans = vec![None; materials.len()];
    for &i in &textured {
        plans[i] = planner.plan(&materials[i])?;
    }
    let Planner { choices, warnings, .. } = planner;
    Ok(Plans { plans, choices, warnings })
}

fn plain_material(from: &MtlMaterial, given: &MaterialOptions) -> Material {
    // Beyond these bounds a colour or exponent is a mistake in the file that need not stop the picture.
    let color = |c: [f32; 3]| Vec3::from_array(c).clamp(Vec3::ZERO, Vec3::splat(1e6));
    let exponent = |exponent: f32| exponent.clamp(0.0, 1e4);
    let fallback = Material::default();
    // Exporters write `Ns 0` for a surface without a highlight; taken by the letter it is one of no end.
    let specular = from.specular.filter(|_| from.shininess != Some(0.0));
    Material {
        name: from.name.clone(),
        diffuse: given.diffuse.or(from.diffuse.map(color)).unwrap_or(fallback.diffuse),
        specular: given.specular.or(specular.map(color)).unwrap_or(fallback.specular),
        shininess: given.shininess.or(from.shininess.map(exponent)).unwrap_or(fallback.shininess),
        surface: None,
    }
}

/// A camera that sees all of the scene, and light from over its left shoulder.
fn frame(scene: &mut Scene) {
    let points = || scene.meshes.iter().flat_map(|mesh| &mesh.positions);
    let (min, max) = points().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), p| (min.min(*p), max.max(*p)));
    scene.camera = Camera::framing(min, max);
    let [right, up, forward] = scene.camera.axes();
    let to_light = up * 0.8 - right * 0.6 - forward * 0.6;
    scene.lights = vec![Light::Directional { to_light, intensity: Vec3::splat(0.85) }];
    scene.ambient = Vec3::splat(0.15);
}
