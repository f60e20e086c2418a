//! Options of the texture filters.

use crate::options::choices::{self, ON_OFF, Words, one_of};
use crate::options::values;
use basrelief::{Derivatives, Ewa, Filter, Formulas, Visibility, Visible};
use clap::Args;
use serde::{Deserialize, Serialize};

#[derive(Args, Clone, Debug, Default, Serialize, Deserialize)]
#[command(next_help_heading = "Texture filter")]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct FilterOptions {
    /// Which texels make up a pixel's colour [default: horizon]
    #[arg(short, long, value_parser = one_of(choices::FILTERS))]
    #[serde(with = "choices")]
    filter: Option<Filter>,
    /// How --filter visible finds the hidden texels [default: exact]
    #[arg(long, value_name = "HOW", value_parser = one_of(choices::VISIBILITIES))]
    #[serde(with = "choices")]
    visible: Option<Visibility>,
    /// Whether the relief is traced; off draws flat polygons [default: on]
    #[arg(long, value_name = "on|off", hide_possible_values = true, value_parser = one_of(ON_OFF))]
    pub(super) parallax: Option<bool>,
    /// Whether rays may pass the relief at outlines of curved meshes, and meshes that meet a relief
    /// are cut by it; off: both by its polygons [default: on]
    #[arg(long, value_name = "on|off", hide_possible_values = true, value_parser = one_of(ON_OFF))]
    pub(super) silhouette: Option<bool>,
    /// Which texture coordinates a pixel's ellipse comes from [default: relief]
    #[arg(long, value_name = "OF", value_parser = one_of(choices::DERIVATIVES))]
    #[serde(with = "choices")]
    derivatives: Option<Derivatives>,
    /// Which reading of the paper's formulas to use [default: meant]
    #[arg(long, value_name = "AS", value_parser = one_of(choices::FORMULAS))]
    #[serde(with = "choices")]
    formulas: Option<Formulas>,
    /// Choose the mip level so that an ellipse holds at most N texels; 0: always the full texture,
    /// as in the paper [default: 256]
    #[arg(long, value_name = "N")]
    texel_budget: Option<u32>,
    /// For --filter ewa: where the Gaussian is cut, in pixels, 1 to 1.5; 1 is the paper's ellipse
    /// [default: 1]
    #[arg(long, value_name = "R", value_parser = values::number, allow_hyphen_values = true)]
    cut: Option<f32>,
    /// For --filter ewa: added to A and C of formula (1) for the texels' own kernel, 0.25 to 1; 2/3
    /// is bilinear interpolation, 1 Heckbert's [default: 0.6666667]
    #[arg(long, value_name = "S", value_parser = values::number, allow_hyphen_values = true)]
    texel_kernel: Option<f32>,
    /// Whether --filter ewa takes every texel of an ellipse, and not only those next to its longer
    /// axis, which is several times as fast; --cut and --texel-kernel are for every texel [default:
    /// off]
    #[arg(long, value_name = "on|off", hide_possible_values = true, value_parser = one_of(ON_OFF))]
    every_texel: Option<bool>,
    /// Longest ellipse, as the ratio of its axes, 1 to 1e6; longer ones are widened [default: 64]
    #[arg(long, value_name = "N", value_parser = values::number, allow_hyphen_values = true)]
    max_anisotropy: Option<f32>,
    /// For --filter visible: a derivative of formula (3) this many times as long as that of (2) is
    /// a jump of the relief, and (2) is taken; 1 to 1000000, or 0 for never, as in the paper
    /// [default: 4]
    #[arg(long, value_name = "N", value_parser = values::number, allow_hyphen_values = true)]
    max_stretch: Option<f32>,
    /// Rays a pixel of --filter truth and parallax, 1 to 65536 [default: 64]
    #[arg(long, value_name = "N")]
    samples: Option<u32>,
    /// How finely --filter horizon and ewa cut a pixel's footprint: fast (4), best (24), or 2 to 64.
    /// For horizon, two lines for three of these, on a mip level with at most 2 to 2.75 times as
    /// many texels across [default: 12]
    #[arg(long, value_name = "N", value_parser = values::lines)]
    lines: Option<u32>,
    /// Whether --filter horizon keeps tables for distant surfaces [default: on]
    #[arg(long, value_name = "on|off", hide_possible_values = true, value_parser = one_of(ON_OFF))]
    far_field: Option<bool>,
    /// Most memory of those tables for each material in MiB, 1 to 4096 [default: 32]
    #[arg(long, value_name = "N")]
    far_field_mib: Option<u32>,
}

impl FilterOptions {
    /// The filter that is chosen, with its options.
    pub(crate) fn chosen(&self) -> Filter {
        self.apply(self.filter.unwrap_or_default())
    }

    /// A filter with the options that are given in place of its own.
    pub(crate) fn apply(&self, mut filter: Filter) -> Filter {
        self.clone().link(&mut filter, Way::ToFilter);
        filter
    }

    /// The filter whose texels `inspect` shows where pictures are drawn by `filter`: EWA, or the
    /// paper's for any other.
    pub(crate) fn inspected(&self, filter: Filter) -> Filter {
        if filter.is_same_choice(&Filter::Ewa(Ewa::default())) {
            filter
        } else {
            self.apply(Filter::Visible(Visible::default()))
        }
    }

    /// Which option sets what of which filter, read both ways.
    fn link(&mut self, filter: &mut Filter, way: Way) {
        let theirs = filter.options_mut();
        way.link(&mut self.visible, theirs.visibility);
        way.link(&mut self.derivatives, theirs.derivatives);
        way.link(&mut self.formulas, theirs.formulas);
        way.link(&mut self.texel_budget, theirs.texel_budget);
        way.link(&mut self.cut, theirs.cut);
        way.link(&mut self.texel_kernel, theirs.texel_kernel);
        way.link(&mut self.every_texel, theirs.every_texel);
        way.link(&mut self.max_anisotropy, theirs.max_anisotropy);
        way.link(&mut self.max_stretch, theirs.max_stretch);
        way.link(&mut self.samples, theirs.samples);
        way.link(&mut self.lines, theirs.lines);
        way.link(&mut self.far_field, theirs.far_field);
        way.link(&mut self.far_field_mib, theirs.far_field_mib);
    }
}

impl From<Filter> for FilterOptions {
    /// Options that give all of a filter, whatever the defaults are.
    fn from(mut filter: Filter) -> Self {
        let mut options = Self { filter: Some(filter), ..Self::default() };
        options.link(&mut filter, Way::ToOptions);
        options
    }
}

/// From options to a filter, or back.
#[derive(Clone, Copy)]
enum Way {
    ToFilter,
    ToOptions,
}

impl Way {
    /// Does nothing for an option that the filter does not have.
    fn link<T: Copy>(self, option: &mut Option<T>, value: Option<&mut T>) {
        let Some(value) = value else { return };
        match self {
            Self::ToFilter => *value = option.unwrap_or(*value),
            Self::ToOptions => *option = Some(*value),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_inspected_is_ewa_or_the_paper() {
        let options = FilterOptions {
            derivatives: Some(Derivatives::Flat),
            max_stretch: Some(0.0),
            ..FilterOptions::default()
        };
        let paper = Filter::Visible(Visible {
            derivatives: Derivatives::Flat,
            max_stretch: 0.0,
            ..Visible::default()
        });
        for filter in Filter::ALL.map(|filter| options.apply(filter)) {
            let is_ewa = matches!(filter, Filter::Ewa(_));
            assert_eq!(options.inspected(filter), if is_ewa { filter } else { paper });
        }
    }
}
