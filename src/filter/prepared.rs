//! A surface with all that is made of it once.

use super::far_field::FarField;
use crate::footprint::Footprint;
use crate::light::{Gloss, Horizons, SunlitTexels};
use crate::relief::{HeightCells, HeightField, LevelLoss, displacement, march};
use crate::simd::PixelLanes;
use crate::texture::Surface;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A surface ready to be filtered: with its height field, what its mip levels lose in occlusion,
/// and tables of what is seen from afar. What takes long is made when it is first asked for, and
/// kept; copies share it.
#[derive(Clone, Debug)]
pub struct Prepared {
    surface: Arc<Surface>,
    relief: Option<Arc<Relief>>,
    /// The tables, if the surface has any, for so many MiB.
    far: Arc<Mutex<Option<Tables>>>,
    has_far_field: bool,
    /// Whether its colours hold light and shadow.
    is_lit: bool,
    /// The sun whose highlights are asked for, times its colours.
    gloss: Option<Gloss>,
    /// How it is seen from near under each sun that it is lit by for good.
    sunlit: Arc<[SunlitTexels]>,
}

/// Tables, if a surface has any, for so many MiB.
type Tables = (u32, Option<Arc<FarField>>);

/// What is made of the heights.
#[derive(Debug)]
struct Relief {
    field: OnceLock<HeightField>,
    cells: OnceLock<HeightCells>,
    loss: LevelLoss,
    /// Without skylines, and with them.
    horizons: [OnceLock<Horizons>; 2],
}

impl Prepared {
    /// Prepares a surface.
    pub fn new(surface: impl Into<Arc<Surface>>) -> Self {
        let surface = surface.into();
        let relief = (surface.relief_depth() > 0.0).then(|| {
            Arc::new(Relief {
                field: OnceLock::new(),
                cells: OnceLock::new(),
                loss: LevelLoss::new(&surface),
                horizons: Default::default(),
            })
        });
        let (has_far_field, is_lit, gloss, sunlit) = (true, false, None, Arc::default());
        Self { surface, relief, far: Arc::default(), has_far_field, is_lit, gloss, sunlit }
    }

    /// The same surface drawn flat.
    pub fn without_relief(&self) -> Self {
        Self { relief: None, ..self.clone() }
    }

    /// The same relief in the lit colours of another surface: what is made of heights is shared.
    pub(crate) fn recolored(&self, surface: Surface) -> Self {
        Self { surface: Arc::new(surface), far: Arc::default(), is_lit: true, ..self.clone() }
    }

    /// The same as it is seen from near under each sun.
    pub(crate) fn seen_near(self, sunlit: Vec<SunlitTexels>) -> Self {
        Self { sunlit: sunlit.into(), ..self }
    }

    /// The same relief with what it reflects of a sun's light for its colours, of which highlights are
    /// seen.
    pub(crate) fn glossy(&self, surface: Surface, gloss: Gloss) -> Self {
        Self { gloss: Some(gloss), ..self.recolored(surface) }
    }

    /// The same surface without tables for distant footprints.
    pub fn without_far_field(&self) -> Self {
        Self { has_far_field: false, ..self.clone() }
    }

    /// The pixel at `base` with the derivatives `dx` and `dy` of the flat polygon's coordinates, in
    /// repeats a pixel, and the hit of its view ray. `view` is the direction from the eye in the
    /// frame of the texture: how far it goes along u, along v and down, all in repeats; any length
    /// above 0.
    pub fn footprint(
        &self,
        base: [f32; 2],
        dx: [f32; 2],
        dy: [f32; 2],
        view: [f32; 3],
    ) -> Footprint {
        let Some(field) = self.field() else { return Footprint::new(base, dx, dy, [0.0; 2]) };
        let displacement = displacement(&view.map(PixelLanes::splat), field.relief_depth);
        let depth = march(field, &base.map(PixelLanes::splat), &displacement).as_array()[0];
        let displacement = displacement.map(|lanes| lanes.as_array()[0]);
        let hit = [0, 1].map(|i| base[i] + displacement[i] * depth);
        Footprint { hit, ..Footprint::new(base, dx, dy, displacement) }
    }

    /// Whether its colours hold light and shadow.
    pub(super) fn is_lit(&self) -> bool {
        self.is_lit
    }

    /// Whether it shows more or less of its colours to each eye.
    pub(crate) fn shows_eye(&self) -> bool {
        self.gloss.is_some()
    }

    /// The sun whose highlights it shows.
    pub(super) fn gloss(&self) -> Option<&Gloss> {
        self.gloss.as_ref()
    }

    /// How it is seen from near under each sun that it is lit by for good.
    pub(super) fn sunlit(&self) -> &[SunlitTexels] {
        &self.sunlit
    }

    /// The texels.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The texels, to be kept.
    pub(crate) fn shared_surface(&self) -> &Arc<Surface> {
        &self.surface
    }

    /// Whether it is not flat.
    pub(crate) fn has_relief(&self) -> bool {
        self.relief.is_some()
    }

    /// The heights; `None` where the surface is flat.
    pub fn field(&self) -> Option<&HeightField> {
        let relief = self.relief.as_deref()?;
        Some(relief.field.get_or_init(|| HeightField::new(&self.surface)))
    }

    /// The heights of all levels in cells; `None` where the surface is flat.
    pub(super) fn cells(&self) -> Option<&HeightCells> {
        let relief = self.relief.as_deref()?;
        Some(relief.cells.get_or_init(|| HeightCells::new(&self.surface)))
    }

    /// What hides light from its texels, for what is glossy with skylines; `None` where the surface is flat.
    pub(crate) fn horizons(&self, is_glossy: bool) -> Option<&Horizons> {
        let [matte, glossy] = &self.relief.as_deref()?.horizons;
        if is_glossy {
            return Some(glossy.get_or_init(|| Horizons::with_skylines(&self.surface)));
        }
        // Those with skylines serve what is matte, too.
        Some(glossy.get().unwrap_or_else(|| matte.get_or_init(|| Horizons::new(&self.surface))))
    }

    /// What levels lose in occlusion; `None` where the surface is flat.
    pub(super) fn level_loss(&self) -> Option<&LevelLoss> {
        self.relief.as_deref().map(|relief| &relief.loss)
    }

    /// Tables of at most so many MiB; `None` for a surface that has none.
    pub(super) fn far_field(&self, mib: u32) -> Option<Arc<FarField>> {
        self.relief.as_deref().filter(|_| self.has_far_field)?;
        let kept = self.far.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if let Some((_, far)) = kept.filter(|(kept, _)| *kept == mib) {
            return far;
        }
        // Made without the lock: whoever held it and waited for its tasks could be given one that
        // asks for it. Whoever is last is kept, and all are the same.
        let made = FarField::new(&self.surface, (self.gloss.clone(), self.sunlit.clone()), mib)
            .map(Arc::new);
        *self.far.lock().unwrap_or_else(PoisonError::into_inner) = Some((mib, made.clone()));
        made
    }
}
