//! A sun's disc.

use crate::scene::{Light, angle};
use glam::Vec3;

/// A sun as it is seen from anywhere.
#[derive(Clone, Copy, Debug)]
pub struct Disc {
    /// A unit direction to its middle.
    pub to_middle: Vec3,
    /// The tangent of half its size.
    pub radius: f32,
}

impl Disc {
    /// By the unit direction to its middle and its size in degrees.
    pub fn new(to_middle: Vec3, degrees: f32) -> Self {
        let [cos, sin] = angle::cos_sin(f64::from(degrees) * (0.5 / 360.0));
        Self { to_middle, radius: (sin / cos) as f32 }
    }

    /// Of a light, if it is a sun.
    pub fn of(light: &Light) -> Option<Self> {
        match *light {
            Light::Sun { to_light, angular_size, .. } => {
                Some(Self::new(to_light.normalize_or_zero(), angular_size))
            }
            Light::Point { .. } => None,
        }
    }

    /// Unit directions to so many points of it, each of which stands for the same part.
    pub fn points(&self, num: usize) -> impl Iterator<Item = Vec3> + use<> {
        let Self { to_middle, radius } = *self;
        let [x, y] = <[Vec3; 2]>::from(to_middle.any_orthonormal_pair());
        spiral(num).map(move |(turn, share)| {
            let ([cos, sin], share) = (turn.map(|c| c as f32), share as f32);
            (to_middle + (x * cos + y * sin) * (share.sqrt() * radius)).normalize_or_zero()
        })
    }
}

/// Points of a disc (Vogel 1979), each with the same area: the direction from the middle, and the
/// share of the disc that is nearer to it.
pub fn spiral(num: usize) -> impl Iterator<Item = ([f64; 2], f64)> {
    // Cosine and sine of the golden angle, pi (3 - sqrt 5): turned by products, since sines of the
    // platform differ from machine to machine.
    const TURN: [f64; 2] = [-0.737_368_878_078_319_8, 0.675_490_294_261_523_7];
    let mut turn = [1.0_f64, 0.0];
    (0..num).map(move |i| {
        let [x, y] = turn;
        turn = [x * TURN[0] - y * TURN[1], x * TURN[1] + y * TURN[0]];
        ([x, y], (i as f64 + 0.5) / num as f64)
    })
}
