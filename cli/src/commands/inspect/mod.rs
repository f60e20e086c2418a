//! `basrelief inspect`: what one pixel sees, as numbers and as a picture.

mod numbers;
mod subject;

use crate::options::inspect::InspectOptions;
use crate::options::scene_file;
use crate::output;
use crate::pictures::inspection::page::draw;
use crate::refusal::Refusal;
use basrelief::{Error, inspect};
use std::process::ExitCode;
use subject::Subject;

/// Inspects the pixel that the options name.
pub(crate) fn run(mut options: InspectOptions) -> Result<ExitCode, Refusal> {
    scene_file::read_into(&mut options.scene, &mut options.settings)?;
    let format = options.output.as_deref().map(output::image_format).transpose()?;
    if options.json && options.output.as_deref().is_some_and(output::is_stdout) {
        return Err("--json and --output - both write to stdout".into());
    }
    let subject = Subject::of(&options)?;
    let seen =
        inspect::pixel(&subject.scene, &subject.settings, subject.pixel).map_err(pixel_refusal)?;
    if let (Some(path), Some(format)) = (&options.output, format) {
        let picture = draw(&seen, &subject.names(&seen), subject.layers).into_frame();
        output::write(path, &picture.encode(format)?)?;
        if output::is_stdout(path) {
            return Ok(ExitCode::SUCCESS);
        }
    }
    let text =
        if options.json { numbers::json(&seen, &subject)? } else { numbers::text(&seen, &subject) };
    output::print(text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

fn pixel_refusal(error: Error) -> Refusal {
    match error {
        Error::Scene { part, reason } if part.starts_with("pixel ") => {
            format!("--{part}: {reason}").into()
        }
        _ => error.into(),
    }
}
