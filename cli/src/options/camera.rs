//! Options of the camera, `[camera]` in scene files, and the lines of a list of cameras.

use crate::options::choices::{self, one_of};
use crate::options::file_values;
use crate::options::values::{self, Pose};
use basrelief::{Camera, Intrinsics, PoseAxes};
use clap::Args;
use glam::Vec3;
use serde::{Deserialize, Serialize};

#[derive(Args, Clone, Debug, Default, Serialize, Deserialize)]
#[command(next_help_heading = "Camera (what is not given frames the scene)")]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct CameraOptions {
    /// Where the eye is, in the scene's units
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    #[serde(deserialize_with = "file_values::vector")]
    eye: Option<Vec3>,
    /// The point in the middle of the picture
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    #[serde(deserialize_with = "file_values::vector")]
    target: Option<Vec3>,
    /// The direction that points upwards in the picture
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    #[serde(deserialize_with = "file_values::direction")]
    up: Option<Vec3>,
    /// Vertical field of view in degrees
    #[arg(long, value_name = "DEG", value_parser = values::field_of_view, allow_hyphen_values = true)]
    #[serde(deserialize_with = "file_values::field_of_view")]
    fov: Option<f32>,
    /// Focal lengths and optical axis in pixels of the whole frame, whose first pixel has its centre
    /// at 0.5,0.5; in place of --fov
    #[arg(long, value_name = "FX,FY,CX,CY", value_parser = values::intrinsics, allow_hyphen_values = true)]
    #[serde(deserialize_with = "file_values::intrinsics")]
    intrinsics: Option<[f32; 4]>,
    /// Draw with parallel rays a picture so high, in the scene's units; in place of --fov
    #[arg(long, value_name = "HEIGHT", value_parser = values::picture_height, allow_hyphen_values = true, conflicts_with_all = ["fov", "intrinsics"])]
    #[serde(deserialize_with = "file_values::picture_height")]
    orthographic: Option<f32>,
    /// Where the camera is and how it lies: the 4x4 matrix from its axes to the world, 16 numbers
    /// row by row; in place of --eye, --target and --up
    #[arg(long, value_name = "M11,M12,...,M44", value_parser = values::pose, allow_hyphen_values = true, conflicts_with_all = ["eye", "target", "up"])]
    #[serde(deserialize_with = "file_values::pose")]
    pose: Option<Pose>,
    /// The axes of --pose [default: opencv]
    #[arg(long, value_name = "WHOSE", value_parser = one_of(choices::POSE_AXES), requires = "pose")]
    #[serde(with = "choices")]
    pose_axes: Option<PoseAxes>,
    /// Distance from the eye before which nothing is drawn, in the scene's units
    #[arg(long, value_name = "D", value_parser = values::above_zero, allow_hyphen_values = true)]
    #[serde(deserialize_with = "file_values::above_zero")]
    near: Option<f32>,
}

impl From<&Camera> for CameraOptions {
    /// Options that give all of `camera`.
    fn from(camera: &Camera) -> Self {
        let Camera { eye, target, up, fov_degrees, intrinsics, orthographic, near } = *camera;
        Self {
            eye: Some(eye),
            target: Some(target),
            up: Some(up),
            fov: orthographic.is_none().then_some(fov_degrees),
            intrinsics: intrinsics.map(|Intrinsics { fx, fy, cx, cy }| [fx, fy, cx, cy]),
            orthographic,
            // The eye, target and up say the same.
            pose: None,
            pose_axes: None,
            near: Some(near),
        }
    }
}

impl CameraOptions {
    /// Refuses what contradicts itself; on the command line the options' own rules do.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        let is_placed = self.eye.is_some() || self.target.is_some() || self.up.is_some();
        if self.orthographic.is_some() && (self.fov.is_some() || self.intrinsics.is_some()) {
            return Err("orthographic takes the place of fov and intrinsics");
        }
        match self.pose {
            Some(_) if is_placed => Err("a pose takes the place of eye, target and up"),
            None if self.pose_axes.is_some() => Err("pose-axes needs a pose"),
            _ => Ok(()),
        }
    }

    /// Drops a pose where `over` says where the eye is, and the other way round, and parallel rays
    /// where it says how others go.
    pub(crate) fn make_way_for(&mut self, over: &Self) {
        if over.orthographic.is_some() {
            (self.fov, self.intrinsics) = (None, None);
        }
        if over.fov.is_some() || over.intrinsics.is_some() {
            self.orthographic = None;
        }
        if over.pose.is_some() {
            (self.eye, self.target, self.up) = (None, None, None);
        }
        if over.eye.is_some() || over.target.is_some() || over.up.is_some() {
            (self.pose, self.pose_axes) = (None, None);
        }
    }

    /// A camera with what these say.
    pub(crate) fn placed(&self, start: &Camera) -> Camera {
        let intrinsics = self.intrinsics.map(|[fx, fy, cx, cy]| Intrinsics { fx, fy, cx, cy });
        // Parallel rays and others take each other's place.
        let is_pinhole = self.fov.is_some() || intrinsics.is_some();
        let (of_start, is_parallel) = (start.orthographic, self.orthographic.is_some());
        let mut camera = Camera {
            eye: self.eye.unwrap_or(start.eye),
            target: self.target.unwrap_or(start.target),
            up: self.up.unwrap_or(start.up),
            fov_degrees: self.fov.unwrap_or(start.fov_degrees),
            intrinsics: intrinsics.or(start.intrinsics.filter(|_| !is_parallel)),
            orthographic: self.orthographic.or(of_start.filter(|_| !is_pinhole)),
            near: self.near.unwrap_or(start.near),
        };
        if let Some(pose) = &self.pose {
            let axes = self.pose_axes.unwrap_or(PoseAxes::OpenCv);
            // The option's parser refused what is no pose, whatever the axes.
            return camera.posed(pose, axes).unwrap_or(camera);
        }
        let is_vertical =
            (camera.target - camera.eye).normalize_or_zero().cross(camera.up).length() < 1e-4;
        if is_vertical && self.up.is_none() {
            // Seen from straight above or below: what lies at the back is drawn at the top.
            camera.up = Vec3::NEG_Z;
        }
        camera
    }
}
