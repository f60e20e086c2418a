//! What lights a scene. Colours are linear; a white surface that faces an intensity of 1 is drawn
//! white.

use crate::arguments::{color, exception, floats, numbers, refused, tuple, vector};
use crate::pickles::{Made, array, made};
use basrelief::Light;
use glam::Vec3;
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;

/// Light from infinitely far away.
///
/// Sun(direction, color=1.0, size=0.53)
///
/// direction: three numbers, towards the light.
/// color: linear red, green and blue, or one number for all three, 0 to 1e6.
/// size: diameter of its disc in degrees, 0 (hard shadows) to 90.
#[pyclass(frozen, module = "basrelief")]
#[derive(Debug)]
pub(crate) struct Sun(pub(crate) Light);

#[pymethods]
impl Sun {
    #[new]
    #[pyo3(signature = (direction, color = None, size = Light::SUN_SIZE))]
    fn new(
        direction: &Bound<'_, PyAny>,
        color: Option<&Bound<'_, PyAny>>,
        size: f32,
    ) -> PyResult<Self> {
        let to_light = vector(direction, "direction")?;
        Ok(Self(Light::Sun { to_light, intensity: given(color)?, angular_size: size }))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py>> {
        light(py, self.0)
    }

    fn __repr__(&self) -> String {
        format!("{:?}", self.0)
    }
}

/// Light from a point, falling off with the square of the distance; it casts no shadows.
///
/// PointLight(position, color=1.0)
///
/// position: three numbers, in world units.
/// color: linear red, green and blue at a distance of one world unit, or one number, 0 to 1e6.
#[pyclass(frozen, module = "basrelief")]
#[derive(Debug)]
pub(crate) struct PointLight(pub(crate) Light);

#[pymethods]
impl PointLight {
    #[new]
    #[pyo3(signature = (position, color = None))]
    fn new(position: &Bound<'_, PyAny>, color: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let position = vector(position, "position")?;
        Ok(Self(Light::Point { position, intensity: given(color)? }))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py>> {
        light(py, self.0)
    }

    fn __repr__(&self) -> String {
        format!("{:?}", self.0)
    }
}

/// What makes a light again.
fn light(py: Python<'_>, light: Light) -> PyResult<Made<'_>> {
    match light {
        Light::Sun { to_light, intensity, angular_size } => {
            made::<Sun>(py, (tuple(py, to_light)?, tuple(py, intensity)?, angular_size))
        }
        Light::Point { position, intensity } => {
            made::<PointLight>(py, (tuple(py, position)?, tuple(py, intensity)?))
        }
    }
}

fn given(arg: Option<&Bound<'_, PyAny>>) -> PyResult<Vec3> {
    arg.map_or(Ok(Vec3::ONE), |arg| color(arg, "color"))
}

/// Light from everywhere, unless it is hidden. Up is +y.
///
/// Sky(color), or Sky(top, horizon, ground) with a blend between three colours.
///
/// Each is linear red, green and blue, or one number for all three, 0 to 1e6.
#[pyclass(frozen, module = "basrelief")]
#[derive(Debug)]
pub(crate) struct Sky(pub(crate) basrelief::Sky);

#[pymethods]
impl Sky {
    #[new]
    #[pyo3(signature = (top, horizon = None, ground = None))]
    fn new(
        top: &Bound<'_, PyAny>,
        horizon: Option<&Bound<'_, PyAny>>,
        ground: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let top = color(top, "top")?;
        let Some(horizon) = horizon else { return Ok(Self(basrelief::Sky::Color(top))) };
        let horizon = color(horizon, "horizon")?;
        let ground = ground.map_or(Ok(horizon), |ground| color(ground, "ground"))?;
        Ok(Self(basrelief::Sky::Gradient { top, horizon, ground }))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py>> {
        match &self.0 {
            basrelief::Sky::Color(color) => made::<Self>(py, (tuple(py, *color)?,)),
            basrelief::Sky::Gradient { top, horizon, ground } => {
                made::<Self>(py, (tuple(py, *top)?, tuple(py, *horizon)?, tuple(py, *ground)?))
            }
            basrelief::Sky::Environment(_) => unreachable!("a class of its own"),
        }
    }
}

/// Light from everywhere by a picture of all directions.
///
/// Environment(image, turn=0.0)
///
/// image: array (H, W, 3) of floats, linear light within 0 to 1e6: longitude across, latitude
///     down; the top row is +y, the middle of a row -z.
/// turn: degrees about up, counter-clockwise seen from above.
#[pyclass(frozen, module = "basrelief")]
#[derive(Debug)]
pub(crate) struct Environment(pub(crate) basrelief::Environment);

#[pymethods]
impl Environment {
    #[new]
    #[pyo3(signature = (image, turn = 0.0))]
    fn new(image: &Bound<'_, PyAny>, turn: f32) -> PyResult<Self> {
        let image = floats(image, "image", &[None, None, Some(3)])?;
        let [height, width, _] = *image.shape() else {
            return Err(refused("image", "must be of shape (H, W, 3)"));
        };
        let texels: Vec<_> =
            numbers(&image)?.as_chunks::<3>().0.iter().map(|c| Vec3::from(*c)).collect();
        basrelief::Environment::new(width, height, texels, turn).map(Self).map_err(exception)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py>> {
        let [width, height] = self.0.size();
        let texels = self.0.texels().iter().flat_map(|texel| texel.to_array()).collect();
        made::<Self>(py, (array(py, texels, &[height, width, 3])?, self.0.turn_degrees()))
    }
}
