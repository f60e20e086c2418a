//! The paper's sets of texels.

use super::{Checked, Pixel, ensure};
use crate::filter::visible::{Occlusion, remove_hidden};
use crate::filter::{self, TexelSet, isotropic, level_within_budget};
use crate::settings::{Filter, Settings, Visibility};
use crate::texture::Surface;
use std::collections::BTreeSet;

type Texels = BTreeSet<[i32; 2]>;

/// The paper's sets: no texel is listed twice; T is the disjoint union of the visible texels and the hidden ones, each of
/// which has a texel that covers it; the two-ended rows are a part of the visible texels; trace and resolve with the buffer
/// of counted texels gives exactly the visible ones. Where nothing of T is visible, the hit's own texels count.
///
/// # Errors
/// Says what broke.
pub fn visible_sets(surface: &Surface, pixel: &Pixel, settings: &Settings) -> Checked {
    let (index, ellipse) = level_within_budget(surface, &pixel.footprint, settings);
    let (level, texels) = (&surface.levels[index], surface.texels_per_repeat(index));
    let [center, displacement] =
        [pixel.footprint.center, pixel.displacement].map(|p| [p[0] * texels[0], p[1] * texels[1]]);
    let mut all = TexelSet::default();
    all.fill_ellipse(&ellipse, center);
    let occlusion = Occlusion::new(level, displacement);
    let left_by = |how| {
        let mut set = all.clone();
        remove_hidden(&mut set, &occlusion, how);
        listed(&set)
    };
    let all_texels = listed(&all)?;
    let [exact, two_ended, resolved] = [Visibility::Exact, Visibility::TwoEnded, Visibility::Resolved].map(left_by);
    let (exact, two_ended, resolved) = (exact?, two_ended?, resolved?);
    ensure(exact.is_subset(&all_texels), || format!("visible, and not in T: {:?}", exact.difference(&all_texels)))?;
    let miscovered =
        all_texels.iter().find(|texel| occlusion.coverer(texel[0], texel[1]).is_some() == exact.contains(*texel));
    ensure(miscovered.is_none(), || format!("{miscovered:?} is both visible and covered, or neither"))?;
    ensure(two_ended.is_subset(&exact), || format!("two-ended takes hidden {:?}", two_ended.difference(&exact)))?;
    ensure(resolved == exact, || format!("resolved differs by {:?}", resolved.symmetric_difference(&exact)))?;
    let settings = Settings { filter: Filter::Visible, visibility: Visibility::Exact, ..settings.clone() };
    let (mean, [_, num]) =
        filter::ellipse_mean(surface, &pixel.footprint, Some(pixel.displacement), &settings, &mut TexelSet::default());
    ensure(num == exact.len() as u64, || format!("{num} texels counted of {}", exact.len()))?;
    let fallback = isotropic::bilinear(surface, index, pixel.footprint.center);
    ensure(num > 0 || mean == fallback, || format!("{mean:?} from no texel, {fallback:?} at the hit"))
}

/// The texels of a set, each once.
fn listed(set: &TexelSet) -> Result<Texels, String> {
    let texels: Texels = set.iter().collect();
    let num = set.iter().count();
    ensure(texels.len() == num && num == set.len(), || format!("{num} listed, {} different", texels.len()))?;
    Ok(texels)
}
