//! The eye: a pinhole camera without lens or far plane.

use crate::error::{Error, Result};
use glam::Vec3;

/// A pinhole camera. World space is right-handed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where the eye is, in world units.
    pub eye: Vec3,
    /// A point in the middle of the picture.
    pub target: Vec3,
    /// A direction that points upwards in the picture; not parallel to the view.
    pub up: Vec3,
    /// Vertical field of view in degrees, above 0 and below 180. Default: 60.
    pub fov_degrees: f32,
    /// Distance along the view, in world units, before which nothing is drawn. Default: 0.01.
    pub near: f32,
}

impl Default for Camera {
    fn default() -> Self {
        Self { eye: Vec3::new(0.0, 0.0, 3.0), target: Vec3::ZERO, up: Vec3::Y, fov_degrees: 60.0, near: 0.01 }
    }
}

impl Camera {
    /// Frames the box from `min` to `max` (world units) from slightly above, at the default field of view.
    #[must_use]
    pub fn framing(min: Vec3, max: Vec3) -> Self {
        let center = (min + max) * 0.5;
        // Far from the origin f32 cannot tell an eye nearer than this from its target.
        let least = (center.abs().max_element() * 1e-5).max(1e-6);
        let radius = ((max - min).length() * 0.5).max(least);
        let direction = Vec3::new(0.45, 0.55, 1.0).normalize();
        let distance = radius / (0.5 * Self::default().fov_degrees.to_radians()).sin();
        Self { eye: center + direction * distance, target: center, near: radius * 1e-3, ..Self::default() }
    }

    /// The axes of view space in world space: right, up and forward, each of length one.
    #[must_use]
    pub fn axes(&self) -> [Vec3; 3] {
        let forward = (self.target - self.eye).normalize();
        let right = forward.cross(self.up).normalize();
        [right, right.cross(forward), forward]
    }

    /// Pixels per unit of `x / w` and `y / w`, where `w` is the distance along the view, for a frame `height` pixels high (pixels are square).
    #[must_use]
    pub fn focal_pixels(&self, height: u32) -> f32 {
        let tan = (f64::from(self.fov_degrees).to_radians() * 0.5).tan();
        (f64::from(height) * 0.5 / tan) as f32
    }

    /// Checks that the camera sees something.
    ///
    /// # Errors
    /// Names what is not finite, parallel or out of range.
    pub fn validate(&self) -> Result<()> {
        let refuse = |reason: &str| Err(Error::scene("camera", reason));
        if !(self.eye.is_finite() && self.target.is_finite() && self.up.is_finite()) {
            return refuse("eye, target and up must be finite");
        }
        if !(self.fov_degrees > 0.0 && self.fov_degrees < 180.0) {
            return refuse("the field of view must be above 0 and below 180 degrees");
        }
        if !(self.near > 0.0 && self.near.is_finite()) {
            return refuse("near must be above 0");
        }
        if !self.axes().iter().all(|axis| axis.is_finite() && axis.length_squared() > 0.5) {
            return refuse("eye and target must differ, and up must not be parallel to the view");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn framing_is_valid_and_holds_the_box_whatever_its_size_and_place() {
        for scale in [1e-9, 1.0, 1e18_f32] {
            for place in [Vec3::ZERO, Vec3::ONE, Vec3::splat(1e18) - scale] {
                let (min, max) = (place - scale, place + scale);
                let camera = Camera::framing(min, max);
                camera.validate().unwrap_or_else(|error| panic!("{scale} at {place}: {error}"));
                let forward = camera.axes()[2];
                let nearest = (camera.target - camera.eye).dot(forward) - (max - min).length() * 0.5;
                assert!(camera.near <= nearest, "{scale} at {place}: near {} beyond {nearest}", camera.near);
            }
        }
    }
}
