//! What is made before the first frame: height fields, far-field tables, sample positions.

use crate::filter::{FarField, horizon, parallax, truth};
use crate::relief::HeightField;
use crate::scene::{Material, Scene};
use crate::settings::{Filter, Lighting, Settings};
use crate::texture::Surface;
use rayon::prelude::*;
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
            fields: per_surface(scene, |_| true, |surface| Some(HeightField::new(surface))),
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
            let fits = |surface: &Surface| {
                let num_texels = surface.levels[0].width * surface.levels[0].height;
                let fits = num_texels <= left;
                left -= if fits { num_texels } else { 0 };
                fits
            };
            self.far_fields = per_surface(scene, fits, |surface| FarField::new(surface, settings));
            self.far_field_mib = settings.far_field_mib;
        }
    }
}

/// What is made of each material's surface, if that has relief and `is_wanted`, which is asked in the order of the
/// materials: one per distinct surface, in parallel.
fn per_surface<T: Send + Sync>(
    scene: &Scene,
    mut is_wanted: impl FnMut(&Surface) -> bool,
    make: impl Fn(&Surface) -> Option<T> + Sync,
) -> Vec<Option<Arc<T>>> {
    let relief = |material: &Material| material.surface.clone().filter(|surface| surface.relief_depth > 0.0);
    let mut surfaces: Vec<Arc<Surface>> = Vec::new();
    let mut index_of = |surface: Arc<Surface>| {
        surfaces.iter().position(|other| Arc::ptr_eq(other, &surface)).unwrap_or_else(|| {
            surfaces.push(surface);
            surfaces.len() - 1
        })
    };
    let indices: Vec<_> = scene.materials.iter().map(|material| relief(material).map(&mut index_of)).collect();
    let wanted: Vec<_> = surfaces.into_iter().map(|surface| is_wanted(&surface).then_some(surface)).collect();
    let made: Vec<_> = wanted.into_par_iter().map(|surface| make(surface.as_deref()?).map(Arc::new)).collect();
    indices.into_iter().map(|index| made[index?].clone()).collect()
}
