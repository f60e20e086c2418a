//! Lights.

use glam::Vec3;

/// A light. Intensities are linear RGB, 0 to 1e6; a white surface that faces an intensity of 1 is
/// drawn white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Light from infinitely far away.
    Sun {
        /// The direction towards the light; any length above 0.
        to_light: Vec3,
        /// Linear RGB of all of its disc together, however large that is.
        intensity: Vec3,
        /// The diameter of its disc in degrees, 0 to 90; 0 casts hard shadows.
        /// [`Light::SUN_SIZE`] is the real one's.
        angular_size: f32,
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
    /// The sun's diameter as it is seen from the earth, in degrees.
    pub const SUN_SIZE: f32 = 0.53;

    /// A sun as large as the real one.
    pub fn sun(to_light: Vec3, intensity: Vec3) -> Self {
        Self::Sun { to_light, intensity, angular_size: Self::SUN_SIZE }
    }

    pub(crate) fn validate(&self) -> Result<(), String> {
        let (place, intensity) = match *self {
            Self::Sun { to_light, intensity, .. } => (to_light, intensity),
            Self::Point { position, intensity } => (position, intensity),
        };
        // A comparison with NaN is false.
        if !place.abs().cmple(Vec3::splat(1e18)).all() {
            return Err("its place or direction must be finite and within 1e18".into());
        }
        if !is_light(intensity) {
            return Err("its intensity must be within 0 to 1e6".into());
        }
        if let Self::Sun { to_light, angular_size, .. } = *self {
            if to_light.length_squared() < 1e-30 {
                return Err("the direction to the light must not be zero".into());
            }
            if !(0.0..=90.0).contains(&angular_size) {
                return Err("its size must be within 0 to 90 degrees".into());
            }
        }
        Ok(())
    }
}
