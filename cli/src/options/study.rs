//! The command line of `basrelief study`.

use crate::options::scene::SceneOptions;
use crate::options::values;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct StudyOptions {
    #[command(flatten)]
    pub(crate) scene: SceneOptions,

    /// Folder for index.html and study.csv; made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "study", help_heading = "Study")]
    pub(crate) output: PathBuf,
    /// Width and height of the pictures in pixels [default: 640x360, or what the scene file says]
    #[arg(short, long, value_name = "WxH", value_parser = values::size, allow_hyphen_values = true, help_heading = "Study")]
    pub(crate) size: Option<[u32; 2]>,
    /// Rays a pixel of the truth
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(1..=65536), help_heading = "Study")]
    pub(crate) truth_samples: u32,
    /// Frames that each filter draws after one to warm up; the middle time counts
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000), help_heading = "Study")]
    pub(crate) repeat: u32,
    /// Threads to draw with; 0: as many processors as this process may use
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1024), help_heading = "Study")]
    pub(crate) threads: u32,
    /// Say nothing but warnings and errors
    #[arg(short, long, help_heading = "Study")]
    pub(crate) quiet: bool,
}
