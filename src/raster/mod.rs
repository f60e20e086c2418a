//! Screen triangles to quads: edge functions and fill rule, bins, tiles, and quads with their attributes.

mod quad;

pub use quad::{AttributePlanes, LitPlanes, Plane, QuadPair};
