//! A camera that goes around a place.

use basrelief::Camera;
use glam::Vec3;

/// Steepest view up or down, in radians: straight up has no sideways.
const STEEPEST: f32 = 1.5;

/// How far from its first distance the eye can go, as a factor.
const FARTHEST: f32 = 1e3;

/// A camera as its place on a sphere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Orbit {
    camera: Camera,
    /// The vertical, and the two directions that angles are measured from.
    axes: [Vec3; 3],
    first_distance: f32,
    distance: f32,
    /// Radians around the vertical, and above the level.
    yaw: f32,
    pitch: f32,
}

impl Orbit {
    /// Begins where a valid camera is.
    pub(crate) fn new(camera: Camera) -> Self {
        let up = camera.up.normalize();
        let from_target = camera.eye - camera.target;
        let level =
            (from_target - up * from_target.dot(up)).normalize_or(up.any_orthonormal_vector());
        let distance = from_target.length();
        let pitch =
            (from_target.dot(up) / distance).clamp(-1.0, 1.0).asin().clamp(-STEEPEST, STEEPEST);
        Self {
            camera,
            axes: [up, level, up.cross(level)],
            first_distance: distance,
            distance,
            yaw: 0.0,
            pitch,
        }
    }

    /// Where the eye is now.
    pub(crate) fn camera(&self) -> Camera {
        let [up, east, north] = self.axes;
        let level = east * self.yaw.cos() + north * self.yaw.sin();
        let eye =
            self.camera.target + (level * self.pitch.cos() + up * self.pitch.sin()) * self.distance;
        // Close to a surface the near plane must come along.
        let near = self.camera.near * (self.distance / self.first_distance).min(1.0);
        // With parallel rays nothing gets larger by going nearer: the picture shows less.
        let nearer = self.distance / self.first_distance;
        let orthographic = self.camera.orthographic.map(|height| height * nearer);
        Camera { eye, near, orthographic, ..self.camera }
    }

    /// Turns by radians around the vertical and up.
    pub(crate) fn turn(&mut self, yaw: f32, pitch: f32) {
        self.yaw = (self.yaw + yaw) % std::f32::consts::TAU;
        self.pitch = (self.pitch + pitch).clamp(-STEEPEST, STEEPEST);
    }

    /// Moves the place in the middle by parts of the picture's height, to the right and up.
    pub(crate) fn pan(&mut self, right: f32, up: f32) {
        let camera = self.camera();
        let [x, y, _] = camera.axes();
        let height = camera
            .orthographic
            .unwrap_or_else(|| 2.0 * self.distance * (camera.fov_degrees.to_radians() * 0.5).tan());
        self.camera.target += (x * right + y * up) * height;
    }

    /// Goes nearer by steps; negative ones go away.
    pub(crate) fn zoom(&mut self, steps: f32) {
        let factor = (-0.12 * steps).exp();
        let [least, most] = [self.first_distance / FARTHEST, self.first_distance * FARTHEST];
        self.distance = (self.distance * factor).clamp(least, most);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera {
            eye: Vec3::new(1.0, 2.0, 5.0),
            target: Vec3::new(0.5, 0.5, -1.0),
            ..Camera::default()
        }
    }

    #[test]
    fn it_begins_where_the_camera_is() {
        for up in [Vec3::Y, Vec3::Z, Vec3::new(1.0, 3.0, 0.2)] {
            let camera = Camera { up, ..camera() };
            assert!(Orbit::new(camera).camera().eye.distance(camera.eye) < 1e-4, "{up}");
        }
    }

    #[test]
    fn every_way_to_move_gives_a_valid_camera() {
        let mut orbit = Orbit::new(camera());
        for i in 0..500 {
            let step = i as f32;
            orbit.turn(step * 0.1, (step * 0.7).sin());
            orbit.pan((step * 0.3).sin() * 0.1, 0.05);
            orbit.zoom(if i < 250 { 1.0 } else { -1.0 });
            orbit.camera().validate().unwrap_or_else(|e| panic!("step {i}: {e}"));
        }
    }

    #[test]
    fn turning_keeps_the_distance_and_zooming_the_direction() {
        let mut orbit = Orbit::new(camera());
        let distance = |orbit: &Orbit| orbit.camera().eye.distance(orbit.camera().target);
        let before = distance(&orbit);
        orbit.turn(1.0, 0.2);
        assert!((distance(&orbit) - before).abs() < 1e-3);
        let [.., forward] = orbit.camera().axes();
        orbit.zoom(3.0);
        assert!(
            distance(&orbit) < before * 0.8 && orbit.camera().axes()[2].distance(forward) < 1e-4
        );
    }
}
