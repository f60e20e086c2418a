//! From footprints to colours: filters to be used alone, and the way that frames take.
//!
//! ```
//! use basrelief::filter::Prepared;
//! use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps};
//! use basrelief::{Ewa, Filter};
//!
//! // White ridges across u, with black joints as deep as a tenth of a repeat.
//! let is_ridge = |x: u32| x % 16 < 8;
//! let surface = Surface::new(SurfaceMaps {
//!     albedo: Some(ColorImage::from_fn(64, 64, |x, _| if is_ridge(x) { [1.0; 3] } else { [0.0; 3] })),
//!     height: Some(HeightImage::from_fn(64, 64, |x, _| if is_ridge(x) { 1.0 } else { 0.0 })),
//!     relief_depth: 0.1,
//!     ..SurfaceMaps::default()
//! })?;
//! let ground = Prepared::new(surface);
//!
//! // Derivatives of one's own: a pixel covers half a repeat along u and a tenth along v.
//! let seen_along = |view| ground.footprint([0.3, 0.7], [0.5, 0.0], [0.0, 0.1], view);
//! let pixels = [seen_along([0.0, 0.0, 1.0]), seen_along([0.9, 0.0, 0.3])];
//! let [from_above, grazing] = ground.colors(&Filter::default(), &pixels)[..] else { unreachable!() };
//! // From above half of what is seen is black; at a grazing angle the ridges hide the joints.
//! assert!((0.4..0.6).contains(&from_above[0]) && grazing[0] > 0.8);
//! // What does not ask what is hidden sees the joints from everywhere.
//! let ewa = ground.colors(&Filter::Ewa(Ewa::default()), &pixels);
//! assert!((0.4..0.6).contains(&ewa[1][0]));
//! # Ok::<(), basrelief::Error>(())
//! ```
//!
//! [`Prepared`] is a surface with all that is made of it once. [`Prepared::footprint`] makes a
//! [`Footprint`] of a place, derivatives and a view; [`Prepared::colors`] filters many of them a
//! call, by any [`Filter`](crate::Filter), the paper's own method included.
//! [`Filter::Horizon`](crate::Filter::Horizon) builds tables for distant footprints when it is
//! first asked, unless its options say no.
//!
//! Frames go the same way eight pixels a vector: [`Footprints`] in, [`Filtered`] out, by
//! [`Filter::colors`](crate::Filter::colors), the one place that tells the filters apart.
//! [`Filter::levels`](crate::Filter::levels) beside it says what that reads.
//!
//! | room | what it does |
//! |---|---|
//! | `points` | one place: nearest, bilinear, trilinear |
//! | `trilinear`, `corners`, `queue` | trilinear look-ups of eight pixels at once |
//! | `ewa` | elliptical weighted average: all texels, or those next to the longer axis |
//! | `visible` | the paper's method: the ellipse's texels, and which of them are hidden |
//! | `horizon` | the floating horizon: visible texels by their visible length |
//! | `far_field` | tables of what is seen, for distant footprints of the horizon |
//! | `parallax`, `truth` | rays on their own, many a pixel |

mod batch;
mod corners;
mod dispatch;
#[doc(hidden)]
pub mod ewa;
mod far_field;
mod horizon;
mod parallax;
#[doc(hidden)]
pub mod points;
mod prepared;
mod queue;
mod samples;
mod traits;
#[doc(hidden)]
pub mod trilinear;
mod truth;
#[doc(hidden)]
pub mod visible;

pub use crate::footprint::{Footprint, Footprints};
pub use batch::{Batch, Filtered, LevelChoice, Work};
pub use dispatch::Scratch;
pub(crate) use horizon::lit_at;
pub use prepared::Prepared;
pub use samples::{SampleOffsets, Samples};
pub use traits::{Reads, Traits};
