//! `basrelief study`: every filter on a scene against the truth, on one page.

mod chart;
mod crops;
mod csv;
mod gather;
mod machine;
mod page;
mod trials;

use super::progress::Progress;
use super::render::thread_pool;
use super::scene::SceneOptions;
use super::settings::SettingsOptions;
use super::{Refusal, output, scene_file, values};
use basrelief::{Lighting, Scene, Settings};
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub(crate) struct StudyOptions {
    #[command(flatten)]
    scene: SceneOptions,

    /// Folder for index.html and study.csv; made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "study", help_heading = "Study")]
    output: PathBuf,
    /// Width and height of the pictures in pixels [default: 640x360, or what the scene file says]
    #[arg(short, long, value_name = "WxH", value_parser = values::size, allow_hyphen_values = true, help_heading = "Study")]
    size: Option<[u32; 2]>,
    /// Rays a pixel of the truth
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(1..=65536), help_heading = "Study")]
    truth_samples: u32,
    /// Frames that each filter draws after one to warm up; the middle time counts
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000), help_heading = "Study")]
    repeat: u32,
    /// Threads to draw with; 0: as many processors as this process may use
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1024), help_heading = "Study")]
    threads: u32,
    /// Say nothing but warnings and errors
    #[arg(short, long, help_heading = "Study")]
    quiet: bool,
}

/// Studies the scene that the options name.
pub(super) fn run(mut options: StudyOptions) -> Result<ExitCode, Refusal> {
    let mut settings = SettingsOptions::default();
    scene_file::read_into(&mut options.scene, &mut settings)?;
    let settings = settings_of(&options, &settings)?;
    let progress = Progress::new(options.quiet);
    let scene = load(&options, &settings, &progress)?;
    let folder = &options.output;
    std::fs::create_dir_all(folder).map_err(|e| format!("{}: cannot be made: {e}", folder.display()))?;
    let [page_path, csv_path] = ["index.html", "study.csv"].map(|name| folder.join(name));
    [&page_path, &csv_path].into_iter().try_for_each(|path| output::check(path))?;
    let plan = gather::Plan { truth_samples: options.truth_samples, repeat: options.repeat };
    let study = thread_pool(options.threads)?.install(|| gather::run(scene, &settings, plan, &progress))?;
    output::write(&csv_path, csv::table(&study).as_bytes())?;
    output::write(&page_path, page::html(&study)?.as_bytes())?;
    progress.say(&format!("wrote {} and {}", page_path.display(), csv_path.display()));
    Ok(ExitCode::SUCCESS)
}

/// The settings that all trials share.
fn settings_of(options: &StudyOptions, of_file: &SettingsOptions) -> Result<Settings, Refusal> {
    let mut settings = of_file.settings(options.scene.has_lights())?;
    if let Some([width, height]) = options.size.or((!of_file.has_size()).then_some([640, 360])) {
        (settings.width, settings.height) = (width, height);
    }
    if settings.region.is_some() {
        return Err("--region: a study is of whole pictures".into());
    }
    Ok(settings)
}

fn load(options: &StudyOptions, settings: &Settings, progress: &Progress) -> Result<Scene, Refusal> {
    let loaded = options.scene.load(settings, settings.lighting == Lighting::Lit, progress)?;
    loaded.choices.iter().for_each(|choice| progress.say(choice));
    loaded.warnings.iter().for_each(|warning| progress.warn(warning));
    Ok(loaded.scene)
}
