//! Draws height-mapped surfaces on the CPU.
#![forbid(unsafe_code)]

pub mod frame;
pub mod invariants;
pub mod metrics;
pub mod scene;
pub mod texture;

mod error;
// The stages are public to the crate's own tests, benches and fuzz targets, and no part of the interface.
#[doc(hidden)]
pub mod filter;
#[doc(hidden)]
pub mod geometry;
#[doc(hidden)]
pub mod raster;
#[doc(hidden)]
pub mod reference;
#[doc(hidden)]
pub mod relief;
mod render;
mod settings;
#[doc(hidden)]
pub mod shade;
#[doc(hidden)]
pub mod simd;

pub use error::{Error, Result};
pub use frame::Frame;
pub use render::{Renderer, Stats, render};
pub use scene::{Camera, Light, Material, Mesh, Scene};
pub use settings::{Derivatives, Filter, Formulas, Lighting, Settings, Visibility};
pub use simd::LEVEL as SIMD_LEVEL;
