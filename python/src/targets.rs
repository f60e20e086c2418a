//! The arrays that frames are drawn into: new ones, or the caller's.

use crate::arguments::{mistyped, refused};
use basrelief::layers::{PixelsMut, ValuesMut};
use basrelief::{Layer, Renderer};
use numpy::{
    Element, PyArrayDyn, PyArrayMethods, PyReadwriteArrayDyn, PyUntypedArrayMethods, dtype,
};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyTuple};

/// What is asked of each pixel.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    /// 8-bit sRGB with straight opacity.
    Color,
    /// Linear light, premultiplied by its opacity.
    Linear,
    Layer(Layer),
}

impl Kind {
    fn parse(name: &str) -> PyResult<Self> {
        let layer = Layer::ALL.into_iter().find(|layer| layer.name() == name).map(Self::Layer);
        match (name, layer) {
            ("color", _) => Ok(Self::Color),
            ("linear", _) => Ok(Self::Linear),
            (_, Some(layer)) => Ok(layer),
            _ => Err(refused("layers", format!("\"{name}\" is not one of {}", names().join(", ")))),
        }
    }

    fn num_channels(self) -> usize {
        match self {
            Self::Color | Self::Linear => 4,
            Self::Layer(layer) => layer.num_channels(),
        }
    }
}

/// The names of all that can be drawn.
pub(crate) fn names() -> Vec<&'static str> {
    ["color", "linear"].into_iter().chain(Layer::ALL.map(Layer::name)).collect()
}

/// One name, or several.
pub(crate) fn parse(arg: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<(String, Kind)>> {
    let Some(arg) = arg else { return Ok(vec![("color".into(), Kind::Color)]) };
    let names: Vec<String> = match arg.extract::<String>() {
        Ok(name) => vec![name],
        Err(_) => arg.extract().map_err(|_| mistyped("layers", "must be names of layers"))?,
    };
    let mut kinds: Vec<(String, Kind)> = Vec::new();
    for name in names {
        let kind = Kind::parse(&name)?;
        if kinds.iter().all(|(known, _)| *known != name) {
            kinds.push((name, kind));
        }
    }
    Ok(kinds)
}

/// An array that is written to.
enum Array<'py> {
    Bytes(PyReadwriteArrayDyn<'py, u8>),
    Floats(PyReadwriteArrayDyn<'py, f32>),
    Ids(PyReadwriteArrayDyn<'py, u32>),
}

/// A layer's array.
pub(crate) struct Target<'py> {
    name: String,
    kind: Kind,
    array: Array<'py>,
}

/// What a [`Target`] holds, without the interpreter.
pub(crate) struct Part<'a> {
    kind: Kind,
    values: Values<'a>,
}

enum Values<'a> {
    Bytes(&'a mut [u8]),
    Floats(&'a mut [f32]),
    Ids(&'a mut [u32]),
}

impl<'py> Target<'py> {
    /// An array of a shape: of `out` by its name, or a new one without `out`.
    pub(crate) fn new(
        py: Python<'py>,
        (name, kind): (String, Kind),
        (num, [width, height]): (Option<usize>, [u32; 2]),
        out: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Self> {
        let num_channels = kind.num_channels();
        let sides = num.into_iter().chain([height, width].map(|side| side as usize));
        let shape: Vec<_> = sides.chain((num_channels > 1).then_some(num_channels)).collect();
        let array = match kind {
            Kind::Color => Array::Bytes(array(py, &name, &shape, out)?),
            Kind::Layer(layer) if layer.is_id() => Array::Ids(array(py, &name, &shape, out)?),
            Kind::Linear | Kind::Layer(_) => Array::Floats(array(py, &name, &shape, out)?),
        };
        Ok(Self { name, kind, array })
    }

    /// Its numbers.
    pub(crate) fn part(&mut self) -> PyResult<Part<'_>> {
        let values = match &mut self.array {
            Array::Bytes(array) => array.as_slice_mut().map(Values::Bytes),
            Array::Floats(array) => array.as_slice_mut().map(Values::Floats),
            Array::Ids(array) => array.as_slice_mut().map(Values::Ids),
        };
        let values = values.map_err(|error| refused(&self.name, error))?;
        Ok(Part { kind: self.kind, values })
    }

    /// Its name and array, which is free again.
    pub(crate) fn put(self, found: &Bound<'py, PyDict>) -> PyResult<()> {
        match self.array {
            Array::Bytes(array) => found.set_item(self.name, &**array),
            Array::Floats(array) => found.set_item(self.name, &**array),
            Array::Ids(array) => found.set_item(self.name, &**array),
        }
    }
}

fn array<'py, T: Element>(
    py: Python<'py>,
    name: &str,
    shape: &[usize],
    out: Option<&Bound<'py, PyDict>>,
) -> PyResult<PyReadwriteArrayDyn<'py, T>> {
    let array = match out {
        Some(out) => {
            let given = out.get_item(name)?;
            given.ok_or_else(|| refused("out", format!("has no array \"{name}\"")))?
        }
        None => empty::<T>(py, shape)?,
    };
    let place = format!("out[\"{name}\"]");
    let wanted = dtype::<T>(py);
    let array = array
        .cast_into::<PyArrayDyn<T>>()
        .map_err(|_| mistyped(&place, format!("must be a NumPy array of {wanted}")))?;
    if array.shape() != shape {
        return Err(refused(
            &place,
            format!("must be of shape {shape:?}, not {:?}", array.shape()),
        ));
    }
    if !array.is_c_contiguous() {
        return Err(refused(&place, "must be C-contiguous; numpy.empty makes such arrays"));
    }
    array.try_readwrite().map_err(|error| refused(&place, error))
}

/// A new array by NumPy itself, which refuses what memory cannot hold with a `MemoryError`.
fn empty<'py, T: Element>(py: Python<'py>, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    static EMPTY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let empty = EMPTY
        .get_or_try_init(py, || Ok::<_, PyErr>(py.import("numpy")?.getattr("empty")?.unbind()))?;
    empty.bind(py).call1((PyTuple::new(py, shape)?, dtype::<T>(py)))
}

impl Part<'_> {
    /// The numbers of frame `i` of frames of so many pixels.
    fn frame(&mut self, i: usize, num_pixels: usize) -> Part<'_> {
        let num = num_pixels * self.kind.num_channels();
        let range = i * num..(i + 1) * num;
        let values = match &mut self.values {
            Values::Bytes(values) => Values::Bytes(&mut values[range]),
            Values::Floats(values) => Values::Floats(&mut values[range]),
            Values::Ids(values) => Values::Ids(&mut values[range]),
        };
        Part { kind: self.kind, values }
    }
}

/// Draws frame `i` of the arrays.
pub(crate) fn draw(renderer: &mut Renderer, parts: &mut [Part<'_>], i: usize) {
    let drawn = renderer.settings().drawn();
    let num_pixels = drawn.width as usize * drawn.height as usize;
    let (mut pictures, mut layers) = (Vec::new(), Vec::new());
    for part in parts {
        let Part { kind, values } = part.frame(i, num_pixels);
        match (kind, values) {
            (Kind::Layer(layer), Values::Ids(values)) => {
                layers.push((layer, ValuesMut::Ids(values)));
            }
            (Kind::Layer(layer), Values::Floats(values)) => {
                layers.push((layer, ValuesMut::Floats(values)));
            }
            (_, Values::Bytes(values)) => {
                pictures.push(PixelsMut::Bytes(values.as_chunks_mut::<4>().0));
            }
            (_, Values::Floats(values)) => {
                pictures.push(PixelsMut::Linear(values.as_chunks_mut::<4>().0));
            }
            (_, Values::Ids(_)) => unreachable!("colours are no ids"),
        }
    }
    // Layers come with the first picture, for less than by themselves.
    for pixels in pictures {
        renderer.render_with_layers_to(pixels, std::mem::take(&mut layers));
    }
    if !layers.is_empty() {
        renderer.render_layers_to(layers);
    }
}
