//! The filters alone: places, derivatives and views in, colours out.

use crate::arguments::{exception, floats_of, numbers, refused};
use crate::material::surface_maps;
use crate::{images, pools, settings};
use basrelief::filter::{Footprint, Prepared};
use basrelief::texture;
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;
use rayon::prelude::*;

/// Pixels that a thread filters at once.
const AT_ONCE: usize = 1024;
/// Largest place and derivative in repeats, as of meshes.
const MOST: f32 = 1e6;

/// A texture with its relief, to be filtered by derivatives of one's own.
///
/// Surface(albedo=None, height=None, relief_depth=0.05, *, normal=None, normal_y="up",
///     wrap="repeat")
///
/// The arguments are those of Material.
#[pyclass(frozen, module = "basrelief")]
#[derive(Debug)]
pub(crate) struct Surface(Prepared);

#[pymethods]
impl Surface {
    #[new]
    #[pyo3(signature = (albedo = None, height = None, relief_depth = 0.05, *, normal = None,
        normal_y = "up", wrap = "repeat"))]
    fn new(
        py: Python<'_>,
        albedo: Option<&Bound<'_, PyAny>>,
        height: Option<&Bound<'_, PyAny>>,
        relief_depth: f32,
        normal: Option<&Bound<'_, PyAny>>,
        normal_y: &str,
        wrap: &str,
    ) -> PyResult<Self> {
        let wrap = images::wrap(wrap)?;
        let maps = surface_maps([albedo, height, normal], relief_depth, (normal_y, wrap))?;
        let made = pools::run(py, || texture::Surface::new(maps).map(Prepared::new))?;
        made.map(Self).map_err(exception)
    }

    /// The colours of pixels, each by itself.
    ///
    /// uv: (..., 2), places in the texture, in repeats, v upwards.
    /// dx, dy: (..., 2), their derivatives to the right and down the screen, in repeats a pixel, of
    ///     the polygon without relief.
    /// view: (..., 3), directions from the eye in the texture's frame: along u, along v and down,
    ///     all in repeats, of any length above 0. None looks straight down.
    /// filter: a name or a Filter. threads: None is as many as the process may use.
    ///
    /// Returns (..., 3) of float32: linear red, green and blue, unlit.
    #[pyo3(signature = (uv, dx, dy, view = None, *, filter = None, threads = None))]
    fn colors<'py>(
        &self,
        py: Python<'py>,
        uv: &Bound<'py, PyAny>,
        dx: &Bound<'py, PyAny>,
        dy: &Bound<'py, PyAny>,
        view: Option<&Bound<'py, PyAny>>,
        filter: Option<&Bound<'py, PyAny>>,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
        let filter = settings::filter(filter)?;
        let given = Given::new([uv, dx, dy], view)?;
        let (pixels, prepared) = (given.pixels()?, &self.0);
        let filtered = |first: usize| {
            let end = (first + AT_ONCE).min(pixels.places.len());
            let footprints: Vec<_> = (first..end).map(|i| pixels.footprint(prepared, i)).collect();
            prepared.colors(&filter, &footprints)
        };
        let pool = pools::pool(pools::threads(threads)?)?;
        let firsts: Vec<usize> = (0..pixels.places.len()).step_by(AT_ONCE).collect();
        let colors = py.detach(|| {
            pool.install(|| firsts.into_par_iter().flat_map_iter(filtered).collect::<Vec<_>>())
        });
        let mut shape = given.shape().to_vec();
        shape.push(3);
        PyArray1::from_vec(py, colors.into_flattened()).reshape(shape)
    }
}

/// What a caller says of pixels, checked.
struct Given<'py> {
    /// Places and derivatives.
    places: [Floats<'py>; 3],
    view: Option<Floats<'py>>,
}

type Floats<'py> = PyReadonlyArrayDyn<'py, f32>;

/// The same, without the interpreter.
struct Pixels<'a> {
    places: &'a [[f32; 2]],
    derivatives: [&'a [[f32; 2]]; 2],
    views: Option<&'a [[f32; 3]]>,
}

impl<'py> Given<'py> {
    fn new(
        [uv, dx, dy]: [&Bound<'py, PyAny>; 3],
        view: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Self> {
        let places = [floats_of(uv, "uv", 2)?, floats_of(dx, "dx", 2)?, floats_of(dy, "dy", 2)?];
        let view = view.map(|view| floats_of(view, "view", 3)).transpose()?;
        let given = Self { places, view };
        let shape = given.shape();
        let [_, dx, dy] = &given.places;
        for (name, array) in [("dx", Some(dx)), ("dy", Some(dy)), ("view", given.view.as_ref())] {
            let own = array.map_or(shape, |array| &array.shape()[..array.ndim() - 1]);
            if own != shape {
                return Err(refused(name, format!("is of {own:?} pixels, and uv of {shape:?}")));
            }
        }
        for (name, array) in ["uv", "dx", "dy"].into_iter().zip(&given.places) {
            if !numbers(array)?.iter().all(|c| c.abs() <= MOST) {
                return Err(refused(name, "must be finite and within 1e6 repeats"));
            }
        }
        let is_view = |v: &[f32; 3]| v.iter().all(|c| c.abs() <= 1e18) && *v != [0.0; 3];
        if !given.pixels()?.views.is_none_or(|views| views.iter().all(is_view)) {
            return Err(refused("view", "must be finite, within 1e18, and no direction 0"));
        }
        Ok(given)
    }

    /// The shape of the pixels.
    fn shape(&self) -> &[usize] {
        let [uv, ..] = &self.places;
        &uv.shape()[..uv.ndim() - 1]
    }

    fn pixels(&self) -> PyResult<Pixels<'_>> {
        let [uv, dx, dy] = &self.places;
        let [places, dx, dy] = [numbers(uv)?, numbers(dx)?, numbers(dy)?];
        let [places, dx, dy] = [places, dx, dy].map(|numbers| numbers.as_chunks::<2>().0);
        let views = self.view.as_ref().map(numbers).transpose()?;
        let views = views.map(|views| views.as_chunks::<3>().0);
        Ok(Pixels { places, derivatives: [dx, dy], views })
    }
}

impl Pixels<'_> {
    fn footprint(&self, surface: &Prepared, i: usize) -> Footprint {
        let [dx, dy] = self.derivatives.map(|derivatives| derivatives[i]);
        // Straight down.
        let view = self.views.map_or([0.0, 0.0, 1.0], |views| views[i]);
        surface.footprint(self.places[i], dx, dy, view)
    }
}
