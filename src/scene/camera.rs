//! The eye: a pinhole camera without lens or far plane, or one whose rays are parallel.

use crate::error::{Error, Result};
use glam::{DVec3, Vec3};

/// Sine and cosine of the 15 degrees from which [`Camera::framing`] looks down: enough to see the
/// top of things.
const ELEVATION: [f32; 2] = [0.258_819_04, 0.965_925_8];
/// How much of a picture [`Camera::framing`] fills at most, each way.
const FILLED: f32 = 0.92;

/// The axes of a camera in a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PoseAxes {
    /// x to the right, y down, z forward.
    OpenCv,
    /// x to the right, y up, z backward (Blender, `NeRF`).
    OpenGl,
}

/// What a camera makes of a point at `(x, y, z)` to the right, down and forward: the place on the
/// frame `(fx x / z + cx, fy y / z + cy)`, in pixels.
///
/// The frame's upper left corner is at `(0, 0)`, and its first pixel's centre, through which that
/// pixel's ray goes, at `(0.5, 0.5)`. Where a calibration counts from the centre of the first pixel,
/// as that of `OpenCV` does, add 0.5 to its `cx` and `cy`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intrinsics {
    /// Focal length across in pixels, 1e-3 to 1e6.
    pub fx: f32,
    /// Focal length down in pixels, 1e-3 to 1e6.
    pub fy: f32,
    /// Column of the optical axis in pixels, -32768 to 65536.
    pub cx: f32,
    /// Row of the optical axis in pixels, -32768 to 65536.
    pub cy: f32,
}

impl Intrinsics {
    /// So far may the optical axis be from a frame's corner: the frame then lies within the guard
    /// band around it.
    const CENTER: std::ops::RangeInclusive<f32> = -32768.0..=65536.0;

    fn is_valid(&self) -> bool {
        [self.fx, self.fy].iter().all(|f| (1e-3..=1e6).contains(f))
            && [self.cx, self.cy].iter().all(|c| Self::CENTER.contains(c))
    }
}

/// Where the rays of a camera come from: one place, or, where they are parallel, one direction.
///
/// Both are a point in homogeneous coordinates, `(place, share)`, with a share of 1 or 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eye {
    /// A place in world units, or a direction to the eye of length one.
    pub place: Vec3,
    /// 1 for a place and 0 for a direction.
    pub share: f32,
}

impl Eye {
    /// The way from a world position to the eye; of length one where that is a direction.
    #[inline(always)]
    pub fn seen_from(&self, position: Vec3) -> Vec3 {
        self.place - position * self.share
    }

    /// The same in f64.
    #[inline(always)]
    pub fn seen_from_exact(&self, position: DVec3) -> DVec3 {
        self.place.as_dvec3() - position * f64::from(self.share)
    }
}

/// A pinhole camera, or an [orthographic](Self::orthographic) one. World space is right-handed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where the eye is, in world units; of an orthographic camera the middle of the picture, from
    /// where distances along the view count.
    pub eye: Vec3,
    /// A point in the middle of the picture.
    pub target: Vec3,
    /// A direction that points upwards in the picture; not parallel to the view.
    pub up: Vec3,
    /// Vertical field of view in degrees, above 0 and below 180. Default: 60.
    pub fov_degrees: f32,
    /// Focal lengths and optical axis on the whole frame in pixels, in place of the field of view.
    /// Default: `None`, square pixels and the axis in the frame's middle.
    pub intrinsics: Option<Intrinsics>,
    /// The picture's height in world units, 1e-9 to 1e9, of a camera whose rays are all parallel to the
    /// view; in place of the field of view. Pixels are square, and the eye lies in the frame's middle.
    /// Default: `None`, rays through one place.
    pub orthographic: Option<f32>,
    /// Distance along the view, in world units, before which nothing is drawn. Default: 0.01.
    pub near: f32,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            eye: Vec3::new(0.0, 0.0, 3.0),
            target: Vec3::ZERO,
            up: Vec3::Y,
            fov_degrees: 60.0,
            intrinsics: None,
            orthographic: None,
            near: 0.01,
        }
    }
}

impl Camera {
    /// Frames the box from `min` to `max` (world units) from its front, which is the side of +Z,
    /// and a little from above, at the default field of view. A picture that is `aspect` times as
    /// wide as high, or wider, shows all of it with a small margin.
    pub fn framing(min: Vec3, max: Vec3, aspect: f32) -> Self {
        let center = (min + max) * 0.5;
        // Far from the origin f32 cannot tell an eye nearer than this from its target.
        let least = (center.abs().max_element() * 1e-5).max(1e-6);
        let half = ((max - min) * 0.5).max(Vec3::splat(least));
        let to_eye = Vec3::new(0.0, ELEVATION[0], ELEVATION[1]);
        let up = Vec3::new(0.0, ELEVATION[1], -ELEVATION[0]);
        // A corner is in view at the distance `toward + |across| / slope` and beyond; left and
        // right are alike.
        let slope = Self::default().tan_half_fov() as f32 * FILLED;
        let distance = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|[y, z]| {
            let corner = half * Vec3::new(1.0, y, z);
            corner.dot(to_eye) + (corner.x / aspect).max(corner.dot(up).abs()) / slope
        });
        let eye = center + to_eye * distance.into_iter().fold(0.0, f32::max);
        Self { eye, target: center, near: half.length() * 1e-3, ..Self::default() }
    }

    /// The axes of view space in world space: right, up and forward, each of length one.
    pub fn axes(&self) -> [Vec3; 3] {
        // Where the view is nearly along `up`, their product in f32 is not across both; where it is
        // just along it, that in f64 is 0.
        let ahead = self.target.as_dvec3() - self.eye.as_dvec3();
        let right = ahead.cross(self.up.as_dvec3()).normalize();
        let forward = ahead.normalize();
        [right, right.cross(forward), forward].map(|axis| axis.as_vec3())
    }

    /// Where its rays come from.
    pub fn viewpoint(&self) -> Eye {
        match self.orthographic {
            Some(_) => Eye { place: -self.axes()[2], share: 0.0 },
            None => Eye { place: self.eye, share: 1.0 },
        }
    }

    /// A camera from its pose, the matrix from the camera's axes to the world, row by row: its
    /// columns are the axes and the eye. `near` is the default's.
    ///
    /// # Errors
    /// Says so where the axes are not of length one, at right angles and right-handed, within 1e-3,
    /// or where the camera is not valid.
    pub fn from_pose(pose: &[[f32; 4]; 4], axes: PoseAxes, intrinsics: Intrinsics) -> Result<Self> {
        let intrinsics = Some(intrinsics);
        let camera = Self { intrinsics, ..Self::default() }.posed(pose, axes)?;
        camera.validate().map(|()| camera)
    }

    /// The camera in another [pose](Self::from_pose).
    ///
    /// # Errors
    /// As [`Self::from_pose`].
    pub fn posed(self, pose: &[[f32; 4]; 4], axes: PoseAxes) -> Result<Self> {
        let refuse = |reason: &str| Err(Error::scene("camera", reason));
        let [x, y, z, eye] =
            [0, 1, 2, 3].map(|column| Vec3::from([0, 1, 2].map(|row| pose[row][column])));
        if pose[3] != [0.0, 0.0, 0.0, 1.0] || !eye.is_finite() {
            return refuse("the pose's last row must be 0, 0, 0, 1, and its place finite");
        }
        let is_near = |a: f32, b: f32| (a - b).abs() <= 1e-3;
        let are_unit = [x, y, z].iter().all(|axis| is_near(axis.length(), 1.0));
        // The third axis of a right-handed frame: compared, which finds out angles as well.
        let is_right = [0, 1, 2].iter().all(|&i| is_near(x.cross(y)[i], z[i]));
        if !are_unit || !is_right || !is_near(x.dot(y), 0.0) {
            return refuse("the pose's axes must be a rotation: of length one and right-handed");
        }
        let (up, forward) = match axes {
            PoseAxes::OpenCv => (-y, z),
            PoseAxes::OpenGl => (y, -z),
        };
        // As far from the eye as that from the origin: nearer, rounding would turn the view.
        let target = eye + forward * eye.abs().max_element().max(1.0);
        Ok(Self { eye, target, up, ..self })
    }

    /// Focal lengths and optical axis on a frame of so many pixels; pixels per world unit in place of
    /// focal lengths where the camera is orthographic.
    pub fn on_frame(&self, width: u32, height: u32) -> Intrinsics {
        self.intrinsics.unwrap_or_else(|| {
            let half =
                self.orthographic.map_or_else(|| self.tan_half_fov(), |h| f64::from(h) * 0.5);
            let focal = (f64::from(height) * 0.5 / half) as f32;
            let [cx, cy] = [width, height].map(|side| side as f32 * 0.5);
            Intrinsics { fx: focal, fy: focal, cx, cy }
        })
    }

    fn tan_half_fov(&self) -> f64 {
        (f64::from(self.fov_degrees).to_radians() * 0.5).tan()
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
        if self.intrinsics.is_some_and(|intrinsics| !intrinsics.is_valid()) {
            return refuse(
                "focal lengths must be within 1e-3 to 1e6 pixels, the axis within -32768 to 65536",
            );
        }
        if self.orthographic.is_some_and(|height| !(1e-9..=1e9).contains(&height)) {
            return refuse("an orthographic picture's height must be within 1e-9 to 1e9");
        }
        if self.orthographic.is_some() && self.intrinsics.is_some() {
            return refuse("intrinsics are those of a pinhole camera, not of an orthographic one");
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

    /// Where the corners of a box are seen, -1 to 1 from the left and lower edge of the picture to
    /// the others.
    fn corners_seen(camera: &Camera, min: Vec3, max: Vec3, aspect: f32) -> Vec<[f32; 2]> {
        let [right, up, forward] = camera.axes();
        let tan = (camera.fov_degrees.to_radians() * 0.5).tan();
        let corner =
            |i: u32| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { min[axis] } else { max[axis] });
        (0..8)
            .map(|i| Vec3::from_array(corner(i)) - camera.eye)
            .map(|ray| {
                [ray.dot(right) / aspect, ray.dot(up)]
                    .map(|across| across / (ray.dot(forward) * tan))
            })
            .collect()
    }

    #[test]
    fn framing_fills_the_picture_and_keeps_a_margin() {
        let boxes = [
            [1.0, 1.0, 1.0],
            [10.0, 1.0, 1.0],
            [1.0, 10.0, 1.0],
            [1.0, 1.0, 10.0],
            [5.0, 0.0, 5.0],
            [2.0, 3.0, 0.0],
        ];
        for half in boxes.map(Vec3::from_array) {
            for aspect in [0.4, 1.0, 16.0 / 9.0] {
                let (min, max) = (Vec3::splat(7.0) - half, Vec3::splat(7.0) + half);
                let camera = Camera::framing(min, max, aspect);
                let seen = corners_seen(&camera, min, max, aspect);
                let farthest =
                    seen.as_flattened().iter().fold(0.0_f32, |most, at| most.max(at.abs()));
                assert!((0.9..0.93).contains(&farthest), "{half} at {aspect}: {seen:?}");
                let wider = corners_seen(&camera, min, max, aspect * 2.0);
                assert!(
                    wider.as_flattened().iter().all(|at| at.abs() < 0.93),
                    "{half} at {aspect}: {wider:?}"
                );
            }
        }
    }

    #[test]
    fn framing_looks_at_the_front_from_a_little_above() {
        let camera = Camera::framing(Vec3::new(-1.0, 0.0, -3.0), Vec3::new(1.0, 4.0, 1.0), 1.0);
        let [right, _, forward] = camera.axes();
        assert!(right.abs_diff_eq(Vec3::X, 1e-6) && forward.z < 0.0);
        assert!((forward.y.asin().to_degrees() + 15.0).abs() < 1e-3, "{forward}");
    }

    #[test]
    fn framing_is_valid_whatever_the_size_and_place() {
        for scale in [0.0, 1e-9, 1.0, 1e18_f32] {
            for place in [Vec3::ZERO, Vec3::ONE, Vec3::splat(1e18) - scale] {
                let (min, max) = (place - scale, place + scale);
                let camera = Camera::framing(min, max, 1.0);
                camera.validate().unwrap_or_else(|error| panic!("{scale} at {place}: {error}"));
                let forward = camera.axes()[2];
                let nearest =
                    (camera.target - camera.eye).dot(forward) - (max - min).length() * 0.5;
                assert!(
                    camera.near <= nearest,
                    "{scale} at {place}: near {} beyond {nearest}",
                    camera.near
                );
            }
        }
    }
}
