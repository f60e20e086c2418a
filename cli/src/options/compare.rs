//! The command line of `basrelief compare`.

use crate::options::values;
use basrelief::metrics::Picture;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct CompareOptions {
    /// An image: PNG, JPEG, TGA, TIFF, BMP, EXR or HDR; with --golden also a folder of images
    #[arg(value_name = "A")]
    pub(crate) a: PathBuf,
    /// An image of the same size
    #[arg(value_name = "B", required_unless_present = "golden")]
    pub(crate) b: Option<PathBuf>,
    /// With --golden, further images or folders
    #[arg(value_name = "MORE", requires = "golden")]
    pub(crate) more: Vec<PathBuf>,
    /// Most pixels of an image; they take 32 bytes each while they are read
    #[arg(long, value_name = "N", default_value_t = Picture::MAX_PIXELS, value_parser = clap::value_parser!(u64).range(1..=1 << 30))]
    pub(crate) max_pixels: u64,
    /// Exit with code 1 if the peak signal-to-noise ratio is below DB decibels
    #[arg(long, value_name = "DB", value_parser = values::decibels, allow_hyphen_values = true)]
    pub(crate) min_psnr: Option<f64>,
    /// Write an image of the errors: black none, then violet, red, orange, pale yellow for
    /// --heatmap-max or more
    #[arg(long, value_name = "FILE")]
    pub(crate) heatmap: Option<PathBuf>,
    /// The error that --heatmap shows in its brightest colour; 1 is the whole range of a channel
    #[arg(long, value_name = "E", default_value = "0.25", value_parser = values::fraction, allow_hyphen_values = true)]
    pub(crate) heatmap_max: f32,
    /// Compare each image with that of the same name in DIR; exit with code 1 if one differs.
    /// DIR/failed then shows what was expected, what was given and the difference; with
    /// `BASRELIEF_ACCEPT=1` in the environment what is given becomes golden
    #[arg(long, value_name = "DIR", conflicts_with_all = ["min_psnr", "heatmap"], help_heading = "Golden images")]
    pub(crate) golden: Option<PathBuf>,
    /// A pixel differs if its red, green, blue or opacity is off by more than E of its range, 0 to
    /// 1
    #[arg(long, value_name = "E", default_value = "0", value_parser = values::unit, requires = "golden", help_heading = "Golden images")]
    pub(crate) tolerance: f32,
    /// Share of pixels that may differ, 0 to 1
    #[arg(long, value_name = "S", default_value = "0", value_parser = values::unit, requires = "golden", help_heading = "Golden images")]
    pub(crate) share: f32,
    /// Print one JSON object, or one a line for each golden image; the ratio of equal images, which
    /// is infinite, is null
    #[arg(long)]
    pub(crate) json: bool,
}
