//! The scalar twin that the kernels are held against: the definitions of `docs/theory.md`, one
//! texel and one ray at a time, in f64.
//!
//! * `derivatives` and `Conic`: formulas (1), (2) and (3), as meant and as printed.
//! * `texels`, `ray_margin`, `mean`: the texels T of an ellipse, which of them a ray to the eye
//!   leaves visible, and the weighted mean of a set.
//! * `Lines`: the floating horizon line by line, with the weight of every texel.
//! * `first_hit`, `supersampled`: a dense march, and the value of a pixel by many rays.
//! * `parallax`: common practice, a ray in 32 steps.
//!
//! Short and slow on purpose. Shares with the kernels the packed texels, the ellipse's definition,
//! and nothing else.

mod formulas;
mod horizon;
mod parallax;
mod stored;
mod supersample;
mod texels;

pub(crate) use stored::color;

pub use formulas::{Conic, derivatives};
pub use horizon::Lines;
pub use parallax::{parallax, parallax_with_margin};
pub use supersample::{Ray, first_hit, supersampled};
pub use texels::{RAY_TIE, mean, ray_margin, texels};
