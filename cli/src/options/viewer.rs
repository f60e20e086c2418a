//! The command line of `basrelief view`.

use crate::options::choices::{FILTERS, one_of};
use crate::options::scene::SceneOptions;
use crate::options::settings::SettingsOptions;
use crate::options::values;
use basrelief::Filter;
use clap::Args;

/// Keys and mouse, as `--help` and the window show them.
pub(crate) const KEYS: &str = "\
drag, arrows        go around          wheel, + -   nearer, away
right drag, W A S D  move               R            back to the start
1 to 8              filter             Shift 1 to 8 filter of the right half
Tab                 split on, off      L            light on, off
click, I            inspect the pixel  Esc          close; once more: quit
H                   this help          drop a file  OBJ or glTF: load it; image: a map of it";

#[derive(Args)]
pub(crate) struct ViewerOptions {
    #[command(flatten)]
    pub(crate) scene: SceneOptions,
    #[command(flatten)]
    pub(crate) settings: SettingsOptions,

    /// Show this filter beside that of --filter in a split window
    #[arg(long, value_name = "FILTER", value_parser = one_of(FILTERS), help_heading = "Window")]
    pub(crate) split: Option<Filter>,
    /// Go around by itself for SECONDS, say how many frames a second were drawn, and quit
    #[arg(long, value_name = "SECONDS", value_parser = values::above_zero, allow_hyphen_values = true, help_heading = "Window")]
    pub(crate) spin: Option<f32>,
    /// Draw all frames in full size, while moving too
    #[arg(long, help_heading = "Window")]
    pub(crate) full_size: bool,
    /// Threads to draw with; 0: as many processors as this process may use
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1024), help_heading = "Window")]
    pub(crate) threads: u32,
}
