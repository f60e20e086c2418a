//! Where the texels of an ellipse are looked up: the mip level, and the ellipse in its texels.

use super::{Ellipse, Footprint, TexelSet};
use crate::settings::{Filter, Settings, Visibility};
use crate::texture::{Level, Surface};

/// Most texels of an ellipse, whatever the budget: larger ones take a coarser level, so that a pixel's time is bounded.
const MAX_TEXELS: f32 = (1 << 20) as f32;

/// The ellipse of a footprint on the level where `Ewa` and `Visible` scan it, row by row.
///
/// Rows run along the ellipse's longer side, so that eight neighbouring texels fill the lanes: along v on the transposed
/// level. Only two-ended rows, whose ends mean something, always run along u.
#[derive(Clone, Copy, Debug)]
pub struct Scan<'a> {
    /// The texels.
    pub level: &'a Level,
    /// The mip level.
    pub index: usize,
    /// The ellipse in texels, `U` along the rows.
    pub ellipse: Ellipse,
    /// Its middle in texels, along the rows first.
    pub center: [f32; 2],
    is_turned: bool,
    texels_per_repeat: [f32; 2],
}

impl<'a> Scan<'a> {
    /// The finest level on which the ellipse is within the texel budget.
    #[must_use]
    pub fn new(surface: &'a Surface, footprint: &Footprint, settings: &Settings) -> Self {
        let (index, ellipse) = level_within_budget(surface, footprint, settings);
        let texels_per_repeat = surface.texels_per_repeat(index);
        let has_ends = settings.filter == Filter::Visible && settings.visibility == Visibility::TwoEnded;
        let is_turned = ellipse.a > ellipse.c && !has_ends;
        let (level, ellipse) = if is_turned {
            (&surface.transposed[index], Ellipse { a: ellipse.c, c: ellipse.a, ..ellipse })
        } else {
            (&surface.levels[index], ellipse)
        };
        let scan = Self { level, index, ellipse, center: [0.0; 2], is_turned, texels_per_repeat };
        Self { center: scan.in_texels(footprint.center), ..scan }
    }

    /// A place or a way in repeats of the texture, `(u, v)`, in texels of the level, along the rows first.
    #[must_use]
    pub fn in_texels(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        let [u, v] = [u * self.texels_per_repeat[0], v * self.texels_per_repeat[1]];
        if self.is_turned { [v, u] } else { [u, v] }
    }

    /// Makes `set` the set T: the texels whose centre lies in the ellipse.
    pub fn fill(&self, set: &mut TexelSet) {
        set.fill_ellipse(&self.ellipse, self.center);
    }
}

fn level_within_budget(surface: &Surface, footprint: &Footprint, settings: &Settings) -> (usize, Ellipse) {
    let budget = if settings.texel_budget == 0 { MAX_TEXELS } else { settings.texel_budget as f32 };
    let at = |level: usize| {
        Ellipse::new(footprint, surface.texels_per_repeat(level), settings.formulas)
            .widened(settings.max_anisotropy, settings.formulas)
    };
    let last = surface.levels.len() - 1;
    let level = (0..last).find(|&level| at(level).area() <= budget).unwrap_or(last);
    (level, at(level))
}
