//! Drawing frames of a scene.

use crate::arguments::{exception, matrix, mistyped, points, refused, size as size_of};
use crate::camera::Camera;
use crate::frames::Frames;
use crate::scene::Scene;
use crate::targets::{self, Part, Target};
use crate::{inspect, pools, settings};
use basrelief::{Mesh, Region, Settings, Sky};
use pyo3::exceptions::{PyKeyError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use pyo3::types::PyDict;
use std::collections::HashMap;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, Instant};

/// How long frames are drawn before the interpreter may look at signals.
const AT_ONCE: Duration = Duration::from_millis(100);
/// Pixels of a frame where no size is given.
const SIZE: [u32; 2] = [640, 480];

/// Draws frames of a scene; keeps what it has made of it from frame to frame.
///
/// Renderer(scene, *, filter="horizon", lighting=None, exposure=0.0, tone="none", msaa=4,
///     parallax=True, silhouette=True, cull=False, tile_size=32, threads=None)
///
/// filter: which texels make up a pixel's colour: a name or a Filter.
/// lighting: "lit" or "unlit"; None is lit where the scene has a light or a sky.
/// exposure: how many times light is doubled. tone: "none", or "neutral" (Khronos PBR Neutral).
/// msaa: samples a pixel at edges of "color" and "linear": 1, 4 or 8. Layers have one.
/// parallax: whether relief is traced. silhouette: whether it has an outline of its own.
/// cull: whether triangles seen from behind are left out.
/// threads: how many draw; None is as many as the process may use. They are made when the first
///     frame is drawn, in each process anew, so a renderer may be used after a fork.
///
/// Pictures are the same, byte for byte, for any threads and tile_size, on any machine. The
/// interpreter's lock is released while frames are drawn; threads that share a renderer take turns.
#[pyclass(frozen, module = "basrelief")]
#[derive(Debug)]
pub(crate) struct Renderer {
    state: Mutex<State>,
    /// The process that locked the state last.
    holder: AtomicU32,
    threads: usize,
}

#[derive(Debug)]
struct State {
    renderer: basrelief::Renderer,
    /// The scene's own camera.
    first: basrelief::Camera,
    /// Meshes that were placed, as they were before.
    rests: HashMap<usize, Mesh>,
    /// Memory for the next that is placed.
    spare: Mesh,
}

#[pymethods]
impl Renderer {
    #[new]
    #[pyo3(signature = (scene, *, filter = None, lighting = None, exposure = 0.0, tone = "none",
        msaa = 4, parallax = true, silhouette = true, cull = false, tile_size = 32,
        threads = None))]
    fn new(
        py: Python<'_>,
        scene: &Bound<'_, Scene>,
        filter: Option<&Bound<'_, PyAny>>,
        lighting: Option<&str>,
        exposure: f32,
        tone: &str,
        msaa: u32,
        parallax: bool,
        silhouette: bool,
        cull: bool,
        tile_size: u32,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let scene = (*scene.get().scene).clone();
        let is_dark = scene.lights.is_empty() && scene.sky == Sky::default();
        let [width, height] = SIZE;
        let mut asked = Settings {
            width,
            height,
            filter: settings::filter(filter)?,
            exposure,
            msaa,
            parallax,
            silhouette,
            cull_back_faces: cull,
            tile_size,
            ..Settings::default()
        };
        let lighting = lighting.unwrap_or(if is_dark { "unlit" } else { "lit" });
        settings::light(&mut asked, lighting, tone)?;
        let threads = pools::threads(threads)?;
        let pool = pools::pool(threads)?;
        let made = py.detach(|| pool.install(|| basrelief::Renderer::new(scene, asked)));
        let renderer = made.map_err(exception)?;
        let (first, (rests, spare)) = (renderer.scene().camera, Default::default());
        let state = State { renderer, first, rests, spare };
        let holder = AtomicU32::new(std::process::id());
        Ok(Self { state: Mutex::new(state), holder, threads })
    }

    /// Draws a frame, or one for each of several cameras.
    ///
    /// camera: a Camera, a sequence of them, or None for the scene's.
    /// size: width and height in pixels.
    /// layers: a name or several of basrelief.LAYERS: "color" (uint8, sRGB with straight opacity),
    ///     "linear" (float32, linear light times its opacity), and those of docs/layers.md: "depth"
    ///     (float32, along the view, infinity where nothing is seen), "normal", "position", "uv",
    ///     "albedo", "object", "material", "triangle" (uint32, 4294967295 where nothing is seen)
    ///     and others.
    /// out: a dict that holds an array for each layer, C-contiguous, of the right shape and dtype:
    ///     they are overwritten, and no memory is taken.
    /// region: (x, y, width, height), the part of the frame that is drawn: its pixels are those of
    ///     the whole frame.
    ///
    /// Returns a dict of arrays of shape (H, W) or (H, W, channels), row 0 at the top; with several
    /// cameras their number comes first.
    #[pyo3(signature = (camera = None, size = None, layers = None, *, out = None, region = None))]
    fn render<'py>(
        &self,
        py: Python<'py>,
        camera: Option<&Bound<'py, PyAny>>,
        size: Option<&Bound<'py, PyAny>>,
        layers: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyDict>>,
        region: Option<[u32; 4]>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let size = size.map_or(Ok(SIZE), |size| size_of(size, "size"))?;
        let kinds = targets::parse(layers)?;
        let state = &mut *self.lock(py)?;
        let (cameras, num) = state.cameras(camera)?;
        let region = region.map(|[x, y, width, height]| Region { x, y, width, height });
        self.work(py, || state.set_size(size, region))?.map_err(exception)?;
        let drawn = state.renderer.settings().drawn();
        let shape = (num, [drawn.width, drawn.height]);
        let targets = kinds.into_iter().map(|kind| Target::new(py, kind, shape, out));
        let mut targets = targets.collect::<PyResult<Vec<_>>>()?;
        let parts = targets.iter_mut().map(Target::part);
        self.draw(py, state, &cameras, &mut parts.collect::<PyResult<Vec<_>>>()?)?;
        let found = PyDict::new(py);
        targets.into_iter().try_for_each(|target| target.put(&found))?;
        Ok(found)
    }

    /// Frames one by one, for data sets larger than memory: an iterator over dicts as render gives.
    ///
    /// cameras: any iterable of Camera. reuse: whether each frame overwrites the arrays of the one
    ///     before.
    #[pyo3(signature = (cameras, size = None, layers = None, *, reuse = false))]
    fn frames<'py>(
        slf: Bound<'py, Self>,
        cameras: &Bound<'py, PyAny>,
        size: Option<Py<PyAny>>,
        layers: Option<Py<PyAny>>,
        reuse: bool,
    ) -> PyResult<Frames> {
        Ok(Frames::new(slf.unbind(), cameras.try_iter()?.unbind(), (size, layers), reuse))
    }

    /// Places meshes: draws the next frames with the vertices of each, as the scene has them, moved
    /// by a matrix.
    ///
    /// transforms: a dict from meshes, by their names or places in Scene.objects, to arrays (4, 4)
    ///     from the scene to the world, row by row. They may turn, move, stretch and shear, but not
    ///     mirror. Meshes that are not named stay where they are.
    ///
    /// Nothing is made anew, but for what meshes hide from each other in lit frames.
    fn place(&self, py: Python<'_>, transforms: &Bound<'_, PyDict>) -> PyResult<()> {
        let state = &mut *self.lock(py)?;
        let mut placed = Vec::new();
        for (mesh, transform) in transforms {
            let index = state.mesh(&mesh)?;
            if placed.iter().any(|(known, _)| *known == index) {
                return Err(refused("transforms", format!("names mesh {index} twice")));
            }
            let transform = matrix(&transform, "transforms")?;
            placed.push((index, state.placed(index, &transform)?));
        }
        self.exchange(py, state, &mut placed)
    }

    /// Gives a mesh other vertices, (N, 3), as many as it has, in world units; faces and texture
    /// coordinates stay. Without normals, (N, 3), they are made from the faces.
    #[pyo3(signature = (mesh, vertices, normals = None))]
    fn set_vertices(
        &self,
        py: Python<'_>,
        mesh: &Bound<'_, PyAny>,
        vertices: &Bound<'_, PyAny>,
        normals: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let positions = points(vertices, "vertices")?;
        let normals = normals.map_or(Ok(Vec::new()), |normals| points(normals, "normals"))?;
        let state = &mut *self.lock(py)?;
        let index = state.mesh(mesh)?;
        let old = &state.renderer.scene().meshes[index];
        let num = old.positions.len();
        for (name, len) in [("vertices", positions.len()), ("normals", normals.len())] {
            if len != num && (name == "vertices" || len != 0) {
                return Err(refused(name, format!("has {len} rows for {num} vertices")));
            }
        }
        let (tex_coords, triangles) = (old.tex_coords.clone(), old.triangles.clone());
        let colors = old.colors.clone();
        let new = Mesh {
            name: old.name.clone(),
            material: old.material,
            colors,
            ..Mesh::new(positions, tex_coords, normals, triangles)
        };
        self.exchange(py, state, &mut vec![(index, new)])?;
        state.rests.remove(&index);
        Ok(())
    }

    /// What one pixel sees, and why: numbers of the view ray, the ellipses of formulas (1) to (3),
    /// the paper's sets of texels and a cut through the relief, as a dict.
    ///
    /// pixel: column and row. It must see a mesh with texture coordinates and a surface.
    #[pyo3(signature = (pixel, camera = None, size = None))]
    fn inspect<'py>(
        &self,
        py: Python<'py>,
        pixel: &Bound<'py, PyAny>,
        camera: Option<&Bound<'py, Camera>>,
        size: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let pixel = size_of(pixel, "pixel")?;
        let size = size.map_or(Ok(SIZE), |size| size_of(size, "size"))?;
        let state = &mut *self.lock(py)?;
        let (cameras, _) = state.cameras(camera.map(|camera| camera.as_any()))?;
        let seen = self.work(py, || {
            state.set_size(size, None)?;
            state.renderer.set_camera(cameras[0])?;
            let renderer = &state.renderer;
            basrelief::inspect::pixel(renderer.scene(), renderer.settings(), pixel)
        })?;
        inspect::dict(py, &seen.map_err(exception)?)
    }

    /// How many threads draw.
    #[getter]
    fn threads(&self) -> usize {
        self.threads
    }
}

impl Renderer {
    /// The state, when no other thread has it.
    fn lock<'a>(&'a self, py: Python<'_>) -> PyResult<MutexGuard<'a, State>> {
        let process = std::process::id();
        let guard = match self.state.try_lock() {
            Ok(guard) => guard,
            Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
            // The thread that has it is not in this process: nobody would ever give it back.
            Err(TryLockError::WouldBlock) if self.holder.load(Ordering::Relaxed) != process => {
                let text = "the process was forked while another thread drew with this renderer: \
                    make a renderer in the new process";
                return Err(PyRuntimeError::new_err(text));
            }
            Err(TryLockError::WouldBlock) => {
                self.state.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner)
            }
        };
        self.holder.store(process, Ordering::Relaxed);
        Ok(guard)
    }

    /// Does work on the renderer's threads, without the interpreter's lock.
    fn work<T: Send>(&self, py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
        let pool = pools::pool(self.threads)?;
        Ok(py.detach(|| pool.install(work)))
    }

    fn draw(
        &self,
        py: Python<'_>,
        state: &mut State,
        cameras: &[basrelief::Camera],
        parts: &mut [Part<'_>],
    ) -> PyResult<()> {
        let mut next = 0;
        while next < cameras.len() {
            // Threads are woken once for many small frames; a long batch can be interrupted.
            let drawn = self.work(py, || {
                let start = Instant::now();
                while next < cameras.len() && start.elapsed() < AT_ONCE {
                    state.renderer.set_camera(cameras[next])?;
                    targets::draw(&mut state.renderer, parts, next);
                    next += 1;
                }
                Ok(())
            })?;
            drawn.map_err(exception)?;
            py.check_signals()?;
        }
        Ok(())
    }

    fn exchange(
        &self,
        py: Python<'_>,
        state: &mut State,
        meshes: &mut Vec<(usize, Mesh)>,
    ) -> PyResult<()> {
        let exchanged = self.work(py, || state.renderer.exchange_meshes(meshes))?;
        exchanged.map_err(exception)?;
        state.spare = meshes.pop().map(|(_, mesh)| mesh).unwrap_or_default();
        Ok(())
    }
}

impl State {
    /// The cameras that are given, and how many where they are a sequence.
    fn cameras(
        &self,
        arg: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<(Vec<basrelief::Camera>, Option<usize>)> {
        let Some(arg) = arg else { return Ok((vec![self.first], None)) };
        if let Ok(camera) = arg.cast::<Camera>() {
            return Ok((vec![camera.get().0], None));
        }
        let wrong = |_| mistyped("camera", "must be a Camera or a sequence of them");
        let mut cameras = Vec::new();
        for camera in arg.try_iter().map_err(wrong)? {
            cameras.push(camera?.cast::<Camera>().map_err(|error| wrong(error.into()))?.get().0);
        }
        let num = cameras.len();
        Ok((cameras, Some(num)))
    }

    fn set_size(
        &mut self,
        [width, height]: [u32; 2],
        region: Option<Region>,
    ) -> basrelief::Result<()> {
        let old = self.renderer.settings();
        if (old.width, old.height, old.region) == (width, height, region) {
            return Ok(());
        }
        self.renderer.set_settings(Settings { width, height, region, ..old.clone() })
    }

    /// The index of a mesh by its name or index.
    fn mesh(&self, arg: &Bound<'_, PyAny>) -> PyResult<usize> {
        let meshes = &self.renderer.scene().meshes;
        if let Ok(name) = arg.extract::<String>() {
            let mut named = (0..meshes.len()).filter(|i| meshes[*i].name == name);
            return match (named.next(), named.next()) {
                (Some(index), None) => Ok(index),
                (None, _) => Err(PyKeyError::new_err(format!("there is no mesh \"{name}\""))),
                _ => Err(PyKeyError::new_err(format!("several meshes are named \"{name}\""))),
            };
        }
        let index = arg.extract::<usize>();
        let index = index.map_err(|_| mistyped("mesh", "must be a name or an index"))?;
        if index < meshes.len() {
            return Ok(index);
        }
        Err(refused("mesh", format!("{index} is not the index of one of {} meshes", meshes.len())))
    }

    /// A mesh, as the scene has it, moved by a matrix.
    fn placed(&mut self, index: usize, transform: &[[f32; 4]; 4]) -> PyResult<Mesh> {
        let Self { renderer, rests, spare, .. } = self;
        let rest = rests.entry(index).or_insert_with(|| renderer.scene().meshes[index].clone());
        let mut placed = std::mem::take(spare);
        rest.place(transform, &mut placed).map_err(exception)?;
        Ok(placed)
    }
}
