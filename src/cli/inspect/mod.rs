//! `basrelief inspect`: what one pixel sees, as numbers and as a picture.

mod cut;
mod numbers;
mod options;
mod picture;
mod texels;

pub(super) use options::InspectOptions;
#[cfg(feature = "viewer")]
pub(super) use picture::draw_small;
use picture::{Layers, draw};

use super::progress::Progress;
use super::settings::refusal;
use super::{Refusal, output, scene_file};
use basrelief::inspect::{self, Figure, Inspection};
use basrelief::{Scene, Settings};
use std::process::ExitCode;

/// Inspects the pixel that the options name.
pub(super) fn run(mut options: InspectOptions) -> Result<ExitCode, Refusal> {
    scene_file::read_into(&mut options.scene, &mut options.settings)?;
    let format = options.output.as_deref().map(output::image_format).transpose()?;
    if options.json && options.output.as_deref().is_some_and(output::is_stdout) {
        return Err("--json and --output - both write to stdout".into());
    }
    let subject = Subject::of(&options)?;
    let seen = inspect::pixel(&subject.scene, &subject.settings, subject.pixel).map_err(|e| pixel_refusal(&e))?;
    if let (Some(path), Some(format)) = (&options.output, format) {
        let picture = draw(&seen, &subject.names(&seen), subject.layers).into_frame();
        output::write(path, &picture.encode(format).map_err(|e| refusal(&e))?)?;
        if output::is_stdout(path) {
            return Ok(ExitCode::SUCCESS);
        }
    }
    let text = if options.json { numbers::json(&seen, &subject)? } else { numbers::text(&seen, &subject) };
    output::print(text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

/// A scene, settings and a pixel.
pub(super) struct Subject {
    scene: Scene,
    settings: Settings,
    pixel: [u32; 2],
    layers: Layers,
    title: Option<&'static str>,
}

impl Subject {
    fn of(options: &InspectOptions) -> Result<Self, Refusal> {
        if let Some(number) = options.figure {
            let figure = Figure::ALL[number as usize - 1];
            return Ok(Self {
                scene: figure.scene(),
                settings: figure.settings(),
                pixel: figure.pixel(),
                layers: Layers::of_figure(number),
                title: Some(figure.title),
            });
        }
        let pixel = options.pixel.ok_or("the pixel is missing: say --pixel X,Y, or --figure N")?;
        let settings = options.settings.settings(false)?;
        if settings.region.is_some() {
            return Err("--region: a pixel is named by its place in the whole picture".into());
        }
        let progress = Progress::new(false);
        let loaded = options.scene.load(&settings, false, &progress)?;
        loaded.warnings.iter().for_each(|warning| progress.warn(warning));
        Ok(Self { scene: loaded.scene, settings, pixel, layers: Layers::default(), title: None })
    }

    /// What the picture is headed with.
    fn names(&self, seen: &Inspection) -> String {
        let [x, y] = self.pixel;
        let place = format!("pixel {x},{y} of {}x{}", self.settings.width, self.settings.height);
        match self.title {
            Some(title) => format!("{title} ({place})"),
            None => format!("{place}: {}", self.surface(seen)),
        }
    }

    fn surface(&self, seen: &Inspection) -> String {
        let or_number = |name: &str, index: usize| if name.is_empty() { index.to_string() } else { name.to_owned() };
        let mesh = or_number(&self.scene.meshes[seen.mesh].name, seen.mesh);
        let material = or_number(&self.scene.materials[seen.material].name, seen.material);
        format!("mesh {mesh}, triangle {}, material {material}", seen.triangle)
    }
}

fn pixel_refusal(error: &basrelief::Error) -> Refusal {
    match error {
        basrelief::Error::Scene { part, reason } if part.starts_with("pixel ") => format!("--{part}: {reason}"),
        _ => refusal(error),
    }
}
