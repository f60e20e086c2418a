//! Elliptical weighted average (Heckbert 1989): the mean of a set of texels with the weight `exp(-2 r^2)`, a Gaussian
//! over the disc of radius one pixel, `r^2 = (A U^2 + B U V + C V^2) / F <= 1`.
//!
//! [`mean`] takes all texels of an ellipse, [`Lines`] those next to its longer axis.

mod gaussian;
mod lines;
mod sums;
mod whole;

pub use lines::Lines;
pub use whole::mean;

use super::texel_set::{RowQuadric, lane_columns};
use super::{Ellipse, Filtered, Footprint, PixelFootprints, TexelSet};
use crate::settings::{Formulas, Settings};
use crate::simd::{TexelLanes, exp_negative};
use crate::texture::{Level, Surface};
use sums::Sums;

/// Whether every texel of an ellipse counts, and not only those next to its longer axis.
#[must_use]
pub fn takes_every_texel(settings: &Settings) -> bool {
    settings.every_texel || settings.texel_budget == 0 || settings.formulas == Formulas::Printed
}

/// The mip level whose texels make up a pixel in frames.
#[must_use]
pub fn level(surface: &Surface, footprint: &Footprint, settings: &Settings) -> usize {
    if takes_every_texel(settings) {
        whole::choose_level(surface, footprint, settings).0
    } else {
        Lines::new(surface, &PixelFootprints::splat(footprint, [0.0; 2]), settings).level(0)
    }
}

/// The mean of one pixel, as frames show it.
#[must_use]
pub fn shown(surface: &Surface, footprint: &Footprint, settings: &Settings) -> Filtered {
    if takes_every_texel(settings) {
        return mean(surface, footprint, settings, true).0;
    }
    let lines = Lines::new(surface, &PixelFootprints::splat(footprint, [0.0; 2]), settings);
    if surface.has_normals { lines.mean::<true>(surface, 0).0 } else { lines.mean::<false>(surface, 0).0 }
}

/// The weighted mean of the texels of `set` in the ellipse around `center` (in texels); `None` for an empty set.
#[must_use]
pub fn average(level: &Level, set: &TexelSet, ellipse: &Ellipse, center: [f32; 2]) -> Option<Filtered> {
    let [x0, y0] = center.map(|c| c - 0.5);
    let mut sums = Sums::default();
    for row in &set.rows {
        let quadric = RowQuadric::new(ellipse, row.y as f32 - y0);
        let start = level.row_start(row.y);
        let [first, num] = row.batches;
        for (i, &bits) in set.bits[first..first + num].iter().enumerate() {
            if bits != 0 {
                let x = row.x + 8 * i as i32;
                let r2 = quadric.at(lane_columns(x) - x0).fast_max(TexelLanes::ZERO).fast_min(TexelLanes::ONE);
                sums.add(level, start + level.run_start(x), exp_negative(r2 + r2) & lane_mask(bits));
            }
        }
    }
    sums.mean(level.has_normals())
}

/// All bits of the lanes whose bit is set.
fn lane_mask(bits: u8) -> TexelLanes {
    TexelLanes::new(std::array::from_fn(|lane| f32::from_bits(if bits >> lane & 1 == 1 { u32::MAX } else { 0 })))
}
