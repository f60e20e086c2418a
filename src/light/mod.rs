//! How bright a surface is: sky, Lambert and GGX.
//!
//! ```text
//! colour = emissive + k albedo (sky(n) + sum I max(0, n.l)) + R sky(r) + sum I F pi D V n.l
//! ```
//!
//! `R` is what the surface reflects of a sky of 1, `k` what is left of that for the diffuse layer of
//! what is not metal, `r` the direction that a mirror reflects to the eye; F, D and V are those of
//! [`reflection`]. Nothing is hidden from light there; [`exact`] is the truth, with rays. On flat pieces
//! the relief hides light from itself: [`BakedLight`], and on curved ones too: [`Horizons`].
//!
//! Where a pixel holds many normals, `n` is their mean, and the lobe is widened by how much shorter
//! than one it is: `a^2 + 2 (1 - |n|) / |n|` (Toksvig 2005, "Mipmapping normal maps").

mod bake;
mod beams;
mod byte_levels;
mod curved;
mod disc;
pub mod exact;
mod gloss;
mod horizons;
mod local;
pub mod reflection;
mod sky_lobe;
mod sky_shares;
mod skylines;
mod smooth;
mod sunlit;
mod surface_point;
mod texel_light;
mod vectors;

pub use bake::{BakedLight, Part};
pub use beams::{Beam, TextureFrame};
pub use curved::{Curved, CurvedSun, FrameLanes, LinearSky, Luster, Sheen, Shine, Slant, Ways};
pub use disc::{Disc, spiral};
pub use gloss::{Gloss, rough_length};
pub(crate) use gloss::{lobes, spread_square};
pub use horizons::{Horizons, NORMAL_PLANE, NUM_AZIMUTHS, SKY_PLANE, SKYLINE_PLANE};
pub use local::{LocalLight, LocalLights, Reflected, SeenGloss};
pub use sky_lobe::SkyLobe;
pub use sky_shares::{Layer, SkyShares};
pub(crate) use skylines::Skyline;
pub use skylines::Skylines;
pub use smooth::SmoothTriangle;
pub(crate) use smooth::shares;
pub use sunlit::{Sunlight, Sunlit, SunlitTexels};
pub use surface_point::{SurfacePoint, unit_axes};
pub(crate) use texel_light::lit_parts;
pub(crate) use vectors::dot;
pub use vectors::{Vectors, cross, repeat_length};
