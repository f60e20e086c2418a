//! What a surface is made of.

use crate::texture::Surface;
use glam::Vec3;
use std::sync::Arc;

/// What a surface is made of. Colours are linear RGB.
#[derive(Clone, Debug)]
pub struct Material {
    /// Its name, for messages.
    pub name: String,
    /// Diffuse colour; multiplies the surface's albedo (`Kd`). Default: 1, 1, 1.
    pub diffuse: Vec3,
    /// Colour of highlights (`Ks`). Default: 0.
    pub specular: Vec3,
    /// Blinn-Phong exponent (`Ns`), 0 to 1e4. Default: 32.
    pub shininess: f32,
    /// Textures and relief; `None` draws the plain diffuse colour. Shared between materials that
    /// use the same maps.
    pub surface: Option<Arc<Surface>>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            diffuse: Vec3::ONE,
            specular: Vec3::ZERO,
            shininess: 32.0,
            surface: None,
        }
    }
}

impl Material {
    pub(crate) fn validate(&self) -> Result<(), String> {
        let colours = [self.diffuse, self.specular];
        if !colours
            .iter()
            .all(|c| c.is_finite() && c.min_element() >= 0.0 && c.max_element() <= 1e6)
        {
            return Err("diffuse and specular must be within 0 to 1e6".into());
        }
        if !(0.0..=1e4).contains(&self.shininess) {
            return Err(format!("shininess {} is not within 0 to 1e4", self.shininess));
        }
        Ok(())
    }
}
