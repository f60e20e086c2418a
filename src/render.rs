//! The whole frame.

use crate::error::Result;
use crate::frame::Frame;
use crate::scene::{Camera, Scene};
use crate::settings::Settings;

/// What a frame took.
#[derive(Clone, Debug, Default)]
pub struct Stats {
    /// Milliseconds from model space to binned screen triangles.
    pub geometry_ms: f64,
    /// Milliseconds of coverage and depth.
    pub raster_ms: f64,
    /// Milliseconds of relief, filter and light.
    pub shade_ms: f64,
    /// Pixels that a surface covers.
    pub pixels_shaded: u64,
    /// Triangles of the scene.
    pub triangles_in: u64,
    /// Triangles after clipping and culling.
    pub triangles_drawn: u64,
    /// Texels of all ellipses.
    pub texels_tested: u64,
    /// Texels that the relief does not hide.
    pub texels_visible: u64,
}

/// Draws frames of one scene.
pub struct Renderer {
    scene: Scene,
    settings: Settings,
}

impl Renderer {
    /// A renderer of `scene`.
    ///
    /// # Errors
    /// Names what is not valid.
    pub fn new(scene: Scene, settings: Settings) -> Result<Self> {
        scene.validate()?;
        settings.validate()?;
        Ok(Self { scene, settings })
    }

    /// Changes how frames are drawn.
    ///
    /// # Errors
    /// Names what is not valid.
    pub fn set_settings(&mut self, settings: Settings) -> Result<()> {
        settings.validate()?;
        self.settings = settings;
        Ok(())
    }

    /// Moves the camera.
    ///
    /// # Errors
    /// Names what is not valid.
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

    /// Draws a frame.
    pub fn render(&mut self) -> Frame {
        self.render_timed(&|| 0.0).0
    }

    /// Draws a frame and measures it by `clock`, which gives milliseconds.
    pub fn render_timed(&mut self, clock: &(dyn Fn() -> f64 + Sync)) -> (Frame, Stats) {
        let start = clock();
        let frame = Frame::filled(self.settings.width, self.settings.height, self.scene.background);
        (frame, Stats { shade_ms: clock() - start, ..Stats::default() })
    }
}

/// Draws one frame of `scene`.
///
/// # Errors
/// Names what is not valid.
pub fn render(scene: Scene, settings: Settings) -> Result<Frame> {
    Ok(Renderer::new(scene, settings)?.render())
}
