//! What a frame must know of a filter beside its colours and levels, on one page.

use super::samples::Samples;
use crate::footprint::FootprintRule;
use crate::settings::{Derivatives, Ewa, Filter, Formulas, Horizon, Rays, Trilinear, Visible};

/// What a frame must know of a filter.
#[derive(Clone, Copy, Debug)]
pub struct Traits {
    /// How its footprints are made.
    pub rule: FootprintRule,
    /// The rays of a pixel; `None` for a filter that takes a footprint for a pixel.
    pub samples: Option<Samples>,
    /// Whether lights are asked for each texel that is seen, so that colours hold their diffuse
    /// part already.
    pub asks_for_lights: bool,
    /// What it reads of a prepared surface beside texels and heights.
    pub reads: Reads,
}

/// What is made of a surface for some filters alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reads {
    /// Nothing.
    TexelsAlone,
    /// Heights in cells.
    Cells,
    /// What levels lose in occlusion, and tables of so many MiB if any.
    Seen {
        /// Most memory of the tables.
        far_field_mib: Option<u32>,
    },
}

impl Filter {
    /// What a frame must know of it.
    pub fn traits(&self) -> Traits {
        /// The ellipse of differences of either formula around a hit.
        fn traced(derivatives: Derivatives, formulas: Formulas, max_stretch: f32) -> Traits {
            Traits {
                rule: FootprintRule { derivatives, formulas, max_stretch, is_traced: true },
                samples: None,
                asks_for_lights: false,
                reads: Reads::TexelsAlone,
            }
        }
        let at_hit = || traced(Derivatives::Flat, Formulas::Meant, 0.0);
        // What is seen is found around the base place, by the filter itself.
        let at_base = || Traits { rule: FootprintRule::FLAT, ..at_hit() };
        match *self {
            Self::Nearest | Self::Bilinear => at_hit(),
            Self::Trilinear(Trilinear { derivatives, formulas })
            | Self::Ewa(Ewa { derivatives, formulas, .. }) => traced(derivatives, formulas, 0.0),
            Self::Visible(Visible { derivatives, formulas, max_stretch, .. }) => {
                traced(derivatives, formulas, max_stretch)
            }
            Self::Horizon(Horizon { far_field, far_field_mib, .. }) => Traits {
                asks_for_lights: true,
                reads: Reads::Seen { far_field_mib: far_field.then_some(far_field_mib) },
                ..at_base()
            },
            Self::Parallax(Rays { samples }) => Traits {
                // One ray goes through the pixel's centre, as the footprint does.
                samples: (samples > 1).then_some(Samples { num: samples, is_exact: false }),
                reads: Reads::Cells,
                ..at_base()
            },
            Self::Truth(Rays { samples }) => {
                Traits { samples: Some(Samples { num: samples, is_exact: true }), ..at_hit() }
            }
        }
    }
}
