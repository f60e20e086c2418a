//! The paper's method: the weighted mean of those texels of the ellipse that the relief does not
//! hide.
//!
//! [`TexelSet`] holds the texels T of an ellipse, [`remove_hidden`] takes out those that
//! [`Occlusion`] finds hidden.

mod average;
mod bounds;
mod occlusion;
mod texel_set;

pub use average::average;
pub use occlusion::{Occlusion, remove_hidden};
pub use texel_set::{TexelRow, TexelSet};

use super::batch::{Batch, Filtered, Work, each_covered};
use super::points;
use crate::footprint::Footprint;
use crate::footprint::levels::{EllipseRule, within_budget};
use crate::settings::Visible;
use crate::texture::{Surface, Texel};

/// The means of a batch's pixels.
pub(super) fn colors(
    surface: &Surface,
    batch: &Batch,
    visible: &Visible,
    set: &mut TexelSet,
    out: &mut [Filtered],
) -> Work {
    let mut work = Work::default();
    each_covered(batch, out, |pixels, lane| {
        let (mean, of_pixel) = mean(surface, &pixels.lane(lane), visible, set);
        work += of_pixel;
        mean
    });
    work
}

/// What bounds the ellipse.
pub fn ellipse_rule(visible: &Visible) -> EllipseRule {
    let Visible { formulas, texel_budget, max_anisotropy, .. } = *visible;
    EllipseRule { formulas, texel_budget, max_anisotropy }
}

/// The mean of the texels of one pixel's ellipse around the hit, hidden ones left out.
pub fn mean(
    surface: &Surface,
    footprint: &Footprint,
    visible: &Visible,
    set: &mut TexelSet,
) -> (Texel, Work) {
    // Find the texels of the ellipse: T.
    let (index, ellipse) = within_budget(surface, footprint, &ellipse_rule(visible));
    let level = &surface.levels()[index];
    let center = level.in_texels(footprint.hit);
    set.fill_ellipse(&ellipse, center);
    // Take out the hidden ones: T_vis is left.
    let num_tested = if footprint.displacement == [0.0; 2] {
        set.len() as u64
    } else {
        let occlusion = Occlusion::new(level, level.in_texels(footprint.displacement));
        remove_hidden(set, &occlusion, visible.visibility)
    };
    // T_vis is never empty: where every texel of a set was hidden or skipped, the hit itself
    // counts.
    let mean = average(level, set, &ellipse, center);
    let work = Work { num_tested, num_averaged: set.len() as u64 };
    (mean.unwrap_or_else(|| points::bilinear(level, footprint.hit)), work)
}
