//! The truth of light: rays from the exact hit to every light and to the sky.
//!
//! ```text
//!                    sun's disc, one point a sample          the sky, by two rays a sample:
//!                     /                                       one around the normal for the diffuse
//!        ___         /            ____                        layer, one as the surface reflects
//!       |   | mesh  /            |    | mesh
//!  -----|   |------/-------------|    |-----  polygon         each goes up through the relief
//!       |___|     /   ___                                     (relief::Climb), then past all
//!     \          /___/   \___/                relief          triangles (Occluders)
//!      \________p
//! ```
//!
//! The place is the relief's, not the polygon's; so is the shadow of a mesh with an outline
//! ([`Outlined`](crate::shell::Outlined)). Points on discs and in the sky are those of a
//! [`Sequence`], which is the same whatever lights there are: lights add up.
//!
//! Of what comes from the sky along the reflected ray the surface shows the share `w = F G2 / G1`, and
//! the diffuse layer is left with what a dielectric does not reflect, `1 - w`. So a surface of albedo
//! 1 under a sky of 1 that nothing hides is 1 at every sample.

mod between;
mod ceiling;
mod holes;
mod occluders;
mod rays;
mod reaching;
mod sequence;

pub use between::Receiver;
pub use ceiling::{Ceiling, Spots};
pub use occluders::{LightRay, Occluders};
pub use rays::{Clearance, ExactLight, Hit, Spot};
pub use reaching::{LightReaching, Reaching};
pub use sequence::Sequence;
