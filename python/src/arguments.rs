//! What callers give, checked: refusals are exceptions that name the argument.

use glam::{Vec2, Vec3};
use numpy::{Element, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::{
    PyFileNotFoundError, PyOSError, PyPermissionError, PyTypeError, PyValueError,
};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyTuple};
use std::fmt::Display;
use std::io;

/// A `ValueError` that begins with the argument's name.
pub(crate) fn refused(name: &str, reason: impl Display) -> PyErr {
    PyValueError::new_err(format!("{name}: {reason}"))
}

/// A `TypeError` that begins with the argument's name.
pub(crate) fn mistyped(name: &str, reason: impl Display) -> PyErr {
    PyTypeError::new_err(format!("{name}: {reason}"))
}

/// The library's refusal as the exception that Python has for it.
pub(crate) fn exception(error: basrelief::Error) -> PyErr {
    let kind = std::error::Error::source(&error)
        .and_then(|source| source.downcast_ref::<io::Error>())
        .map(io::Error::kind);
    let text = error.to_string();
    match kind {
        Some(io::ErrorKind::NotFound) => PyFileNotFoundError::new_err(text),
        Some(io::ErrorKind::PermissionDenied) => PyPermissionError::new_err(text),
        // Decoders hand on what they think of a file's bytes as errors of reading, too.
        Some(io::ErrorKind::InvalidData | io::ErrorKind::UnexpectedEof) | None => {
            PyValueError::new_err(text)
        }
        Some(_) => PyOSError::new_err(text),
    }
}

/// An array of numbers as NumPy reads the argument: of any shape, not yet of a type.
fn as_array<'py>(arg: &Bound<'py, PyAny>, name: &str, kinds: &str) -> PyResult<Bound<'py, PyAny>> {
    static AS_ARRAY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let py = arg.py();
    let as_array = AS_ARRAY
        .get_or_try_init(py, || Ok::<_, PyErr>(py.import("numpy")?.getattr("asarray")?.unbind()))?;
    let array = as_array.bind(py).call1((arg,)).map_err(|error| {
        let is_ours = error.is_instance_of::<PyValueError>(py)
            || error.is_instance_of::<PyTypeError>(py)
            || error.is_instance_of::<pyo3::exceptions::PyOverflowError>(py);
        if is_ours { refused(name, format!("is no array: {}", error.value(py))) } else { error }
    })?;
    let dtype = array.getattr("dtype")?;
    let kind: String = dtype.getattr("kind")?.extract()?;
    if kinds.contains(&kind) {
        return Ok(array);
    }
    let wanted = if kinds.contains('f') { "numbers" } else { "whole numbers" };
    Err(mistyped(name, format!("must be an array of {wanted}, not of {dtype}")))
}

/// The argument as a C-contiguous array of `T`; copied only where it is none.
fn typed<'py, T: Element>(
    arg: &Bound<'py, PyAny>,
    name: &str,
    kinds: &str,
) -> PyResult<PyReadonlyArrayDyn<'py, T>> {
    let py = arg.py();
    let array = as_array(arg, name, kinds)?;
    let options = PyDict::new(py);
    options.set_item("order", "C")?;
    options.set_item("copy", false)?;
    let array = array.call_method("astype", (numpy::dtype::<T>(py),), Some(&options))?;
    let array = array.cast_into::<PyArrayDyn<T>>()?;
    array.try_readonly().map_err(|_| refused(name, "is being written to"))
}

/// Whether a shape is the one asked for, where `None` stands for any length.
fn is_shape(shape: &[usize], wanted: &[Option<usize>]) -> bool {
    shape.len() == wanted.len()
        && shape.iter().zip(wanted).all(|(have, want)| want.is_none_or(|want| *have == want))
}

fn check_shape(name: &str, shape: &[usize], wanted: &[Option<usize>]) -> PyResult<()> {
    if is_shape(shape, wanted) {
        return Ok(());
    }
    let sides = wanted.iter().map(|side| side.map_or("N".into(), |side| side.to_string()));
    let sides = sides.collect::<Vec<_>>().join(", ");
    Err(refused(name, format!("must be of shape ({sides}), not {shape:?}")))
}

/// An array of numbers as 32-bit floats, of a shape in which `None` is any length.
pub(crate) fn floats<'py>(
    arg: &Bound<'py, PyAny>,
    name: &str,
    shape: &[Option<usize>],
) -> PyResult<PyReadonlyArrayDyn<'py, f32>> {
    let array = typed::<f32>(arg, name, "fiu")?;
    check_shape(name, array.shape(), shape)?;
    Ok(array)
}

/// An array of numbers as 32-bit floats, of any shape that ends in `last`.
pub(crate) fn floats_of<'py>(
    arg: &Bound<'py, PyAny>,
    name: &str,
    last: usize,
) -> PyResult<PyReadonlyArrayDyn<'py, f32>> {
    let array = typed::<f32>(arg, name, "fiu")?;
    match array.shape() {
        [.., num] if *num == last => Ok(array),
        shape => Err(refused(name, format!("must be of shape (..., {last}), not {shape:?}"))),
    }
}

/// The numbers of an array that [`floats`] or [`floats_of`] gave.
pub(crate) fn numbers<'a, T: Element>(array: &'a PyReadonlyArrayDyn<'_, T>) -> PyResult<&'a [T]> {
    array.as_slice().map_err(|error| PyValueError::new_err(error.to_string()))
}

/// Points or directions: an array of shape (N, 3).
pub(crate) fn points(arg: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<Vec3>> {
    let array = floats(arg, name, &[None, Some(3)])?;
    Ok(numbers(&array)?.as_chunks::<3>().0.iter().map(|p| Vec3::from(*p)).collect())
}

/// Texture coordinates: an array of shape (N, 2).
pub(crate) fn places(arg: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<Vec2>> {
    let array = floats(arg, name, &[None, Some(2)])?;
    Ok(numbers(&array)?.as_chunks::<2>().0.iter().map(|p| Vec2::from(*p)).collect())
}

/// Indices of vertices: an array of whole numbers of shape (N, 3), each below `num`.
pub(crate) fn triangles(arg: &Bound<'_, PyAny>, name: &str, num: usize) -> PyResult<Vec<[u32; 3]>> {
    let array = typed::<i64>(arg, name, "iu")?;
    check_shape(name, array.shape(), &[None, Some(3)])?;
    let indices = numbers(&array)?;
    let is_index = |i: i64| u32::try_from(i).is_ok_and(|i| (i as usize) < num);
    match indices.iter().find(|i| !is_index(**i)) {
        Some(i) => Err(refused(name, format!("{i} is not the index of one of {num} vertices"))),
        None => Ok(indices.as_chunks::<3>().0.iter().map(|t| t.map(|i| i as u32)).collect()),
    }
}

/// A 4x4 matrix, row by row.
pub(crate) fn matrix(arg: &Bound<'_, PyAny>, name: &str) -> PyResult<[[f32; 4]; 4]> {
    let array = floats(arg, name, &[Some(4), Some(4)])?;
    let rows = numbers(&array)?.as_chunks::<4>().0;
    rows.try_into().map_err(|_| refused(name, "must be of shape (4, 4)"))
}

/// Three numbers.
pub(crate) fn vector(arg: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec3> {
    let array = floats(arg, name, &[Some(3)])?;
    Ok(Vec3::from_slice(numbers(&array)?))
}

/// Linear red, green and blue, or one number for all three.
pub(crate) fn color(arg: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec3> {
    if let Ok(gray) = arg.extract::<f32>() {
        return Ok(Vec3::splat(gray));
    }
    vector(arg, name)
}

/// One of some words.
pub(crate) fn choice<T: Copy>(name: &str, word: &str, choices: &[(&str, T)]) -> PyResult<T> {
    if let Some((_, value)) = choices.iter().find(|(known, _)| *known == word) {
        return Ok(*value);
    }
    let words: Vec<_> = choices.iter().map(|(word, _)| format!("\"{word}\"")).collect();
    Err(refused(name, format!("\"{word}\" is not one of {}", words.join(", "))))
}

/// Width and height in pixels.
pub(crate) fn size(arg: &Bound<'_, PyAny>, name: &str) -> PyResult<[u32; 2]> {
    arg.extract::<(u32, u32)>()
        .map(|(width, height)| [width, height])
        .map_err(|_| mistyped(name, "must be two whole numbers, width and height"))
}

/// Three numbers as a tuple.
pub(crate) fn tuple<'py>(py: Python<'py>, v: Vec3) -> PyResult<Bound<'py, PyTuple>> {
    PyTuple::new(py, v.to_array())
}
