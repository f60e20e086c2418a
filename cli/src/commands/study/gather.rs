//! Draws and measures the trials.

use crate::commands::study::crops::{self, Crop};
use crate::commands::study::trials::Trial;
use crate::machine::Machine;
use crate::progress::Progress;
use crate::refusal::Refusal;
use crate::timing::{draw_repeated, middle, milliseconds};
use basrelief::frame::Format;
use basrelief::metrics::{PIXELS_PER_DEGREE, Picture, compare, errors_as_colors, flip, heat_map};
use basrelief::{Filter, Frame, Rays, Renderer, Scene, Settings};
use std::time::Instant;

/// The error that the heat maps show in their brightest colour.
pub(crate) const HEAT_SCALE: f32 = 0.25;

/// The same of FLIP errors.
pub(crate) const FLIP_SCALE: f32 = 0.5;

/// What is done.
pub(crate) struct Plan {
    pub(crate) trials: Vec<Trial>,
    pub(crate) truth_samples: u32,
    pub(crate) repeat: u32,
}

/// What was found.
pub(crate) struct Study {
    pub(crate) settings: Settings,
    pub(crate) plan: Plan,
    pub(crate) machine: Machine,
    pub(crate) num_triangles: usize,
    pub(crate) truth_ms: f64,
    pub(crate) tables_ms: f64,
    pub(crate) outcomes: Vec<Outcome>,
    pub(crate) truth_png: Vec<u8>,
    pub(crate) crops: Vec<Crop>,
}

/// A trial's figures and pictures.
pub(crate) struct Outcome {
    pub(crate) trial: Trial,
    /// Middle time of a frame in milliseconds.
    pub(crate) ms: f64,
    /// In decibels; infinite where the pictures are equal.
    pub(crate) psnr: f64,
    pub(crate) ssim: f64,
    /// 0 to 1, less is better.
    pub(crate) flip: f64,
    pub(crate) png: Vec<u8>,
    pub(crate) error_png: Vec<u8>,
    pub(crate) flip_png: Vec<u8>,
}

/// Draws and measures everything.
pub(crate) fn run(
    scene: Scene,
    settings: &Settings,
    plan: Plan,
    progress: &Progress,
) -> Result<Study, Refusal> {
    let num_triangles = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    progress.stage(format!("drawing the truth, {} rays a pixel", plan.truth_samples));
    let start = Instant::now();
    let truth = Filter::Truth(Rays { samples: plan.truth_samples });
    let with = |filter| Settings { filter, ..settings.clone() };
    let mut renderer = Renderer::new(scene, with(truth))?;
    let truth = over_black(renderer.render());
    let truth_ms = milliseconds(start);
    let truth_picture = Picture::from(&truth);
    let (mut outcomes, mut frames, mut tables_ms) = (Vec::new(), Vec::new(), 0.0_f64);
    for (i, trial) in plan.trials.iter().enumerate() {
        progress.stage(format!("{} ({} of {})", trial.name, i + 1, plan.trials.len()));
        let start = Instant::now();
        renderer.set_settings(with(trial.filter))?;
        tables_ms = tables_ms.max(milliseconds(start));
        let (frame, took) = draw_repeated(&mut renderer, plan.repeat);
        let (frame, ms) = (over_black(frame), middle(&took).0);
        outcomes.push(measured(trial, ms, &frame, &truth_picture)?);
        frames.push(frame);
    }
    Ok(Study {
        settings: settings.clone(),
        plan,
        machine: Machine::here(),
        num_triangles,
        truth_ms,
        tables_ms,
        outcomes,
        truth_png: png(&truth)?,
        crops: crops::choose(&truth, &frames)?,
    })
}

fn measured(
    trial: &Trial,
    ms: f64,
    frame: &Frame,
    truth: &Picture,
) -> Result<Outcome, basrelief::Error> {
    let picture = Picture::from(frame);
    let difference = compare(truth, &picture)?;
    let seen = flip(truth, &picture, PIXELS_PER_DEGREE)?;
    Ok(Outcome {
        trial: trial.clone(),
        ms,
        psnr: difference.psnr_db,
        ssim: difference.ssim,
        flip: seen.mean,
        png: png(frame)?,
        error_png: png(&heat_map(truth, &picture, HEAT_SCALE)?)?,
        flip_png: png(&errors_as_colors(&seen.errors, frame.width, FLIP_SCALE)?)?,
    })
}

/// A frame whose background, where it lets through, is black: so every pixel is compared.
fn over_black(mut frame: Frame) -> Frame {
    frame.pixels.iter_mut().for_each(|pixel| pixel[3] = 1.0);
    frame
}

fn png(frame: &Frame) -> Result<Vec<u8>, basrelief::Error> {
    frame.encode(Format::Png)
}

impl Study {
    /// The trials of which no other is both faster and better, by a quality that grows, from the
    /// fastest to the best.
    pub(crate) fn front(&self, quality: impl Fn(&Outcome) -> f64) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.outcomes.len()).collect();
        let key = |i: usize| (self.outcomes[i].ms, -quality(&self.outcomes[i]));
        order.sort_by(|&a, &b| key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal));
        let mut best = f64::NEG_INFINITY;
        order.retain(|&i| {
            let is_better = quality(&self.outcomes[i]) > best;
            best = best.max(quality(&self.outcomes[i]));
            is_better
        });
        order
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::commands::study::trials::tests::defaults;

    /// A study of made-up figures: milliseconds and decibels.
    pub(crate) fn study(figures: &[(f64, f64)]) -> Study {
        let trials = defaults();
        let outcome = |(i, &(ms, psnr)): (usize, &(f64, f64))| Outcome {
            trial: trials[i].clone(),
            ms,
            psnr,
            ssim: 0.9,
            flip: 1.0 / psnr,
            png: vec![],
            error_png: vec![],
            flip_png: vec![],
        };
        Study {
            settings: Settings::default(),
            outcomes: figures.iter().enumerate().map(outcome).collect(),
            plan: Plan { trials, truth_samples: 1, repeat: 1 },
            machine: Machine::here(),
            num_triangles: 0,
            truth_ms: 0.0,
            tables_ms: 0.0,
            truth_png: vec![],
            crops: vec![],
        }
    }

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let study = study(&[
            (10.0, 30.0),
            (20.0, 25.0),
            (5.0, 20.0),
            (40.0, 50.0),
            (40.0, 45.0),
            (50.0, f64::INFINITY),
        ]);
        assert_eq!(study.front(|outcome| outcome.psnr), [2, 0, 3, 5]);
        assert_eq!(study.front(|outcome| -outcome.flip), [2, 0, 3, 5]);
    }
}
