//! Frames one by one.

use crate::renderer::Renderer;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyIterator};
use std::sync::{Mutex, PoisonError};

/// Frames of cameras one by one: what Renderer.frames gives.
#[pyclass(frozen, module = "basrelief")]
pub(crate) struct Frames {
    renderer: Py<Renderer>,
    cameras: Py<PyIterator>,
    /// Size and layers, as the caller gave them.
    asked: (Option<Py<PyAny>>, Option<Py<PyAny>>),
    reuse: bool,
    last: Mutex<Option<Py<PyDict>>>,
}

impl Frames {
    pub(crate) fn new(
        renderer: Py<Renderer>,
        cameras: Py<PyIterator>,
        asked: (Option<Py<PyAny>>, Option<Py<PyAny>>),
        reuse: bool,
    ) -> Self {
        Self { renderer, cameras, asked, reuse, last: Mutex::default() }
    }
}

#[pymethods]
impl Frames {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(camera) = self.cameras.bind(py).clone().next() else { return Ok(None) };
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner).take();
        let options = PyDict::new(py);
        options.set_item("out", last)?;
        let (size, layers) = &self.asked;
        let render = self.renderer.bind(py).getattr("render")?;
        let frame = render.call((camera?, size, layers), Some(&options))?.cast_into::<PyDict>()?;
        if self.reuse {
            let kept = frame.clone().unbind();
            *self.last.lock().unwrap_or_else(PoisonError::into_inner) = Some(kept);
        }
        Ok(Some(frame))
    }
}
