//! What a surface is made of.

use super::cut_out::CutOut;
use super::light::is_light;
use crate::texture::{Surface, Texture};
use glam::Vec3;
use std::sync::Arc;

/// What a surface is made of, in the terms of glTF 2.0. Colours are linear RGB.
#[derive(Clone, Debug)]
pub struct Material {
    /// Its name, for messages.
    pub name: String,
    /// What multiplies the surface's albedo, 0 to 1e6 (`Kd`): the diffuse colour of a dielectric,
    /// the colour of a metal's reflections. Default: 1, 1, 1.
    pub base_color: Vec3,
    /// 0 for a dielectric, 1 for a metal (`Pm`). Default: 0.
    pub metallic: f32,
    /// How strongly a dielectric reflects, 0 to 1: 0 is matte, 1 is glTF's dielectric, which reflects
    /// 0.04 of light that comes straight and all of it along the surface (`KHR_materials_specular`).
    /// Default: 0.
    pub specular: f32,
    /// How rough it is, 0 (a mirror) to 1 (`Pr`): the square root of GGX's alpha. Default: 1.
    pub roughness: f32,
    /// Light that it sends out by itself, 0 to 1e6 (`Ke`), seen under
    /// [`Lighting::Lit`](crate::Lighting::Lit). It does not light others. Default: 0.
    pub emissive: Vec3,
    /// Textures of these numbers.
    pub maps: MaterialMaps,
    /// Holes; `None`, the default, has none.
    pub cut_out: Option<CutOut>,
    /// Colour, normals and relief; `None` draws the plain base colour. Shared between materials that use
    /// the same maps.
    pub surface: Option<Arc<Surface>>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec3::ONE,
            metallic: 0.0,
            specular: 0.0,
            roughness: 1.0,
            emissive: Vec3::ZERO,
            maps: MaterialMaps::default(),
            cut_out: None,
            surface: None,
        }
    }
}

/// Textures of a material's numbers, each of its own size; they are read where the surface is. What
/// has none pays nothing for them.
///
/// Frames bake light texel by texel of the *surface*: of a finer texture they see what one of its
/// texels covers, see [`SurfaceMaps::least_size`](crate::texture::SurfaceMaps::least_size). Two of
/// them may be channels of one image, as glTF's blue and green of metal and roughness.
#[derive(Clone, Debug, Default)]
pub struct MaterialMaps {
    /// What [`Material::metallic`] is multiplied with; its red counts.
    pub metallic: Option<Arc<Texture>>,
    /// What [`Material::roughness`] is multiplied with; its red counts.
    pub roughness: Option<Arc<Texture>>,
    /// How much of the sky's light, 0 to 1, gets to a place and is reflected there, over what the
    /// relief hides already; its red counts. Lights are as they are without it.
    pub occlusion: Option<Arc<Texture>>,
    /// What [`Material::emissive`] is multiplied with.
    pub emissive: Option<Arc<Texture>>,
}

impl MaterialMaps {
    /// Whether there is any.
    pub fn is_empty(&self) -> bool {
        self.all().next().is_none()
    }

    /// Those that there are.
    pub fn all(&self) -> impl Iterator<Item = &Arc<Texture>> {
        let Self { metallic, roughness, occlusion, emissive } = self;
        [metallic, roughness, occlusion, emissive].into_iter().flatten()
    }
}

/// What a material does with light at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finish {
    /// As [`Material::metallic`].
    pub metallic: f32,
    /// As [`Material::specular`].
    pub specular: f32,
    /// As [`Material::roughness`].
    pub roughness: f32,
    /// As [`Material::emissive`].
    pub emissive: Vec3,
    /// See [`MaterialMaps::occlusion`].
    pub occlusion: f32,
}

impl Material {
    /// Whether all that it shows of light is diffuse.
    pub(crate) fn is_matte(&self) -> bool {
        self.metallic == 0.0 && self.specular == 0.0
    }

    /// What it does with light where `read` reads its textures.
    pub fn finish(&self, read: impl Fn(&Texture) -> [f32; 3]) -> Finish {
        let MaterialMaps { metallic, roughness, occlusion, emissive } = &self.maps;
        let color = |map: &Option<Arc<Texture>>| map.as_ref().map_or([1.0; 3], |map| read(map));
        let [metallic, roughness, occlusion] =
            [metallic, roughness, occlusion].map(|map| color(map)[0].min(1.0));
        Finish {
            metallic: self.metallic * metallic,
            specular: self.specular,
            roughness: self.roughness * roughness,
            emissive: self.emissive * Vec3::from(color(emissive)),
            occlusion,
        }
    }

    /// What it does with light where it has no texture coordinates.
    pub fn plain_finish(&self) -> Finish {
        self.finish(|_| [1.0; 3])
    }

    pub(crate) fn validate(&self) -> Result<(), String> {
        if !is_light(self.base_color) || !is_light(self.emissive) {
            return Err("base_color and emissive must be within 0 to 1e6".into());
        }
        let shares = [
            ("metallic", self.metallic),
            ("specular", self.specular),
            ("roughness", self.roughness),
        ];
        for (name, value) in shares {
            if !(0.0..=1.0).contains(&value) {
                return Err(format!("{name} {value} is not within 0 to 1"));
            }
        }
        if self.surface.is_none() && !self.maps.is_empty() {
            return Err("its textures are read where its surface is, and it has none".into());
        }
        Ok(())
    }
}
