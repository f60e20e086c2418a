//! Lights.

use glam::Vec3;

/// A light. Intensities are linear RGB, 0 to 1e6; a white surface that faces an intensity of 1 is
/// drawn white.
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

/// Whether linear RGB is within 0 to 1e6.
pub(super) fn is_light(rgb: Vec3) -> bool {
    rgb.cmpge(Vec3::ZERO).all() && rgb.cmple(Vec3::splat(1e6)).all()
}

impl Light {
    pub(crate) fn validate(&self) -> Result<(), String> {
        let (place, intensity) = match *self {
            Self::Directional { to_light, intensity } => (to_light, intensity),
            Self::Point { position, intensity } => (position, intensity),
        };
        // A comparison with NaN is false.
        if !place.abs().cmple(Vec3::splat(1e18)).all() {
            return Err("its place or direction must be finite and within 1e18".into());
        }
        if !is_light(intensity) {
            return Err("its intensity must be within 0 to 1e6".into());
        }
        if matches!(self, Self::Directional { .. }) && place.length_squared() < 1e-30 {
            return Err("the direction to the light must not be zero".into());
        }
        Ok(())
    }
}
