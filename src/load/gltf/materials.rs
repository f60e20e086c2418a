//! Materials of a glTF file: what they are made of, and which images they name.

use super::document::{Document, Reasoned};
use super::uri;
use crate::error::Result;
use crate::load::images::Images;
use crate::load::plan::CUT;
use crate::scene::Material;
use crate::scene::angle::cos_sin;
use crate::texture::Wrap;
use glam::{Vec2, Vec3};
use gltf::json::extensions::texture::TextureTransform;
use gltf::json::material::AlphaMode;
use gltf::json::texture::{self, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{Index, Value, deserialize, image, material};
use std::path::PathBuf;

/// Which coordinates a texture is read at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    /// The number of the set: `TEXCOORD_n`.
    pub(super) set: u32,
    /// The place of the origin, and of a step along u and along v, in the file's sense: v down.
    offset: Vec2,
    axes: [Vec2; 2],
}

/// A texture that a material names.
#[derive(Clone, Debug)]
pub(super) struct TextureRef {
    pub(super) index: Index<gltf::json::Texture>,
    pub(super) placement: Placement,
}

/// An image, and what lies beyond its edges along u and along v.
#[derive(Clone, Debug)]
pub(super) struct Picture {
    pub(super) path: PathBuf,
    pub(super) wraps: [Wrap; 2],
}

/// A material as its file has it.
#[derive(Clone, Debug)]
pub(super) struct GltfMaterial {
    /// Without its surface.
    pub(super) plain: Material,
    pub(super) albedo: Option<TextureRef>,
    pub(super) normal: Option<TextureRef>,
    pub(super) normal_scale: f32,
    /// Roughness in its green, metal in its blue.
    pub(super) metal_rough: Option<TextureRef>,
    pub(super) occlusion: Option<TextureRef>,
    /// How much of the occlusion there is, 0 to 1.
    pub(super) occlusion_strength: f32,
    pub(super) emissive: Option<TextureRef>,
    /// The opacity that multiplies that of its colour texture, and below which it is cut out; `None`
    /// where it is opaque.
    pub(super) cut: Option<[f32; 2]>,
    /// Whether it shows its colour whatever the light.
    pub(super) is_unlit: bool,
    pub(super) height: Option<Height>,
    pub(super) relief_depth: Option<f32>,
}

/// The height map that a material's extras name.
#[derive(Clone, Debug)]
pub(super) enum Height {
    Texture(TextureRef),
    File(String),
}

impl Default for Placement {
    fn default() -> Self {
        Self { set: 0, offset: Vec2::ZERO, axes: [Vec2::X, Vec2::Y] }
    }
}

impl Placement {
    fn new(set: u32, transform: Option<&TextureTransform>) -> Self {
        let Some(transform) = transform else { return Self { set, ..Self::default() } };
        // Counter-clockwise, as one sees it where v points down.
        let turns = f64::from(transform.rotation.0) / std::f64::consts::TAU;
        let [cos, sin] = cos_sin(turns).map(|c| c as f32);
        let [along_u, along_v] = transform.scale.0;
        Self {
            set: transform.tex_coord.unwrap_or(set),
            offset: transform.offset.0.into(),
            axes: [Vec2::new(cos, -sin) * along_u, Vec2::new(sin, cos) * along_v],
        }
    }

    /// Coordinates of the file, v down, to ours, v up.
    pub(super) fn apply(&self, at: Vec2) -> Vec2 {
        let at = self.axes[0] * at.x + self.axes[1] * at.y + self.offset;
        Vec2::new(at.x, 1.0 - at.y)
    }
}

impl GltfMaterial {
    /// What is drawn where a primitive names no material.
    pub(super) fn unnamed() -> Self {
        Self::of(&material::Material::default(), "none".into())
    }

    fn of(from: &material::Material, name: String) -> Self {
        let color = |c: [f32; 3]| Vec3::from_array(c).max(Vec3::ZERO).min(Vec3::splat(1e6));
        let unit = |number: f32| number.clamp(0.0, 1.0);
        let extensions = from.extensions.as_ref();
        let strength = extensions.and_then(|e| e.emissive_strength.as_ref());
        let specular = extensions.and_then(|e| e.specular.as_ref());
        let pbr = &from.pbr_metallic_roughness;
        let [red, green, blue, opacity] = pbr.base_color_factor.0;
        let plain = Material {
            name,
            base_color: color([red, green, blue]),
            metallic: unit(pbr.metallic_factor.0),
            specular: unit(specular.map_or(1.0, |specular| specular.specular_factor.0)),
            roughness: unit(pbr.roughness_factor.0),
            emissive: color(
                from.emissive_factor
                    .0
                    .map(|c| c * strength.map_or(1.0, |strength| strength.emissive_strength.0)),
            ),
            ..Material::default()
        };
        let (normal, occlusion) = (from.normal_texture.as_ref(), from.occlusion_texture.as_ref());
        Self {
            plain,
            albedo: pbr.base_color_texture.as_ref().map(texture_ref),
            normal: normal.map(|texture| {
                let transform = texture.extensions.as_ref().and_then(|e| e.others.get(TRANSFORM));
                texture_with(texture.index, texture.tex_coord, transform)
            }),
            normal_scale: normal.map_or(1.0, |normal| normal.scale),
            metal_rough: pbr.metallic_roughness_texture.as_ref().map(texture_ref),
            occlusion: occlusion.map(|texture| {
                let transform = texture.extensions.as_ref().and_then(|e| e.others.get(TRANSFORM));
                texture_with(texture.index, texture.tex_coord, transform)
            }),
            occlusion_strength: unit(occlusion.map_or(1.0, |texture| texture.strength.0)),
            emissive: from.emissive_texture.as_ref().map(texture_ref),
            cut: threshold(from).map(|threshold| [unit(opacity), threshold]),
            is_unlit: extensions.is_some_and(|e| e.unlit.is_some()),
            height: None,
            relief_depth: None,
        }
    }

    /// Where all its textures are read, as the first of them is: one set of coordinates serves all.
    pub(super) fn placement(&self) -> Placement {
        let Self { albedo, normal, metal_rough, emissive, occlusion, .. } = self;
        let all = [albedo, normal, metal_rough, emissive, occlusion];
        let first = all.into_iter().flatten().next();
        first.map_or(Placement::default(), |texture| texture.placement)
    }

    /// Leaves out textures that lie elsewhere than the first, and says which: where that lies they
    /// would show what is meant for another place.
    fn drop_elsewhere(&mut self) -> Vec<&'static str> {
        let placement = self.placement();
        let is_elsewhere = |texture: &mut TextureRef| texture.placement != placement;
        let Self { normal, metal_rough, emissive, occlusion, plain, .. } = self;
        let mut dropped = Vec::new();
        if normal.take_if(is_elsewhere).is_some() {
            dropped.push("normal");
        }
        if metal_rough.take_if(is_elsewhere).is_some() {
            // Its number alone would make all of it a metal.
            plain.metallic = 0.0;
            dropped.push("metal and roughness");
        }
        if emissive.take_if(is_elsewhere).is_some() {
            // All of it would glow.
            plain.emissive = Vec3::ZERO;
            dropped.push("emission");
        }
        if occlusion.take_if(is_elsewhere).is_some() {
            dropped.push("occlusion");
        }
        dropped
    }
}

/// The opacity below which a material is cut out.
fn threshold(from: &material::Material) -> Option<f32> {
    match from.alpha_mode {
        Checked::Valid(AlphaMode::Mask) => {
            Some(from.alpha_cutoff.map_or(CUT, |cutoff| cutoff.0.clamp(0.0, 1.0)))
        }
        Checked::Valid(AlphaMode::Blend) => Some(CUT),
        _ => None,
    }
}

/// The name under which textures of normals and occlusion have their transform.
const TRANSFORM: &str = "KHR_texture_transform";

/// A texture whose transform is not read yet.
fn texture_with(
    index: Index<gltf::json::Texture>,
    set: u32,
    transform: Option<&Value>,
) -> TextureRef {
    let transform = transform.and_then(|value| deserialize::from_value(value.clone()).ok());
    TextureRef { index, placement: Placement::new(set, transform.as_ref()) }
}

fn texture_ref(info: &texture::Info) -> TextureRef {
    let transform = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
    TextureRef { index: info.index, placement: Placement::new(info.tex_coord, transform) }
}

impl Document {
    /// The materials, and last that of what has none.
    ///
    /// # Errors
    /// Names the material whose extras are wrong.
    pub(super) fn materials(&mut self) -> Reasoned<Vec<GltfMaterial>> {
        let mut warnings = Vec::new();
        let mut materials = Vec::new();
        for (i, from) in self.root.materials.iter().enumerate() {
            let name = from.name.clone().unwrap_or_else(|| format!("material {i}"));
            let mut material = GltfMaterial::of(from, name);
            let name = material.plain.name.escape_debug().to_string();
            if let Some(extras) = &from.extras {
                material
                    .read_extras(extras.get())
                    .map_err(|reason| format!("material '{name}': {reason}"))?;
            }
            if matches!(from.alpha_mode, Checked::Valid(AlphaMode::Blend)) {
                warnings.push(format!(
                    "material '{name}' is not blended; drawn where its opacity is at least {CUT}"
                ));
            }
            for kind in material.drop_elsewhere() {
                warnings.push(format!(
                    "material '{name}': its {kind} texture lies elsewhere than its first; \
                     drawn without it"
                ));
            }
            materials.push(material);
        }
        warnings.into_iter().for_each(|warning| self.warn(warning));
        materials.push(GltfMaterial::unnamed());
        Ok(materials)
    }

    /// The image of a texture; `None`, with a remark, where it is missing or cannot be read.
    ///
    /// # Errors
    /// Says why an image file is refused.
    pub(super) fn picture(
        &mut self,
        index: Index<gltf::json::Texture>,
        images: &mut Images,
    ) -> Result<Option<Picture>> {
        let Some(texture) = self.root.get(index) else {
            self.warn(format_args!("texture {index} does not exist; drawn without it"));
            return Ok(None);
        };
        let sampler = texture.sampler.and_then(|sampler| self.root.get(sampler));
        let wraps = sampler.map_or([Wrap::Repeat; 2], |sampler| {
            [sampler.wrap_s, sampler.wrap_t].map(|mode| match mode {
                Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
                Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
                _ => Wrap::Repeat,
            })
        });
        let source = texture.source;
        let Some(image) = self.root.get(source) else {
            self.warn(format_args!(
                "texture {index} has no image of a known kind; drawn without it"
            ));
            return Ok(None);
        };
        let path = self.image_path(source, &image.clone(), images)?;
        Ok(path.map(|path| Picture { path, wraps }))
    }

    /// The file of an image, or the name under which `images` has its bytes.
    fn image_path(
        &mut self,
        index: Index<gltf::json::Image>,
        image: &image::Image,
        images: &mut Images,
    ) -> Result<Option<PathBuf>> {
        let shown = PathBuf::from(format!("{}#image {index}", self.path.display()));
        if images.has(&shown) {
            return Ok(Some(shown));
        }
        let bytes = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => match uri::data(uri) {
                Some(data) => data.map_err(|reason| format!("image {index} {reason}")),
                None => return self.file(&uri::file_name(uri)),
            },
            (None, Some(view)) => self.view(view).map(<[u8]>::to_vec),
            (None, None) => Err(format!("image {index} has neither a file nor bytes")),
        };
        match bytes {
            Ok(bytes) => {
                images.add(shown.clone(), bytes);
                Ok(Some(shown))
            }
            Err(reason) => {
                self.warn(format_args!("{reason}; drawn without it"));
                Ok(None)
            }
        }
    }

    /// A file that the document names; a missing one is warned of.
    ///
    /// # Errors
    /// Says why a file is refused.
    pub(super) fn file(&mut self, name: &str) -> Result<Option<PathBuf>> {
        let found = self.folder.find(name, &self.path);
        let found = found.map_err(|refused| refused.of(&self.path, name))?;
        if found.is_none() {
            self.warn(format_args!("'{name}' is missing; drawn without it"));
        }
        Ok(found)
    }
}

impl GltfMaterial {
    /// `basrelief_height`, the number of a texture or the name of a file, and `basrelief_depth`.
    fn read_extras(&mut self, extras: &str) -> Reasoned<()> {
        // Extras may be anything.
        let Ok(Value::Object(extras)) = deserialize::from_str::<Value>(extras) else {
            return Ok(());
        };
        self.height = match extras.get("basrelief_height") {
            None => None,
            Some(Value::String(name)) => Some(Height::File(name.clone())),
            Some(value) => {
                let index = value.as_u64().and_then(|index| u32::try_from(index).ok());
                let index = index.ok_or("basrelief_height must be a texture's number or a file")?;
                let placement = self.placement();
                Some(Height::Texture(TextureRef { index: Index::new(index), placement }))
            }
        };
        if let Some(depth) = extras.get("basrelief_depth") {
            let depth = depth.as_f64().filter(|depth| (0.0..=1.0).contains(depth));
            self.relief_depth = Some(depth.ok_or("basrelief_depth must be within 0 to 1")? as f32);
        }
        Ok(())
    }
}
