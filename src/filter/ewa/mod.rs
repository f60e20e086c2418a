//! Elliptical weighted average (Heckbert 1989): the mean of a set of texels with the weight `exp(-2
//! r^2)`, a Gaussian over the disc of radius one pixel, `r^2 = (A U^2 + B U V + C V^2) / F <= 1`.
//!
//! [`mean`] takes all texels of an ellipse, [`LongAxes`] those next to its longer axis.

mod gaussian;
mod long_axis;
mod sums;
mod whole;

pub use long_axis::LongAxes;
pub use whole::mean;

use super::batch::{Batch, Filtered, Work, each_covered};
use crate::footprint::{Footprints, levels};
use crate::settings::{Ewa, Formulas};
use crate::simd::{LineLanes, PixelLanes, sums_of_eight};
use crate::texture::Surface;

/// Pairs whose axes are found before their texels are read: a pair's steps wait for each other,
/// those of several do not.
const AXES_AT_ONCE: usize = 4;

/// The means of a batch's pixels.
pub(super) fn colors(surface: &Surface, batch: &Batch, ewa: &Ewa, out: &mut [Filtered]) -> Work {
    let num_read = if takes_every_texel(ewa) {
        let mut num_read = 0;
        each_covered(batch, out, |pixels, lane| {
            let (mean, num) = mean(surface, &pixels.lane(lane), ewa, batch.is_lit());
            num_read += num;
            mean
        });
        num_read
    } else if batch.is_lit() && surface.has_normals() {
        along_axes::<true>(surface, batch.pixels, ewa, out)
    } else {
        along_axes::<false>(surface, batch.pixels, ewa, out)
    };
    Work { num_tested: num_read, num_averaged: num_read }
}

/// The mip level whose texels make up a pixel of a vector.
pub(super) fn level(surface: &Surface, pixels: &Footprints, lane: usize, ewa: &Ewa) -> usize {
    if takes_every_texel(ewa) {
        levels::for_gaussian(surface, &pixels.lane(lane), ewa).0
    } else {
        LongAxes::new(surface, pixels, ewa).level(lane)
    }
}

/// Whether every texel of an ellipse counts, and not only those next to its longer axis.
pub fn takes_every_texel(ewa: &Ewa) -> bool {
    ewa.every_texel || ewa.texel_budget == 0 || ewa.formulas == Formulas::Printed
}

fn along_axes<const HAS_NORMALS: bool>(
    surface: &Surface,
    pixels: &[Footprints],
    ewa: &Ewa,
    out: &mut [Filtered],
) -> u64 {
    let mut num_read = 0;
    // Those of lanes that are not covered are left over from others, and not looked at.
    let mut sums = [[[LineLanes::ZERO; 4]; 8]; 2];
    for (pixels, out) in pixels.chunks(AXES_AT_ONCE).zip(out.chunks_mut(AXES_AT_ONCE)) {
        let mut axes = [None; AXES_AT_ONCE];
        for (axes, pixels) in axes.iter_mut().zip(pixels) {
            *axes = Some(LongAxes::new(surface, pixels, ewa));
        }
        for ((axes, pixels), out) in axes.iter().flatten().zip(pixels).zip(out) {
            for lane in pixels.covered() {
                let (of_pixel, num) = axes.sums::<HAS_NORMALS>(lane);
                sums[0][lane] = of_pixel.colors();
                if HAS_NORMALS {
                    sums[1][lane] = of_pixel.normals();
                }
                num_read += num;
            }
            // A sum over lanes takes many steps in turn: eight pixels take theirs at once.
            out.color = means(&sums[0]);
            if HAS_NORMALS {
                out.normal = means(&sums[1]);
            }
        }
    }
    num_read
}

/// The means of eight pixels, by the sums of their weights and of what is weighed.
#[inline(always)]
fn means(pixels: &[[LineLanes; 4]; 8]) -> [PixelLanes; 3] {
    let total = |value: usize| sums_of_eight(pixels.each_ref().map(|sums| sums[value]));
    // Of a covered pixel the column next to its middle weighs far more than 1.
    let share = PixelLanes::ONE / total(0).fast_max(PixelLanes::ONE);
    [total(1) * share, total(2) * share, total(3) * share]
}
