//! What must hold of the filters for any texture, footprint and view: for property tests and
//! fuzzing, yours included.
//!
//! Each function checks one property for one pixel and says in one line what broke. A [`Footprint`]
//! is a pixel in texture space; [`Footprint::bounded`] makes one of any numbers, NaN and infinity
//! included, as the renderer does.
//!
//! To fuzz your own textures and settings:
//!
//! ```
//! use basrelief::invariants::{self, Footprint};
//! use basrelief::texture::{HeightImage, Surface, SurfaceMaps};
//! use basrelief::{Filter, Visible};
//! use proptest::prelude::*;
//!
//! let stairs = HeightImage::from_fn(16, 16, |x, _| x as f32 / 15.0);
//! let surface = Surface::new(SurfaceMaps { height: Some(stairs), relief_depth: 0.1, ..Default::default() })?;
//! let visible = Visible { texel_budget: 64, ..Default::default() };
//! let place = || prop::array::uniform2(-1.0_f32..1.0);
//! proptest!(|(center in place(), dx in place(), dy in place(), view in place())| {
//!     let pixel = Footprint::new(center, dx, dy, view).bounded();
//!     invariants::visible_sets(&surface, &pixel, &visible).map_err(TestCaseError::fail)?;
//!     invariants::within_texels(&surface, &pixel, &Filter::Visible(visible)).map_err(TestCaseError::fail)?;
//! });
//! # Ok::<(), basrelief::Error>(())
//! ```

mod check;
mod frames;
mod layers;
mod light;
mod looked_up;
mod means;
mod outlines;
mod pixel;
mod sets;
mod symmetry;
mod weights;

pub use crate::footprint::Footprint;
pub use check::Checked;
pub use frames::{fan_is_hit_once, frame_is_finite, march_finds_first_hit};
pub use layers::layers_agree;
pub use light::{lights_add, no_more_than_the_sky};
pub use looked_up::{
    flat_tables_give_the_mean, steps_find_the_references_hit, tables_give_texels_in_any_order,
};
pub use means::{flat_relief_hides_nothing, linear_in_texture, same_for_same_ellipse};
pub use outlines::outlines_hold;
pub use pixel::{
    anisotropy_limit_only_limits, ellipse_is_bounded, filtered, within_texels, work_is_bounded,
};
pub use sets::visible_sets;
pub use symmetry::{mirrored, same_when_scaled, shifted, turned};
pub use weights::{horizon_weights, records_are_visible};
