//! What goes from process to process: how a thing is made again, for Python's copies and pickles.

use numpy::{Element, IntoPyArray, PyArrayMethods};
use pyo3::PyTypeInfo;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// What `__reduce__` gives: what is called, and with what.
pub(crate) type Made<'py> = (Bound<'py, PyAny>, Bound<'py, PyTuple>);

/// A call of a class.
pub(crate) fn made<'py, T: PyTypeInfo>(
    py: Python<'py>,
    args: impl IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error = PyErr>,
) -> PyResult<Made<'py>> {
    Ok((py.get_type::<T>().into_any(), args.into_pyobject(py)?))
}

/// A call of a class's `_rebuild`.
pub(crate) fn rebuilt<'py, T: PyTypeInfo>(
    py: Python<'py>,
    args: impl IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error = PyErr>,
) -> PyResult<Made<'py>> {
    Ok((py.get_type::<T>().getattr("_rebuild")?, args.into_pyobject(py)?))
}

/// Numbers as an array of a shape.
pub(crate) fn array<'py, T: Element>(
    py: Python<'py>,
    numbers: Vec<T>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    Ok(numbers.into_pyarray(py).reshape(shape)?.into_any())
}

/// A copy, which stays as it is whatever the caller does with theirs.
pub(crate) fn copy(arg: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
    Ok(arg.py().import("copy")?.call_method1("deepcopy", (arg,))?.unbind())
}
