//! `basrelief [render]`: load once, then draw and write picture after picture.

use crate::commands::measure;
use crate::options::frames::Sequence;
use crate::options::render::RenderOptions;
use crate::options::scene_file;
use crate::options::threads::thread_pool;
use crate::output;
use crate::pictures::picture::{self, Way};
use crate::progress::Progress;
use crate::refusal::Refusal;
use crate::stats::Report;
use crate::timing::{Took, milliseconds};
use basrelief::{Lighting, Renderer, Settings};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// Draws the scene that the options name.
pub(crate) fn run(mut options: RenderOptions) -> Result<ExitCode, Refusal> {
    // All that can be refused without work is refused before the work.
    scene_file::read_into(&mut options.scene, &mut options.settings)?;
    if let Some(view) = options.view.view {
        return measure::run(&options, view);
    }
    let settings = options.settings.settings(options.scene.has_lights())?;
    let sequence = options.frames.sequence(options.output.as_deref())?;
    let way = check(&options, &settings, &sequence)?;
    let pool = thread_pool(options.threads)?;
    let progress = Progress::new(options.quiet);
    sequence.remark.iter().for_each(|remark| progress.say(remark));
    let mut pictures: Vec<(u32, PathBuf)> = sequence.pictures().collect();
    let num_asked = pictures.len();
    if options.frames.skip_existing {
        pictures.retain(|(_, path)| !path.is_file());
    }
    let num_skipped = num_asked - pictures.len();
    if num_skipped > 0 {
        progress.say(&format!("{num_skipped} of {num_asked} pictures are there already"));
    }
    let job = Job { options: &options, settings, sequence, pictures, way, progress };
    if !job.pictures.is_empty() || options.save_scene.is_some() {
        pool.install(|| job.run())?;
    }
    Ok(ExitCode::SUCCESS)
}

/// What can be written, and how.
fn check(
    options: &RenderOptions,
    settings: &Settings,
    sequence: &Sequence,
) -> Result<Way, Refusal> {
    let name = sequence.output();
    if sequence.is_numbered() && options.repeat.is_some() {
        return Err("--repeat: measures one picture, not many frames".into());
    }
    if options.json
        && [Some(name), options.stats.as_deref()].into_iter().flatten().any(output::is_stdout)
    {
        return Err("--json: stdout is taken by --output or --stats".into());
    }
    let others = [("--stats", &options.stats), ("--save-scene", &options.save_scene)];
    for (option, path) in
        others.into_iter().filter_map(|(option, path)| Some((option, path.as_deref()?)))
    {
        if path == name {
            return Err(format!("{option} and --output are both {}", path.display()).into());
        }
        output::check(path)?;
    }
    Way::of(settings, output::image_format(name)?, options.repeat.is_some())
}

struct Job<'a> {
    options: &'a RenderOptions,
    settings: Settings,
    sequence: Sequence,
    /// Numbers and files of what is to be drawn.
    pictures: Vec<(u32, PathBuf)>,
    way: Way,
    progress: Progress,
}

impl Job<'_> {
    fn run(&self) -> Result<(), Refusal> {
        let start = Instant::now();
        let mut renderer = self.prepare()?;
        let load_ms = milliseconds(start);
        let report =
            |took| Report::new(took, load_ms, rayon::current_num_threads(), &self.settings);
        let took = self.draw_all(&mut renderer, &report)?;
        if took.is_empty() {
            return Ok(());
        }
        let report = report(took);
        if let Some(path) = &self.options.stats {
            output::write(path, &report.json()?)?;
        }
        self.progress.say(&report.line());
        match &self.pictures[..] {
            [(_, path)] if output::is_stdout(path) => {}
            [(_, path)] => self.progress.say(&format!("wrote {}", path.display())),
            [(_, first), .., (_, last)] => {
                let num = self.pictures.len();
                self.progress.say(&format!(
                    "wrote {num} pictures, {} to {}",
                    first.display(),
                    last.display()
                ));
            }
            [] => {}
        }
        Ok(())
    }

    /// The renderer of the scene, with its tables; the scene file is written if one is asked for.
    fn prepare(&self) -> Result<Renderer, Refusal> {
        let Self { options, settings, progress, .. } = self;
        let loaded = options.scene.load(settings, settings.lighting == Lighting::Lit, progress)?;
        loaded.choices.iter().for_each(|choice| progress.say(choice));
        loaded.warnings.iter().for_each(|warning| progress.warn(warning));
        let camera = loaded.scene.camera;
        let cameras = self.sequence.cameras(camera);
        for (number, _) in self.pictures.iter().filter(|_| self.sequence.is_numbered()) {
            cameras
                .camera(*number)
                .validate()
                .map_err(|e| format!("frame {number}: {}", Refusal::from(e)))?;
        }
        progress.stage("building tables");
        let renderer = Renderer::new(loaded.scene, picture::first_settings(settings, self.way))?;
        if let Some(path) = &options.save_scene {
            output::write(
                path,
                scene_file::text(&options.scene, settings, &camera, path)?.as_bytes(),
            )?;
        }
        Ok(renderer)
    }

    fn draw_all(
        &self,
        renderer: &mut Renderer,
        report: &dyn Fn(Vec<Took>) -> Report,
    ) -> Result<Vec<Took>, Refusal> {
        let cameras = self.sequence.cameras(renderer.scene().camera);
        let mut all = Vec::new();
        for (i, (number, path)) in self.pictures.iter().enumerate() {
            renderer.set_camera(cameras.camera(*number))?;
            self.progress.stage(match self.sequence.is_numbered() {
                true => format!("drawing frame {number} ({} of {})", i + 1, self.pictures.len()),
                false => "drawing".into(),
            });
            let took = picture::draw(
                renderer,
                &self.settings,
                path,
                (self.way, self.options.repeat),
                &self.progress,
            )?;
            if self.options.json {
                let frame = self.sequence.is_numbered().then_some(*number);
                output::print(&report(took.clone()).of_picture(path, frame).json()?)?;
            }
            all.extend(took);
        }
        Ok(all)
    }
}
