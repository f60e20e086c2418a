//! `basrelief [render]`: load once, then draw and write picture after picture.

use crate::commands::measure;
use crate::options::frames::Sequence;
use crate::options::layers::LayerFile;
use crate::options::render::RenderOptions;
use crate::options::scene_file;
use crate::options::threads::thread_pool;
use crate::output;
use crate::pictures::layers;
use crate::pictures::picture::{self, Way};
use crate::progress::Progress;
use crate::refusal::Refusal;
use crate::stats::Report;
use crate::timing::{Took, milliseconds};
use basrelief::frame::Format;
use basrelief::{Filter, Lighting, Renderer, Settings};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Draws the scene that the options name.
pub(crate) fn run(mut options: RenderOptions) -> Result<ExitCode, Refusal> {
    // All that can be refused without work is refused before the work.
    scene_file::read_into(&mut options.scene, &mut options.settings)?;
    if let Some(view) = options.view.view {
        return measure::run(&options, view);
    }
    let mut settings = options.settings.settings(options.scene.look())?;
    let layers = options.layers.files()?;
    let draws_picture = options.output.is_some() || layers.is_empty();
    if !draws_picture {
        // Layers ask for no filter: none makes tables.
        settings.filter = Filter::Nearest;
    }
    // Without a picture, the first file of layers says whether a frame is there.
    let first = if draws_picture { None } else { layers.first().map(|file| file.path.as_path()) };
    let sequence = options.frames.sequence(options.output.as_deref().or(first))?;
    let way = check(&options, &settings, &sequence, &layers)?;
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
    let job = Job {
        options: &options,
        settings,
        sequence,
        pictures,
        layers,
        draws_picture,
        way,
        progress,
    };
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
    layers: &[LayerFile],
) -> Result<Way, Refusal> {
    let name = sequence.output();
    check_layers(options, sequence, layers)?;
    if sequence.is_numbered() && options.repeat.is_some() {
        return Err("--repeat: measures one picture, not many frames".into());
    }
    if options.json
        && [Some(name), options.stats.as_deref()].into_iter().flatten().any(output::is_stdout)
    {
        return Err("--json: stdout is taken by --output or --stats".into());
    }
    let others = [
        ("--stats", &options.stats),
        ("--save-scene", &options.save_scene),
        ("--layer-names", &options.layers.layer_names),
    ];
    for (option, path) in
        others.into_iter().filter_map(|(option, path)| Some((option, path.as_deref()?)))
    {
        if path == name {
            return Err(format!("{option} and --output are both {}", path.display()).into());
        }
        output::check(path)?;
    }
    if !layers.is_empty() && options.output.is_none() {
        return Ok(Way::Whole(Format::Exr));
    }
    let way = Way::of(settings, output::image_format(name)?, options.repeat.is_some())?;
    if way == Way::Bands && !layers.is_empty() {
        return Err("--layer: a picture this large is drawn in bands, which have no layers; \
                    --region draws a part, and without --output there are layers alone"
            .into());
    }
    Ok(way)
}

/// Whether the files of layers can be written beside all others.
fn check_layers(
    options: &RenderOptions,
    sequence: &Sequence,
    layers: &[LayerFile],
) -> Result<(), Refusal> {
    if options.output.is_none() && !layers.is_empty() {
        let measured = [
            ("--repeat", options.repeat.is_some()),
            ("--stats", options.stats.is_some()),
            ("--json", options.json),
        ];
        if let Some((option, _)) = measured.iter().find(|(_, is_given)| *is_given) {
            return Err(format!("{option}: needs a picture, from --output").into());
        }
    }
    let others =
        [&options.output, &options.stats, &options.save_scene, &options.layers.layer_names];
    for file in layers {
        let path = &file.path;
        if others.into_iter().any(|other| other.as_ref() == Some(path)) {
            return Err(format!("--layer: {} is another file already", path.display()).into());
        }
        let is_pattern = path.file_name().is_some_and(|name| name.to_string_lossy().contains('#'));
        if sequence.is_numbered() && !is_pattern {
            return Err(format!(
                "--layer {}: many frames need #### for the frame's number",
                path.display()
            )
            .into());
        }
        output::check(path)?;
    }
    Ok(())
}

struct Job<'a> {
    options: &'a RenderOptions,
    settings: Settings,
    sequence: Sequence,
    /// Numbers and files of what is to be drawn.
    pictures: Vec<(u32, PathBuf)>,
    layers: Vec<LayerFile>,
    /// Or layers alone.
    draws_picture: bool,
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
        let has_normals = settings.lighting == Lighting::Lit
            || self.layers.iter().any(LayerFile::asks_for_normals);
        let loaded = options.scene.load(settings, has_normals, progress)?;
        loaded.choices.iter().for_each(|choice| progress.say(choice));
        loaded.warnings.iter().for_each(|warning| progress.warn(warning));
        let camera = loaded.scene.camera;
        let cameras = self.sequence.cameras(camera)?;
        for (number, _) in self.pictures.iter().filter(|_| self.sequence.is_numbered()) {
            cameras
                .camera(*number)
                .validate()
                .map_err(|e| format!("frame {number}: {}", Refusal::from(e)))?;
        }
        progress.stage("building tables");
        let renderer = Renderer::new(loaded.scene, picture::first_settings(settings, self.way))?;
        if let Some(path) = &options.layers.layer_names {
            output::write(path, &layers::names(renderer.scene())?)?;
        }
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
        let cameras = self.sequence.cameras(renderer.scene().camera)?;
        let mut all = Vec::new();
        for (i, (number, path)) in self.pictures.iter().enumerate() {
            renderer.set_camera(cameras.camera(*number))?;
            self.progress.stage(match self.sequence.is_numbered() {
                true => format!("drawing frame {number} ({} of {})", i + 1, self.pictures.len()),
                false => "drawing".into(),
            });
            self.draw_layers(renderer, *number)?;
            if !self.draws_picture {
                continue;
            }
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

    /// Before the picture, whose file then says that all of a frame is there.
    fn draw_layers(&self, renderer: &mut Renderer, number: u32) -> Result<(), Refusal> {
        if self.layers.is_empty() {
            return Ok(());
        }
        let path_of = |pattern: &Path| self.sequence.file_like(pattern, number);
        layers::draw(renderer, &self.layers, &path_of)?;
        for file in &self.layers {
            let path = path_of(&file.path);
            self.progress.say(&format!("wrote layers to {}", path.display()));
        }
        Ok(())
    }
}
