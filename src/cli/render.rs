//! `basrelief [render]`: load, draw, write.

use super::args::RenderOptions;
use super::progress::Progress;
use super::settings::refusal;
use super::stats::Report;
use super::{Refusal, output};
use basrelief::{Frame, Lighting, Renderer, Settings, Stats};
use std::process::ExitCode;
use std::time::Instant;

/// Draws the scene that the options name.
pub(super) fn run(options: &RenderOptions) -> Result<ExitCode, Refusal> {
    // All that can be refused without work is refused before the work.
    let settings = options.settings.settings(options.scene.has_lights())?;
    let format = output::image_format(&options.output)?;
    check_stats(options)?;
    let pool = thread_pool(options.threads)?;
    let progress = Progress::new(options.quiet);
    let (frame, report) = pool.install(|| draw(options, &settings, &progress))?;
    progress.stage("writing");
    let bytes = frame.encode(format).map_err(|e| refusal(&e))?;
    output::write(&options.output, &bytes)?;
    if let Some(path) = &options.stats {
        output::write(path, &report.json()?)?;
    }
    progress.say(&report.line());
    if !output::is_stdout(&options.output) {
        progress.say(&format!("wrote {}", options.output.display()));
    }
    Ok(ExitCode::SUCCESS)
}

fn check_stats(options: &RenderOptions) -> Result<(), Refusal> {
    let Some(stats) = &options.stats else { return Ok(()) };
    if *stats == options.output {
        return Err(format!("--stats and --output are both {}", stats.display()));
    }
    output::check(stats)
}

/// A pool of `num` threads, or of as many as this process may use.
fn thread_pool(num: u32) -> Result<rayon::ThreadPool, Refusal> {
    let num = match num {
        // Heeds the affinity mask and the quota of a control group, rounded down.
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        _ => num as usize,
    };
    rayon::ThreadPoolBuilder::new().num_threads(num).build().map_err(|e| format!("--threads {num}: {e}"))
}

fn draw(options: &RenderOptions, settings: &Settings, progress: &Progress) -> Result<(Frame, Report), Refusal> {
    let start = Instant::now();
    let mut renderer = prepare(options, settings, progress)?;
    let load_ms = milliseconds(start);
    let (frame, frames) = draw_frames(&mut renderer, options.repeat, progress);
    Ok((frame, Report::new(frames, load_ms, rayon::current_num_threads(), settings)))
}

fn prepare(options: &RenderOptions, settings: &Settings, progress: &Progress) -> Result<Renderer, Refusal> {
    progress.stage("loading");
    let loaded = options.scene.load(settings.lighting == Lighting::Lit)?;
    loaded.choices.iter().for_each(|choice| progress.say(choice));
    loaded.warnings.iter().for_each(|warning| progress.warn(warning));
    progress.stage("building tables");
    Renderer::new(loaded.scene, settings.clone()).map_err(|e| refusal(&e))
}

/// Draws once, or once to warm up and then `repeat` times. Gives the last frame and what each took.
fn draw_frames(renderer: &mut Renderer, repeat: Option<u32>, progress: &Progress) -> (Frame, Vec<(f64, Stats)>) {
    progress.stage("drawing");
    let (mut frame, mut frames) = draw_timed(renderer, Vec::new());
    if let Some(num) = repeat {
        frames.clear();
        for i in 1..=num {
            progress.stage(format!("drawing frame {i} of {num}"));
            (frame, frames) = draw_timed(renderer, frames);
        }
    }
    (frame, frames)
}

fn draw_timed(renderer: &mut Renderer, mut frames: Vec<(f64, Stats)>) -> (Frame, Vec<(f64, Stats)>) {
    let start = Instant::now();
    let (frame, stats) = renderer.render_timed(&|| milliseconds(start));
    frames.push((milliseconds(start), stats));
    (frame, frames)
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}
