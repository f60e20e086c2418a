//! The view ray of a pixel.

/// The view ray of a pixel in the texture, in repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// `(u, v)` where it meets the polygon.
    pub base: [f32; 2],
    /// How far it moves along the texture down to the deepest relief.
    pub displacement: [f32; 2],
    /// The part of the relief depth at which it first meets relief, 0 to 1.
    pub hit_depth: f32,
    /// `(u, v)` there: `base + hit_depth * displacement`.
    pub hit: [f32; 2],
}
