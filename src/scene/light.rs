//! Lights.

use glam::Vec3;

/// A light. Intensities are linear RGB, 0 or more; a white surface that faces an intensity of 1 is drawn white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Light from infinitely far away.
    Directional {
        /// The direction towards the light; any length above 0.
        to_light: Vec3,
        /// Linear RGB.
        intensity: Vec3,
    },
    /// Light from a point, falling off with the square of the distance.
    Point {
        /// Where the light is, in world units.
        position: Vec3,
        /// Linear RGB at a distance of one world unit.
        intensity: Vec3,
    },
}

impl Light {
    pub(crate) fn validate(&self) -> Result<(), String> {
        let (place, intensity) = match *self {
            Self::Directional { to_light, intensity } => (to_light, intensity),
            Self::Point { position, intensity } => (position, intensity),
        };
        if !place.is_finite() || !intensity.is_finite() || intensity.min_element() < 0.0 {
            return Err("place and intensity must be finite, intensity 0 or more".into());
        }
        if matches!(self, Self::Directional { .. }) && place.length_squared() < 1e-30 {
            return Err("the direction to the light must not be zero".into());
        }
        Ok(())
    }
}
