//! What is made before the first frame: height fields, far-field tables, sample positions.

use crate::filter::{FarField, horizon, parallax, truth};
use crate::relief::HeightField;
use crate::scene::{Material, Scene};
use crate::settings::{Filter, Lighting, Settings};
use crate::texture::Surface;
use std::sync::{Arc, Mutex};

/// Most texels of all surfaces together that far-field tables are built for: some seconds of work. Surfaces beyond, in the
/// order of the materials, are drawn without.
const MOST_FAR_TEXELS: usize = 1 << 22;

/// What every frame of a scene needs besides the scene.
#[derive(Debug)]
pub(super) struct Tables {
    /// The height field of each material that has relief; shared where the surface is.
    pub(super) fields: Vec<Option<Arc<HeightField>>>,
    /// The tables of the same materials for distant footprints; `None` while they are not needed.
    pub(super) far_fields: Vec<Option<Arc<FarField>>>,
    /// Sample offsets of the truth.
    pub(super) kernel: truth::Kernel,
    /// Sample offsets of common practice.
    pub(super) offsets: Vec<[f32; 2]>,
    /// Buffers of the horizon filter, one for each task that ever ran at once.
    pub(super) scratches: Mutex<Vec<horizon::Scratch>>,
    /// Memory that `far_fields` were built for.
    far_field_mib: u32,
}

impl Tables {
    /// Tables that do not depend on the settings.
    pub(super) fn new(scene: &Scene) -> Self {
        Self {
            fields: per_surface(scene, |surface| Some(HeightField::new(surface))),
            far_fields: vec![None; scene.materials.len()],
            kernel: truth::Kernel::new(1),
            offsets: Vec::new(),
            scratches: Mutex::default(),
            far_field_mib: 0,
        }
    }

    /// Makes what the settings need and is not there.
    pub(super) fn update(&mut self, scene: &Scene, settings: &Settings) {
        match settings.filter {
            Filter::Truth => self.kernel = truth::Kernel::new(settings.samples),
            Filter::Parallax => self.offsets = parallax::offsets(settings.samples),
            _ => {}
        }
        let is_needed = settings.filter == Filter::Horizon
            && settings.parallax
            && settings.far_field
            && settings.lighting == Lighting::Unlit;
        if !is_needed {
            self.far_fields.fill(None);
            self.far_field_mib = 0;
        } else if self.far_field_mib != settings.far_field_mib {
            let mut left = MOST_FAR_TEXELS;
            self.far_fields = per_surface(scene, |surface| {
                let [width, height] = [surface.levels[0].width, surface.levels[0].height];
                left = left.checked_sub(width * height)?;
                FarField::new(surface, settings)
            });
            self.far_field_mib = settings.far_field_mib;
        }
    }
}

/// What is made of each material's surface, if that has relief: one per distinct surface.
fn per_surface<T>(scene: &Scene, mut make: impl FnMut(&Surface) -> Option<T>) -> Vec<Option<Arc<T>>> {
    let mut made: Vec<(Arc<Surface>, Option<Arc<T>>)> = Vec::new();
    let mut of = |surface: &Arc<Surface>| {
        if let Some((_, table)) = made.iter().find(|(other, _)| Arc::ptr_eq(other, surface)) {
            return table.clone();
        }
        let table = make(surface).map(Arc::new);
        made.push((surface.clone(), table.clone()));
        table
    };
    let relief = |material: &Material| material.surface.clone().filter(|surface| surface.relief_depth > 0.0);
    scene.materials.iter().map(|material| relief(material).and_then(|surface| of(&surface))).collect()
}
