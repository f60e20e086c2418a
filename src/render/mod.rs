//! A whole frame: geometry, tiles, relief, filter, shade.
//!
//! 1. `geometry` projects, clips and snaps the triangles.
//! 2. `raster` finds the visible triangle of every sample, tile by tile, and gathers the quads that
//!    each covers.
//! 3. For each block of quads (`shade`): `relief` finds the hits, `footprint` says where the pixels
//!    lie in the texture, `filter` finds their texels, `light` shades them.
//! 4. `raster` adds the colours up to pixels.

mod baked;
mod bows;
mod by_place;
mod curved;
mod curved_lights;
mod curved_shadows;
mod exact;
mod gloss;
mod ground;
mod hidden_lights;
mod highlights;
mod lit;
mod mapped;
mod open_sky;
mod outlines;
mod passages;
mod places;
mod points;
mod prepared;
mod reflections;
mod rims;
mod shade;
mod shadows;
mod skies;
mod strays;

pub(crate) use ground::{clearance, pixel_center, point_of, surface_point};
pub(crate) use outlines::Outlines;
pub(crate) use passages::Passages;
pub(crate) use prepared::PreparedScene;
pub(crate) use shade::{ShadeScratch, Shader};

use crate::error::{Error, Result};
use crate::frame::{Frame, Pixel};
use crate::geometry::Geometry;
use crate::raster::{Drawn, Follow, Pool, QuadBlock, Rasterizer, TileGrid};
use crate::scene::{Camera, Mesh, Scene};
use crate::settings::{Region, Settings};

/// What drawing a frame took, in milliseconds: of the whole frame for `geometry_ms`, `raster_ms`
/// and `binning_ms`, of all threads together for the others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stats {
    /// Projecting, clipping and snapping.
    pub geometry_ms: f64,
    /// All that is neither geometry nor shading: the next three, and adding up colours.
    pub raster_ms: f64,
    /// Listing the triangles of each tile.
    pub binning_ms: f64,
    /// Coverage, depth and the quads that are seen.
    pub coverage_ms: f64,
    /// Attribute planes of the triangles that are seen.
    pub attributes_ms: f64,
    /// Relief, filter and light.
    pub shade_ms: f64,
    /// Pixels shaded; a pixel that two triangles share counts twice.
    pub pixels_shaded: u64,
    /// Quads of 2x2 pixels shaded; one that two triangles share counts twice.
    pub quads_shaded: u64,
    /// Triangles of the scene.
    pub triangles_in: u64,
    /// Triangles that reached the screen.
    pub triangles_drawn: u64,
    /// Texels whose visibility was tested; rows of sixteen lines for the horizon.
    pub texels_tested: u64,
    /// Texels that were averaged.
    pub texels_visible: u64,
}

/// Draws frames of a scene; keeps its tables and buffers between them.
#[derive(Debug)]
pub struct Renderer {
    scene: Scene,
    settings: Settings,
    prepared: PreparedScene,
    pool: Pool<ShadeScratch>,
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
        let mut renderer = Self {
            prepared: PreparedScene::new(&scene),
            scene,
            // Replaced below, on the one path that checks settings and builds their tables.
            settings: Settings::default(),
            pool: Pool::default(),
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
        // Checked first: settings that fail leave the renderer as it was.
        settings.validate()?;
        self.prepared.make_ready(&self.scene, &settings);
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
        // It may see other sides of flat pieces.
        self.prepared.make_ready(&self.scene, &self.settings);
        Ok(())
    }

    /// Draws the next frames with other meshes in the place of some, by their index: a mesh that
    /// moves, or changes its shape. They are exchanged, so that their memory can be taken again.
    /// Surfaces stay as they are; in lit frames what meshes hide from each other is made anew.
    ///
    /// # Errors
    /// Names the first mesh that does not exist or is not valid; then none is exchanged.
    pub fn exchange_meshes(&mut self, meshes: &mut [(usize, Mesh)]) -> Result<()> {
        let num = self.scene.meshes.len();
        for (i, mesh) in meshes.iter() {
            let part = || format!("mesh {i} ({})", mesh.name.escape_debug());
            if *i >= num {
                return Err(Error::scene(part(), format!("is not one of {num} meshes")));
            }
            let checked = mesh.validate(self.scene.materials.len());
            checked.map_err(|reason| Error::scene(part(), reason))?;
        }
        for (i, mesh) in meshes {
            std::mem::swap(&mut self.scene.meshes[*i], mesh);
        }
        self.prepared.forget_meshes();
        self.prepared.make_ready(&self.scene, &self.settings);
        Ok(())
    }

    /// Draws the next frames' part `region`, or the whole frames, and leaves the other settings as
    /// they are.
    ///
    /// # Errors
    /// Says so when the region does not lie within the frame.
    pub fn set_region(&mut self, region: Option<Region>) -> Result<()> {
        // A region is valid only within a frame of that size, so the settings are checked as a
        // whole, and get back what they had if they fail.
        let old = std::mem::replace(&mut self.settings.region, region);
        self.settings.validate().inspect_err(|_| self.settings.region = old)
    }

    /// What is drawn.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// How it is drawn.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// What is drawn, with what is prepared of it, and the buffers that drawing fills.
    pub(crate) fn parts(
        &mut self,
    ) -> (&Scene, &Settings, &PreparedScene, &Pool<ShadeScratch>, &mut Geometry, &mut Rasterizer)
    {
        let Self { scene, settings, prepared, pool, geometry, rasterizer } = self;
        (scene, settings, prepared, pool, geometry, rasterizer)
    }

    /// Draws a frame on the threads of the current rayon pool.
    pub fn render(&mut self) -> Frame {
        let mut frame = Frame::default();
        self.render_into(&mut frame);
        frame
    }

    /// A frame for each of `cameras`, drawn when it is asked for, so that there may be more of them
    /// than memory holds.
    ///
    /// ```no_run
    /// use basrelief::{Camera, Frame, Renderer, Settings, scene};
    ///
    /// let mut renderer = Renderer::new(scene::builtin(), Settings::default())?;
    /// let first = renderer.scene().camera;
    /// let along = (0..10_000).map(|i| Camera { eye: first.eye + 0.001 * i as f32, ..first });
    /// for (i, frame) in renderer.frames(along).enumerate() {
    ///     let frame: Frame<[u8; 4]> = frame?;
    ///     frame.save(format!("{i:05}.png"))?;
    /// }
    /// # Ok::<(), basrelief::Error>(())
    /// ```
    ///
    /// # Errors
    /// Of each frame: names what is wrong with its camera.
    pub fn frames<P: DrawnPixel>(
        &mut self,
        cameras: impl IntoIterator<Item = Camera>,
    ) -> impl Iterator<Item = Result<Frame<P>>> {
        cameras.into_iter().map(|camera| {
            self.set_camera(camera)?;
            let mut frame = Frame::default();
            self.render_into(&mut frame);
            Ok(frame)
        })
    }

    /// Draws over a frame, whose memory is taken again where its size is right.
    pub fn render_into<P: DrawnPixel>(&mut self, frame: &mut Frame<P>) {
        self.render_timed(frame, &|| 0.0);
    }

    /// [`Self::render_into`], and what it took; `clock` gives milliseconds, since the library reads
    /// no clock of its own.
    pub fn render_timed<P: DrawnPixel>(
        &mut self,
        frame: &mut Frame<P>,
        clock: &(dyn Fn() -> f64 + Sync),
    ) -> Stats {
        let area = TileGrid::new(&self.settings).area;
        frame.fit(area.size().map(|side| side as u32));
        let stats = P::draw(self, &mut frame.pixels, clock);
        if let Some(region) = self.settings.region {
            // The tiles cover whole blocks, which begin a few pixels before the region.
            let [x, y] = area.min.map(|v| v as u32);
            frame.crop(Region { x: region.x - x, y: region.y - y, ..region });
        }
        stats
    }

    /// Draws over pixels of the caller's, row by row from the top: no memory is taken for the
    /// picture, unless it is a [region](Settings::region).
    ///
    /// # Panics
    /// If they are not as many as [`Settings::drawn`] says.
    pub fn render_to<P: DrawnPixel>(&mut self, pixels: &mut [P]) {
        if self.settings.region.is_some() {
            let mut frame = Frame::default();
            self.render_into(&mut frame);
            pixels.copy_from_slice(&frame.pixels);
        } else {
            P::draw(self, pixels, &|| 0.0);
        }
    }

    fn draw<P: Pixel>(&mut self, pixels: &mut [P], clock: &(dyn Fn() -> f64 + Sync)) -> Stats {
        let Self { scene, settings, prepared, pool, geometry, rasterizer } = self;
        let start = clock();
        // All triangles are projected before the first tile begins: its list must be complete.
        geometry.project(scene, settings);
        let projected = clock();
        // Called for each triangle that is seen: only where that makes a difference.
        let group = |triangle| prepared.group(scene, triangle);
        let group = prepared.is_baked().then_some(&group as &(dyn Fn(_) -> _ + Sync));
        let outlines = prepared.outlines(scene, settings, geometry.projection());
        let outlines = outlines.as_ref();
        let shader = Shader::new(scene, settings, prepared, outlines, pool);
        let shade = |block: &QuadBlock, colors: &mut Vec<_>| shader.shade(block, colors);
        let passages = Passages::new(scene, geometry.projection(), outlines);
        let follow = passages.as_ref().map(|passages| passages as &dyn Follow);
        let drawn = Drawn { scene, settings, group, follow };
        let counts = rasterizer.draw(geometry, drawn, &shade, clock, pixels);
        let work = shader.work();
        Stats {
            geometry_ms: projected - start,
            // Tiles add up their shading over all threads. Its share of the frame's time is an
            // estimate, and may be more than there was.
            raster_ms: (clock()
                - projected
                - counts.shade_ms / rayon::current_num_threads() as f64)
                .max(0.0),
            binning_ms: counts.binning_ms,
            coverage_ms: counts.coverage_ms,
            attributes_ms: counts.attributes_ms,
            shade_ms: counts.shade_ms,
            pixels_shaded: counts.pixels_shaded,
            quads_shaded: counts.quads_shaded,
            triangles_in: scene.meshes.iter().map(|mesh| mesh.triangles.len() as u64).sum(),
            triangles_drawn: counts.triangles_drawn,
            texels_tested: work.num_tested,
            texels_visible: work.num_averaged,
        }
    }
}

/// A [`Pixel`] that frames are drawn in. Each kind of pixel has its drawing compiled once, here,
/// and not in every crate that draws.
pub trait DrawnPixel: Pixel {
    #[doc(hidden)]
    fn draw(
        renderer: &mut Renderer,
        pixels: &mut [Self],
        clock: &(dyn Fn() -> f64 + Sync),
    ) -> Stats;
}

impl DrawnPixel for [f32; 4] {
    fn draw(
        renderer: &mut Renderer,
        pixels: &mut [Self],
        clock: &(dyn Fn() -> f64 + Sync),
    ) -> Stats {
        renderer.draw(pixels, clock)
    }
}

impl DrawnPixel for [u8; 4] {
    fn draw(
        renderer: &mut Renderer,
        pixels: &mut [Self],
        clock: &(dyn Fn() -> f64 + Sync),
    ) -> Stats {
        renderer.draw(pixels, clock)
    }
}

/// Draws one frame.
///
/// # Errors
/// Names the first setting or part of the scene that is not valid.
pub fn render(scene: Scene, settings: Settings) -> Result<Frame> {
    Ok(Renderer::new(scene, settings)?.render())
}
