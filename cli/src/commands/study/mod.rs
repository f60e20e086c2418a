//! `basrelief study`: every filter on a scene against the truth, on one page.

mod chart;
mod crops;
mod csv;
mod gather;
mod page;
mod trials;

use crate::options::scene_file;
use crate::options::settings::SettingsOptions;
use crate::options::study::StudyOptions;
use crate::options::threads::thread_pool;
use crate::output;
use crate::progress::Progress;
use crate::refusal::Refusal;
use basrelief::{Lighting, Scene, Settings};
use std::process::ExitCode;

/// Studies the scene that the options name.
pub(crate) fn run(mut options: StudyOptions) -> Result<ExitCode, Refusal> {
    let mut settings = SettingsOptions::default();
    scene_file::read_into(&mut options.scene, &mut settings)?;
    let trials = trials::all(&settings.filter)?;
    let settings = settings_of(&options, &settings)?;
    let progress = Progress::new(options.quiet);
    let scene = load(&options, &settings, &progress)?;
    let folder = &options.output;
    std::fs::create_dir_all(folder)
        .map_err(|e| Refusal::file(folder, format_args!("cannot be made: {e}")))?;
    let [page_path, csv_path] = ["index.html", "study.csv"].map(|name| folder.join(name));
    [&page_path, &csv_path].into_iter().try_for_each(|path| output::check(path))?;
    let plan =
        gather::Plan { trials, truth_samples: options.truth_samples, repeat: options.repeat };
    let study =
        thread_pool(options.threads)?.install(|| gather::run(scene, &settings, plan, &progress))?;
    output::write(&csv_path, csv::table(&study).as_bytes())?;
    output::write(&page_path, page::html(&study)?.as_bytes())?;
    progress.say(&format!("wrote {} and {}", page_path.display(), csv_path.display()));
    Ok(ExitCode::SUCCESS)
}

/// The settings that all trials share.
fn settings_of(options: &StudyOptions, of_file: &SettingsOptions) -> Result<Settings, Refusal> {
    let mut settings = of_file.settings(options.scene.look_of_study())?;
    if let Some([width, height]) = options.size.or((!of_file.has_size()).then_some([640, 360])) {
        (settings.width, settings.height) = (width, height);
    }
    if settings.region.is_some() {
        return Err("--region: a study is of whole pictures".into());
    }
    Ok(settings)
}

fn load(
    options: &StudyOptions,
    settings: &Settings,
    progress: &Progress,
) -> Result<Scene, Refusal> {
    let loaded = options.scene.load(settings, settings.lighting == Lighting::Lit, progress)?;
    loaded.choices.iter().for_each(|choice| progress.say(choice));
    loaded.warnings.iter().for_each(|warning| progress.warn(warning));
    Ok(loaded.scene)
}
