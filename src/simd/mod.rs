//! Lane types and the few helpers on them. The only room that names `wide`.
//!
//! Two readings of lanes: in `raster` and `relief` a lane is a *pixel* (two 2x2 quads), in `filter`
//! a lane is a *texel*. For the same bytes on every machine: `a * b + c` and never `mul_add`, `1.0
//! / x` and never `recip`, sums of lanes in one fixed order ([`sum`]), minima and maxima by
//! [`f32x8::fast_min`] and [`f32x8::fast_max`] on values that are not NaN.

mod between;
mod lanes;

pub use between::{BETWEEN_SCALE, Between, Blend};
pub use lanes::*;
