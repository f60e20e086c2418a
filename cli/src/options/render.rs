//! The command line of `basrelief [render]`.

use crate::options::choices::{Choice, ON_OFF, one_of};
use crate::options::frames::FramesOptions;
use crate::options::layers::LayerOptions;
use crate::options::scene::SceneOptions;
use crate::options::settings::SettingsOptions;
use basrelief::inspect::View;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct RenderOptions {
    #[command(flatten)]
    pub(crate) scene: SceneOptions,
    #[command(flatten)]
    pub(crate) settings: SettingsOptions,
    #[command(flatten)]
    pub(crate) view: ViewOptions,

    #[command(flatten)]
    pub(crate) layers: LayerOptions,

    #[command(flatten)]
    pub(crate) frames: FramesOptions,

    /// Image to write: .png, .jpg, .tga, .tiff, .bmp (8-bit sRGB) or .exr (linear float); - writes
    /// PNG to stdout; of many frames #### becomes the number [default: basrelief.png,
    /// frame_####.png of many frames]
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub(crate) output: Option<PathBuf>,
    /// Write a scene file (TOML) that draws this picture again: the options, all settings and the
    /// camera
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub(crate) save_scene: Option<PathBuf>,
    /// Draw N frames after one to warm up and report the middle time
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000), help_heading = "Output")]
    pub(crate) repeat: Option<u32>,
    /// Write times and counts as one JSON object to FILE; - is stdout
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub(crate) stats: Option<PathBuf>,
    /// Print times, counts and file of each picture as a line of JSON
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
    /// Say nothing but warnings and errors
    #[arg(short, long, help_heading = "Output")]
    pub(crate) quiet: bool,
    /// Threads to draw with; 0: as many processors as this process may use
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1024), help_heading = "Output")]
    pub(crate) threads: u32,
}

pub(crate) const VIEWS: &[Choice<View>] = &[
    ("coverage", View::Coverage, "How many triangles a pixel sees, and how much of it they cover"),
    ("mip", View::Mip, "Mip level that the filter reads"),
    ("footprint", View::Footprint, "Texels of the full texture in the pixel's ellipse"),
    ("visible", View::Visible, "The part of these texels that the relief does not hide"),
    (
        "horizon",
        View::Horizon,
        "The part of the rows along the view that the floating horizon sees",
    ),
    ("depth", View::Depth, "Distance to the relief along the view"),
    ("normal", View::Normal, "Normal of the relief in world space"),
    ("uv", View::Uv, "Texture coordinates of the hit"),
    ("shadow", View::Shadow, "The part of what suns and points send that reaches the hit"),
    ("light", View::Light, "What lights and sky light a white surface to at the hit"),
    ("occlusion", View::Occlusion, "The part of the sky that nothing hides from the hit"),
];

#[derive(Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct ViewOptions {
    /// Show numbers of every pixel as colours, in place of the picture
    #[arg(long, value_name = "WHAT", value_parser = one_of(VIEWS), conflicts_with = "files")]
    pub(crate) view: Option<View>,
    /// Whether a legend is added below the picture of --view
    #[arg(long, value_name = "on|off", action = clap::ArgAction::Set, hide_possible_values = true, default_value = "on", value_parser = one_of(ON_OFF), requires = "view")]
    pub(crate) legend: bool,
}
