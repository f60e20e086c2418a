//! `--view`: a whole frame of numbers as colours, with a legend.

mod colors;

use super::args::RenderOptions;
use super::choices::{Choice, ON_OFF, one_of};
use super::draw::{CELL, Canvas, Pen, Rgba, Size};
use super::progress::Progress;
use super::render::thread_pool;
use super::settings::refusal;
use super::{Refusal, output};
use basrelief::inspect::{Measured, View, measure};
use clap::Args;
use colors::{Key, Scale};
use std::process::ExitCode;

pub(crate) const VIEWS: &[Choice<View>] = &[
    ("coverage", View::Coverage, "How many triangles a pixel sees, and how much of it they cover"),
    ("mip", View::Mip, "Mip level that the filter reads"),
    ("footprint", View::Footprint, "Texels of the full texture in the pixel's ellipse"),
    ("visible", View::Visible, "The part of these texels that the relief does not hide"),
    ("horizon", View::Horizon, "The part of the rows along the view that the floating horizon sees"),
    ("depth", View::Depth, "Distance to the relief along the view"),
    ("normal", View::Normal, "Normal of the relief in world space"),
    ("uv", View::Uv, "Texture coordinates of the hit"),
];

#[derive(Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct ViewOptions {
    /// Show numbers of every pixel as colours, in place of the picture
    #[arg(long, value_name = "WHAT", value_parser = one_of(VIEWS))]
    pub(super) view: Option<View>,
    /// Whether a legend is added below the picture of --view
    #[arg(long, value_name = "on|off", action = clap::ArgAction::Set, hide_possible_values = true, default_value = "on", value_parser = one_of(ON_OFF), requires = "view")]
    legend: bool,
}

const LEGEND_HEIGHT: u32 = 56;
const PAPER: Rgba = [250, 250, 248, 255];
const INK: Rgba = [32, 33, 36, 255];

/// Draws the numbers of a frame.
pub(super) fn run(options: &RenderOptions, view: View) -> Result<ExitCode, Refusal> {
    let settings = options.settings.settings(false)?;
    let sequence = options.frames.sequence(options.output.as_deref())?;
    let is_more = options.stats.is_some() || options.repeat.is_some() || options.json || options.save_scene.is_some();
    if is_more || sequence.is_numbered() || settings.region.is_some() {
        let words = "--stats, --repeat, --json, --save-scene, --region and many frames are of pictures, not of --view";
        return Err(words.into());
    }
    let format = output::image_format(sequence.output())?;
    let measured = thread_pool(options.threads)?.install(|| {
        let progress = Progress::new(options.quiet);
        let loaded = options.scene.load(&settings, view == View::Normal, &progress)?;
        loaded.warnings.iter().for_each(|warning| progress.warn(warning));
        progress.stage("measuring");
        measure(&loaded.scene, &settings, view).map_err(|e| refusal(&e))
    })?;
    let frame = draw(&measured, view, options.view.legend).into_frame();
    output::write(sequence.output(), &frame.encode(format).map_err(|e| refusal(&e))?)?;
    Ok(ExitCode::SUCCESS)
}

/// The numbers as colours, with a legend below.
pub(super) fn draw(measured: &Measured, view: View, has_legend: bool) -> Canvas {
    let scale = Scale::new(measured, view);
    let Measured { width, height, .. } = *measured;
    let mut canvas = Canvas::new(width, height + if has_legend { LEGEND_HEIGHT } else { 0 }, PAPER);
    canvas.paint(&scale.colors(measured));
    if has_legend {
        draw_legend(&mut canvas, height as f32, &scale);
    }
    canvas
}

fn draw_legend(canvas: &mut Canvas, top: f32, scale: &Scale) {
    let width = canvas.size()[0] as f32;
    canvas.text([8.0, top + 4.0], scale.title(), Size::Bold, INK);
    match scale.key() {
        Key::Bar { ramp, ticks } => {
            let bar = [8.0, top + 24.0, (width - 40.0).clamp(16.0, 600.0), 12.0];
            for i in 0..bar[2] as u32 {
                let [r, g, b] = ramp.at(i as f32 / bar[2]);
                canvas.rect([bar[0] + i as f32, bar[1], 1.0, bar[3]], [r, g, b, 255]);
            }
            let mut free = f32::MIN;
            for (place, text) in ticks {
                let x = bar[0] + place * bar[2];
                canvas.line(&[[x, bar[1]], [x, bar[1] + 16.0]], Pen::solid(1.0, INK));
                let length = CELL[0] * text.len() as f32;
                let start = (x + 2.0).min(width - length - 2.0);
                if start > free {
                    canvas.text([start, top + 38.0], &text, Size::Small, INK);
                    free = start + length + CELL[0];
                }
            }
        }
        Key::Areas(areas) => {
            let mut x = 8.0;
            for ([r, g, b], text) in areas {
                canvas.rect([x, top + 28.0, 14.0, 14.0], INK);
                canvas.rect([x + 1.0, top + 29.0, 12.0, 12.0], [r, g, b, 255]);
                canvas.text([x + 20.0, top + 27.0], &text, Size::Small, INK);
                x += 20.0 + CELL[0] * (text.len() as f32 + 2.0);
            }
        }
    }
}
