//! Which image serves a material as colour, height and normals.
//!
//! Height: the caller's file, else `disp`/`map_disp`, else `bump`/`map_bump` when that image is
//! gray. A coloured bump is a normal map, as `norm`/`map_Kn` is. Every choice is put into words.

use super::files::Folder;
use super::given::{self, Given};
use super::mtl::{MtlMaterial, TextureRef};
use super::options::{HeightSense, LoadOptions, MaterialOptions, NormalY};
use crate::decode::{self, Channel};
use crate::error::Result;
use crate::texture::Wrap;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// Relief depth in texture repeats where nothing says otherwise.
pub(super) const DEFAULT_DEPTH: f32 = 0.05;

/// The opacity at which surfaces are cut out where nothing says otherwise.
pub(super) const CUT: f32 = 0.5;

/// In the order of plans.
pub(super) const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];

/// An image file and how it is read.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Map {
    /// Absolute and without links; or the name of an image in the model's own bytes.
    pub(super) path: PathBuf,
    pub(super) kind: Kind,
}

/// How an image is read. Floats are held as bits, so that plans can be ordered.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    Color,
    Height {
        channel: Option<Channel>,
        range: [u32; 2],
    },
    Normal {
        strength: u32,
        is_green_down: bool,
    },
    /// One number a texel: as `Height`.
    Gray {
        channel: Option<Channel>,
        range: [u32; 2],
    },
    /// What is there of a surface: as `Gray`, at and above a threshold.
    Opacity {
        channel: Option<Channel>,
        range: [u32; 2],
        threshold: u32,
        /// Whether an image that is nowhere there counts as opaque: where nothing but the image asks
        /// for holes, all of its opacity may be unused.
        may_be_unused: bool,
    },
}

impl Kind {
    /// Bytes of a texel once it is read.
    pub(super) fn num_bytes(&self) -> u64 {
        if matches!(self, Self::Color | Self::Normal { .. }) { 6 } else { 2 }
    }
}

/// Textures of a material's numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Numbers {
    pub(super) metallic: Option<Map>,
    pub(super) roughness: Option<Map>,
    pub(super) occlusion: Option<Map>,
    pub(super) emissive: Option<Map>,
    /// Of cut-outs, which are there without light, too.
    pub(super) opacity: Option<Map>,
}

impl Numbers {
    /// Those that there are.
    pub(super) fn all(&self) -> impl Iterator<Item = &Map> {
        let Self { metallic, roughness, occlusion, emissive, opacity } = self;
        [metallic, roughness, occlusion, emissive, opacity].into_iter().flatten()
    }
}

/// What one surface is made from.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Plan {
    albedo: Option<Map>,
    height: Option<Map>,
    normal: Option<Map>,
    /// Textures of the material's numbers.
    pub(super) numbers: Numbers,
    /// Index into [`WRAPS`].
    wrap: usize,
    /// The relief depth as bits.
    depth: u32,
}

impl Plan {
    /// A plan of the maps that there are.
    pub(super) fn new(
        [albedo, height, normal]: [Option<Map>; 3],
        numbers: Numbers,
        wrap: Wrap,
        relief_depth: f32,
    ) -> Self {
        let wrap = WRAPS.iter().position(|w| *w == wrap).unwrap_or_default();
        Self { albedo, height, normal, numbers, wrap, depth: relief_depth.to_bits() }
    }

    /// The maps that there are.
    pub(super) fn maps(&self) -> impl Iterator<Item = &Map> {
        self.surface_maps().chain(self.numbers.all())
    }

    /// Those of them that the surface is made from.
    pub(super) fn surface_maps(&self) -> impl Iterator<Item = &Map> {
        [&self.albedo, &self.height, &self.normal].into_iter().flatten()
    }

    pub(super) fn wrap(&self) -> Wrap {
        WRAPS[self.wrap]
    }

    /// Index into [`WRAPS`].
    pub(super) fn wrap_index(&self) -> usize {
        self.wrap
    }

    /// Whether normals are those of a map, on a surface without relief.
    pub(super) fn has_only_normals(&self) -> bool {
        self.normal.is_some() && (self.height.is_none() || self.relief_depth() == 0.0)
    }

    /// Whether there is anything to take normals from.
    pub(super) fn has_relief(&self) -> bool {
        self.height.is_some() || self.normal.is_some()
    }

    pub(super) fn is_mirrored(&self) -> bool {
        self.wrap() == Wrap::Mirror
    }

    pub(super) fn relief_depth(&self) -> f32 {
        f32::from_bits(self.depth)
    }
}

/// Plans one material after another.
pub(super) struct Planner<'a> {
    options: &'a LoadOptions,
    folder: &'a Folder,
    given: Given<'a>,
    /// Whether the image behind a `bump` is gray.
    is_gray: BTreeMap<PathBuf, bool>,
    pub(super) choices: Vec<String>,
    pub(super) warnings: Vec<String>,
}

impl<'a> Planner<'a> {
    /// Looks at the caller's maps and at the images of those `bump` lines whose meaning depends on
    /// them.
    ///
    /// # Errors
    /// Names a file that is missing or refused.
    pub(super) fn new(
        options: &'a LoadOptions,
        folder: &'a Folder,
        materials: &[&MtlMaterial],
    ) -> Result<Self> {
        let given = Given::new(options)?;
        let (is_gray, warnings) = Default::default();
        let choices = given::choices(options);
        let mut planner = Self { options, folder, given, is_gray, choices, warnings };
        planner.look_at_bumps(materials)?;
        Ok(planner)
    }

    fn given(&self, material: &MtlMaterial) -> &MaterialOptions {
        self.given.of(&material.name)
    }

    /// Finds out which images of `bump` lines are gray, where that decides what they serve as.
    fn look_at_bumps(&mut self, materials: &[&MtlMaterial]) -> Result<()> {
        let mut paths = BTreeSet::new();
        for material in materials {
            let Some(bump) = material.bump.as_ref().filter(|bump| bump.texture.channel.is_none())
            else {
                continue;
            };
            let find = |map: &TextureRef| {
                self.folder.resolve(&map.texture.name, map.place()).ok().flatten()
            };
            let has_height = self.given(material).height.is_some()
                || material.height.as_ref().and_then(find).is_some();
            // Where both height and normals are settled without it, the image need not be read.
            if !has_height || self.wants_normals(material) {
                paths.extend(find(bump));
            }
        }
        let paths: Vec<_> = paths.into_iter().collect();
        self.options.check_num_textures(paths.len())?;
        let limits = self.options.image_limits();
        let is_gray: Vec<Result<bool>> = paths
            .par_iter()
            .map(|path| {
                Ok(decode::probe(path, limits)?.is_gray_format()
                    || decode::samples(path, limits)?.is_gray())
            })
            .collect();
        for (path, is_gray) in paths.into_iter().zip(is_gray) {
            self.is_gray.insert(path, is_gray?);
        }
        Ok(())
    }

    fn wants_normals(&self, material: &MtlMaterial) -> bool {
        self.options.keep_normals && self.given(material).normal.is_none()
    }

    /// The maps of a material that is drawn with texture coordinates; `None` when it has none.
    ///
    /// # Errors
    /// Names the line whose file is refused.
    pub(super) fn plan(&mut self, material: &MtlMaterial) -> Result<Option<Plan>> {
        let (albedo, albedo_clamped) = self.albedo(material)?;
        let bump = self.found(material.bump.as_ref())?;
        let (bump_height, bump_normal) = match bump {
            Some((bump, path))
                if bump.texture.channel.is_some() || self.is_gray.get(&path) != Some(&false) =>
            {
                (Some((bump, path)), None)
            }
            other => (None, other),
        };
        let (height, depth, height_clamped) = self.height(material, bump_height)?;
        let normal = self.normal(material, bump_normal)?;
        let fallback = if albedo_clamped || height_clamped { Wrap::Clamp } else { Wrap::Repeat };
        let wrap = self.given(material).wrap.unwrap_or(fallback);
        let numbers = self.numbers(material, albedo.as_ref())?;
        let plan = Plan::new([albedo, height, normal], numbers, wrap, depth);
        let has_maps = plan.maps().next().is_some();
        Ok(has_maps.then_some(plan))
    }

    /// The file behind a texture line, if there is one; a missing one is warned of.
    fn found<'r>(
        &mut self,
        texture: Option<&'r TextureRef>,
    ) -> Result<Option<(&'r TextureRef, PathBuf)>> {
        let Some(texture) = texture else {
            return Ok(None);
        };
        let name = &texture.texture.name;
        let path = self.folder.resolve(name, texture.place())?;
        if path.is_none() {
            let text = format_args!("{} '{name}' is missing; drawn without it", texture.keyword);
            self.warnings.push(texture.place().remark(text));
        }
        Ok(path.map(|path| (texture, path)))
    }

    fn albedo(&mut self, material: &MtlMaterial) -> Result<(Option<Map>, bool)> {
        if let Some(path) = self.given(material).albedo.clone() {
            return Ok((Some(Map { path, kind: Kind::Color }), false));
        }
        let found = self.found(material.albedo.as_ref())?;
        let is_clamped = found.as_ref().is_some_and(|(texture, _)| texture.texture.is_clamped);
        Ok((found.map(|(_, path)| Map { path, kind: Kind::Color }), is_clamped))
    }

    /// The opacity of cut-outs: that of `map_d`, or its brightness; else that of the colour image.
    fn opacity(&mut self, material: &MtlMaterial, albedo: Option<&Map>) -> Result<Option<Map>> {
        if self.given(material).cut_out == Some(false) {
            return Ok(None);
        }
        let (name, limits) = (material.name.escape_debug(), self.options.image_limits());
        let opacity = material.opacity.unwrap_or(1.0).clamp(0.0, 1.0);
        let kind = |channel, range: [f32; 2], may_be_unused| {
            let (range, threshold) = (range.map(f32::to_bits), CUT.to_bits());
            Kind::Opacity { channel, range, threshold, may_be_unused }
        };
        if let Some((line, path)) = self.found(material.opacity_map.as_ref())? {
            let has_opacity = decode::probe(&path, limits)?.has_opacity();
            let channel = line.texture.channel.or(has_opacity.then_some(Channel::Matte));
            let range = line.texture.range.map(|number| number * opacity);
            return Ok(Some(Map { path, kind: kind(channel, range, false) }));
        }
        if opacity < 1.0 {
            self.warnings.push(format!("material {name}: d {opacity} is drawn opaque"));
        }
        let Some(Map { path, .. }) = albedo else { return Ok(None) };
        if !decode::probe(path, limits)?.has_opacity() {
            return Ok(None);
        }
        let file = path.file_name().unwrap_or_default().display();
        let choice = format!("material {name}: holes where {file} has an opacity below {CUT}");
        self.choices.push(choice);
        let kind = kind(Some(Channel::Matte), [0.0, 1.0], true);
        Ok(Some(Map { path: path.clone(), kind }))
    }

    /// Textures of a material's numbers; most are only asked for by lighting.
    fn numbers(&mut self, material: &MtlMaterial, albedo: Option<&Map>) -> Result<Numbers> {
        let opacity = self.opacity(material, albedo)?;
        if !self.options.keep_normals {
            return Ok(Numbers { opacity, ..Numbers::default() });
        }
        let given = self.given(material).clone();
        let mut of = |given: Option<PathBuf>, line: Option<&TextureRef>, is_gray: bool| {
            let (channel, range, path) = match (given, self.found(line)?) {
                (Some(path), _) => (None, [0.0, 1.0], path),
                (None, Some((line, path))) => (line.texture.channel, line.texture.range, path),
                (None, None) => return Ok(None),
            };
            let range = range.map(f32::to_bits);
            let kind = if is_gray { Kind::Gray { channel, range } } else { Kind::Color };
            Ok(Some(Map { path, kind }))
        };
        Ok(Numbers {
            metallic: of(given.metallic_map, material.metallic_map.as_ref(), true)?,
            roughness: of(given.roughness_map, material.roughness_map.as_ref(), true)?,
            occlusion: of(given.occlusion_map, None, true)?,
            emissive: of(given.emissive_map, material.emissive_map.as_ref(), false)?,
            opacity,
        })
    }

    fn height(
        &mut self,
        material: &MtlMaterial,
        bump: Option<(&TextureRef, PathBuf)>,
    ) -> Result<(Option<Map>, f32, bool)> {
        let MaterialOptions { height, height_sense, relief_depth, .. } =
            self.given(material).clone();
        let height_sense = height_sense.unwrap_or_default();
        let fallback = relief_depth.unwrap_or(DEFAULT_DEPTH);
        if let Some(path) = height {
            let kind = height_kind(height_sense, None, [0.0, 1.0], false);
            return Ok((Some(Map { path, kind }), fallback, false));
        }
        let Some((texture, path)) = self.found(material.height.as_ref())?.or(bump) else {
            return Ok((None, fallback, false));
        };
        let line = &texture.texture;
        // A negative -bm turns the relief over; the polygon stays its top.
        let bump = line.bump.unwrap_or(DEFAULT_DEPTH);
        let depth = relief_depth.unwrap_or(bump.abs().min(1.0));
        if relief_depth.is_none() && bump.abs() > 1.0 {
            self.warnings.push(
                texture
                    .place()
                    .remark(format_args!("-bm {bump} is cut to a relief depth of 1 repeat")),
            );
        }
        let (keyword, name) = (texture.keyword, &line.name);
        self.choices.push(format!(
            "material {}: height from {keyword} {name}, relief depth {depth}",
            material.name
        ));
        let kind = height_kind(height_sense, line.channel, line.range, bump < 0.0);
        Ok((Some(Map { path, kind }), depth, line.is_clamped))
    }

    fn normal(
        &mut self,
        material: &MtlMaterial,
        bump: Option<(&TextureRef, PathBuf)>,
    ) -> Result<Option<Map>> {
        let is_green_down = self.given(material).normal_y == Some(NormalY::Down);
        let kind = |strength: f32| Kind::Normal { strength: strength.to_bits(), is_green_down };
        if !self.options.keep_normals {
            return Ok(None);
        }
        if let Some(path) = self.given(material).normal.clone() {
            return Ok(Some(Map { path, kind: kind(1.0) }));
        }
        let Some((texture, path)) = self.found(material.normal.as_ref())?.or(bump) else {
            return Ok(None);
        };
        let (keyword, name) = (texture.keyword, &texture.texture.name);
        self.choices.push(format!("material {}: normals from {keyword} {name}", material.name));
        Ok(Some(Map { path, kind: kind(texture.texture.bump.unwrap_or(1.0)) }))
    }
}

pub(super) fn height_kind(
    sense: HeightSense,
    channel: Option<Channel>,
    [base, gain]: [f32; 2],
    is_turned: bool,
) -> Kind {
    let is_deep = sense == HeightSense::WhiteDeep;
    let range = if is_deep != is_turned { [1.0 - base, -gain] } else { [base, gain] };
    Kind::Height { channel, range: range.map(f32::to_bits) }
}
