//! The page: one file that needs no network.

use crate::commands::study::chart::{self, Axis};
use crate::commands::study::crops::Crop;
use crate::commands::study::gather::{FLIP_SCALE, HEAT_SCALE, Outcome, Study};
use crate::refusal::Refusal;
use askama::Template;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use basrelief::{SIMD_LEVEL, metrics};

const PSNR: Axis = Axis { title: "PSNR, dB", value: |outcome| outcome.psnr, is_falling: false };
const FLIP: Axis =
    Axis { title: "FLIP, less is better", value: |outcome| outcome.flip, is_falling: true };

#[derive(Template)]
#[template(path = "study.html")]
struct Page {
    width: u32,
    height: u32,
    rows: Vec<Row>,
    charts: Vec<Chart>,
    truth: String,
    crops: Vec<CropView>,
    /// Which rows are the two sides of the wipe at first.
    first: usize,
    second: usize,
    heat_stops: String,
    heat_scale: f32,
    flip_scale: f32,
    facts: Vec<(&'static str, String)>,
}

struct Row {
    number: usize,
    name: &'static str,
    options: String,
    /// All that the filter was told, by those options and by the scene file.
    filter: String,
    ms: String,
    psnr: String,
    ssim: String,
    flip: String,
    is_on_front: bool,
    png: String,
    error_png: String,
    flip_png: String,
}

struct Chart {
    title: &'static str,
    svg: String,
    front: String,
}

struct CropView {
    place: String,
    truth: String,
    /// Names and pictures.
    pictures: Vec<(&'static str, String)>,
}

/// The page of a study.
pub(crate) fn html(study: &Study) -> Result<String, Refusal> {
    let front = PSNR.front(study);
    let row = |(i, outcome): (usize, &Outcome)| Row {
        number: i + 1,
        name: outcome.trial.name,
        options: outcome.trial.options.clone(),
        filter: format!("{:?}", outcome.trial.filter),
        ms: number(outcome.ms, if outcome.ms < 100.0 { 1 } else { 0 }),
        psnr: if outcome.psnr.is_finite() { number(outcome.psnr, 1) } else { "equal".into() },
        ssim: number(outcome.ssim, 4),
        flip: number(outcome.flip, 4),
        is_on_front: front.contains(&i),
        png: data_uri(&outcome.png),
        error_png: data_uri(&outcome.error_png),
        flip_png: data_uri(&outcome.flip_png),
    };
    let name = |name: &str| {
        study.outcomes.iter().position(|outcome| outcome.trial.name == name).unwrap_or(0)
    };
    let page = Page {
        width: study.settings.width,
        height: study.settings.height,
        rows: study.outcomes.iter().enumerate().map(row).collect(),
        charts: vec![
            chart_view("Quality against time: PSNR", study, &PSNR)?,
            chart_view("The same by FLIP", study, &FLIP)?,
        ],
        truth: data_uri(&study.truth_png),
        crops: crop_views(study),
        first: name("parallax, 1 ray"),
        second: name("horizon"),
        heat_stops: heat_stops()?,
        heat_scale: HEAT_SCALE,
        flip_scale: FLIP_SCALE,
        facts: facts(study),
    };
    Ok(page.render().map_err(|e| format!("page: {e}"))?)
}

fn chart_view(title: &'static str, study: &Study, axis: &Axis) -> Result<Chart, Refusal> {
    let names = axis
        .front(study)
        .into_iter()
        .map(|i| format!("{} ({})", study.outcomes[i].trial.name, i + 1));
    Ok(Chart { title, svg: chart::svg(study, axis)?, front: names.collect::<Vec<_>>().join(", ") })
}

fn crop_views(study: &Study) -> Vec<CropView> {
    let view = |crop: &Crop| {
        let [x, y, w, h] = crop.area;
        let pictures = study.outcomes.iter().zip(&crop.pngs);
        CropView {
            place: format!("{w} x {h} pixels at {x}, {y}"),
            truth: data_uri(&crop.truth_png),
            pictures: pictures.map(|(outcome, png)| (outcome.trial.name, data_uri(png))).collect(),
        }
    };
    study.crops.iter().map(view).collect()
}

/// Colours of the heat maps' scale, as CSS has them.
fn heat_stops() -> Result<String, Refusal> {
    let steps: Vec<f32> = (0..=16).map(|i| i as f32 / 16.0).collect();
    let colors = metrics::errors_as_colors(&steps, steps.len() as u32, 1.0)?;
    Ok(colors
        .to_rgb8()
        .iter()
        .map(|[r, g, b]| format!("#{r:02x}{g:02x}{b:02x}"))
        .collect::<Vec<_>>()
        .join(","))
}

fn facts(study: &Study) -> Vec<(&'static str, String)> {
    let (machine, settings) = (&study.machine, &study.settings);
    vec![
        ("Version", format!("basrelief {}, built for {SIMD_LEVEL}", env!("CARGO_PKG_VERSION"))),
        ("Processor", format!("{}, {} threads", machine.processor, machine.threads)),
        ("System", machine.system.clone()),
        ("Scene", format!("{} triangles", study.num_triangles)),
        (
            "Truth",
            format!("{} rays a pixel, {:.1} s", study.plan.truth_samples, study.truth_ms / 1e3),
        ),
        ("Times", format!("middle of {} frames after one to warm up", study.plan.repeat)),
        (
            "Tables of the far field",
            format!("{:.1} s, once, before the first frame", study.tables_ms / 1e3),
        ),
        ("Settings", format!("{settings:?}")),
        (
            "Measures",
            format!(
                "of sRGB values, background over black; FLIP at {:.0} pixels a degree",
                metrics::PIXELS_PER_DEGREE
            ),
        ),
    ]
}

fn number(value: f64, places: usize) -> String {
    format!("{value:.places$}")
}

fn data_uri(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", BASE64_STANDARD.encode(png))
}
