//! The paper's sets of texels.

use super::check::{Checked, ensure};
use crate::filter::points;
use crate::filter::visible::{self, Occlusion, TexelSet, remove_hidden};
use crate::footprint::Footprint;
use crate::footprint::levels::within_budget;
use crate::settings::{Visibility, Visible};
use crate::texture::Surface;
use std::collections::BTreeSet;

type Texels = BTreeSet<[i32; 2]>;

/// The paper's sets: no texel is listed twice; T is the disjoint union of the visible texels and
/// the hidden ones, each of which has a texel that covers it; the two-ended rows are a part of the
/// visible texels; trace and resolve with the buffer of counted texels gives exactly the visible
/// ones. Where nothing of T is visible, the hit's own texels count.
///
/// # Errors
/// Says what broke.
pub fn visible_sets(surface: &Surface, pixel: &Footprint, visible: &Visible) -> Checked {
    let (index, ellipse) = within_budget(surface, pixel, &visible::ellipse_rule(visible));
    let level = &surface.levels()[index];
    let [center, displacement] = [pixel.hit, pixel.displacement].map(|p| level.in_texels(p));
    let mut all = TexelSet::default();
    all.fill_ellipse(&ellipse, center);
    let occlusion = Occlusion::new(level, displacement);
    let left_by = |how| {
        let mut set = all.clone();
        remove_hidden(&mut set, &occlusion, how);
        listed(&set)
    };
    let all_texels = listed(&all)?;
    let [exact, two_ended, resolved] =
        [Visibility::Exact, Visibility::TwoEnded, Visibility::Resolved].map(left_by);
    let (exact, two_ended, resolved) = (exact?, two_ended?, resolved?);
    ensure(exact.is_subset(&all_texels), || {
        format!("visible, and not in T: {:?}", exact.difference(&all_texels))
    })?;
    let miscovered = all_texels
        .iter()
        .find(|texel| occlusion.coverer(texel[0], texel[1]).is_some() == exact.contains(*texel));
    ensure(miscovered.is_none(), || {
        format!("{miscovered:?} is both visible and covered, or neither")
    })?;
    ensure(two_ended.is_subset(&exact), || {
        format!("two-ended takes hidden {:?}", two_ended.difference(&exact))
    })?;
    ensure(resolved == exact, || {
        format!("resolved differs by {:?}", resolved.symmetric_difference(&exact))
    })?;
    let exactly = Visible { visibility: Visibility::Exact, ..*visible };
    let (mean, work) = visible::mean(surface, pixel, &exactly, &mut TexelSet::default());
    let num = work.num_averaged;
    ensure(num == exact.len() as u64, || format!("{num} texels counted of {}", exact.len()))?;
    let fallback = points::bilinear(level, pixel.hit);
    ensure(num > 0 || mean == fallback, || {
        format!("{mean:?} from no texel, {fallback:?} at the hit")
    })
}

/// The texels of a set, each once.
fn listed(set: &TexelSet) -> Result<Texels, String> {
    let texels: Texels = set.iter().collect();
    let num = set.iter().count();
    ensure(texels.len() == num && num == set.len(), || {
        format!("{num} listed, {} different", texels.len())
    })?;
    Ok(texels)
}
