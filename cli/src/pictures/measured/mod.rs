//! A whole frame of numbers as colours, with a legend.

mod colors;

use crate::pictures::draw::{CELL, Canvas, Pen, Rgba, Size};
use basrelief::inspect::{Measured, View};
use colors::{Key, Scale};

const LEGEND_HEIGHT: u32 = 56;
const PAPER: Rgba = [250, 250, 248, 255];
const INK: Rgba = [32, 33, 36, 255];

/// The numbers as colours, with a legend below.
pub(crate) fn draw(measured: &Measured, view: View, has_legend: bool) -> Canvas {
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
