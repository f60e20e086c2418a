//! How a scene is read: what the caller says of materials, and limits.

use crate::decode::ImageLimits;
use crate::error::{Error, Result};
use crate::texture::Wrap;
use glam::Vec3;
use std::collections::BTreeMap;
use std::path::PathBuf;

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

/// What the caller says of materials in place of their file. `None`, the default, leaves it to the
/// file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MaterialOptions {
    /// Colour map for materials with texture coordinates.
    pub albedo: Option<PathBuf>,
    /// Height map for materials with texture coordinates.
    pub height: Option<PathBuf>,
    /// Normal map for materials with texture coordinates.
    pub normal: Option<PathBuf>,
    /// Texture of metal for materials with texture coordinates; `None`: `map_Pm`.
    pub metallic_map: Option<PathBuf>,
    /// Texture of roughness for materials with texture coordinates; `None`: `map_Pr`.
    pub roughness_map: Option<PathBuf>,
    /// Texture of occlusion for materials with texture coordinates.
    pub occlusion_map: Option<PathBuf>,
    /// Texture of emission for materials with texture coordinates; `None`: `map_Ke`.
    pub emissive_map: Option<PathBuf>,
    /// Which end of the height map is high; `None`: white.
    pub height_sense: Option<HeightSense>,
    /// Relief depth in texture repeats, 0 to 1; `None`: `-bm` of the height map in the MTL,
    /// `basrelief_depth` in the extras of a glTF material, else 0.05.
    pub relief_depth: Option<f32>,
    /// Where the normal map's green points; `None`: up.
    pub normal_y: Option<NormalY>,
    /// What lies beyond a texture's edges; `None`: clamp where the MTL says `-clamp on`, what a glTF
    /// sampler says, else repeat.
    pub wrap: Option<Wrap>,
    /// What multiplies the colour map, linear RGB, 0 to 1e6; `None`: `Kd`, else 1.
    pub base_color: Option<Vec3>,
    /// 0 for a dielectric, 1 for a metal; `None`: 1 where there is a texture of it, else `Pm`, else
    /// 0.
    pub metallic: Option<f32>,
    /// How strongly a dielectric reflects, 0 to 1; `None`: 1 where the MTL has a `Ks` that is not
    /// black, `Pr`, `Pm` or a texture of them, or `roughness` is given here, else 0.
    pub specular: Option<f32>,
    /// How rough it is, 0 to 1; `None`: 1 where there is a texture of it, else `Pr`, else that of the
    /// exponent `Ns` where `Ks` is not black, else 1.
    pub roughness: Option<f32>,
    /// Light that it sends out, linear RGB, 0 to 1e6; `None`: `Ke`, else 0; 1 in place of 0 where
    /// there is a texture of it.
    pub emissive: Option<Vec3>,
    /// Whether it has holes where its file says so: by `map_d`, by the opacity of its colour image, or by
    /// glTF's `alphaMode`; `None`: it has.
    pub cut_out: Option<bool>,
}

impl MaterialOptions {
    /// The files that can be given.
    pub fn files_mut(&mut self) -> [&mut Option<PathBuf>; 7] {
        let Self { albedo, height, normal, metallic_map, roughness_map, .. } = self;
        let (occlusion, emissive) = (&mut self.occlusion_map, &mut self.emissive_map);
        [albedo, height, normal, metallic_map, roughness_map, occlusion, emissive]
    }

    /// These options, and those of `other` where these say nothing.
    pub fn or(self, other: &Self) -> Self {
        Self {
            albedo: self.albedo.or_else(|| other.albedo.clone()),
            height: self.height.or_else(|| other.height.clone()),
            normal: self.normal.or_else(|| other.normal.clone()),
            metallic_map: self.metallic_map.or_else(|| other.metallic_map.clone()),
            roughness_map: self.roughness_map.or_else(|| other.roughness_map.clone()),
            occlusion_map: self.occlusion_map.or_else(|| other.occlusion_map.clone()),
            emissive_map: self.emissive_map.or_else(|| other.emissive_map.clone()),
            height_sense: self.height_sense.or(other.height_sense),
            relief_depth: self.relief_depth.or(other.relief_depth),
            normal_y: self.normal_y.or(other.normal_y),
            wrap: self.wrap.or(other.wrap),
            base_color: self.base_color.or(other.base_color),
            metallic: self.metallic.or(other.metallic),
            specular: self.specular.or(other.specular),
            roughness: self.roughness.or(other.roughness),
            emissive: self.emissive.or(other.emissive),
            cut_out: self.cut_out.or(other.cut_out),
        }
    }
}

/// How [`load`](super::load) reads a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadOptions {
    /// What is said of all materials. Default: nothing.
    pub all: MaterialOptions,
    /// What is said of single materials, by their names, before what is said of all. Default:
    /// nothing.
    pub materials: BTreeMap<String, MaterialOptions>,
    /// Whether surfaces keep normals, and materials their textures of metal, roughness, occlusion
    /// and emission, which only lighting needs. Default: `false`.
    pub keep_normals: bool,
    /// Width over height of the picture that the camera frames the scene for, above 0; wider
    /// pictures show all of it, too. Default: 1.
    pub aspect: f32,
    /// Where normals are made, faces that meet at a sharper angle than this keep their own:
    /// degrees, 0 (every edge is sharp) to 180 (none is). Default: `None`, 60 of an OBJ file, and 0
    /// of glTF, which demands it.
    pub crease_angle: Option<f32>,
    /// Whether files that lie outside the model's folder, also by a link, may be read when the model
    /// names them. Files that the caller names may lie anywhere. Default: `false`.
    pub allow_outside: bool,
    /// Most texels a side of an image, 1 to 32768. Default: 32768.
    pub max_image_side: u32,
    /// Most memory, in MiB, that all textures may take together while they are decoded and packed,
    /// by an estimate from the heads of the files: about 60 bytes a texel. Default: 1024, room for
    /// one material of 4096 x 4096 texels.
    pub max_image_mib: u32,
    /// Most triangles, and most `v`, `vt` and `vn` lines each; of glTF, most triangles and vertices
    /// of all that its nodes place. Default: 50 million.
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
            aspect: 1.0,
            crease_angle: None,
            allow_outside: false,
            max_image_side: 32768,
            max_image_mib: 1024,
            max_triangles: 50_000_000,
            max_textures: 1024,
        }
    }
}

impl LoadOptions {
    /// Refuses values out of their ranges.
    pub(super) fn check(&self) -> Result<()> {
        let mut given = self.materials.values().chain([&self.all]);
        if given.any(|material| {
            material.relief_depth.is_some_and(|depth| !(0.0..=1.0).contains(&depth))
        }) {
            return Err(Error::setting("relief_depth", "must be within 0 to 1 texture repeats"));
        }
        if self.crease_angle.is_some_and(|angle| !(0.0..=180.0).contains(&angle)) {
            return Err(Error::setting("crease_angle", "must be within 0 to 180 degrees"));
        }
        if !(self.aspect > 0.0 && self.aspect.is_finite()) {
            return Err(Error::setting("aspect", "must be above 0"));
        }
        Ok(())
    }

    /// Refuses more texture files than allowed.
    pub(super) fn check_num_textures(&self, num: usize) -> Result<()> {
        if num <= self.max_textures as usize {
            return Ok(());
        }
        let reason =
            format!("the scene names {num} texture files, more than {}", self.max_textures);
        Err(Error::setting("max_textures", reason))
    }

    /// The limits of one image.
    pub(super) fn image_limits(&self) -> ImageLimits {
        ImageLimits {
            side: self.max_image_side.min(32768),
            texels: u64::MAX,
            bytes: u64::from(self.max_image_mib) << 20,
        }
    }
}
