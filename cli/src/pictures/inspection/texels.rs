//! The texels around a pixel's footprint, enlarged; u to the right, v upwards.

use crate::pictures::draw::{Canvas, Pen, Point, Rgba, Size};
use crate::pictures::inspection::palette::{
    FLAT, HIDDEN, INK, Layers, RAY, RELIEF, SKIPPED, TWICE, VISIBLE,
};
use basrelief::inspect::Ellipse;
use basrelief::inspect::{Inspection, Projected, Reading};
use basrelief::texture::srgb8_from_linear;
use std::collections::{HashMap, HashSet};

/// A texel is at least this many pixels wide, or what lies farther from the texels of T is cut off.
const LEAST_SCALE: f32 = 3.0;

/// Rays drawn from hidden texels at the most.
const MOST_RAYS: usize = 48;

/// How the ellipse is drawn that is filtered where it is neither that of (2) nor that of (3).
pub(crate) const FILTERED: Pen = Pen { width: 2.0, color: INK, dash: Some([3.0, 3.0]) };

/// Whether a jump of the relief is left out of the ellipse that is filtered.
pub(crate) fn is_bounded(seen: &Inspection) -> bool {
    let has_widened = |reading: &Reading| {
        [reading.flat.widened, reading.relief.widened].contains(&seen.sets.ellipse)
    };
    !seen.readings.iter().any(has_widened)
}

/// From texels to pixels.
struct Map {
    /// The texel place in the upper left corner.
    corner: [f32; 2],
    scale: f32,
    size: [u32; 2],
}

/// Draws the texels.
pub(crate) fn draw(seen: &Inspection, size: [u32; 2], layers: Layers) -> Canvas {
    let mut canvas = Canvas::new(size[0], size[1], INK);
    let map = Map::around(seen, size, layers);
    draw_texels(&mut canvas, &map, seen, layers);
    if layers.rays {
        draw_rays(&mut canvas, &map, seen);
    }
    let reading = &seen.readings[0];
    let ellipses =
        [(&reading.flat, Pen::dashed(2.5, FLAT)), (&reading.relief, Pen::solid(2.5, RELIEF))];
    for ((projected, pen), _) in
        ellipses.into_iter().zip(layers.ellipses).filter(|(_, is_shown)| *is_shown)
    {
        let outline = outline(&projected.widened, projected.center).map(|place| map.place(place));
        let outline: Vec<Point> = outline.collect();
        canvas.line(&outline, Pen::solid(pen.width + 2.0, [255, 255, 255, 160]));
        canvas.line(&outline, pen);
    }
    if is_bounded(seen) && layers.ellipses[1] {
        let outline: Vec<Point> = outline(&seen.sets.ellipse, reading.relief.center)
            .map(|place| map.place(place))
            .collect();
        canvas.line(&outline, FILTERED);
    }
    let [base, hit] = [map.place(reading.flat.center), map.place(reading.relief.center)];
    canvas.arrow([base, hit], Pen::solid(4.0, [255, 255, 255, 200]));
    canvas.arrow([base, hit], Pen::solid(2.0, RAY));
    for (place, color) in [(base, FLAT), (hit, RELIEF)] {
        canvas.disc(place, 6.0, [255, 255, 255, 255]);
        canvas.disc(place, 4.0, color);
    }
    if size[1] >= 360 && seen.cut.displacement > 0.0 {
        draw_view(&mut canvas, seen);
    }
    canvas
}

impl Map {
    /// All that the layers show, or, where texels would be too small, the ellipse of the set.
    fn around(seen: &Inspection, size: [u32; 2], layers: Layers) -> Self {
        let reading = &seen.readings[0];
        let set = &seen.sets.all;
        let texels = set
            .iter()
            .flat_map(|t| [[t[0] as f32, t[1] as f32], [t[0] as f32 + 1.0, t[1] as f32 + 1.0]]);
        let of = |p: &Projected| outline(&p.widened, p.center).collect::<Vec<_>>();
        let near: Vec<[f32; 2]> = texels.chain(of(&reading.relief)).collect();
        let mut all = near.clone();
        if layers.ellipses[0] {
            all.extend(of(&reading.flat));
        }
        let whole = Self::of_places(&all, size);
        if whole.scale >= LEAST_SCALE { whole } else { Self::of_places(&near, size) }
    }

    fn of_places(places: &[[f32; 2]], size: [u32; 2]) -> Self {
        let bound = |axis: usize, pick: fn(f32, f32) -> f32, start: f32| {
            places.iter().map(|p| p[axis]).filter(|c| c.is_finite()).fold(start, pick)
        };
        let low = [0, 1].map(|axis| bound(axis, f32::min, f32::MAX));
        let high = [0, 1].map(|axis| bound(axis, f32::max, f32::MIN));
        let scales = [0, 1].map(|axis| size[axis] as f32 / ((high[axis] - low[axis]) * 1.1 + 3.0));
        let scale = scales[0].min(scales[1]).min(48.0);
        let scale = if scale >= LEAST_SCALE { scale.floor() } else { scale };
        let middle = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
        let [w, h] = size.map(|side| side as f32 / scale * 0.5);
        Self { corner: [(middle[0] - w).floor(), (middle[1] + h).ceil()], scale, size }
    }

    fn place(&self, [u, v]: [f32; 2]) -> Point {
        [(u - self.corner[0]) * self.scale, (self.corner[1] - v) * self.scale]
    }

    /// The texels that are in sight, and the upper left corner of each.
    fn texels(&self) -> impl Iterator<Item = ([i32; 2], Point)> + '_ {
        let [columns, rows] = self.size.map(|side| (side as f32 / self.scale).ceil() as i32 + 1);
        let [left, top] = self.corner.map(|c| c as i32);
        (top - rows..=top).flat_map(move |y| {
            (left..left + columns).map(move |x| ([x, y], self.place([x as f32, y as f32 + 1.0])))
        })
    }
}

fn draw_texels(canvas: &mut Canvas, map: &Map, seen: &Inspection, layers: Layers) {
    let sets = &seen.sets;
    let set = |texels: &[[i32; 2]]| texels.iter().copied().collect::<HashSet<[i32; 2]>>();
    let (all, hidden, skipped) = (set(&sets.all), set(&sets.hidden), set(&sets.skipped));
    let twice: HashMap<[i32; 2], u32> = sets.counted_twice.iter().copied().collect();
    let gap = if map.scale >= 10.0 { 1.0 } else { 0.0 };
    for (texel, [x, y]) in map.texels() {
        let color = seen.color(texel).map(srgb8_from_linear);
        let count = twice.get(&texel).copied().filter(|_| layers.twice);
        let tint = match () {
            () if !layers.texels || !all.contains(&texel) => None,
            () if count.is_some() => Some(TWICE),
            () if layers.hidden && hidden.contains(&texel) => Some(HIDDEN),
            () if layers.skipped && skipped.contains(&texel) => Some(SKIPPED),
            () => Some(VISIBLE),
        };
        // Whole pixels: no seam between texels.
        let [left, top] = [x.round(), y.round()];
        let area =
            [left, top, (x + map.scale).round() - left - gap, (y + map.scale).round() - top - gap];
        canvas.rect(area, tinted(color, tint));
        if let (Some(count), true) = (count, map.scale >= 18.0) {
            let at = [x + map.scale * 0.5 - 4.0, y + map.scale * 0.5 - 8.0];
            canvas.text(at, &count.to_string(), Size::Bold, [255, 255, 255, 255]);
        }
        if tint == Some(HIDDEN) && map.scale >= 8.0 {
            // Told apart without colours too.
            let [right, bottom] = [x + map.scale - gap - 1.0, y + map.scale - gap - 1.0];
            canvas.line(&[[x + 1.0, bottom], [right, y + 1.0]], Pen::solid(1.0, [90, 30, 0, 200]));
        }
    }
}

/// The colour of a texel under a tint; what is not in the set is paler.
fn tinted(color: [u8; 3], tint: Option<Rgba>) -> Rgba {
    let (over, part) = tint.map_or(([235; 3], 0.35), |[r, g, b, _]| ([r, g, b], 0.62));
    let [r, g, b] = std::array::from_fn(|i| {
        (f32::from(color[i]) * (1.0 - part) + f32::from(over[i]) * part + 0.5) as u8
    });
    [r, g, b, 255]
}

/// From hidden texels to those that are seen in their place.
fn draw_rays(canvas: &mut Canvas, map: &Map, seen: &Inspection) {
    let pairs = &seen.sets.covered_by;
    let step = pairs.len().div_ceil(MOST_RAYS).max(1);
    for pair in pairs.iter().step_by(step) {
        let ends = pair.map(|texel| map.place(texel.map(|c| c as f32 + 0.5)));
        canvas.arrow(ends, Pen::solid(1.0, TWICE));
    }
}

/// The direction of the view, in the lower left corner.
fn draw_view(canvas: &mut Canvas, seen: &Inspection) {
    let [u, v] = seen.cut.direction;
    let [_, height] = canvas.size();
    let middle = [62.0, height as f32 - 62.0];
    canvas.rect([6.0, height as f32 - 122.0, 112.0, 116.0], [255, 255, 255, 225]);
    let [x, y] = [u as f32 * 34.0, v as f32 * -34.0];
    canvas.arrow(
        [[middle[0] - x, middle[1] - y - 6.0], [middle[0] + x, middle[1] + y - 6.0]],
        Pen::solid(3.0, INK),
    );
    canvas.text([14.0, height as f32 - 24.0], "view: to far", Size::Small, INK);
}

/// The outline of an ellipse around `center`, its points closest where it bends most.
fn outline(ellipse: &Ellipse, center: [f32; 2]) -> impl Iterator<Item = [f32; 2]> {
    // With F as it stands: as printed it is not that of A, B and C. The larger eigenvalue is that
    // of the shorter axis.
    let [smaller, larger] = ellipse.squared_axes();
    let [short, long] = [larger, smaller].map(|eigenvalue| (ellipse.f / eigenvalue).sqrt());
    let (sin, cos) = (0.5 * ellipse.b.atan2(ellipse.a - ellipse.c)).sin_cos();
    (0..=128).map(move |i| {
        let (y, x) = (i as f32 / 128.0 * std::f32::consts::TAU).sin_cos();
        let [x, y] = [short * x, long * y];
        [center[0] + x * cos - y * sin, center[1] + x * sin + y * cos]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outlines_lie_on_the_ellipse() {
        for [a, b, c, f] in [
            [3.0, 2.0, 5.0, 7.0],
            [1.0, 0.0, 1.0, 4.0],
            [20.8, 5.6, 3.98, 75.2],
            [0.5, -1.9, 2.0, 0.1],
        ] {
            let ellipse = Ellipse { a, b, c, f };
            let points: Vec<_> = outline(&ellipse, [0.0, 0.0]).collect();
            assert!(
                points.iter().all(|&point| (ellipse.r2(point) - 1.0).abs() < 1e-3),
                "{ellipse:?}"
            );
            let most = points.iter().map(|p| p[0].hypot(p[1])).fold(0.0, f32::max);
            let smaller = 0.5 * (a + c) - (0.5_f32 * (a - c)).hypot(0.5 * b);
            assert!(
                (most / (f / smaller).sqrt() - 1.0).abs() < 1e-2,
                "the tips are there: {ellipse:?}"
            );
        }
    }
}
