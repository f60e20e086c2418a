//! A whole frame: geometry, tiles, relief, filter, shade.
//!
//! 1. `geometry` projects, clips and snaps the triangles.
//! 2. `raster` finds the visible triangle of every sample, tile by tile, and gathers the quads that each covers.
//! 3. For each pair of quads ([`quads`]): `relief` gives the view slope and the hits, `filter` the footprint and its texels,
//!    `shade` the colour.
//! 4. `raster` adds the colours up to pixels.

mod quads;

use crate::error::Result;
use crate::filter::{FarField, parallax, truth};
use crate::frame::Frame;
use crate::geometry::Geometry;
use crate::raster::Rasterizer;
use crate::relief::HeightField;
use crate::scene::{Camera, Material, Scene};
use crate::settings::{Filter, Lighting, Settings};
use crate::texture::Surface;
use quads::QuadShader;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// What drawing a frame took. Times are of the whole frame for `geometry_ms`, and of all threads together for the others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stats {
    /// Projecting, clipping and snapping, in milliseconds.
    pub geometry_ms: f64,
    /// Coverage and depth, in milliseconds.
    pub raster_ms: f64,
    /// Relief, filter and light, in milliseconds.
    pub shade_ms: f64,
    /// Pixels shaded; a pixel that two triangles share counts twice.
    pub pixels_shaded: u64,
    /// Triangles of the scene.
    pub triangles_in: u64,
    /// Triangles that reached the screen.
    pub triangles_drawn: u64,
    /// Texels whose visibility was tested; rows of eight lines for the horizon.
    pub texels_tested: u64,
    /// Texels that were averaged.
    pub texels_visible: u64,
}

/// Draws frames of a scene; keeps its tables and buffers between them.
#[derive(Debug)]
pub struct Renderer {
    scene: Scene,
    settings: Settings,
    /// The height field of each material that has relief; shared where the surface is.
    fields: Vec<Option<Arc<HeightField>>>,
    /// The tables of the same materials for distant footprints; empty until they are needed.
    far_fields: Vec<Option<Arc<FarField>>>,
    kernel: truth::Kernel,
    offsets: Vec<[f32; 2]>,
    geometry: Geometry,
    rasterizer: Rasterizer,
}

impl Renderer {
    /// Checks the scene and settings and builds what every frame needs.
    ///
    /// # Errors
    /// Names the first setting or part of the scene that is not valid.
    pub fn new(scene: Scene, settings: Settings) -> Result<Self> {
        scene.validate()?;
        let fields = per_surface(&scene, |surface| Some(HeightField::new(surface)));
        let far_fields = vec![None; scene.materials.len()];
        let mut renderer = Self {
            scene,
            settings: Settings::default(),
            fields,
            far_fields,
            kernel: truth::Kernel::new(1),
            offsets: Vec::new(),
            geometry: Geometry::default(),
            rasterizer: Rasterizer::default(),
        };
        renderer.set_settings(settings)?;
        Ok(renderer)
    }

    /// Draws the next frames with other settings.
    ///
    /// # Errors
    /// Names the first setting that is out of its range.
    pub fn set_settings(&mut self, settings: Settings) -> Result<()> {
        settings.validate()?;
        if settings.filter == Filter::Truth {
            self.kernel = truth::Kernel::new(settings.samples);
        }
        self.offsets = parallax::offsets(settings.samples);
        let wants_far =
            settings.filter == Filter::Horizon && settings.far_field && settings.lighting == Lighting::Unlit;
        let has_far =
            self.far_fields.iter().any(Option::is_some) && settings.far_field_mib == self.settings.far_field_mib;
        if !wants_far {
            self.far_fields.fill(None);
        } else if !has_far {
            self.far_fields = per_surface(&self.scene, |surface| FarField::new(surface, &settings));
        }
        self.settings = settings;
        Ok(())
    }

    /// Draws the next frames from another place.
    ///
    /// # Errors
    /// Names what is wrong with the camera.
    pub fn set_camera(&mut self, camera: Camera) -> Result<()> {
        camera.validate()?;
        self.scene.camera = camera;
        Ok(())
    }

    /// What is drawn.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// How it is drawn.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Draws a frame on the threads of the current rayon pool.
    pub fn render(&mut self) -> Frame {
        self.render_timed(&|| 0.0).0
    }

    /// Draws a frame and says what it took; `clock` gives milliseconds, since the library reads no clock of its own.
    pub fn render_timed(&mut self, clock: &(dyn Fn() -> f64 + Sync)) -> (Frame, Stats) {
        let Self { scene, settings, fields, far_fields, kernel, offsets, geometry, rasterizer } = self;
        let start = clock();
        geometry.project(scene, settings);
        let projected = clock();
        let shader = QuadShader::new(scene, settings, (fields, far_fields), (kernel, offsets));
        let shade_us = AtomicU64::new(0);
        let shade = |pair: &crate::raster::QuadPair| {
            let before = clock();
            let color = shader.shade(pair);
            shade_us.fetch_add(((clock() - before) * 1e3) as u64, Ordering::Relaxed);
            color
        };
        let mut frame = Frame::filled(settings.width, settings.height, [0.0; 4]);
        let counts = rasterizer.draw(geometry, scene, settings, &shade, &mut frame);
        let shade_ms = shade_us.into_inner() as f64 * 1e-3;
        let [texels_tested, texels_visible] = shader.num_texels();
        let stats = Stats {
            geometry_ms: projected - start,
            raster_ms: (clock() - projected - shade_ms / rayon::current_num_threads() as f64).max(0.0),
            shade_ms,
            pixels_shaded: counts.pixels_shaded,
            triangles_in: scene.meshes.iter().map(|mesh| mesh.triangles.len() as u64).sum(),
            triangles_drawn: counts.triangles_drawn,
            texels_tested,
            texels_visible,
        };
        (frame, stats)
    }
}

/// What is made of each material's surface, if that has relief: one per distinct surface.
fn per_surface<T>(scene: &Scene, make: impl Fn(&Surface) -> Option<T>) -> Vec<Option<Arc<T>>> {
    let mut made: Vec<(Arc<Surface>, Option<Arc<T>>)> = Vec::new();
    let mut of = |surface: &Arc<Surface>| {
        if let Some((_, table)) = made.iter().find(|(other, _)| Arc::ptr_eq(other, surface)) {
            return table.clone();
        }
        let table = make(surface).map(Arc::new);
        made.push((surface.clone(), table.clone()));
        table
    };
    let relief = |material: &Material| material.surface.clone().filter(|surface| surface.relief_depth > 0.0);
    scene.materials.iter().map(|material| relief(material).and_then(|surface| of(&surface))).collect()
}

/// Draws one frame.
///
/// # Errors
/// Names the first setting or part of the scene that is not valid.
pub fn render(scene: Scene, settings: Settings) -> Result<Frame> {
    Ok(Renderer::new(scene, settings)?.render())
}
