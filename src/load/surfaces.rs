//! Planned maps to shared surfaces.
//!
//! Input: a [`Plan`] for every material. Every image file is decoded once, in parallel, and every
//! different plan becomes one [`Surface`], small ones in parallel too. What all of that needs is
//! estimated from the heads of the files before any is decoded.

use super::images::Images;
use super::options::LoadOptions;
use super::plan::{Kind, Map, Numbers, Plan, WRAPS};
use super::stage::{Counter, LoadStage, Report};
use crate::decode::{ImageInfo, Samples};
use crate::error::{Error, Result};
use crate::scene::{CutOut, MaterialMaps};
use crate::texture::{
    ColorImage, GrayImage, HeightImage, NormalImage, Surface, SurfaceMaps, Texture,
};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

/// Bytes of a texel in all levels, each also transposed: two words, a third for normals, 4/3 for
/// the smaller levels.
const STORED_BYTES: u64 = 22;
const STORED_BYTES_WITH_NORMALS: u64 = 32;
/// Bytes of a texel while its surface is built, beyond its maps and what is stored in the end:
/// copies of maps that another surface uses too.
const BUILD_BYTES: u64 = 8;
/// Texels of surfaces that are built at once; a larger surface is built alone, by all threads.
/// Counted in texels, not threads, so that what is refused does not depend on the machine.
const AT_ONCE: u64 = 1 << 23;

#[derive(Clone)]
enum MapImage {
    Color(ColorImage),
    Height(HeightImage),
    Normal(NormalImage),
    Gray(GrayImage),
}

/// What a plan becomes.
#[derive(Clone, Debug)]
pub(super) struct Built {
    pub(super) surface: Arc<Surface>,
    pub(super) maps: MaterialMaps,
    pub(super) cut_out: Option<CutOut>,
}

/// Textures of materials' numbers; materials share those of one map and index into [`WRAPS`].
type Textures = BTreeMap<(Map, usize), Arc<Texture>>;

/// The surface of each plan, and its textures; equal plans share one.
///
/// # Errors
/// Names the image that cannot be read or the limit that is exceeded.
pub(super) fn build(
    plans: &BTreeSet<Plan>,
    images: &Images,
    options: &LoadOptions,
    report: &Report,
) -> Result<BTreeMap<Plan, Built>> {
    let files = kinds_by_file(plans);
    options.check_num_textures(files.len())?;
    let limits = options.image_limits();
    let paths: Vec<&Path> = files.keys().copied().collect();
    let infos: Vec<_> = paths.par_iter().map(|path| images.probe(path, limits)).collect();
    let infos: Vec<ImageInfo> = infos.into_iter().collect::<Result<_>>()?;
    let infos = paths.iter().copied().zip(infos).collect();
    check_memory(plans, &infos, options)?;
    let counter = Counter::new(files.len(), |done, num| LoadStage::Images { done, num }, report);
    let decode_all = |(path, kinds): (&&Path, &BTreeSet<&Kind>)| {
        let samples = images.samples(path, limits);
        samples.map(|samples| maps_of(path, kinds, &samples)).inspect(|_| counter.add_one())
    };
    let decoded: Vec<_> = files.par_iter().map(decode_all).collect();
    let mut maps = BTreeMap::new();
    for of_file in decoded {
        maps.extend(of_file?);
    }
    let textures = textures(plans, &mut maps)?;
    let counter = Counter::new(plans.len(), |done, num| LoadStage::Pyramids { done, num }, report);
    let mut left: Vec<&Plan> = plans.iter().rev().collect();
    let mut surfaces = BTreeMap::new();
    while !left.is_empty() {
        let mut batch = Vec::new();
        let mut num_texels = 0;
        while let Some(plan) = left.pop_if(|plan| {
            num_texels += plan_texels(plan, &infos);
            batch.is_empty() || num_texels <= AT_ONCE
        }) {
            // The last plan that uses a map takes it, so that two copies exist as briefly as
            // possible.
            let is_used_later =
                |map: &Map| left.iter().any(|plan| plan.surface_maps().any(|other| other == map));
            batch.push((plan, surface_maps(plan, &mut maps, is_used_later, options.keep_normals)));
        }
        let built = batch.into_par_iter().map(|(plan, maps)| {
            let maps = SurfaceMaps { least_size: least_size(plan, &infos), ..maps };
            let surface = Arc::new(Surface::new(maps)?);
            counter.add_one();
            let maps = material_maps(plan, &textures);
            Ok((plan.clone(), Built { surface, maps, cut_out: cut_out(plan, &textures) }))
        });
        // The first refusal in the order of the plans, whichever thread is first.
        let built: Vec<Result<_>> = built.collect();
        for surface in built {
            surfaces.extend([surface?]);
        }
    }
    Ok(surfaces)
}

/// The textures of the plans' numbers; their images are not needed any more.
fn textures(plans: &BTreeSet<Plan>, images: &mut BTreeMap<Map, MapImage>) -> Result<Textures> {
    let wanted: BTreeSet<_> = plans
        .iter()
        .flat_map(|plan| plan.numbers.all().map(|map| (map.clone(), plan.wrap_index())))
        .collect();
    let mut textures = Textures::new();
    for (map, wrap) in wanted {
        let texture = match (images.get(&map).cloned(), &map.kind) {
            (Some(MapImage::Gray(image)), Kind::Opacity { threshold, may_be_unused, .. }) => {
                let threshold = f32::from_bits(*threshold);
                let is_there = |texel: &u16| f32::from(*texel) / 65535.0 >= threshold;
                let is_unused = *may_be_unused && !image.texels.iter().any(is_there);
                if is_unused || image.texels.iter().all(is_there) {
                    // Without holes it need not be asked.
                    continue;
                }
                Texture::opacity(image, WRAPS[wrap], threshold)?
            }
            (Some(MapImage::Gray(image)), _) => Texture::gray(image, WRAPS[wrap])?,
            (Some(MapImage::Color(image)), _) => Texture::color(image, WRAPS[wrap])?,
            _ => continue,
        };
        textures.insert((map, wrap), Arc::new(texture));
    }
    images.retain(|map, _| !matches!(map.kind, Kind::Gray { .. } | Kind::Opacity { .. }));
    Ok(textures)
}

fn material_maps(plan: &Plan, textures: &Textures) -> MaterialMaps {
    let Numbers { metallic, roughness, occlusion, emissive, .. } = &plan.numbers;
    let [metallic, roughness, occlusion, emissive] = [metallic, roughness, occlusion, emissive]
        .map(|map| {
            let key = (map.clone()?, plan.wrap_index());
            textures.get(&key).cloned()
        });
    MaterialMaps { metallic, roughness, occlusion, emissive }
}

/// The holes of a plan's surface, if it has any.
fn cut_out(plan: &Plan, textures: &Textures) -> Option<CutOut> {
    let map = plan.numbers.opacity.as_ref()?;
    let opacity = textures.get(&(map.clone(), plan.wrap_index())).cloned()?;
    Some(CutOut { opacity })
}

/// Texels that a surface must have so that nothing of its textures is lost.
fn least_size(plan: &Plan, infos: &BTreeMap<&Path, ImageInfo>) -> [u32; 2] {
    let sizes = plan.numbers.all().filter_map(|map| infos.get(map.path.as_path()));
    sizes.fold([1, 1], |a, info| [0, 1].map(|i| a[i].max(info.size[i])))
}

/// Every file once, with all the ways in which it is read.
fn kinds_by_file(plans: &BTreeSet<Plan>) -> BTreeMap<&Path, BTreeSet<&Kind>> {
    let mut files: BTreeMap<&Path, BTreeSet<&Kind>> = BTreeMap::new();
    for map in plans.iter().flat_map(Plan::maps) {
        files.entry(&map.path).or_default().insert(&map.kind);
    }
    files
}

fn num_texels([width, height]: [u32; 2]) -> u64 {
    u64::from(width) * u64::from(height)
}

/// Texels of a plan's finest level as it is stored.
fn plan_texels(plan: &Plan, infos: &BTreeMap<&Path, ImageInfo>) -> u64 {
    let sizes = plan.maps().filter_map(|map| infos.get(map.path.as_path())).map(|info| info.size);
    let size = sizes.fold([1, 1], |a, b| [a[0].max(b[0]), a[1].max(b[1])]);
    num_texels(size) * if plan.is_mirrored() { 4 } else { 1 }
}

/// Refuses a scene whose textures would take too much memory, before any is decoded.
fn check_memory(
    plans: &BTreeSet<Plan>,
    infos: &BTreeMap<&Path, ImageInfo>,
    options: &LoadOptions,
) -> Result<()> {
    let info = |map: &Map| infos.get(map.path.as_path());
    let decoded: u64 = infos.values().map(|info| info.num_bytes).sum();
    let maps: BTreeSet<&Map> = plans.iter().flat_map(Plan::maps).collect();
    let converted: u64 = maps
        .iter()
        .filter_map(|map| Some(num_texels(info(map)?.size) * map.kind.num_bytes()))
        .sum();
    // With its levels, a texture takes a third more than its image.
    let textures: BTreeSet<&Map> = plans.iter().flat_map(|plan| plan.numbers.all()).collect();
    let textures = textures.into_iter().filter_map(|map| Some((map, info(map)?)));
    let mut stored: u64 =
        textures.map(|(map, info)| num_texels(info.size) * map.kind.num_bytes() * 4 / 3).sum();
    let (mut sum, mut largest) = (0, 0);
    for plan in plans {
        let has_normals = options.keep_normals && plan.has_relief();
        let per_texel = if has_normals { STORED_BYTES_WITH_NORMALS } else { STORED_BYTES };
        let num = plan_texels(plan, infos);
        stored += num * per_texel;
        sum += num;
        largest = largest.max(num);
    }
    let built = sum.min(largest.max(AT_ONCE)) * BUILD_BYTES;
    let mib = (decoded + converted + stored + built) >> 20;
    if mib > u64::from(options.max_image_mib) {
        let reason = format!(
            "the scene's textures need about {mib} MiB, more than {}",
            options.max_image_mib
        );
        return Err(Error::setting("max_image_mib", reason));
    }
    Ok(())
}

fn maps_of(path: &Path, kinds: &BTreeSet<&Kind>, samples: &Samples) -> Vec<(Map, MapImage)> {
    let map = |kind: &Kind| (Map { path: path.into(), kind: kind.clone() }, convert(samples, kind));
    kinds.iter().map(|kind| map(kind)).collect()
}

fn convert(samples: &Samples, kind: &Kind) -> MapImage {
    match *kind {
        Kind::Color => MapImage::Color(samples.color()),
        Kind::Height { channel, range } => {
            MapImage::Height(samples.gray(channel, range.map(f32::from_bits)).into())
        }
        Kind::Gray { channel, range } | Kind::Opacity { channel, range, .. } => {
            MapImage::Gray(samples.gray(channel, range.map(f32::from_bits)))
        }
        Kind::Normal { strength, is_green_down } => {
            let green = if is_green_down { -1.0 } else { 1.0 };
            MapImage::Normal(samples.normal(f32::from_bits(strength), green))
        }
    }
}

fn surface_maps(
    plan: &Plan,
    images: &mut BTreeMap<Map, MapImage>,
    is_used_later: impl Fn(&Map) -> bool,
    keep_normals: bool,
) -> SurfaceMaps {
    let (wrap, relief_depth) = (plan.wrap(), plan.relief_depth());
    let mut maps = SurfaceMaps { wrap, relief_depth, keep_normals, ..SurfaceMaps::default() };
    for map in plan.surface_maps() {
        let image = if is_used_later(map) { images.get(map).cloned() } else { images.remove(map) };
        match image {
            Some(MapImage::Color(image)) => maps.albedo = Some(image),
            Some(MapImage::Height(image)) => maps.height = Some(image),
            Some(MapImage::Normal(image)) => maps.normal = Some(image),
            Some(MapImage::Gray(_)) | None => {}
        }
    }
    maps
}
