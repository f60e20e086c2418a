//! Lines, areas and text on a picture, without a font or library of the machine.

mod ramp;
mod text;

pub(crate) use ramp::Ramp;
pub(crate) use text::{CELL, Size};

use basrelief::Frame;
use basrelief::texture::linear_from_srgb8;
use tiny_skia::{
    Color, FillRule, Paint, Path, PathBuilder, Pixmap, PixmapPaint, Rect, Stroke, StrokeDash,
    Transform,
};

/// sRGB and opacity.
pub(crate) type Rgba = [u8; 4];

/// A place in pixels from the upper left corner.
pub(crate) type Point = [f32; 2];

/// How a line is drawn: its width in pixels, its colour, and the lengths of dashes and gaps if it
/// has any.
#[derive(Clone, Copy)]
pub(crate) struct Pen {
    pub(crate) width: f32,
    pub(crate) color: Rgba,
    pub(crate) dash: Option<[f32; 2]>,
}

impl Pen {
    pub(crate) fn solid(width: f32, color: Rgba) -> Self {
        Self { width, color, dash: None }
    }

    pub(crate) fn dashed(width: f32, color: Rgba) -> Self {
        Self { width, color, dash: Some([6.0, 4.0]) }
    }
}

/// A picture to draw on.
pub(crate) struct Canvas {
    pixmap: Pixmap,
}

impl Canvas {
    /// A picture of one colour. Sizes are of a pixel at least.
    pub(crate) fn new(width: u32, height: u32, background: Rgba) -> Self {
        let mut pixmap = Pixmap::new(width.max(1), height.max(1))
            .expect("a picture on a screen fits into memory");
        pixmap.fill(color_of(background));
        Self { pixmap }
    }

    /// Width and height in pixels.
    pub(crate) fn size(&self) -> [u32; 2] {
        [self.pixmap.width(), self.pixmap.height()]
    }

    /// Opaque sRGB bytes, red, green, blue and opacity, row by row.
    pub(crate) fn bytes(&self) -> &[u8] {
        self.pixmap.data()
    }

    /// The picture as a frame, which all image formats can hold.
    pub(crate) fn into_frame(self) -> Frame {
        let [width, height] = self.size();
        let linear = |bytes: &[u8]| [bytes[0], bytes[1], bytes[2]].map(linear_from_srgb8);
        let pixels = self.bytes().chunks_exact(4).map(|bytes| {
            let [r, g, b] = linear(bytes);
            [r, g, b, 1.0]
        });
        Frame { width, height, pixels: pixels.collect() }
    }

    /// Sets the pixels of the upper rows, from the upper left corner.
    pub(crate) fn paint(&mut self, pixels: &[[u8; 3]]) {
        for (bytes, [r, g, b]) in self.pixmap.data_mut().chunks_exact_mut(4).zip(pixels) {
            bytes.copy_from_slice(&[*r, *g, *b, 255]);
        }
    }

    /// Fills a rectangle: left, top, width and height.
    pub(crate) fn rect(&mut self, [x, y, width, height]: [f32; 4], color: Rgba) {
        if let Some(rect) = Rect::from_xywh(x, y, width, height) {
            self.pixmap.fill_rect(rect, &paint(color), Transform::identity(), None);
        }
    }

    /// Fills a polygon.
    pub(crate) fn polygon(&mut self, points: &[Point], color: Rgba) {
        if let Some(path) = path(points, true) {
            self.pixmap.fill_path(
                &path,
                &paint(color),
                FillRule::Winding,
                Transform::identity(),
                None,
            );
        }
    }

    /// Draws a line through points, of which those that are not finite are left out.
    pub(crate) fn line(&mut self, points: &[Point], pen: Pen) {
        if let Some(path) = path(points, false) {
            let dash = pen.dash.and_then(|[dash, gap]| StrokeDash::new(vec![dash, gap], 0.0));
            let stroke = Stroke { width: pen.width, dash, ..Stroke::default() };
            self.pixmap.stroke_path(&path, &paint(pen.color), &stroke, Transform::identity(), None);
        }
    }

    /// Draws a line with a head at its end.
    pub(crate) fn arrow(&mut self, [from, to]: [Point; 2], pen: Pen) {
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = along[0].hypot(along[1]);
        if length < 1.0 {
            return;
        }
        let [x, y] = along.map(|c| c / length * (4.0 + 2.5 * pen.width));
        self.line(&[from, [to[0] - x * 0.6, to[1] - y * 0.6]], pen);
        let side = |way: f32| [to[0] - x - way * y * 0.45, to[1] - y + way * x * 0.45];
        self.polygon(&[to, side(1.0), side(-1.0)], pen.color);
    }

    /// Fills a disc.
    pub(crate) fn disc(&mut self, [x, y]: Point, radius: f32, color: Rgba) {
        if let Some(path) = PathBuilder::from_circle(x, y, radius) {
            self.pixmap.fill_path(
                &path,
                &paint(color),
                FillRule::Winding,
                Transform::identity(),
                None,
            );
        }
    }

    /// Draws another picture on this one, its upper left corner at `x`, `y`.
    pub(crate) fn picture(&mut self, [x, y]: [i32; 2], other: &Self) {
        let paint = PixmapPaint::default();
        self.pixmap.draw_pixmap(x, y, other.pixmap.as_ref(), &paint, Transform::identity(), None);
    }

    /// Writes a line of text, its upper left corner at `x`, `y`. Letters that the font has not are
    /// `?`.
    pub(crate) fn text(&mut self, [x, y]: Point, text: &str, size: Size, color: Rgba) {
        let [width, height] = self.size().map(|side| side as i32);
        let mut left = x.round() as i32;
        let top = y.round() as i32;
        for glyph in text::glyphs(text, size) {
            for (row, coverages) in (top..).zip(glyph.rows()) {
                for (column, &coverage) in (left..).zip(coverages) {
                    if coverage > 0 && (0..width).contains(&column) && (0..height).contains(&row) {
                        let at = (row * width + column) as usize * 4;
                        blend(&mut self.pixmap.data_mut()[at..at + 4], color, coverage);
                    }
                }
            }
            left += glyph.width() as i32;
        }
    }
}

/// Lays a colour over an opaque pixel.
fn blend(bytes: &mut [u8], color: Rgba, coverage: u8) {
    let part = u32::from(coverage) * u32::from(color[3]) / 255;
    for (byte, channel) in bytes.iter_mut().zip(color).take(3) {
        *byte = ((u32::from(*byte) * (255 - part) + u32::from(channel) * part + 127) / 255) as u8;
    }
}

fn color_of([r, g, b, a]: Rgba) -> Color {
    Color::from_rgba8(r, g, b, a)
}

fn paint(color: Rgba) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color(color_of(color));
    paint
}

fn path(points: &[Point], is_closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    // Farther out than any picture, where the drawing crate would run into overflow.
    let is_near = |point: &&Point| point.iter().all(|c| c.abs() < 1e5);
    for (i, [x, y]) in points.iter().filter(is_near).enumerate() {
        if i == 0 { path.move_to(*x, *y) } else { path.line_to(*x, *y) }
    }
    if is_closed {
        path.close();
    }
    path.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_stay_as_they_are() {
        let pixels: Vec<[u8; 3]> = (0..=255).map(|i| [i, 255 - i, i / 2]).collect();
        let mut canvas = Canvas::new(16, 16, [0, 0, 0, 255]);
        canvas.paint(&pixels);
        assert_eq!(canvas.into_frame().to_rgb8(), pixels);
    }

    #[test]
    fn what_is_drawn_is_in_the_frame() {
        let mut canvas = Canvas::new(60, 40, [255, 255, 255, 255]);
        canvas.rect([10.0, 10.0, 5.0, 5.0], [200, 0, 0, 255]);
        canvas
            .line(&[[0.0, 30.5], [f32::NAN, 0.0], [60.0, 30.5]], Pen::solid(1.0, [0, 0, 255, 255]));
        canvas.text([30.0, 5.0], "M", Size::Small, [0, 0, 0, 255]);
        let bytes = canvas.into_frame().to_rgb8();
        assert_eq!(
            (bytes[12 * 60 + 12], bytes[30 * 60 + 40], bytes[0]),
            ([200, 0, 0], [0, 0, 255], [255; 3])
        );
        let darkest =
            (0..40 * 60).filter(|i| i % 60 >= 30 && i / 60 < 25).map(|i| bytes[i][0]).min();
        assert!(darkest < Some(60), "a letter was written");
    }
}
