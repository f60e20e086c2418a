//! What surfaces are made of.

use crate::arguments::{choice, color, exception, tuple};
use crate::pickles::{Made, copy, rebuilt};
use crate::{images, pools};
use basrelief::texture::{Surface, SurfaceMaps, Texture, Wrap};
use basrelief::{Error, MaterialMaps};
use glam::Vec3;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// What a surface is made of, in the terms of glTF 2.0.
///
/// Material(*, name="", base_color=1.0, metallic=0.0, specular=0.0, roughness=1.0, emissive=0.0,
///     albedo=None, height=None, relief_depth=0.05, normal=None, normal_y="up",
///     metallic_map=None, roughness_map=None, occlusion_map=None, emissive_map=None,
///     wrap="repeat")
///
/// base_color, emissive: linear red, green and blue, or one number, 0 to 1e6. The others: 0 to 1.
/// albedo, emissive_map: colour images: (H, W), (H, W, 3) or (H, W, 4; the fourth is left out) of
///     uint8 or uint16, which are sRGB, or of floats, which are linear light.
/// height: (H, W) of uint8 or uint16, or floats from 0 to 1: 1 (white) lies on the polygon, 0 is
///     relief_depth deep, in repeats of the texture, 0 to 1.
/// normal: (H, W, 3) of uint8 or uint16, or floats from -1 to 1; normal_y says where its green
///     points, "up" (OpenGL, glTF, Blender) or "down" (DirectX).
/// metallic_map, roughness_map, occlusion_map: (H, W), linear, 0 to 1; they multiply the numbers.
/// wrap: "repeat", "mirror" or "clamp", beyond the texture's edges.
///
/// Row 0 of an image is its top. Maps need a mesh with texture coordinates.
#[pyclass(frozen, module = "basrelief")]
#[derive(Debug)]
pub(crate) struct Material {
    pub(crate) material: basrelief::Material,
    /// Its images as they were given, and how they are read: a surface has them no more, packed and
    /// of one size.
    given: Py<PyDict>,
}

#[pymethods]
impl Material {
    #[new]
    #[pyo3(signature = (*, name = "", base_color = None, metallic = 0.0, specular = 0.0,
        roughness = 1.0, emissive = None, albedo = None, height = None, relief_depth = 0.05,
        normal = None, normal_y = "up", metallic_map = None, roughness_map = None,
        occlusion_map = None, emissive_map = None, wrap = "repeat"))]
    fn new(
        py: Python<'_>,
        name: &str,
        base_color: Option<&Bound<'_, PyAny>>,
        metallic: f32,
        specular: f32,
        roughness: f32,
        emissive: Option<&Bound<'_, PyAny>>,
        albedo: Option<&Bound<'_, PyAny>>,
        height: Option<&Bound<'_, PyAny>>,
        relief_depth: f32,
        normal: Option<&Bound<'_, PyAny>>,
        normal_y: &str,
        metallic_map: Option<&Bound<'_, PyAny>>,
        roughness_map: Option<&Bound<'_, PyAny>>,
        occlusion_map: Option<&Bound<'_, PyAny>>,
        emissive_map: Option<&Bound<'_, PyAny>>,
        wrap: &str,
    ) -> PyResult<Self> {
        let (wrap_word, wrap) = (wrap, images::wrap(wrap)?);
        let gray = |arg: Option<&Bound<'_, PyAny>>, name| {
            let Some(arg) = arg else { return Ok(None) };
            texture(py, images::gray(arg, name)?, wrap, Texture::gray)
        };
        let glow = emissive_map.map(|arg| images::color(arg, "emissive_map")).transpose()?;
        let maps = MaterialMaps {
            metallic: gray(metallic_map, "metallic_map")?,
            roughness: gray(roughness_map, "roughness_map")?,
            occlusion: gray(occlusion_map, "occlusion_map")?,
            emissive: glow.map_or(Ok(None), |glow| texture(py, glow, wrap, Texture::color))?,
        };
        let given = surface_maps([albedo, height, normal], relief_depth, (normal_y, wrap))?;
        // Textures of numbers are read where there is a surface.
        let has_surface = given.albedo.is_some()
            || given.height.is_some()
            || given.normal.is_some()
            || !maps.is_empty();
        let surface = has_surface
            .then(|| pools::run(py, || Surface::new(given))?.map(Arc::new).map_err(exception))
            .transpose()?;
        let rgb = |arg: Option<&Bound<'_, PyAny>>, name, default| {
            arg.map_or(Ok(default), |arg| color(arg, name))
        };
        let made = basrelief::Material {
            name: name.into(),
            base_color: rgb(base_color, "base_color", Vec3::ONE)?,
            metallic,
            specular,
            roughness,
            emissive: rgb(emissive, "emissive", Vec3::ZERO)?,
            maps,
            surface,
            ..basrelief::Material::default()
        };
        let given = PyDict::new(py);
        for (name, image) in [
            ("albedo", albedo),
            ("height", height),
            ("normal", normal),
            ("metallic_map", metallic_map),
            ("roughness_map", roughness_map),
            ("occlusion_map", occlusion_map),
            ("emissive_map", emissive_map),
        ] {
            image.map_or(Ok(()), |image| given.set_item(name, copy(image)?))?;
        }
        given.set_item("relief_depth", relief_depth)?;
        given.set_item("normal_y", normal_y)?;
        given.set_item("wrap", wrap_word)?;
        Ok(Self { material: made, given: given.unbind() })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py>> {
        let basrelief::Material {
            name, base_color, emissive, metallic, specular, roughness, ..
        } = &self.material;
        let given = self.given.bind(py).copy()?;
        given.set_item("name", name)?;
        given.set_item("base_color", tuple(py, *base_color)?)?;
        given.set_item("emissive", tuple(py, *emissive)?)?;
        for (name, value) in
            [("metallic", metallic), ("specular", specular), ("roughness", roughness)]
        {
            given.set_item(name, value)?;
        }
        rebuilt::<Self>(py, (given,))
    }

    #[staticmethod]
    fn _rebuild<'py>(py: Python<'py>, given: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyAny>> {
        py.get_type::<Self>().call((), Some(given))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.material.name
    }

    fn __repr__(&self) -> String {
        format!("<Material \"{}\">", self.material.name.escape_debug())
    }
}

/// Albedo, height and normal as the maps of a surface.
pub(crate) fn surface_maps(
    [albedo, height, normal]: [Option<&Bound<'_, PyAny>>; 3],
    relief_depth: f32,
    (normal_y, wrap): (&str, Wrap),
) -> PyResult<SurfaceMaps> {
    let green: i16 = choice("normal_y", normal_y, &[("up", 1), ("down", -1)])?;
    let mut normal = normal.map(|arg| images::normal(arg, "normal")).transpose()?;
    if let Some(image) = &mut normal {
        image.texels.iter_mut().for_each(|texel| texel[1] *= green);
    }
    Ok(SurfaceMaps {
        albedo: albedo.map(|arg| images::color(arg, "albedo")).transpose()?,
        height: height.map(|arg| images::height(arg, "height")).transpose()?,
        normal,
        wrap,
        relief_depth,
        ..SurfaceMaps::default()
    })
}

fn texture<I: Send>(
    py: Python<'_>,
    image: I,
    wrap: Wrap,
    make: fn(I, Wrap) -> Result<Texture, Error>,
) -> PyResult<Option<Arc<Texture>>> {
    let made = pools::run(py, || make(image, wrap))?.map_err(exception)?;
    Ok(Some(Arc::new(made)))
}
