//! Scenes from files.

use crate::arguments::{choice, color, exception, refused};
use crate::images;
use crate::pickles::copy;
use crate::pools;
use crate::scene::{Scene, Source};
use basrelief::load::{HeightSense, LoadOptions, MaterialOptions, NormalY};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::path::{Path, PathBuf, absolute};
use std::sync::Arc;

/// Options that name files.
const FILES: [&str; 7] = [
    "albedo",
    "height",
    "normal",
    "metallic_map",
    "roughness_map",
    "occlusion_map",
    "emissive_map",
];

/// A scene from a file with its materials and images.
///
/// load(path, *, materials=None, **options)
///
/// The camera frames the scene; a sun shines over the viewer's left shoulder, and a faint sky.
///
/// options for all materials, in place of what the file says: albedo, height, normal,
///     metallic_map, roughness_map, occlusion_map, emissive_map (paths), relief_depth (repeats of
///     the texture, 0 to 1), height_sense ("white-high" or "white-deep"), normal_y ("up" or
///     "down"), wrap ("repeat", "mirror" or "clamp"), base_color, metallic, specular, roughness,
///     emissive.
/// materials: a dict from names of materials to dicts of such options.
/// Other options: aspect (width over height that the camera frames for, 1.0), crease_angle
///     (degrees), allow_outside (images outside the file's folder, False), max_image_side,
///     max_image_mib, max_triangles, max_textures.
///
/// Raises FileNotFoundError where there is no such file, ValueError with file and line where one
/// is wrong.
#[pyfunction]
#[pyo3(signature = (path, *, materials = None, **options))]
pub(crate) fn load(
    py: Python<'_>,
    path: PathBuf,
    materials: Option<&Bound<'_, PyDict>>,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Scene> {
    // Frames of any lighting can be drawn of it.
    let mut wanted = LoadOptions { keep_normals: true, ..LoadOptions::default() };
    for (name, value) in options.into_iter().flatten() {
        let name: String = name.extract()?;
        if !of_file(&mut wanted, &name, &value)? && !of_material(&mut wanted.all, &name, &value)? {
            return Err(unknown(&name));
        }
    }
    for (material, options) in materials.into_iter().flatten() {
        let mut own = MaterialOptions::default();
        for (name, value) in options.cast::<PyDict>()? {
            let name: String = name.extract()?;
            if !of_material(&mut own, &name, &value)? {
                return Err(unknown(&name));
            }
        }
        wanted.materials.insert(material.extract()?, own);
    }
    let loaded = pools::run(py, || basrelief::load::load(&path, &wanted))?.map_err(exception)?;
    let remarks = [loaded.warnings, loaded.choices];
    let source = Source::File(again(py, &path, materials, options)?);
    Ok(Scene { scene: Arc::new(loaded.scene), remarks, source })
}

/// What loads the file again, from any folder.
fn again<'py>(
    py: Python<'py>,
    path: &Path,
    materials: Option<&Bound<'py, PyDict>>,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Py<PyTuple>> {
    let all = PyDict::new(py);
    for (name, own) in materials.into_iter().flatten() {
        all.set_item(name, kept(own.cast()?)?)?;
    }
    let options = options.map_or_else(|| Ok(PyDict::new(py)), kept)?;
    Ok((absolute(path)?, all, options).into_pyobject(py)?.unbind())
}

/// A copy of options that does not hang on the current folder.
fn kept<'py>(options: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyDict>> {
    let kept = PyDict::new(options.py());
    for (name, value) in options {
        if FILES.contains(&&*name.extract::<String>()?) {
            kept.set_item(name, absolute(value.extract::<PathBuf>()?)?)?;
        } else {
            kept.set_item(name, copy(&value)?)?;
        }
    }
    Ok(kept)
}

fn unknown(name: &str) -> PyErr {
    PyTypeError::new_err(format!("load() has no option '{name}'; help(basrelief.load) lists them"))
}

/// The argument, with its name where it is of a wrong type.
fn extract<'py, T: for<'a> FromPyObject<'a, 'py>>(
    value: &Bound<'py, PyAny>,
    name: &str,
) -> PyResult<T> {
    value.extract::<T>().map_err(|error| refused(name, error.into()))
}

/// Sets an option of the whole file, if it is one.
fn of_file(options: &mut LoadOptions, name: &str, value: &Bound<'_, PyAny>) -> PyResult<bool> {
    match name {
        "aspect" => options.aspect = extract(value, name)?,
        "crease_angle" => options.crease_angle = Some(extract(value, name)?),
        "allow_outside" => options.allow_outside = extract(value, name)?,
        "max_image_side" => options.max_image_side = extract(value, name)?,
        "max_image_mib" => options.max_image_mib = extract(value, name)?,
        "max_triangles" => options.max_triangles = extract(value, name)?,
        "max_textures" => options.max_textures = extract(value, name)?,
        _ => return Ok(false),
    }
    Ok(true)
}

/// Sets an option of materials, if it is one.
fn of_material(
    options: &mut MaterialOptions,
    name: &str,
    value: &Bound<'_, PyAny>,
) -> PyResult<bool> {
    let senses = [("white-high", HeightSense::WhiteHigh), ("white-deep", HeightSense::WhiteDeep)];
    let ways = [("up", NormalY::Up), ("down", NormalY::Down)];
    let word = || extract::<String>(value, name);
    match name {
        "albedo" => options.albedo = Some(extract(value, name)?),
        "height" => options.height = Some(extract(value, name)?),
        "normal" => options.normal = Some(extract(value, name)?),
        "metallic_map" => options.metallic_map = Some(extract(value, name)?),
        "roughness_map" => options.roughness_map = Some(extract(value, name)?),
        "occlusion_map" => options.occlusion_map = Some(extract(value, name)?),
        "emissive_map" => options.emissive_map = Some(extract(value, name)?),
        "height_sense" => options.height_sense = Some(choice(name, &word()?, &senses)?),
        "normal_y" => options.normal_y = Some(choice(name, &word()?, &ways)?),
        "wrap" => options.wrap = Some(images::wrap(&word()?)?),
        "relief_depth" => options.relief_depth = Some(extract(value, name)?),
        "base_color" => options.base_color = Some(color(value, name)?),
        "metallic" => options.metallic = Some(extract(value, name)?),
        "specular" => options.specular = Some(extract(value, name)?),
        "roughness" => options.roughness = Some(extract(value, name)?),
        "emissive" => options.emissive = Some(color(value, name)?),
        _ => return Ok(false),
    }
    Ok(true)
}
