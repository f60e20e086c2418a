//! What one pixel sees, and why: the numbers behind the paper's figures.
//!
//! [`pixel`] gathers for a pixel of a frame: where its view ray meets polygon and relief ([`Ray`]),
//! both ellipses in both readings of the paper's formulas ([`Reading`]), the sets of texels
//! ([`Sets`]), a cut through the relief along the view ([`Cut`]), and in a lit frame the light that
//! reaches it, with a cut along the main light ([`PixelLight`]). [`Figure`] places the eye on
//! the built-in scene so that one of the paper's figures is seen. [`measure`] gives one such number
//! for every pixel of a frame. Plain data: nothing here draws.
//!
//! ```
//! use basrelief::inspect::{self, Figure};
//!
//! let figure = Figure::ALL[3];
//! let seen = inspect::pixel(&figure.scene(), &figure.settings(), figure.pixel())?;
//! assert!(!seen.sets.hidden.is_empty() && !seen.sets.visible.is_empty());
//! assert_eq!(seen.sets.hidden.len() + seen.sets.visible.len(), seen.sets.all.len());
//! # Ok::<(), basrelief::Error>(())
//! ```

mod cut;
mod figures;
mod ground;
mod light;
mod measure;
mod ray;
mod readings;
mod sets;

pub use crate::footprint::Ellipse;
pub use crate::light::exact::{LightReaching, Reaching};
pub use cut::{Cut, CutPoint};
pub use figures::Figure;
pub use light::PixelLight;
pub use measure::{Measured, View, measure};
pub use ray::Ray;
pub use readings::{Corner, Projected, Reading};
pub use sets::Sets;

use crate::error::{Error, Result};
use crate::filter::Prepared;
use crate::light::exact::ExactLight;
use crate::render::PreparedScene;
use crate::scene::Scene;
use crate::settings::{Lighting, Settings};
use crate::texture::FULL_F32;
use ground::Ground;
use light::hit_of;

/// What one pixel sees.
#[derive(Clone, Debug)]
pub struct Inspection {
    /// Column and row of the pixel; row 0 is the top.
    pub pixel: [u32; 2],
    /// Index of the mesh, and of its triangle, at the pixel's centre.
    pub mesh: usize,
    /// Index of the triangle within the mesh.
    pub triangle: usize,
    /// Index of its material.
    pub material: usize,
    /// Relief depth, in texture repeats; 0 where no relief is traced.
    pub relief_depth: f32,
    /// The view ray.
    pub ray: Ray,
    /// Formulas (1), (2) and (3) as meant and as printed.
    pub readings: [Reading; 2],
    /// The paper's sets of texels, of the ellipse that the settings choose.
    pub sets: Sets,
    /// The relief along the view ray.
    pub cut: Cut,
    /// The light that reaches the hit, in a lit frame.
    pub light: Option<PixelLight>,
    prepared: Prepared,
}

/// Inspects the surface at the centre of a pixel (column, row) of the frame that the settings
/// describe.
///
/// # Errors
/// Names a scene or setting that is not valid, and a pixel outside the frame or without a textured
/// surface.
pub fn pixel(scene: &Scene, settings: &Settings, pixel: [u32; 2]) -> Result<Inspection> {
    scene.validate()?;
    settings.validate()?;
    let [x, y] = pixel;
    let name = || format!("pixel {x},{y}");
    if x >= settings.width || y >= settings.height {
        return Err(Error::scene(
            name(),
            format!("is outside the frame of {}x{}", settings.width, settings.height),
        ));
    }
    let all = PreparedScene::new(scene);
    let ground = Ground::at((scene, &all), settings, pixel)
        .ok_or_else(|| Error::scene(name(), "sees no surface"))?;
    let material = &scene.materials[ground.material];
    let surface = material
        .surface
        .clone()
        .ok_or_else(|| Error::scene(name(), "sees a surface without texture coordinates"))?;
    let prepared = Prepared::new(surface);
    let prepared = if settings.parallax { prepared } else { prepared.without_relief() };
    let seen = ground.pixel(prepared.field());
    let sets = Sets::new(&prepared, &seen, &settings.filter);
    let most = settings.filter.max_anisotropy();
    let cut = Cut::new(prepared.surface(), &seen, sets.level, most);
    let point = ground.point().filter(|_| settings.lighting == Lighting::Lit);
    let light = point.map(|point| {
        let mut hit = hit_of(material, &prepared, &seen, point);
        hit.clearance = ground.clearance(scene, &hit);
        let (occluders, outlined) = (all.occluders(scene), all.outlined(scene, settings));
        let exact = ExactLight { scene, occluders, outlined: outlined.as_ref() };
        PixelLight::new(&exact, &prepared, (&seen, &hit), most)
    });
    Ok(Inspection {
        pixel,
        mesh: ground.mesh,
        triangle: ground.triangle,
        material: ground.material,
        relief_depth: prepared.field().map_or(0.0, |field| field.relief_depth),
        ray: seen.ray,
        readings: readings::both(
            prepared.surface(),
            sets.level,
            &seen,
            settings.filter.max_anisotropy(),
        ),
        sets,
        cut,
        light,
        prepared,
    })
}

impl Inspection {
    /// Linear red, green and blue, 0 to 1, of a texel of the level of [`Sets`], at a column and row
    /// of the endless pattern.
    pub fn color(&self, [x, y]: [i32; 2]) -> [f32; 3] {
        let surface = self.prepared.surface();
        let scale = surface.color_scale().min(1.0) / FULL_F32;
        surface.levels()[self.sets.level].texel(x, y).color.map(|c| c * scale)
    }

    /// Height, 0 to 1, of a texel of the level of [`Sets`]; 1 lies on the polygon.
    pub fn height(&self, [x, y]: [i32; 2]) -> f32 {
        self.prepared.surface().levels()[self.sets.level].height_at(x, y)
    }
}
