//! All that is drawn.

use crate::arguments::{color, exception, mistyped, refused, tuple};
use crate::camera::Camera;
use crate::lights::{Environment, PointLight, Sky, Sun};
use crate::load::load;
use crate::material::Material;
use crate::mesh::Mesh;
use crate::pickles::{Made, rebuilt};
use basrelief::Light;
use glam::Vec3;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use std::path::PathBuf;
use std::sync::Arc;

/// All that is drawn: meshes, lights, a sky, a background, and a camera to begin with. It does not
/// change; a Renderer moves what moves.
///
/// Scene(meshes, lights=(), sky=None, background=None, camera=None)
///
/// meshes: a sequence of Mesh; their order gives the numbers of the layer "object", that of their
///     materials, as they first come, those of "material".
/// lights: a sequence of Sun and PointLight.
/// sky: Sky, Environment or None.
/// background: linear red, green, blue and opacity where nothing is hit; None is transparent.
/// camera: a Camera; None frames all meshes in a square picture.
#[pyclass(frozen, module = "basrelief")]
#[derive(Debug)]
pub(crate) struct Scene {
    pub(crate) scene: Arc<basrelief::Scene>,
    pub(crate) remarks: [Vec<String>; 2],
    pub(crate) source: Source,
}

/// Where meshes and materials come from.
#[derive(Debug)]
pub(crate) enum Source {
    Builtin,
    /// Arrays: the materials, in the scene's order.
    Arrays(Vec<Option<Py<Material>>>),
    /// A file: what [`load`](crate::load::load) is called with.
    File(Py<PyTuple>),
}

impl Source {
    fn clone_ref(&self, py: Python<'_>) -> Self {
        match self {
            Self::Builtin => Self::Builtin,
            Self::Arrays(materials) => {
                let own = |material: &Option<Py<_>>| material.as_ref().map(|m| m.clone_ref(py));
                Self::Arrays(materials.iter().map(own).collect())
            }
            Self::File(args) => Self::File(args.clone_ref(py)),
        }
    }
}

/// The built-in scene: an arch of hewn stone on a cobbled street, in the sun.
#[pyfunction]
pub(crate) fn builtin() -> Scene {
    let scene = Arc::new(basrelief::scene::builtin());
    Scene { scene, remarks: Default::default(), source: Source::Builtin }
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (meshes, lights = None, sky = None, background = None, camera = None))]
    fn new(
        py: Python<'_>,
        meshes: Vec<Py<Mesh>>,
        lights: Option<Vec<Bound<'_, PyAny>>>,
        sky: Option<&Bound<'_, PyAny>>,
        background: Option<&Bound<'_, PyAny>>,
        camera: Option<Camera>,
    ) -> PyResult<Self> {
        let mut scene = basrelief::Scene::default();
        let mut known: Vec<Option<Py<Material>>> = Vec::new();
        for mesh in &meshes {
            let Mesh { mesh, material } = mesh.get();
            // Materials are told apart by address, as Python does.
            let address = |material: &Option<Py<_>>| material.as_ref().map(Py::as_ptr);
            let index = known.iter().position(|other| address(other) == address(material));
            let index = index.unwrap_or(known.len());
            if index == known.len() {
                known.push(material.as_ref().map(|material| material.clone_ref(py)));
                let plain = basrelief::Material { name: "none".into(), ..Default::default() };
                let own = material.as_ref().map(|material| material.get().material.clone());
                scene.materials.push(own.unwrap_or(plain));
            }
            scene.meshes.push(basrelief::Mesh { material: index, ..mesh.clone() });
        }
        scene.lights = lights.unwrap_or_default().iter().map(light).collect::<PyResult<_>>()?;
        scene.sky = sky.map_or(Ok(basrelief::Sky::default()), any_sky)?;
        scene.background = background.map_or(Ok([0.0; 4]), background_of)?;
        scene.camera = camera.map_or(scene.camera, |camera| camera.0);
        // What is framed is finite.
        scene.validate().map_err(exception)?;
        if camera.is_none() {
            scene.camera = framing(&scene, 1.0)?;
            scene.validate().map_err(exception)?;
        }
        let source = Source::Arrays(known);
        Ok(Self { scene: Arc::new(scene), remarks: Default::default(), source })
    }

    /// The camera to begin with.
    #[getter]
    fn camera(&self) -> Camera {
        Camera(self.scene.camera)
    }

    /// A camera that sees all meshes in a picture `aspect` times as wide as high, and in wider
    /// ones.
    #[pyo3(signature = (aspect = 1.0))]
    fn framing(&self, aspect: f32) -> PyResult<Camera> {
        framing(&self.scene, aspect).map(Camera)
    }

    /// The least and the most of all vertices, three numbers each, in world units; None without
    /// vertices.
    #[getter]
    fn bounds<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<Option<(Bound<'py, PyTuple>, Bound<'py, PyTuple>)>> {
        let bounds = bounds(&self.scene);
        bounds.map(|[least, most]| Ok((tuple(py, least)?, tuple(py, most)?))).transpose()
    }

    /// Names of the meshes: the layer "object" has their places in this list.
    #[getter]
    fn objects(&self) -> Vec<&str> {
        self.scene.meshes.iter().map(|mesh| mesh.name.as_str()).collect()
    }

    /// Names of the materials: the layer "material" has their places in this list.
    #[getter]
    fn materials(&self) -> Vec<&str> {
        self.scene.materials.iter().map(|material| material.name.as_str()).collect()
    }

    /// What was not supported or missing when it was loaded: one line each.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.remarks[0].clone()
    }

    /// What was chosen when it was loaded, such as which image serves as the height map.
    #[getter]
    fn choices(&self) -> Vec<String> {
        self.remarks[1].clone()
    }

    /// The scene with other lights, sky, background or camera; what is not given stays. Meshes and
    /// surfaces are shared.
    #[pyo3(signature = (*, lights = None, sky = None, background = None, camera = None))]
    fn replace(
        &self,
        py: Python<'_>,
        lights: Option<Vec<Bound<'_, PyAny>>>,
        sky: Option<&Bound<'_, PyAny>>,
        background: Option<&Bound<'_, PyAny>>,
        camera: Option<Camera>,
    ) -> PyResult<Self> {
        let mut scene = (*self.scene).clone();
        if let Some(lights) = lights {
            scene.lights = lights.iter().map(light).collect::<PyResult<_>>()?;
        }
        scene.sky = sky.map_or(Ok(scene.sky), any_sky)?;
        scene.background = background.map_or(Ok(scene.background), background_of)?;
        scene.camera = camera.map_or(scene.camera, |camera| camera.0);
        scene.validate().map_err(exception)?;
        let (remarks, source) = (self.remarks.clone(), self.source.clone_ref(py));
        Ok(Self { scene: Arc::new(scene), remarks, source })
    }

    /// For copies and pickles: arrays go along; a file is read again, with what was replaced since.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py>> {
        let lights = self.scene.lights.iter().map(|light| match light {
            Light::Sun { .. } => Bound::new(py, Sun(*light)).map(Bound::into_any),
            Light::Point { .. } => Bound::new(py, PointLight(*light)).map(Bound::into_any),
        });
        let sky = match &self.scene.sky {
            basrelief::Sky::Environment(picture) => {
                Bound::new(py, Environment(picture.clone()))?.into_any()
            }
            sky => Bound::new(py, Sky(sky.clone()))?.into_any(),
        };
        let source = match &self.source {
            Source::Builtin => None,
            Source::Arrays(materials) => Some(self.meshes(py, materials)?.into_any()),
            Source::File(args) => Some(args.bind(py).clone().into_any()),
        };
        let lights = PyTuple::new(py, lights.collect::<PyResult<Vec<_>>>()?)?;
        let [r, g, b, a] = self.scene.background;
        rebuilt::<Self>(py, (source, lights, sky, (r, g, b, a), self.camera()))
    }

    #[staticmethod]
    fn _rebuild(
        py: Python<'_>,
        source: Option<&Bound<'_, PyAny>>,
        lights: Vec<Bound<'_, PyAny>>,
        sky: &Bound<'_, PyAny>,
        background: &Bound<'_, PyAny>,
        camera: Camera,
    ) -> PyResult<Self> {
        let given = (Some(lights), Some(sky), Some(background), Some(camera));
        let Some(source) = source else {
            return builtin().replace(py, given.0, given.1, given.2, given.3);
        };
        if let Ok(meshes) = source.cast::<PyList>() {
            return Self::new(py, meshes.extract()?, given.0, given.1, given.2, given.3);
        }
        type File<'py> = (PathBuf, Bound<'py, PyDict>, Bound<'py, PyDict>);
        let (path, materials, options): File<'_> = source.extract()?;
        load(py, path, Some(&materials), Some(&options))?
            .replace(py, given.0, given.1, given.2, given.3)
    }

    fn __repr__(&self) -> String {
        let scene = &self.scene;
        let num: usize = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
        let [num_meshes, num_materials] = [scene.meshes.len(), scene.materials.len()];
        format!("<Scene of {num_meshes} meshes, {num_materials} materials, {num} triangles>")
    }
}

impl Scene {
    /// Its meshes, of the scene's own materials.
    fn meshes<'py>(
        &self,
        py: Python<'py>,
        materials: &[Option<Py<Material>>],
    ) -> PyResult<Bound<'py, PyList>> {
        let meshes = self.scene.meshes.iter().map(|mesh| {
            let material = materials[mesh.material].as_ref().map(|m| m.clone_ref(py));
            Bound::new(py, Mesh { mesh: mesh.clone(), material })
        });
        PyList::new(py, meshes.collect::<PyResult<Vec<_>>>()?)
    }
}

fn bounds(scene: &basrelief::Scene) -> Option<[Vec3; 2]> {
    let points = scene.meshes.iter().flat_map(|mesh| &mesh.positions);
    points.map(|p| [*p, *p]).reduce(|[least, most], [p, _]| [least.min(p), most.max(p)])
}

fn framing(scene: &basrelief::Scene, aspect: f32) -> PyResult<basrelief::Camera> {
    if !(aspect > 0.0 && aspect.is_finite()) {
        return Err(refused("aspect", "must be above 0"));
    }
    let all = bounds(scene).map(|[least, most]| basrelief::Camera::framing(least, most, aspect));
    Ok(all.unwrap_or_default())
}

fn light(arg: &Bound<'_, PyAny>) -> PyResult<Light> {
    if let Ok(sun) = arg.cast::<Sun>() {
        return Ok(sun.get().0);
    }
    let point = arg.cast::<PointLight>();
    point.map(|point| point.get().0).map_err(|_| mistyped("lights", "must be Sun or PointLight"))
}

fn any_sky(arg: &Bound<'_, PyAny>) -> PyResult<basrelief::Sky> {
    if let Ok(sky) = arg.cast::<Sky>() {
        return Ok(sky.get().0.clone());
    }
    if let Ok(picture) = arg.cast::<Environment>() {
        return Ok(basrelief::Sky::Environment(picture.get().0.clone()));
    }
    let gray = color(arg, "sky").map_err(|_| mistyped("sky", "must be Sky or Environment"))?;
    Ok(basrelief::Sky::Color(gray))
}

fn background_of(arg: &Bound<'_, PyAny>) -> PyResult<[f32; 4]> {
    arg.extract::<[f32; 4]>()
        .map_err(|_| mistyped("background", "must be four numbers: linear rgb and opacity"))
}
