//! From a footprint to a filtered texel.
//!
//! [`Footprint`] is where a pixel lies in the texture, by formulas (2) or (3); [`Ellipse`] its ellipse, formula (1);
//! [`Scan`] the level on which it is looked up; [`TexelSet`] the texels in it and those of them that the eye sees; [`ewa`] their weighted mean.

mod ellipse;
pub mod ewa;
mod far_field;
mod footprint;
pub mod horizon;
pub mod isotropic;
pub mod parallax;
mod scan;
mod texel_set;
pub mod truth;
pub mod visible;

pub use ellipse::{Ellipse, RECONSTRUCTION};
pub use far_field::FarField;
pub use footprint::{Corner, Differences, Footprint, at_pixel, differences, differences_for};
pub use scan::Scan;
pub use texel_set::{TexelRow, TexelSet};

use crate::settings::Settings;
use crate::simd::{TexelLanes, u32x8};
use crate::texture::Surface;

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

/// The mean of the texels of the ellipse, hidden ones left out if there is a displacement (repeats down to the deepest
/// relief). Returns how many texels were tested and taken as well.
pub fn ellipse_mean(
    surface: &Surface,
    footprint: &Footprint,
    displacement: Option<[f32; 2]>,
    settings: &Settings,
    set: &mut TexelSet,
) -> (Filtered, [u64; 2]) {
    let scan = Scan::new(surface, footprint, settings);
    scan.fill(set);
    let mut num_tested = set.len() as u64;
    if let Some(displacement) = displacement {
        let occlusion = visible::Occlusion::new(scan.level, scan.in_texels(displacement));
        num_tested = visible::remove_hidden(set, &occlusion, settings.visibility);
    }
    let num_visible = set.len() as u64;
    // T_vis is never empty: where every texel of a set was hidden or skipped, the hit itself counts.
    let mean = ewa::average(scan.level, set, &scan.ellipse, scan.center);
    (mean.unwrap_or_else(|| isotropic::bilinear(surface, scan.index, footprint.center)), [num_tested, num_visible])
}

/// Eight packed normals.
pub(crate) fn unpack_normals(words: u32x8) -> [TexelLanes; 3] {
    let number = |bits: u32x8| TexelLanes::from_i32x8(crate::simd::as_signed(bits));
    let [x, y, z] = [words & u32x8::splat(2047), words >> 11_u32 & u32x8::splat(2047), words >> 22_u32].map(number);
    [x * (1.0 / 1023.0) - 1.0, y * (1.0 / 1023.0) - 1.0, z * (1.0 / 511.0) - 1.0]
}
