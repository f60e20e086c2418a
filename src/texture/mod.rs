//! Stored texels: images as they are loaded, and the packed pyramid that the filters read.
//!
//! Everything is linear. Rows are stored bottom up: row 0 holds v = 0, so that texel `i` of a row
//! of `n` lies at `(i + 0.5) / n` repeats in both directions.

mod color;
mod image;
mod level;
mod mapped;
mod pyramid;
mod resample;
mod rows;
mod surface;
mod wrap;

pub(crate) use color::srgb8_of_four;
pub use color::{linear_from_srgb, linear_from_srgb8, srgb_from_linear, srgb8_from_linear};
pub use image::{ColorImage, GrayImage, HeightImage, NormalImage};
pub use level::{FULL, Level, Texel};
pub(crate) use level::{FULL_F32, unpack_normals};
pub use mapped::Texture;
pub(crate) use pyramid::box_taps;
pub(crate) use rows::{APRON, FARTHEST, RowStarts, Rows};
pub(crate) use surface::Normals;
pub use surface::{Surface, SurfaceMaps};
pub use wrap::Wrap;
pub(crate) use wrap::{near_origin, wrap_index};
