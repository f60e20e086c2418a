//! Where a pixel lies in the texture and how far it reaches: what relief hands to every filter.
//!
//! [`Footprints`] is eight pixels of two 2x2 quads, [`Footprint`] one of them. `differences` takes
//! their derivatives from the quad, formulas (2) and (3); [`Ellipses`] and [`Ellipse`] are what
//! they span, formula (1); [`levels`] are all rules by which a filter chooses its mip level.
//! Nothing else describes a pixel to a filter.

mod differences;
mod ellipse;
mod ellipses;
mod footprints;
pub mod levels;
mod rule;

pub use differences::{Corner, at_pixel, differences};
pub use ellipse::{Ellipse, LEAST_AXIS, RowQuadric};
pub use ellipses::Ellipses;
pub use footprints::{Footprint, Footprints};
pub use rule::FootprintRule;
