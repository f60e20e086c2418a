//! The picture of an inspected pixel: texels above, a cut below, a legend beside.

use crate::pictures::draw::{CELL, Canvas, Pen, Rgba, Size};
use crate::pictures::inspection::cut::{self, Along};
use crate::pictures::inspection::palette::{
    FLAT, HIDDEN, INK, Layers, RAY, RELIEF, SKIPPED, TWICE, VISIBLE, WHITE,
};
use crate::pictures::inspection::texels;
use basrelief::inspect::Inspection;

const WIDTH: u32 = 1280;
const TITLE_HEIGHT: u32 = 40;
const TEXELS_SIZE: [u32; 2] = [880, 600];
const CUT_HEIGHT: u32 = 400;
const MARGIN: u32 = 16;
const CUT_SIZE: [u32; 2] = [WIDTH - 2 * MARGIN, CUT_HEIGHT];

/// Draws what a pixel sees; the cut only where relief is traced, and one along the main light where
/// there is one.
pub(crate) fn draw(seen: &Inspection, title: &str, layers: Layers) -> Canvas {
    let [width, texels_height] = TEXELS_SIZE;
    let has_cut = seen.cut.displacement > 0.0;
    let top = TITLE_HEIGHT + texels_height + MARGIN;
    let of_light = seen.light.as_ref().and_then(|light| light.cut.as_ref());
    let of_light = of_light.filter(|cut| has_cut && cut.displacement > 0.0);
    let num_cuts = u32::from(has_cut) + u32::from(of_light.is_some());
    let mut canvas = Canvas::new(WIDTH, top + num_cuts * (CUT_HEIGHT + MARGIN), WHITE);
    canvas.text([MARGIN as f32, 10.0], title, Size::Title, INK);
    canvas.picture([MARGIN as i32, TITLE_HEIGHT as i32], &texels::draw(seen, TEXELS_SIZE, layers));
    legend(&mut canvas, [(width + 2 * MARGIN) as f32, TITLE_HEIGHT as f32], seen, layers);
    if has_cut {
        canvas.picture(
            [MARGIN as i32, top as i32],
            &cut::draw(&seen.cut, (Along::View, seen.sets.level), CUT_SIZE, layers),
        );
    }
    if let Some(cut) = of_light {
        canvas.picture(
            [MARGIN as i32, (top + CUT_HEIGHT + MARGIN) as i32],
            &cut::draw(cut, (Along::Light, 0), CUT_SIZE, Layers::default()),
        );
    }
    canvas
}

/// Draws what a pixel sees in less room: the texels, and the main numbers.
#[cfg(feature = "viewer")]
pub(crate) fn draw_small(seen: &Inspection, [width, height]: [u32; 2]) -> Canvas {
    let mut canvas = Canvas::new(width, height, WHITE);
    let lines = number_lines(seen);
    let room = (CELL[1] * lines.len() as f32) as u32 + 8;
    let picture = [width, height.saturating_sub(room).max(height / 3)];
    canvas.picture([0, 0], &texels::draw(seen, picture, Layers::default()));
    for (i, line) in lines.iter().enumerate() {
        canvas.text([6.0, picture[1] as f32 + 4.0 + CELL[1] * i as f32], line, Size::Small, INK);
    }
    canvas
}

/// An entry: how it is drawn, and its text.
enum Key {
    Area(Rgba),
    Line(Pen),
}

fn legend(canvas: &mut Canvas, [x, mut y]: [f32; 2], seen: &Inspection, layers: Layers) {
    let heading = |canvas: &mut Canvas, y: &mut f32, text: &str| {
        canvas.text([x, *y], text, Size::Bold, INK);
        *y += 1.4 * CELL[1];
    };
    heading(canvas, &mut y, "Texels around the pixel's footprint");
    for (key, text) in texel_keys(seen, layers) {
        match key {
            Key::Area(color) => {
                canvas.rect([x, y + 1.0, 14.0, 14.0], INK);
                canvas.rect([x + 1.0, y + 2.0, 12.0, 12.0], color);
            }
            Key::Line(pen) => canvas.line(&[[x - 1.0, y + 8.0], [x + 16.0, y + 8.0]], pen),
        }
        canvas.text([x + 24.0, y], &text, Size::Small, INK);
        y += 1.3 * CELL[1];
    }
    y += CELL[1];
    heading(canvas, &mut y, "Numbers");
    for line in number_lines(seen) {
        canvas.text([x, y], &line, Size::Small, INK);
        y += 1.15 * CELL[1];
    }
}

fn texel_keys(seen: &Inspection, layers: Layers) -> Vec<(Key, String)> {
    let sets = &seen.sets;
    let keys = [
        (
            layers.texels && layers.hidden,
            Key::Area(VISIBLE),
            format!("visible: {}", sets.visible.len()),
        ),
        (
            layers.texels && !layers.hidden,
            Key::Area(VISIBLE),
            format!("in the ellipse: {}", sets.all.len()),
        ),
        (
            layers.hidden,
            Key::Area(HIDDEN),
            format!("hidden by higher relief: {}", sets.hidden.len()),
        ),
        (
            layers.skipped,
            Key::Area(SKIPPED),
            format!("visible, but skipped from both ends: {}", sets.skipped.len()),
        ),
        (
            layers.twice,
            Key::Area(TWICE),
            format!("counted twice without a buffer: {}", sets.counted_twice.len()),
        ),
        (
            layers.ellipses[0],
            Key::Line(Pen::dashed(2.5, FLAT)),
            "ellipse by (2), around the polygon's place".into(),
        ),
        (
            layers.ellipses[1],
            Key::Line(Pen::solid(2.5, RELIEF)),
            "ellipse by (3), around the hit".into(),
        ),
        (
            texels::is_bounded(seen),
            Key::Line(texels::FILTERED),
            "filtered: without a jump of the relief".into(),
        ),
        (
            seen.cut.displacement > 0.0,
            Key::Line(Pen::solid(2.0, RAY)),
            "the view ray down to the hit".into(),
        ),
        (layers.rays, Key::Line(Pen::solid(1.0, TWICE)), "from hidden to covering texels".into()),
    ];
    keys.into_iter().filter(|(is_shown, ..)| *is_shown).map(|(_, key, text)| (key, text)).collect()
}

fn number_lines(seen: &Inspection) -> Vec<String> {
    let [base, hit] = [seen.ray.base, seen.ray.hit];
    let meant = &seen.readings[0];
    let sets = &seen.sets;
    let axes = |name: &str, p: &basrelief::inspect::Projected| {
        let [short, long] = p.half_axes;
        format!("{name}: axes {long:.1}, {short:.1}, area {:.0}", p.area)
    };
    let [w, h] = sets.texels_per_repeat;
    vec![
        format!("level {}: {w} x {h} texels a repeat", sets.level),
        format!("on the polygon  u {:.4} v {:.4}", base[0], base[1]),
        format!("hit             u {:.4} v {:.4}", hit[0], hit[1]),
        format!("hit depth       {:.3} of depth {:.3}", seen.ray.hit_depth, seen.relief_depth),
        format!("displacement    {:.1}, {:.1} texels", sets.displacement[0], sets.displacement[1]),
        axes("(2)", &meant.flat),
        axes("(3)", &meant.relief),
        format!(
            "T {} = visible {} + hidden {}",
            sets.all.len(),
            sets.visible.len(),
            sets.hidden.len()
        ),
    ]
}
