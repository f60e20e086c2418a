//! Which of the paper's formulas makes a footprint.

use crate::settings::{Derivatives, Formulas};

/// How a filter's footprints are made of the quad's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootprintRule {
    /// Formula (2) or (3).
    pub derivatives: Derivatives,
    /// As meant or as printed.
    pub formulas: Formulas,
    /// See [`Visible::max_stretch`](crate::Visible::max_stretch); 0 takes no difference for a jump.
    pub max_stretch: f32,
    /// Whether the view ray is followed to the relief; else the hit is the base place.
    pub is_traced: bool,
}

impl FootprintRule {
    /// Formula (2) as meant, on the polygon.
    pub const FLAT: Self = Self {
        derivatives: Derivatives::Flat,
        formulas: Formulas::Meant,
        max_stretch: 0.0,
        is_traced: false,
    };
}
