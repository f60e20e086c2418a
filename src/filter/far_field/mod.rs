//! What is seen of a relief from afar: tables of the seen colour for a set of directions.
//!
//! Averaging heights into mip levels loses the occlusion finer than a texel of the level. So for
//! large footprints not what is there is prefiltered, but what is *seen*: for a displacement `D`
//! (texels down to the deepest relief), the image `P_D(b)` of the colour seen over the base
//! coordinate `b` is an ordinary texture, and its mip levels are right. A table holds `P_D` at
//! coarse levels for lengths of `D` in geometric steps times azimuths, addressed by the place on
//! the mean depth plane, `q = b + mean D`, so that neighbouring directions line up. A pixel is the
//! elliptical weighted average of formula (2) over the blend of the four nearest directions. Its
//! cost does not depend on the distance.
//!
//! A table texel is one word: the square roots of red, green and blue in 11, 11 and 10 bits.

mod encode;
mod sample;
mod sights;
mod source;
mod tables;

pub(super) use tables::FarField;
