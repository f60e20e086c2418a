//! `basrelief view`: a window to look around in.

mod orbit;
mod overlay;
mod pace;
mod state;
mod window;
mod worker;

use super::choices::{FILTERS, one_of};
use super::progress::Progress;
use super::scene::SceneOptions;
use super::settings::SettingsOptions;
use super::{Refusal, output, scene_file, values};
use basrelief::Filter;
use clap::Args;
use state::Viewer;
use std::process::ExitCode;
use std::time::Duration;

/// Keys and mouse, as `--help` and the window show them.
pub(crate) const KEYS: &str = "\
drag, arrows        go around          wheel, + -   nearer, away
right drag, W A S D  move               R            back to the start
1 to 8              filter             Shift 1 to 8 filter of the right half
Tab                 split on, off      L            light on, off
click, I            inspect the pixel  Esc          close; once more: quit
H                   this help          drop a file  OBJ: load it; image: a map of it";

#[derive(Args)]
pub(crate) struct ViewerOptions {
    #[command(flatten)]
    scene: SceneOptions,
    #[command(flatten)]
    settings: SettingsOptions,

    /// Show this filter beside that of --filter in a split window
    #[arg(long, value_name = "FILTER", value_parser = one_of(FILTERS), help_heading = "Window")]
    split: Option<Filter>,
    /// Go around by itself for SECONDS, say how many frames a second were drawn, and quit
    #[arg(long, value_name = "SECONDS", value_parser = values::above_zero, allow_hyphen_values = true, help_heading = "Window")]
    spin: Option<f32>,
    /// Draw all frames in full size, while moving too
    #[arg(long, help_heading = "Window")]
    full_size: bool,
    /// Threads to draw with; 0: as many processors as this process may use
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1024), help_heading = "Window")]
    threads: u32,
}

/// Opens a window on the scene that the options name.
pub(super) fn run(mut options: ViewerOptions) -> Result<ExitCode, Refusal> {
    scene_file::read_into(&mut options.scene, &mut options.settings)?;
    let settings = options.settings.settings(options.scene.has_lights())?;
    if settings.region.is_some() {
        return Err("--region: a window shows the whole picture".into());
    }
    let progress = Progress::new(false);
    // Light can be switched on: normals are kept.
    let loaded = options.scene.load(&settings, true, &progress)?;
    loaded.choices.iter().for_each(|choice| progress.say(choice));
    loaded.warnings.iter().for_each(|warning| progress.warn(warning));
    drop(progress);
    let load_options = options.scene.load_options(&settings, true);
    let mut viewer = Viewer::new(loaded.scene, settings, options.scene.path(), load_options);
    viewer.split_with(options.split);
    viewer.keep_full_size(options.full_size);
    let threads = super::render::num_threads(options.threads);
    let spin = options.spin.map(Duration::from_secs_f32);
    if let Some(report) = window::run(viewer, threads, spin)? {
        output::print(format!("{report}\n").as_bytes())?;
    }
    Ok(ExitCode::SUCCESS)
}
