//! The command line of `basrelief inspect`.

use crate::options::scene::SceneOptions;
use crate::options::settings::SettingsOptions;
use crate::options::values;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct InspectOptions {
    #[command(flatten)]
    pub(crate) scene: SceneOptions,
    #[command(flatten)]
    pub(crate) settings: SettingsOptions,

    /// The pixel: its column and row, counted from 0 at the upper left
    #[arg(long, value_name = "X,Y", value_parser = values::pixel, help_heading = "Inspection")]
    pub(crate) pixel: Option<[u32; 2]>,
    /// One of the paper's figures, 1 to 6, on the built-in scene: sets the pixel, the camera and
    /// all settings
    #[arg(long, value_name = "N", conflicts_with_all = ["pixel", "model", "CameraOptions", "LightOptions", "FrameOptions", "FilterOptions"], value_parser = clap::value_parser!(u32).range(1..=6), help_heading = "Inspection")]
    pub(crate) figure: Option<u32>,
    /// Picture to write; without it there are only the numbers. - writes PNG to stdout, without the
    /// numbers
    #[arg(short, long, value_name = "FILE", help_heading = "Inspection")]
    pub(crate) output: Option<PathBuf>,
    /// Print one JSON object, with every texel
    #[arg(long, help_heading = "Inspection")]
    pub(crate) json: bool,
}
