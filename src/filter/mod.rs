//! From a footprint to a filtered texel.
//!
//! [`Footprint`] is where a pixel lies in the texture, by formulas (2) or (3); [`Ellipse`] its ellipse, formula (1);
//! [`TexelSet`] the texels in it and those of them that the eye sees; [`ewa`] their weighted mean.

mod corners;
mod ellipse;
pub mod ewa;
mod far_field;
mod footprint;
pub mod horizon;
pub mod isotropic;
pub mod parallax;
mod seen;
mod texel_set;
pub mod trilinear;
pub mod truth;
pub mod visible;

pub use ellipse::{Ellipse, RECONSTRUCTION};
pub use far_field::FarField;
pub use footprint::{Corner, Differences, Footprint, at_pixel, bounded_place, differences, differences_for};
pub use horizon::PixelFootprints;
pub use seen::{ewa_color, seen_color};
pub use texel_set::{TexelRow, TexelSet};

use crate::settings::Settings;
use crate::simd::{TexelLanes, u32x8};
use crate::texture::Surface;

/// Most texels of an ellipse, whatever the budget: larger ones take a coarser level, so that a pixel's time is bounded.
pub(crate) const MAX_TEXELS: f32 = (1 << 20) as f32;

/// Farthest texel from the pattern's first: numbers up to there, and their neighbours, fit 32 bits.
const FARTHEST: f32 = (1 << 30) as f32;

/// What a filter returns: means of the stored texels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Filtered {
    /// Linear RGB as stored: [`FULL`](crate::texture::FULL) stands for the surface's `color_scale`.
    pub color: [f32; 3],
    /// Mean normal in the texture frame; shorter than one where normals differ.
    pub normal: [f32; 3],
}

impl Filtered {
    /// This where `t` is 0, the other where it is 1.
    #[must_use]
    pub fn lerp(&self, other: &Self, t: f32) -> Self {
        let mix = |a: [f32; 3], b: [f32; 3]| std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t);
        Self { color: mix(self.color, other.color), normal: mix(self.normal, other.normal) }
    }
}

/// The mip level on which the ellipse of `Ewa` and `Visible` is scanned, and the ellipse in its texels.
#[must_use]
pub fn level_within_budget(surface: &Surface, footprint: &Footprint, settings: &Settings) -> (usize, Ellipse) {
    let budget = if settings.texel_budget == 0 { MAX_TEXELS } else { settings.texel_budget as f32 };
    let at = |level: usize| {
        Ellipse::new(footprint, surface.texels_per_repeat(level), settings.formulas)
            .widened(settings.max_anisotropy, settings.formulas)
    };
    let last = surface.levels.len() - 1;
    let level = (0..last).find(|&level| at(level).area() <= budget).unwrap_or(last);
    (level, at(level))
}

/// The mean of the texels of the ellipse, hidden ones left out if there is a displacement (repeats down to the deepest
/// relief). Returns how many texels were tested and taken as well.
pub fn ellipse_mean(
    surface: &Surface,
    footprint: &Footprint,
    displacement: Option<[f32; 2]>,
    settings: &Settings,
    set: &mut TexelSet,
) -> (Filtered, [u64; 2]) {
    let (index, ellipse) = level_within_budget(surface, footprint, settings);
    let (level, texels) = (&surface.levels[index], surface.texels_per_repeat(index));
    let center = [footprint.center[0] * texels[0], footprint.center[1] * texels[1]];
    set.fill_ellipse(&ellipse, center);
    let mut num_tested = set.len() as u64;
    if let Some([du, dv]) = displacement {
        let occlusion = visible::Occlusion::new(level, [du * texels[0], dv * texels[1]]);
        num_tested = visible::remove_hidden(set, &occlusion, settings.visibility);
    }
    let num_visible = set.len() as u64;
    // T_vis is never empty: where every texel of a set was hidden or skipped, the hit itself counts.
    let mean = ewa::average(level, set, &ellipse, center);
    (mean.unwrap_or_else(|| isotropic::bilinear(surface, index, footprint.center)), [num_tested, num_visible])
}

/// Eight packed normals.
pub(crate) fn unpack_normals(words: u32x8) -> [TexelLanes; 3] {
    let number = |bits: u32x8| TexelLanes::from_i32x8(crate::simd::as_signed(bits));
    let [x, y, z] = [words & u32x8::splat(2047), words >> 11_u32 & u32x8::splat(2047), words >> 22_u32].map(number);
    [x * (1.0 / 1023.0) - 1.0, y * (1.0 / 1023.0) - 1.0, z * (1.0 / 511.0) - 1.0]
}
