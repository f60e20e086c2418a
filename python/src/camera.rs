//! Where pictures are taken from.

use crate::arguments::{choice, exception, matrix, refused, tuple, vector};
use basrelief::{Intrinsics, PoseAxes};
use glam::Vec3;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// A pinhole camera, or an orthographic one. The world is right-handed.
///
/// Camera(eye, target, up=(0, 1, 0), fov=60.0, near=0.01, *, orthographic=None)
///
/// eye, target, up: three numbers each: where the eye is and what lies in the middle of the
///     picture, in world units, and a direction that points upwards in the picture.
/// fov: vertical field of view in degrees, above 0 and below 180.
/// near: distance along the view, in world units, before which nothing is drawn.
/// orthographic: in place of fov, the picture's height in world units, 1e-9 to 1e9, of a camera whose
///     rays are all parallel to the view. Depths count from the eye along the view here, too.
#[pyclass(frozen, eq, from_py_object, module = "basrelief")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Camera(pub(crate) basrelief::Camera);

fn checked(camera: basrelief::Camera) -> PyResult<Camera> {
    camera.validate().map_err(exception)?;
    Ok(Camera(camera))
}

#[pymethods]
impl Camera {
    #[new]
    #[pyo3(signature = (eye, target, up = None, fov = None, near = 0.01, *, orthographic = None))]
    fn new(
        eye: &Bound<'_, PyAny>,
        target: &Bound<'_, PyAny>,
        up: Option<&Bound<'_, PyAny>>,
        fov: Option<f32>,
        near: f32,
        orthographic: Option<f32>,
    ) -> PyResult<Self> {
        let start = basrelief::Camera { near, ..basrelief::Camera::default() };
        Self(start).replace(Some(eye), Some(target), up, fov, None, orthographic)
    }

    /// A camera as programs have it.
    ///
    /// fx, fy: focal lengths in pixels. cx, cy: the optical axis in pixels, from the frame's upper
    ///     left corner.
    /// pose: array (4, 4), from the camera's axes to the world: its columns are the axes and the
    ///     eye.
    /// convention: "opencv" (x right, y down, z forward) or "opengl" (x right, y up, z backward:
    ///     Blender, NeRF).
    /// first_pixel: where the first pixel's centre lies in the intrinsics' count: 0.5 (default), or
    ///     0 for calibrations such as OpenCV's.
    #[staticmethod]
    #[pyo3(signature = (fx, fy, cx, cy, pose, convention = "opencv", *, first_pixel = 0.5, near = 0.01))]
    fn from_intrinsics(
        fx: f32,
        fy: f32,
        cx: f32,
        cy: f32,
        pose: &Bound<'_, PyAny>,
        convention: &str,
        first_pixel: f32,
        near: f32,
    ) -> PyResult<Self> {
        let axes = [("opencv", PoseAxes::OpenCv), ("opengl", PoseAxes::OpenGl)];
        let axes = choice("convention", convention, &axes)?;
        if ![0.0, 0.5].contains(&first_pixel) {
            return Err(refused("first_pixel", "must be 0 or 0.5"));
        }
        let [cx, cy] = [cx, cy].map(|c| c + (0.5 - first_pixel));
        let intrinsics = Intrinsics { fx, fy, cx, cy };
        let camera = basrelief::Camera::from_pose(&matrix(pose, "pose")?, axes, intrinsics);
        checked(basrelief::Camera { near, ..camera.map_err(exception)? })
    }

    /// A camera that sees all of the box from `least` to `most` (three numbers each) on pictures
    /// `aspect` times as wide as high, and on wider ones: from +z and a little from above.
    #[staticmethod]
    #[pyo3(signature = (least, most, aspect = 1.0))]
    fn framing(least: &Bound<'_, PyAny>, most: &Bound<'_, PyAny>, aspect: f32) -> PyResult<Self> {
        if !(aspect > 0.0 && aspect.is_finite()) {
            return Err(refused("aspect", "must be above 0"));
        }
        let [least, most] = [vector(least, "least")?, vector(most, "most")?];
        checked(basrelief::Camera::framing(least, most, aspect))
    }

    /// The same camera with some of eye, target, up, fov, near and orthographic replaced: fov,
    /// intrinsics and orthographic take each other's place.
    #[pyo3(signature = (*, eye = None, target = None, up = None, fov = None, near = None,
        orthographic = None))]
    fn replace(
        &self,
        eye: Option<&Bound<'_, PyAny>>,
        target: Option<&Bound<'_, PyAny>>,
        up: Option<&Bound<'_, PyAny>>,
        fov: Option<f32>,
        near: Option<f32>,
        orthographic: Option<f32>,
    ) -> PyResult<Self> {
        let given = |arg: Option<&Bound<'_, PyAny>>, name, own| {
            arg.map_or(Ok(own), |arg| vector(arg, name))
        };
        if fov.is_some() && orthographic.is_some() {
            return Err(refused("orthographic", "takes the place of fov"));
        }
        let intrinsics = self.0.intrinsics.filter(|_| fov.is_none() && orthographic.is_none());
        let own_height = self.0.orthographic.filter(|_| fov.is_none());
        checked(basrelief::Camera {
            eye: given(eye, "eye", self.0.eye)?,
            target: given(target, "target", self.0.target)?,
            up: given(up, "up", self.0.up)?,
            fov_degrees: fov.unwrap_or(self.0.fov_degrees),
            intrinsics,
            orthographic: orthographic.or(own_height),
            near: near.unwrap_or(self.0.near),
        })
    }

    #[getter]
    fn eye<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        tuple(py, self.0.eye)
    }

    #[getter]
    fn target<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        tuple(py, self.0.target)
    }

    #[getter]
    fn up<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        tuple(py, self.0.up)
    }

    /// Vertical field of view in degrees; does not count where there are intrinsics, nor where the
    /// camera is orthographic.
    #[getter]
    fn fov(&self) -> f32 {
        self.0.fov_degrees
    }

    #[getter]
    fn near(&self) -> f32 {
        self.0.near
    }

    /// (fx, fy, cx, cy) in pixels from the frame's upper left corner, or None.
    #[getter]
    fn intrinsics(&self) -> Option<(f32, f32, f32, f32)> {
        self.0.intrinsics.map(|i| (i.fx, i.fy, i.cx, i.cy))
    }

    /// The picture's height in world units where all rays are parallel, or None.
    #[getter]
    fn orthographic(&self) -> Option<f32> {
        self.0.orthographic
    }

    fn __repr__(&self) -> String {
        let basrelief::Camera { eye, target, up, fov_degrees, intrinsics, orthographic, near } =
            self.0;
        let [eye, target, up] = [eye, target, up].map(|v| format!("({}, {}, {})", v.x, v.y, v.z));
        let lens = match (intrinsics, orthographic) {
            (Some(i), _) => format!("intrinsics=({}, {}, {}, {})", i.fx, i.fy, i.cx, i.cy),
            (None, Some(height)) => format!("orthographic={height}"),
            (None, None) => format!("fov={fov_degrees}"),
        };
        format!("Camera(eye={eye}, target={target}, up={up}, {lens}, near={near})")
    }

    /// For copies and pickles.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let rebuild = py.get_type::<Self>().getattr("_rebuild")?;
        let numbers = (
            self.eye(py)?,
            self.target(py)?,
            self.up(py)?,
            self.0.fov_degrees,
            self.0.near,
            self.intrinsics(),
            self.0.orthographic,
        );
        PyTuple::new(py, [rebuild, numbers.into_pyobject(py)?.into_any()])
    }

    #[staticmethod]
    fn _rebuild(
        eye: [f32; 3],
        target: [f32; 3],
        up: [f32; 3],
        fov: f32,
        near: f32,
        intrinsics: Option<(f32, f32, f32, f32)>,
        orthographic: Option<f32>,
    ) -> PyResult<Self> {
        let [eye, target, up] = [eye, target, up].map(Vec3::from);
        let intrinsics = intrinsics.map(|(fx, fy, cx, cy)| Intrinsics { fx, fy, cx, cy });
        let fov_degrees = fov;
        checked(basrelief::Camera { eye, target, up, fov_degrees, intrinsics, orthographic, near })
    }
}
