//! All that is drawn, checked as a whole.

use super::camera::Camera;
use super::cut_out::CutOut;
use super::light::{self, Light};
use super::material::Material;
use super::mesh::Mesh;
use super::sky::Sky;
use crate::error::{Error, Result};
use glam::Vec3;

/// What is drawn.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The surfaces. Each names one of `materials`.
    pub meshes: Vec<Mesh>,
    /// What the surfaces are made of.
    pub materials: Vec<Material>,
    /// From where they are seen.
    pub camera: Camera,
    /// What lights them under [`Lighting::Lit`](crate::Lighting::Lit).
    pub lights: Vec<Light>,
    /// Light from everywhere, added to the lights. Default: none.
    pub sky: Sky,
    /// Colour where nothing is hit, linear RGB, 0 to 1e6, and opacity. Default: black and
    /// transparent.
    pub background: [f32; 4],
}

impl Scene {
    /// The holes of a mesh, if it has any.
    pub(crate) fn cut_out(&self, mesh: &Mesh) -> Option<&CutOut> {
        let cut_out = self.materials[mesh.material].cut_out.as_ref();
        // Where they are the texture coordinates say.
        cut_out.filter(|_| !mesh.tex_coords.is_empty())
    }

    /// Checks indices, array lengths and that every number is within its range.
    ///
    /// # Errors
    /// Names the first part that is not valid.
    pub fn validate(&self) -> Result<()> {
        self.camera.validate()?;
        for (i, material) in self.materials.iter().enumerate() {
            material.validate().map_err(|reason| {
                Error::scene(format!("material {i} ({})", material.name.escape_debug()), reason)
            })?;
        }
        for (i, mesh) in self.meshes.iter().enumerate() {
            mesh.validate(self.materials.len()).map_err(|reason| {
                Error::scene(format!("mesh {i} ({})", mesh.name.escape_debug()), reason)
            })?;
        }
        for (i, light) in self.lights.iter().enumerate() {
            light.validate().map_err(|reason| Error::scene(format!("light {i}"), reason))?;
        }
        self.sky.validate().map_err(|reason| Error::scene("scene", reason))?;
        let [r, g, b, opacity] = self.background;
        if !light::is_light(Vec3::new(r, g, b)) || !(0.0..=1.0).contains(&opacity) {
            return Err(Error::scene(
                "scene",
                "background must be within 0 to 1e6, its opacity within 0 to 1",
            ));
        }
        Ok(())
    }
}
