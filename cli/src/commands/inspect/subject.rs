//! What is inspected: a pixel of a scene, by options or as a figure of the paper.

use crate::options::inspect::InspectOptions;
use crate::pictures::inspection::palette::Layers;
use crate::progress::Progress;
use crate::refusal::Refusal;
use basrelief::inspect::{Figure, Inspection};
use basrelief::{Lighting, Scene, Settings};

/// A scene, settings and a pixel.
pub(crate) struct Subject {
    pub(crate) scene: Scene,
    pub(crate) settings: Settings,
    pub(crate) pixel: [u32; 2],
    pub(crate) layers: Layers,
    pub(crate) title: Option<&'static str>,
}

impl Subject {
    pub(crate) fn of(options: &InspectOptions) -> Result<Self, Refusal> {
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
        let mut settings = options.settings.settings(options.scene.look())?;
        settings.filter = options.settings.filter.inspected(settings.filter);
        if settings.region.is_some() {
            return Err("--region: a pixel is named by its place in the whole picture".into());
        }
        let progress = Progress::new(false);
        let loaded =
            options.scene.load(&settings, settings.lighting == Lighting::Lit, &progress)?;
        loaded.warnings.iter().for_each(|warning| progress.warn(warning));
        Ok(Self { scene: loaded.scene, settings, pixel, layers: Layers::default(), title: None })
    }

    /// What the picture is headed with.
    pub(crate) fn names(&self, seen: &Inspection) -> String {
        let [x, y] = self.pixel;
        let place = format!("pixel {x},{y} of {}x{}", self.settings.width, self.settings.height);
        match self.title {
            Some(title) => format!("{title} ({place})"),
            None => format!("{place}: {}", self.surface(seen)),
        }
    }

    pub(crate) fn surface(&self, seen: &Inspection) -> String {
        let or_number = |name: &str, index: usize| {
            if name.is_empty() { index.to_string() } else { name.to_owned() }
        };
        let mesh = or_number(&self.scene.meshes[seen.mesh].name, seen.mesh);
        let material = or_number(&self.scene.materials[seen.material].name, seen.material);
        format!("mesh {mesh}, triangle {}, material {material}", seen.triangle)
    }
}
