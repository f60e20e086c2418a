//! The relief of a mesh in the world: what lies between its polygons and its deepest relief.
//!
//! Each vertex has an *offset*, from the polygon down to where relief of depth 1 is: along its
//! normal, as long as the relief is deep there, `O = -S W N`. Over a triangle it is linear, as
//! positions are. So each triangle stands on a prism, and neighbours share their sides: a point at
//! depth `t` with the shares `b` of the corners is at `sum b_i (P_i + t O_i)`, and its texture
//! coordinates are `sum b_i uv_i`.
//!
//! ```text
//!   eye o
//!        \  P0_______P1_____P2       polygons
//!         \ /\   |  /|      |\
//!          X  \  | / |      | \     a view ray goes from prism to prism: down while it sees
//!         / \  \ |/  |      |  \    triangles from the front, up where it sees them from behind.
//!            ---Q0---Q1-----Q2      It hits relief or leaves through a polygon: past the outline
//! ```

mod course;
mod curvature;
mod follow;
mod neighbors;
mod outlined;
mod prism;
mod prisms;

pub use course::Course;
pub use follow::{Met, ReliefHit, ViewRay, Width};
pub use outlined::Outlined;
pub use prisms::{Passable, Shell, is_seen_from_behind};
