//! The paper's sets of texels for one pixel.

use super::ground::QuadPixel;
use crate::filter::Prepared;
use crate::filter::visible::{Occlusion, TexelSet, remove_hidden};
use crate::footprint::Ellipse;
use crate::footprint::levels::EllipseRule;
use crate::settings::{Filter, Visibility, Visible};
use std::collections::{BTreeMap, BTreeSet};

/// The texels of a pixel's ellipse. A texel is its column and row in the endless pattern of a mip
/// level.
#[derive(Clone, Debug, PartialEq)]
pub struct Sets {
    /// The mip level that the filter reads.
    pub level: usize,
    /// Texels of that level a repeat, along u and v.
    pub texels_per_repeat: [f32; 2],
    /// The ellipse in texels: that of formula (2) or (3), or of both where the relief jumps (see
    /// [`Visible::max_stretch`]).
    pub ellipse: Ellipse,
    /// Texels down to the deepest relief, along u and v.
    pub displacement: [f32; 2],
    /// T: the texels whose centre lies in the widened ellipse around the hit.
    pub all: Vec<[i32; 2]>,
    /// `T_vis`: those whose ray to the eye meets no higher relief.
    pub visible: Vec<[i32; 2]>,
    /// `T_invis`: the others.
    pub hidden: Vec<[i32; 2]>,
    /// Visible texels that the scan of rows from both ends does not reach.
    pub skipped: Vec<[i32; 2]>,
    /// For every hidden texel the visible one that is seen in its place: where its ray to the eye
    /// leads in the end.
    pub covered_by: Vec<[[i32; 2]; 2]>,
    /// Texels that would count more than once if hidden ones counted those seen in their place and
    /// no buffer kept what has been counted, and how many times they would.
    pub counted_twice: Vec<([i32; 2], u32)>,
}

impl Sets {
    /// The sets of a pixel for a filter: those of its own ellipse, on the level that it reads, or
    /// the paper's where it has none of so many texels.
    pub(super) fn new(prepared: &Prepared, seen: &QuadPixel, filter: &Filter) -> Self {
        let mut shown = *filter;
        if shown.options_mut().texel_budget.is_none() {
            shown = Filter::Visible(Visible::default());
        }
        let rule = shown.traits().rule;
        let footprint = seen.footprint(&rule);
        let number = shown.level(prepared, &footprint).level;
        let level = &prepared.surface().levels()[number];
        let formulas = rule.formulas;
        let ellipse =
            EllipseRule { formulas, texel_budget: 0, max_anisotropy: shown.max_anisotropy() };
        let ellipse = ellipse.ellipse(&footprint, level);
        let mut set = TexelSet::default();
        set.fill_ellipse(&ellipse, level.in_texels(footprint.hit));
        let displacement = level.in_texels(seen.ray.displacement);
        let occlusion = prepared.field().map(|_| Occlusion::new(level, displacement));
        let kept = |how: Visibility| {
            let mut kept = set.clone();
            if let Some(occlusion) = &occlusion {
                remove_hidden(&mut kept, occlusion, how);
            }
            kept.iter().collect::<BTreeSet<_>>()
        };
        let (exact, two_ended) = (kept(Visibility::Exact), kept(Visibility::TwoEnded));
        let all: Vec<[i32; 2]> = set.iter().collect();
        let (visible, hidden): (Vec<_>, Vec<_>) =
            all.iter().partition(|&texel| exact.contains(texel));
        let covered_by: Vec<_> = occlusion
            .iter()
            .flat_map(|occlusion| {
                hidden.iter().map(|&texel| [texel, seen_instead(occlusion, texel)])
            })
            .collect();
        Self {
            level: number,
            texels_per_repeat: level.texels_per_repeat(),
            ellipse,
            displacement,
            skipped: visible.iter().copied().filter(|texel| !two_ended.contains(texel)).collect(),
            counted_twice: counted_twice(&visible, &covered_by),
            all,
            visible,
            hidden,
            covered_by,
        }
    }
}

/// The visible texel that is seen in a hidden one's place.
fn seen_instead(occlusion: &Occlusion, texel: [i32; 2]) -> [i32; 2] {
    let mut texel = texel;
    // Each coverer is nearer to the eye, so the chain ends.
    while let Some(coverer) = occlusion.coverer(texel[0], texel[1]) {
        texel = coverer;
    }
    texel
}

fn counted_twice(visible: &[[i32; 2]], covered_by: &[[[i32; 2]; 2]]) -> Vec<([i32; 2], u32)> {
    let mut counts: BTreeMap<[i32; 2], u32> = visible.iter().map(|&texel| (texel, 1)).collect();
    for [_, coverer] in covered_by {
        // One outside T never counts.
        counts.entry(*coverer).and_modify(|count| *count += 1);
    }
    counts.into_iter().filter(|(_, count)| *count > 1).collect()
}
