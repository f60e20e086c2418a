//! `basrelief view`: a window to look around in.

use crate::options::scene_file;
use crate::options::threads::num_threads;
use crate::options::viewer::ViewerOptions;
use crate::output;
use crate::progress::Progress;
use crate::refusal::Refusal;
use crate::view::state::Viewer;
use crate::view::window;
use std::process::ExitCode;
use std::time::Duration;

/// Opens a window on the scene that the options name.
pub(crate) fn run(mut options: ViewerOptions) -> Result<ExitCode, Refusal> {
    scene_file::read_into(&mut options.scene, &mut options.settings)?;
    let settings = options.settings.settings(options.scene.look())?;
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
    let mut viewer = Viewer::new(
        loaded.scene,
        settings,
        options.settings.filter,
        options.scene.path(),
        load_options,
    );
    viewer.split_with(options.split);
    viewer.keep_full_size(options.full_size);
    let threads = num_threads(options.threads);
    let spin = options.spin.map(Duration::from_secs_f32);
    if let Some(report) = window::run(viewer, threads, spin)? {
        output::print(format!("{report}\n").as_bytes())?;
    }
    Ok(ExitCode::SUCCESS)
}
