//! The Python package `basrelief`: scenes, cameras and frames as plain classes, pixels as NumPy
//! arrays.
//!
//! | file | what it does |
//! |---|---|
//! | `arguments` | what callers give, checked; refusals name the argument |
//! | `images` | arrays to the images of a surface |
//! | `pickles` | how a thing is made again in another process |
//! | `pools` | threads, made at first use, in each process its own |
//! | `camera`, `lights`, `material`, `mesh`, `scene`, `load` | what is drawn |
//! | `settings` | how it is drawn |
//! | `renderer`, `targets`, `frames` | drawing, into arrays of the caller's or new ones |
//! | `surface` | the filters alone |
//! | `inspect` | what one pixel sees, as a dict |
//!
//! Nothing here decides what a picture looks like: that is the library's.
#![forbid(unsafe_code)]
#![allow(clippy::doc_markdown, reason = "docs of classes and methods are Python's docstrings")]
#![allow(clippy::too_many_arguments, reason = "Python's functions have keywords")]

mod arguments;
mod camera;
mod frames;
mod images;
mod inspect;
mod lights;
mod load;
mod material;
mod mesh;
mod pickles;
mod pools;
mod renderer;
mod scene;
mod settings;
mod surface;
mod targets;

use pyo3::prelude::*;

#[pymodule]
mod _native {
    use super::*;

    #[pymodule_export]
    use camera::Camera;
    #[pymodule_export]
    use frames::Frames;
    #[pymodule_export]
    use lights::{Environment, PointLight, Sky, Sun};
    #[pymodule_export]
    use load::load;
    #[pymodule_export]
    use material::Material;
    #[pymodule_export]
    use mesh::Mesh;
    #[pymodule_export]
    use renderer::Renderer;
    #[pymodule_export]
    use scene::{Scene, builtin};
    #[pymodule_export]
    use settings::Filter;
    #[pymodule_export]
    use surface::Surface;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("SIMD_LEVEL", basrelief::SIMD_LEVEL)?;
        module.add("FILTERS", settings::FILTERS.map(|(name, _)| name).to_vec())?;
        module.add("LAYERS", targets::names())
    }
}
