//! All that a scene is read from, put together.

use super::files::Folder;
use super::gltf;
use super::images::Images;
use super::lines::Source;
use super::model::Model;
use super::mtl::{MtlFiles, MtlMaterial};
use super::obj::{self, locate};
use super::options::{LoadOptions, MaterialOptions};
use super::plan::{Numbers, Plan, Planner};
use super::stage::{LoadStage, Report};
use super::surfaces::Built;
use super::{models, surfaces};
use crate::decode::open_regular;
use crate::error::{Error, Result};
use crate::scene::{Camera, Light, Material, Mesh, Scene, Sky};
use glam::Vec3;
use std::cell::RefCell;
use std::collections::{BTreeSet, HashSet};
use std::io::{BufRead, BufReader};
use std::path::Path;

/// The crease angle of an OBJ file where nothing says otherwise, in degrees.
const CREASE: f32 = 60.0;

/// A scene and what its reader should know of how it was read.
#[derive(Clone, Debug, Default)]
pub struct Loaded {
    /// The scene. Its camera is the file's own or frames the bounding box; its lights are those of
    /// the file, or one that shines over the viewer's left shoulder.
    pub scene: Scene,
    /// What was chosen, such as which image serves as the height map: one line each.
    pub choices: Vec<String>,
    /// What was not supported or missing: one line each.
    pub warnings: Vec<String>,
}

/// Reads an OBJ file with its MTL files and images, or a glTF file with its buffers and images
/// ([`is_gltf`](super::is_gltf) tells them by their names).
///
/// A missing MTL or texture that a file names is a warning, and the plain colour is drawn. Meshes
/// without texture coordinates are drawn in their plain colour too. Normals are made where the file
/// has none, see [`LoadOptions::crease_angle`].
///
/// # Errors
/// Names the file, and the line where one is wrong, or the option or limit that refuses it.
pub fn load(model: &Path, options: &LoadOptions) -> Result<Loaded> {
    load_reporting(model, options, &|_| ())
}

/// [`load`] that tells `report`, from any thread, what it is doing.
///
/// # Errors
/// As [`load`].
pub fn load_reporting(
    model: &Path,
    options: &LoadOptions,
    report: &(dyn Fn(LoadStage) + Sync),
) -> Result<Loaded> {
    open_regular(model)?;
    let folder = Folder::of(model, options.allow_outside);
    if !gltf::is_gltf(model) {
        return load_from(&ObjFile(model), &folder, options, report);
    }
    options.check()?;
    report(LoadStage::Model);
    put_together(gltf::read(model, &folder, options)?, options, report)
}

struct ObjFile<'a>(&'a Path);

impl Source for ObjFile<'_> {
    fn path(&self) -> &Path {
        self.0
    }
    fn reader(&self) -> Result<Box<dyn BufRead + '_>> {
        Ok(Box::new(BufReader::with_capacity(1 << 18, open_regular(self.0)?)))
    }
}

/// [`load_reporting`] from any source of text.
pub(super) fn load_from(
    source: &dyn Source,
    folder: &Folder,
    options: &LoadOptions,
    report: &Report,
) -> Result<Loaded> {
    options.check()?;
    report(LoadStage::Model);
    let mtl = RefCell::new(MtlFiles::new(source.path(), folder));
    let models = obj::read(source, options.max_triangles, &mtl)?;
    let MtlFiles { mut materials, mut warnings, .. } = mtl.into_inner();
    let meshes = models::meshes(models, materials.len());
    if meshes.iter().any(models::has_bad_number) {
        return Err(locate::bad_number(source)
            .unwrap_or_else(|| Error::file(source.path(), "has numbers out of range")));
    }
    models::remark_placements(&materials, &mut warnings);
    let meshes = models::finish(meshes, &materials, options.crease_angle.unwrap_or(CREASE))
        .map_err(|reason| Error::file(source.path(), reason))?;
    if meshes.iter().any(|mesh| mesh.material == materials.len()) {
        materials.push(MtlMaterial { name: "none".into(), ..MtlMaterial::default() });
    }
    check_names(options, materials.iter().map(|material| material.name.as_str()))?;
    let Plans { plans, choices, warnings: of_plans } = plans(&meshes, &materials, folder, options)?;
    warnings.extend(of_plans);
    let materials = materials.iter().zip(&plans).map(|(material, plan)| {
        let own = options.materials.get(&material.name).cloned().unwrap_or_default();
        let numbers = plan.as_ref().map_or_else(Numbers::default, |plan| plan.numbers.clone());
        (plain_material(material, &own.or(&options.all), &numbers), plan.clone())
    });
    let materials = materials.collect();
    let (images, camera, lights) = (Images::default(), None, Vec::new());
    let model = Model { meshes, materials, images, camera, lights, choices, warnings };
    put_together(model, options, report)
}

/// Reads the images of a model and makes a scene of it.
pub(super) fn put_together(model: Model, options: &LoadOptions, report: &Report) -> Result<Loaded> {
    let Model { meshes, materials, images, camera, lights, choices, mut warnings } = model;
    check_names(options, materials.iter().map(|(material, _)| material.name.as_str()))?;
    let plans = materials.iter().filter_map(|(_, plan)| plan.clone()).collect();
    let surfaces = surfaces::build(&plans, &images, options, report)?;
    let materials = materials.into_iter().map(|(material, plan)| {
        let built = plan.and_then(|plan| surfaces.get(&plan)).cloned();
        let Some(Built { surface, maps, cut_out }) = built else { return material };
        Material { surface: Some(surface), maps, cut_out, ..material }
    });
    let mut scene = Scene { meshes, materials: materials.collect(), ..Scene::default() };
    frame(&mut scene, options.aspect);
    scene.camera = camera.unwrap_or(scene.camera);
    if !lights.is_empty() {
        scene.lights = lights;
    }
    scene.validate()?;
    let mut seen = HashSet::new();
    warnings.retain(|warning| seen.insert(warning.clone()));
    Ok(Loaded { scene, choices, warnings })
}

/// Refuses options for a material that is not there, which would be lost in silence.
fn check_names<'a>(options: &LoadOptions, materials: impl Iterator<Item = &'a str>) -> Result<()> {
    let names: Vec<&str> = materials.collect();
    let is_there = |name: &String| names.contains(&name.as_str());
    let Some(missing) = options.materials.keys().find(|name| !is_there(name)) else {
        return Ok(());
    };
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

fn plans(
    meshes: &[Mesh],
    materials: &[MtlMaterial],
    folder: &Folder,
    options: &LoadOptions,
) -> Result<Plans> {
    let textured: BTreeSet<usize> =
        meshes.iter().filter(|m| !m.tex_coords.is_empty()).map(|m| m.material).collect();
    let used: Vec<&MtlMaterial> = textured.iter().map(|&i| &materials[i]).collect();
    let mut planner = Planner::new(options, folder, &used)?;
    let mut plans = vec![None; materials.len()];
    for &i in &textured {
        plans[i] = planner.plan(&materials[i])?;
    }
    let Planner { choices, warnings, .. } = planner;
    Ok(Plans { plans, choices, warnings })
}

/// A material without its surface and textures. A texture takes the place of the file's number of metal or
/// roughness; what it sends out is multiplied with `Ke`, where that is not black.
fn plain_material(from: &MtlMaterial, given: &MaterialOptions, maps: &Numbers) -> Material {
    // Beyond these bounds a number is a mistake in the file that need not stop the picture.
    let color = |c: [f32; 3]| Vec3::from_array(c).clamp(Vec3::ZERO, Vec3::splat(1e6));
    let unit = |number: f32| number.clamp(0.0, 1.0);
    let fallback = Material::default();
    let of_map = |map: &Option<_>| map.as_ref().map(|_| 1.0);
    let roughness = from.roughness.map(unit).or_else(|| roughness_of_highlight(from));
    let roughness = of_map(&maps.roughness).or(roughness);
    let metallic = of_map(&maps.metallic).or(from.metallic.map(unit));
    let emissive = from.emissive.map(color).filter(|color| *color != Vec3::ZERO);
    let emissive = emissive.or(maps.emissive.as_ref().map(|_| Vec3::ONE));
    let reflects = roughness.or(given.roughness).or(metallic).is_some();
    Material {
        name: from.name.clone(),
        base_color: given.base_color.or(from.diffuse.map(color)).unwrap_or(fallback.base_color),
        specular: given.specular.unwrap_or(f32::from(u8::from(reflects))),
        metallic: given.metallic.or(metallic).unwrap_or(fallback.metallic),
        roughness: given.roughness.or(roughness).unwrap_or(fallback.roughness),
        emissive: given.emissive.or(emissive).unwrap_or(fallback.emissive),
        ..fallback
    }
}

/// The roughness whose lobe is as wide as a Blinn-Phong highlight: `alpha^2 = 2 / (Ns + 2)`. Of `Ks`
/// it matters only whether there is a highlight at all: how strong it is follows from the material.
fn roughness_of_highlight(from: &MtlMaterial) -> Option<f32> {
    let is_seen = from.specular.is_some_and(|specular| specular.iter().any(|c| *c > 0.0));
    // Exporters write `Ns 0` for a surface without a highlight.
    let exponent = from.shininess.filter(|exponent| is_seen && *exponent > 0.0)?.min(1e6);
    Some((2.0 / (exponent + 2.0)).sqrt().sqrt())
}

/// A camera that sees all of the scene, and light from over its left shoulder.
fn frame(scene: &mut Scene, aspect: f32) {
    let points = || scene.meshes.iter().flat_map(|mesh| &mesh.positions);
    let (min, max) = points()
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), p| (min.min(*p), max.max(*p)));
    scene.camera = Camera::framing(min, max, aspect);
    let [right, up, forward] = scene.camera.axes();
    let to_light = up * 0.8 - right * 0.6 - forward * 0.6;
    scene.lights = vec![Light::sun(to_light, Vec3::splat(0.85))];
    scene.sky = Sky::Color(Vec3::splat(0.15));
}
