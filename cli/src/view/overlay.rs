//! What lies above the frames in the window.

use crate::pictures::draw::{CELL, Canvas, Rgba, Size};
use crate::pictures::inspection::page::draw_small;
use basrelief::Frame;
use basrelief::inspect::Inspection;

const SHADE: Rgba = [16, 18, 22, 215];
const PAPER: Rgba = [245, 245, 243, 255];

/// One frame, or the two halves of one side by side, stretched to the window.
pub(crate) fn frames(frames: &[Frame], [width, height]: [u32; 2]) -> Canvas {
    let mut canvas = Canvas::new(width, height, [24, 26, 30, 255]);
    let pictures: Vec<_> = frames.iter().map(|frame| (frame, frame.to_rgb8())).collect();
    let Some((left, _)) = pictures.first() else { return canvas };
    let num_columns: u32 = frames.iter().map(|frame| frame.width).sum();
    let mut pixels = Vec::with_capacity(width as usize * height as usize);
    let mut row = Vec::with_capacity(num_columns as usize);
    for y in 0..height {
        row.clear();
        for (frame, bytes) in &pictures {
            let start = (y * frame.height / height * frame.width) as usize;
            row.extend_from_slice(&bytes[start..start + frame.width as usize]);
        }
        pixels.extend((0..width).map(|x| row[(x * num_columns / width) as usize]));
    }
    canvas.paint(&pixels);
    if frames.len() > 1 {
        let border = left.width as f32 / num_columns as f32 * width as f32;
        canvas.rect([border - 1.0, 0.0, 2.0, height as f32], PAPER);
    }
    canvas
}

/// The names of the filters, and what drawing took.
pub(crate) fn status(canvas: &mut Canvas, names: &[&str], timing: &str) {
    let width = canvas.size()[0] as f32;
    canvas.rect([0.0, 0.0, width, CELL[1] + 6.0], SHADE);
    canvas.text([6.0, 3.0], names[0], Size::Bold, PAPER);
    if let Some(right) = names.get(1) {
        canvas.text([width * 0.5 + 6.0, 3.0], right, Size::Bold, PAPER);
    }
    let length = CELL[0] * timing.len() as f32 + 12.0;
    // Below, where names and timing have no room beside each other.
    if width > 2.0 * length + 160.0 {
        canvas.text([width - length + 6.0, 3.0], timing, Size::Small, PAPER);
    } else {
        let top = canvas.size()[1] as f32 - CELL[1] - 2.0;
        canvas.rect([0.0, top, length, CELL[1] + 2.0], SHADE);
        canvas.text([6.0, top], timing, Size::Small, PAPER);
    }
}

/// Lines of text in the lower part.
pub(crate) fn lines(canvas: &mut Canvas, text: &str) {
    let [width, height] = canvas.size().map(|side| side as f32);
    let columns = ((width - 20.0) / CELL[0]).max(1.0) as usize;
    let letters = |line: &str| line.chars().collect::<Vec<_>>();
    let wrapped: Vec<String> = text
        .lines()
        .flat_map(|line| {
            letters(line).chunks(columns).map(|part| part.iter().collect()).collect::<Vec<String>>()
        })
        .collect();
    let top = height - CELL[1] * wrapped.len() as f32 - 12.0;
    canvas.rect([0.0, top, width, height - top], SHADE);
    for (i, line) in wrapped.iter().enumerate() {
        canvas.text([10.0, top + 6.0 + CELL[1] * i as f32], line, Size::Small, PAPER);
    }
}

/// What a pixel sees, made to fit beside the picture.
pub(crate) fn inspector(seen: &Inspection, [width, height]: [u32; 2]) -> Canvas {
    draw_small(
        seen,
        [(width / 2).clamp(160, 620), height.saturating_sub(CELL[1] as u32 + 6).max(120)],
    )
}

/// Lays the inspector on the right side.
pub(crate) fn beside(canvas: &mut Canvas, inspector: &Canvas) {
    let [width, height] = canvas.size().map(|side| side as i32);
    let [w, h] = inspector.size().map(|side| side as i32);
    canvas.picture([width - w, height - h], inspector);
}
