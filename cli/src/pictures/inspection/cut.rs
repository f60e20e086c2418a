//! The cut through the relief along the view or a light's way; the eye, or the light, is on the left,
//! above.

use crate::pictures::draw::{CELL, Canvas, Pen, Point, Rgba, Size};
use crate::pictures::inspection::palette::{
    FAINT, FLAT, HIDDEN, INK, Layers, RAY, RELIEF, VISIBLE, WHITE,
};
use basrelief::inspect::{Cut, CutPoint};

const STONE: Rgba = [205, 198, 186, 255];
const HORIZON: Rgba = [230, 159, 0, 255];

/// Part of the relief's depth that is drawn above the polygon.
const ABOVE: f64 = 0.34;

/// Whose way the relief is cut along.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Along {
    View,
    Light,
}

impl Along {
    fn title(self) -> &'static str {
        match self {
            Self::View => "Cut along the view direction",
            Self::Light => "Cut along the main light",
        }
    }

    /// What the ray, what it meets, and what it does not are called.
    fn words(self) -> [&'static str; 4] {
        match self {
            Self::View => [
                "view ray",
                "seen relief, and its visible length above the polygon",
                "hidden relief",
                "running horizon",
            ],
            Self::Light => [
                "ray of the light to the hit",
                "lit relief, and its lit length above the polygon",
                "relief in shadow",
                "edge of the light",
            ],
        }
    }
}

/// From the cut to pixels.
struct Map {
    start: f64,
    scale: [f64; 2],
    top: f64,
}

impl Map {
    fn place(&self, along: f64, depth: f64) -> Point {
        [
            ((along - self.start) * self.scale[0]) as f32,
            ((depth + ABOVE) * self.scale[1] + self.top) as f32,
        ]
    }
}

/// Draws a cut through the relief of a mip level.
pub(crate) fn draw(
    cut: &Cut,
    (along, level): (Along, usize),
    size: [u32; 2],
    layers: Layers,
) -> Canvas {
    let mut canvas = Canvas::new(size[0], size[1], WHITE);
    let [Some(first), Some(last)] = [cut.points.first(), cut.points.last()] else { return canvas };
    let [width, height] = size.map(f64::from);
    let top = 2.6 * f64::from(CELL[1]);
    let scale = [width / (last.along - first.along), (height - top) / (1.06 + ABOVE)];
    let map = Map { start: first.along, scale, top };
    draw_relief(&mut canvas, &map, cut);
    if layers.horizon {
        draw_horizon(&mut canvas, &map, cut);
    }
    draw_ray(&mut canvas, &map, cut, layers);
    let times = scale[1] / (cut.relief_depth.max(1e-9) * scale[0]);
    let mut unit = format!("1 texel = {:.1} pixels, heights {times:.1} times as large", scale[0]);
    if level > 0 {
        // The ray is traced through the full texture: the hit need not lie on this outline.
        unit += &format!("; relief of level {level}, hit in level 0");
    }
    canvas.text([0.0, 0.0], along.title(), Size::Bold, INK);
    canvas.text([240.0, 0.0], &unit, Size::Small, FAINT);
    keys(&mut canvas, along, layers);
    canvas
}

fn keys(canvas: &mut Canvas, along: Along, layers: Layers) {
    let [ray, seen, hidden, edge] = along.words();
    let keys = [
        (true, RAY, ray),
        (true, FLAT, "polygon"),
        (layers.horizon, VISIBLE, seen),
        (layers.horizon, HIDDEN, hidden),
        (layers.horizon, HORIZON, edge),
    ];
    let mut x = 0.0;
    for (_, color, text) in keys.into_iter().filter(|(is_shown, ..)| *is_shown) {
        canvas.rect([x, 1.3 * CELL[1] + 6.0, 14.0, 4.0], color);
        canvas.text([x + 20.0, 1.3 * CELL[1]], text, Size::Small, INK);
        x += 20.0 + CELL[0] * (text.len() as f32 + 3.0);
    }
}

fn draw_relief(canvas: &mut Canvas, map: &Map, cut: &Cut) {
    let mut outline: Vec<Point> =
        cut.points.iter().map(|point| map.place(point.along, point.depth)).collect();
    let profile = outline.clone();
    for along in
        [cut.points.last(), cut.points.first()].into_iter().flatten().map(|point| point.along)
    {
        outline.push(map.place(along, 1.2));
    }
    canvas.polygon(&outline, STONE);
    canvas.line(&profile, Pen::solid(1.5, FAINT));
    let ends = [cut.points.first(), cut.points.last()].into_iter().flatten();
    let polygon: Vec<Point> = ends.map(|point| map.place(point.along, 0.0)).collect();
    canvas.line(&polygon, Pen::solid(2.0, FLAT));
}

/// What is seen and what is hidden between entry and exit, and the line of sight over the highest
/// so far.
fn draw_horizon(canvas: &mut Canvas, map: &Map, cut: &Cut) {
    let [entry, exit] = cut.ellipse;
    let displacement = cut.displacement.max(1e-9);
    let last =
        cut.points.iter().position(|point| point.horizon >= exit).unwrap_or(cut.points.len() - 1);
    let sight = cut.points[..=last].iter().filter(|point| point.along >= entry - displacement);
    let sight: Vec<Point> = sight
        .map(|point| (point.along, (point.along - point.horizon) / displacement))
        .filter(|(_, depth)| *depth >= -ABOVE)
        .map(|(along, depth)| map.place(along, depth))
        .collect();
    canvas.line(&sight, Pen::dashed(2.0, HORIZON));
    let (mut is_odd, mut highest) = (false, f64::NEG_INFINITY);
    for pair in cut.points[..=last].windows(2) {
        let [from, to] = [&pair[0], &pair[1]];
        // Relief that is seen over a place before the entry is not hidden: the pixel below sees it.
        highest = from.projected.max(highest);
        let part =
            |p: f64| ((p - from.projected) / (to.projected - from.projected)).clamp(0.0, 1.0);
        let at = |t: f64| {
            map.place(
                from.along + (to.along - from.along) * t,
                from.depth + (to.depth - from.depth) * t,
            )
        };
        if to.visible > 0.0 {
            let [risen, start, end] = [highest, from.horizon, to.horizon].map(part);
            canvas.line(&[at(0.0), at(risen)], Pen::solid(3.0, HIDDEN));
            canvas.line(&[at(start), at(end)], Pen::solid(4.0, VISIBLE));
            draw_length(canvas, map, [from, to], is_odd);
            is_odd = !is_odd;
        } else if to.along > entry && to.projected <= highest {
            canvas.line(&[at(0.0), at(1.0)], Pen::solid(3.0, HIDDEN));
        }
    }
}

/// A visible length as a bar above the polygon; neighbours differ in lightness.
fn draw_length(canvas: &mut Canvas, map: &Map, [from, to]: [&CutPoint; 2], is_odd: bool) {
    let [left, y] = map.place(from.horizon, 0.0);
    let [right, _] = map.place(to.horizon, 0.0);
    let [r, g, b, _] = VISIBLE;
    let opacity = if is_odd { 150 } else { 255 };
    canvas.rect([left, y - 13.0, (right - left).max(0.3), 10.0], [r, g, b, opacity]);
}

fn draw_ray(canvas: &mut Canvas, map: &Map, cut: &Cut, layers: Layers) {
    let [along, depth] = cut.hit;
    let sight = |base: f64, depth: f64| map.place(base + depth * cut.displacement, depth);
    if layers.horizon || layers.ellipses[0] {
        for base in cut.ellipse {
            canvas.line(&[sight(base, -ABOVE), sight(base, 1.0)], Pen::dashed(1.0, FAINT));
        }
        let [entry, exit] = cut.ellipse.map(|base| map.place(base, 0.0));
        canvas.line(&[entry, exit], Pen::solid(4.0, FLAT));
    }
    canvas.arrow([sight(0.0, -ABOVE), map.place(along, depth)], Pen::solid(2.5, RAY));
    canvas.line(&[map.place(along, depth), sight(0.0, 1.0)], Pen::dashed(1.5, RAY));
    canvas.disc(map.place(0.0, 0.0), 4.5, FLAT);
    canvas.disc(map.place(along, depth), 5.0, RELIEF);
    let [x, y] = map.place(0.0, 0.0);
    canvas.text([x + 8.0, y - 32.0], "on the polygon", Size::Small, FLAT);
    let [x, y] = map.place(along, depth);
    canvas.text([x + 9.0, y - 20.0], "hit", Size::Bold, RELIEF);
}
