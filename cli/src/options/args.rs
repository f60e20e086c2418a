//! The command line as a whole. The options of frames and scenes stand in `settings` and `scene`.

use super::{
    frames::FramesOptions, inspect::InspectOptions, measured::ViewOptions, scene::SceneOptions,
    settings::SettingsOptions, study::StudyOptions, values, version,
};
use basrelief::metrics::Picture;
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// Draws height-mapped surfaces on the CPU, with the texels that the relief hides left out of the texture filter.
///
/// Without a subcommand it renders: `basrelief` draws the built-in scene to basrelief.png, `basrelief scene.obj -o out.png`
/// draws a file.
#[derive(Parser)]
#[command(name = "basrelief", version = version::text(), args_conflicts_with_subcommands = true, max_term_width = 120)]
#[command(after_long_help = EXIT_CODES)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
    #[command(flatten)]
    pub(crate) render: RenderOptions,
}

/// What scripts may rely on.
const EXIT_CODES: &str = "Exit codes:
  0    done
  1    a comparison is below its bound
  2    something is refused, said in one line on stderr; nothing is written
  130  interrupted; nothing half-written stays behind

Environment:
  NO_COLOR                   no colours or bold type, in this help as well
  BASRELIEF_ACCEPT=1         compare --golden accepts what it is given
  SLURM_ARRAY_TASK_ID, ...   the share of many frames that is drawn in a Slurm array
  JOB_COMPLETION_INDEX       the share in a Kubernetes Indexed Job, with --shards";

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Draw a scene to an image file (what happens without a subcommand)
    Render(RenderOptions),
    /// Measure how far two images are apart
    ///
    /// Prints the peak signal-to-noise ratio, the largest error with its pixel and channel, and the structural
    /// similarity (SSIM), of sRGB-encoded values over the pixels that are opaque in both images. EXR and HDR files are
    /// taken as linear. With --golden, tests images against those of a folder. Exit code 0; 1 if below --min-psnr or not
    /// golden; 2 if the images cannot be compared.
    Compare(CompareOptions),
    /// Show what one pixel sees and why: footprint, hidden texels, a cut through the relief, and the formulas' numbers
    Inspect(InspectOptions),
    /// Compare all filters on a scene with the truth: time, quality, pictures and charts on one page
    Study(StudyOptions),
    /// Look around a scene in a window
    #[cfg(feature = "viewer")]
    #[command(after_help = super::view::KEYS)]
    View(super::view::ViewerOptions),
    /// Look around a scene in a window: not part of this build
    #[cfg(not(feature = "viewer"))]
    #[command(hide = true, disable_help_flag = true)]
    View {
        /// Whatever follows
        #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "...")]
        rest: Vec<std::ffi::OsString>,
    },
    /// Put the parts of a picture together that --region drew
    ///
    /// Reads PNG files that `render --region` wrote, which say where they lie, and writes the whole picture as PNG, row by
    /// row: no picture is too large. The parts must cover the picture and not overlap.
    Join(JoinOptions),
    /// Print the completions of a shell: bash, elvish, fish, powershell or zsh
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page, or write those of all subcommands into a folder
    Man {
        /// Folder for basrelief.1, basrelief-render.1 and so on
        #[arg(short, long, value_name = "DIR")]
        output: Option<PathBuf>,
    },
}

#[derive(Args)]
pub(crate) struct JoinOptions {
    /// Parts of one picture, in any order
    #[arg(value_name = "PART", required = true)]
    pub(crate) parts: Vec<PathBuf>,
    /// PNG file to write; - is stdout
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
}

#[derive(Args)]
pub(crate) struct RenderOptions {
    #[command(flatten)]
    pub(crate) scene: SceneOptions,
    #[command(flatten)]
    pub(crate) settings: SettingsOptions,
    #[command(flatten)]
    pub(crate) view: ViewOptions,

    #[command(flatten)]
    pub(crate) frames: FramesOptions,

    /// Image to write: .png, .jpg, .tga, .tiff, .bmp (8-bit sRGB) or .exr (linear float); - writes PNG to stdout; of many
    /// frames #### becomes the number [default: basrelief.png, frame_####.png of many frames]
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub(crate) output: Option<PathBuf>,
    /// Write a scene file (TOML) that draws this picture again: the options, all settings and the camera
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
    /// Write an image of the errors: black none, then violet, red, orange, pale yellow for --heatmap-max or more
    #[arg(long, value_name = "FILE")]
    pub(crate) heatmap: Option<PathBuf>,
    /// The error that --heatmap shows in its brightest colour; 1 is the whole range of a channel
    #[arg(long, value_name = "E", default_value = "0.25", value_parser = values::fraction, allow_hyphen_values = true)]
    pub(crate) heatmap_max: f32,
    /// Compare each image with that of the same name in DIR; exit with code 1 if one differs. DIR/failed then shows what was
    /// expected, what was given and the difference; with `BASRELIEF_ACCEPT=1` in the environment what is given becomes golden
    #[arg(long, value_name = "DIR", conflicts_with_all = ["min_psnr", "heatmap"], help_heading = "Golden images")]
    pub(crate) golden: Option<PathBuf>,
    /// A pixel differs if its red, green, blue or opacity is off by more than E of its range, 0 to 1
    #[arg(long, value_name = "E", default_value = "0", value_parser = values::unit, requires = "golden", help_heading = "Golden images")]
    pub(crate) tolerance: f32,
    /// Share of pixels that may differ, 0 to 1
    #[arg(long, value_name = "S", default_value = "0", value_parser = values::unit, requires = "golden", help_heading = "Golden images")]
    pub(crate) share: f32,
    /// Print one JSON object, or one a line for each golden image; the ratio of equal images, which is infinite, is null
    #[arg(long)]
    pub(crate) json: bool,
}
