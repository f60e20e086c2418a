//! The command line as a whole. The options of frames and scenes stand in `settings` and `scene`.

use super::{scene::SceneOptions, settings::SettingsOptions, values, version};
use basrelief::metrics::Picture;
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// Draws height-mapped surfaces on the CPU, with the texels that the relief hides left out of the texture filter.
///
/// Without a subcommand it renders: `basrelief` draws the built-in scene to basrelief.png, `basrelief scene.obj -o out.png`
/// draws a file.
#[derive(Parser)]
#[command(name = "basrelief", version = version::text(), args_conflicts_with_subcommands = true)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
    #[command(flatten)]
    pub(crate) render: RenderOptions,
}

#[derive(Subcommand)]
#[expect(clippy::large_enum_variant, reason = "there is one, on the stack of main")]
pub(crate) enum Command {
    /// Draw a scene to an image file (what happens without a subcommand)
    Render(RenderOptions),
    /// Measure how far two images are apart
    ///
    /// Prints the peak signal-to-noise ratio, the largest error with its pixel and channel, and the structural
    /// similarity (SSIM), of sRGB-encoded values over the pixels that are opaque in both images. EXR and HDR files are
    /// taken as linear. Exit code 0; 1 if below --min-psnr; 2 if the images cannot be compared.
    Compare(CompareOptions),
}

#[derive(Args)]
pub(crate) struct RenderOptions {
    #[command(flatten)]
    pub(crate) scene: SceneOptions,
    #[command(flatten)]
    pub(crate) settings: SettingsOptions,

    /// Image to write: .png, .jpg, .tga, .tiff, .bmp (8-bit sRGB) or .exr (linear float); - writes PNG to stdout
    #[arg(short, long, value_name = "FILE", default_value = "basrelief.png", help_heading = "Output")]
    pub(crate) output: PathBuf,
    /// Draw N frames after one to warm up and report the middle time
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000), help_heading = "Output")]
    pub(crate) repeat: Option<u32>,
    /// Write times and counts as one JSON object to FILE; - is stdout
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub(crate) stats: Option<PathBuf>,
    /// Say nothing but warnings and errors
    #[arg(short, long, help_heading = "Output")]
    pub(crate) quiet: bool,
    /// Threads to draw with; 0: as many processors as this process may use
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1024), help_heading = "Output")]
    pub(crate) threads: u32,
}

#[derive(Args)]
pub(crate) struct CompareOptions {
    /// An image: PNG, JPEG, TGA, TIFF, BMP, EXR or HDR
    #[arg(value_name = "A")]
    pub(crate) a: PathBuf,
    /// An image of the same size
    #[arg(value_name = "B")]
    pub(crate) b: PathBuf,
    /// Most pixels of an image; they take 32 bytes each while they are read
    #[arg(long, value_name = "N", default_value_t = Picture::MAX_PIXELS, value_parser = clap::value_parser!(u64).range(1..=1 << 30))]
    pub(crate) max_pixels: u64,
    /// Exit with code 1 if the peak signal-to-noise ratio is below DB decibels
    #[arg(long, value_name = "DB", value_parser = values::decibels, allow_hyphen_values = true)]
    pub(crate) min_psnr: Option<f64>,
    /// Write an image of the errors: black none, then violet, red, orange, pale yellow for --heatmap-max or more
    #[arg(long, value_name = "FILE")]
    pub(crate) heatmap: Option<PathBuf>,
    /// The error that --heatmap shows in its brightest colour; 1 is the whole range of a channel
    #[arg(long, value_name = "E", default_value = "0.25", value_parser = values::fraction, allow_hyphen_values = true)]
    pub(crate) heatmap_max: f32,
    /// Print one JSON object; the ratio of equal images, which is infinite, is null
    #[arg(long)]
    pub(crate) json: bool,
}
