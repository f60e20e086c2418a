//! `basrelief render --view`: a whole frame of numbers as colours.

use crate::options::render::RenderOptions;
use crate::options::settings::Look;
use crate::options::threads::thread_pool;
use crate::output;
use crate::pictures::measured::draw;
use crate::progress::Progress;
use crate::refusal::Refusal;
use basrelief::inspect::{View, measure};
use std::process::ExitCode;

/// Draws the numbers of a frame.
pub(crate) fn run(options: &RenderOptions, view: View) -> Result<ExitCode, Refusal> {
    let mut settings = options.settings.settings(Look::default())?;
    if view == View::Visible {
        settings.filter = options.settings.filter.inspected(settings.filter);
    }
    let sequence = options.frames.sequence(options.output.as_deref())?;
    let is_more = options.stats.is_some()
        || options.repeat.is_some()
        || options.json
        || options.save_scene.is_some();
    if is_more || sequence.is_numbered() || settings.region.is_some() {
        let words = "--stats, --repeat, --json, --save-scene, --region and many frames are of pictures, not of --view";
        return Err(words.into());
    }
    let format = output::image_format(sequence.output())?;
    let measured = thread_pool(options.threads)?.install(|| {
        let progress = Progress::new(options.quiet);
        let loaded =
            options.scene.load(&settings, view == View::Normal || view.is_of_light(), &progress)?;
        loaded.warnings.iter().for_each(|warning| progress.warn(warning));
        progress.stage("measuring");
        measure(&loaded.scene, &settings, view).map_err(Refusal::from)
    })?;
    let frame = draw(&measured, view, options.view.legend).into_frame();
    output::write(sequence.output(), &frame.encode(format)?)?;
    Ok(ExitCode::SUCCESS)
}
