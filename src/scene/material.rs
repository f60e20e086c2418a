//! What a surface is made of.

use super::light::is_light;
use crate::texture::Surface;
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
    /// Textures and relief; `None` draws the plain base colour. Shared between materials that use
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
            surface: None,
        }
    }
}

impl Material {
    /// Whether all that it shows of light is diffuse.
    pub(crate) fn is_matte(&self) -> bool {
        self.metallic == 0.0 && self.specular == 0.0
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
        Ok(())
    }
}
