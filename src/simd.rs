//! Lane types and the few helpers on them. The only file that names `wide`.
//!
//! Two readings of lanes: in `raster` and `relief` a lane is a *pixel* (two 2x2 quads), in `filter` a lane is a *texel*.
//! For the same bytes on every machine: `a * b + c` and never `mul_add`, `1.0 / x` and never `recip`, sums of lanes in
//! one fixed order ([`sum`]), minima and maxima by [`f32x8::fast_min`] and [`f32x8::fast_max`] on values that are not NaN.

pub use wide::{f32x8, f32x16, i32x8, i32x16, u32x8, u32x16};

/// Eight pixels: two 2x2 quads, lane `4 * quad + 2 * dy + dx`.
pub type PixelLanes = f32x8;

/// The name of the instruction set that the lanes were built for.
pub const LEVEL: &str = if cfg!(target_feature = "avx512f") {
    "avx512"
} else if cfg!(all(target_feature = "avx2", target_feature = "fma")) {
    "avx2+fma"
} else if cfg!(target_feature = "avx2") {
    "avx2"
} else if cfg!(target_feature = "avx") {
    "avx"
} else if cfg!(target_feature = "sse4.1") {
    "sse4.1"
} else if cfg!(target_feature = "sse2") {
    "sse2"
} else if cfg!(target_feature = "neon") {
    "neon"
} else {
    "scalar"
};
