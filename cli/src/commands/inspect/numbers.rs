//! The numbers of an inspected pixel, formula by formula, as text or JSON.

use crate::commands::inspect::subject::Subject;
use crate::options::choices::word;
use crate::refusal::Refusal;
use basrelief::inspect::Ellipse;
use basrelief::inspect::{
    Corner, Cut, Inspection, PixelLight, Projected, Ray, Reaching, Reading, Sets,
};
use basrelief::{Derivatives, FootprintRule, Formulas, Light};
use serde::Serialize;
use std::fmt::Write;

/// The letters of the paper for the six texture offsets.
const OFFSETS: [[&str; 2]; 3] = [["m", "r"], ["n", "o"], ["p", "s"]];

/// The right sides of formulas (2) and (3), as meant and as printed, from du/dx to dv/dy.
const RIGHT_SIDES: [[[&str; 4]; 2]; 2] = [
    [
        ["u(x+1,y) - u(x,y)", "v(x+1,y) - v(x,y)", "u(x,y+1) - u(x,y)", "v(x,y+1) - v(x,y)"],
        ["u(x+1,y) - u(x,y)", "v(x+1,y) - u(x,y)", "u(x,y+1) - u(x,y)", "v(x,y+1) - u(x,y)"],
    ],
    [
        [
            "(u(x+1,y) + n) - (u(x,y) + m)",
            "(v(x+1,y) + o) - (v(x,y) + r)",
            "(u(x,y+1) + p) - (u(x,y) + m)",
            "(v(x,y+1) + s) - (v(x,y) + r)",
        ],
        [
            "u(x+1,y) + n - u(x,y) + m",
            "v(x+1,y) + o - u(x,y) + m",
            "u(x,y+1) + p - v(x,y) + r",
            "v(x,y+1) + s - v(x,y) + r",
        ],
    ],
];

/// Lines for people.
pub(crate) fn text(seen: &Inspection, subject: &Subject) -> String {
    let mut text = subject.title.map(|title| format!("{title}\n")).unwrap_or_default();
    let [x, y] = seen.pixel;
    let size = format!("{}x{}", subject.settings.width, subject.settings.height);
    let _ = writeln!(text, "pixel {x},{y} of {size}: {}", subject.surface(seen));
    push_ray(&mut text, &seen.ray, seen);
    push_corners(&mut text, seen);
    for (formula, derivatives) in [(2, Derivatives::Flat), (3, Derivatives::Relief)] {
        seen.readings
            .iter()
            .for_each(|reading| push_formula(&mut text, formula, derivatives, reading));
    }
    push_sets(&mut text, &seen.sets, subject);
    push_cut(&mut text, &seen.cut);
    if let Some(light) = &seen.light {
        push_light(&mut text, light, subject);
    }
    text
}

fn push_light(text: &mut String, light: &PixelLight, subject: &Subject) {
    let rgb = |c: glam::Vec3| format!("{:.4} {:.4} {:.4}", c.x, c.y, c.z);
    let Reaching { lights, sky, open } = &light.reaching;
    let _ =
        writeln!(text, "\nthe light that reaches the hit, and what it lights a white surface to");
    for (i, found) in lights.iter().enumerate() {
        let kind = match subject.scene.lights[i] {
            Light::Sun { .. } => "sun",
            Light::Point { .. } => "point",
        };
        let main = if light.main == Some(i) { ", the main one" } else { "" };
        let name = format!("{kind} {i}{main}");
        let (part, shown) = (found.part * 100.0, rgb(found.shown));
        let _ = writeln!(text, "  {name:<24} {part:5.1} % of it   {shown}");
    }
    let _ = writeln!(text, "  {:<24} {:5.1} % open    {}", "sky", open * 100.0, rgb(*sky));
    let _ = writeln!(text, "  {:<24} {:16} {}", "all", "", rgb(light.reaching.shown()));
    if let Some(cut) = &light.cut {
        let [lit, all] = cut.num_seen();
        let length: f64 = cut.points.iter().map(|point| point.visible).sum();
        let _ = writeln!(
            text,
            "  along the main light's way: {lit} of {all} rows are lit; lit lengths add up to {length:.2} texels"
        );
    }
}

fn push_ray(text: &mut String, ray: &Ray, seen: &Inspection) {
    let Ray { base: [u, v], displacement: [du, dv], hit_depth, hit: [hu, hv] } = *ray;
    let [tu, tv] = seen.sets.displacement;
    let _ = writeln!(text, "\nthe view ray (in texture repeats; u to the right, v upwards)");
    let _ = writeln!(text, "  meets the polygon at   u {u:.6}  v {v:.6}");
    let _ = writeln!(
        text,
        "  moves by               u {du:.6}  v {dv:.6} down to the relief depth {:.4}",
        seen.relief_depth
    );
    let _ = writeln!(
        text,
        "                         ({tu:.1} and {tv:.1} texels of level {})",
        seen.sets.level
    );
    let _ = writeln!(
        text,
        "  meets the relief at    u {hu:.6}  v {hv:.6}, {hit_depth:.4} of the depth"
    );
}

fn push_corners(text: &mut String, seen: &Inspection) {
    let [left, right] = seen.readings[0].row;
    let [upper, lower] = seen.readings[0].column;
    let _ =
        writeln!(text, "\ntexture coordinates in the pixel's 2x2 quad, and what the relief adds");
    let corners = [("(x,y)    in its row   ", left, 0), ("(x+1,y)  in its row   ", right, 1)];
    let of_column = [("(x,y)    in its column", upper, 0), ("(x,y+1)  in its column", lower, 2)];
    for (name, Corner { uv, offset }, letters) in corners.into_iter().chain(of_column) {
        let [a, b] = OFFSETS[letters];
        let [[u, v], [du, dv]] = [uv, offset];
        let _ = writeln!(text, "  {name}  u {u:.6}  v {v:.6}   {a} {du:+.6}  {b} {dv:+.6}");
    }
}

fn push_formula(text: &mut String, formula: u32, derivatives: Derivatives, reading: &Reading) {
    let is_printed = usize::from(reading.formulas == Formulas::Printed);
    let (projected, sides) = match derivatives {
        Derivatives::Flat => (&reading.flat, RIGHT_SIDES[0][is_printed]),
        Derivatives::Relief => (&reading.relief, RIGHT_SIDES[1][is_printed]),
    };
    let _ = writeln!(text, "\nformula ({formula}) as {}, in repeats", word(&reading.formulas));
    let values = [projected.dx[0], projected.dx[1], projected.dy[0], projected.dy[1]];
    for ((name, side), value) in ["du/dx", "dv/dx", "du/dy", "dv/dy"].iter().zip(sides).zip(values)
    {
        let _ = writeln!(text, "  {name} = {side:<30} = {value:+.9}");
    }
    let f = if is_printed == 1 { "F = (Ux Vy + Uy Vx)^2" } else { "F = (Ux Vy - Uy Vx)^2" };
    let Ellipse { a, b, c, f: right } = projected.conic;
    let _ = writeln!(text, "formula (1) of it, in texels");
    let sides =
        [("A = Vx^2 + Vy^2", a), ("B = -2 (Ux Vx + Uy Vy)", b), ("C = Ux^2 + Uy^2", c), (f, right)];
    for (side, value) in sides {
        let _ = writeln!(text, "  {side:<38} = {value:.6}");
    }
    let [short, long] = projected.half_axes;
    let area = projected.area;
    let _ = writeln!(
        text,
        "  widened for filtering: half axes {long:.2} and {short:.2}, area {area:.1} texels"
    );
}

fn push_sets(text: &mut String, sets: &Sets, subject: &Subject) {
    let [w, h] = sets.texels_per_repeat;
    let FootprintRule { derivatives, formulas, .. } = subject.settings.filter.traits().rule;
    let (of, reading) = (word(&derivatives), word(&formulas));
    let counted = sets.counted_twice.iter().map(|(_, count)| count - 1).sum::<u32>();
    let _ = writeln!(
        text,
        "\ntexels of level {} ({w}x{h} a repeat), {of} derivatives as {reading}",
        sets.level
    );
    for (name, num) in [
        ("T, in the ellipse around the hit", sets.all.len()),
        ("T_vis, visible", sets.visible.len()),
        ("T_invis, hidden", sets.hidden.len()),
        ("visible, skipped by the scan from both ends", sets.skipped.len()),
        ("counted more than once without a buffer", sets.counted_twice.len()),
        ("  and times too many", counted as usize),
    ] {
        let _ = writeln!(text, "  {name:<46} {num}");
    }
}

fn push_cut(text: &mut String, cut: &Cut) {
    let [entry, exit] = cut.ellipse;
    let [seen, all] = cut.num_seen();
    let length: f64 = cut.points.iter().map(|point| point.visible).sum();
    let _ =
        writeln!(text, "\nthe cut along the view, in texels from where the ray meets the polygon");
    let _ = writeln!(text, "  the ellipse of formula (2) reaches from {entry:.2} to {exit:.2}");
    let _ = writeln!(
        text,
        "  the ray meets the relief at {:.2}, {:.4} of the depth",
        cut.hit[0], cut.hit[1]
    );
    let _ = writeln!(
        text,
        "  rows that make the horizon rise: {seen} of {all}; their visible lengths add up to {length:.2}"
    );
}

/// One JSON object.
pub(crate) fn json(seen: &Inspection, subject: &Subject) -> Result<String, Refusal> {
    let report = Report::new(seen, subject);
    Ok(serde_json::to_string(&report).map_err(|e| format!("--json: {e}"))? + "\n")
}

/// Lengths are in repeats where nothing else is said.
#[derive(Serialize)]
struct Report<'a> {
    pixel: [u32; 2],
    width: u32,
    height: u32,
    mesh: usize,
    triangle: usize,
    material: usize,
    relief_depth: f32,
    base: [f32; 2],
    displacement: [f32; 2],
    hit_depth: f32,
    hit: [f32; 2],
    readings: Vec<ReadingReport>,
    level: usize,
    texels_per_repeat: [f32; 2],
    displacement_texels: [f32; 2],
    texels: &'a [[i32; 2]],
    visible: &'a [[i32; 2]],
    hidden: &'a [[i32; 2]],
    skipped_by_two_ended: &'a [[i32; 2]],
    covered_by: &'a [[[i32; 2]; 2]],
    counted_twice: &'a [([i32; 2], u32)],
    cut: CutReport,
    light: Option<LightReport>,
}

/// Linear RGB: what a white surface is lit to.
#[derive(Serialize)]
struct LightReport {
    /// Of each light: the part that nothing hides, and what it shows.
    lights: Vec<(f32, [f32; 3])>,
    sky: [f32; 3],
    /// The part of the sky that nothing hides.
    open: f32,
    main: Option<usize>,
    /// Along the main light's way, in texels.
    cut: Option<CutReport>,
}

#[derive(Serialize)]
struct ReadingReport {
    formulas: &'static str,
    /// (x, y) and (x+1, y): u, v, and the offsets.
    row: [[f32; 4]; 2],
    /// (x, y) and (x, y+1).
    column: [[f32; 4]; 2],
    formula_2: ProjectedReport,
    formula_3: ProjectedReport,
}

#[derive(Serialize)]
struct ProjectedReport {
    dudx: f32,
    dvdx: f32,
    dudy: f32,
    dvdy: f32,
    /// In texels.
    center: [f32; 2],
    /// A, B, C, F in texels.
    ellipse: [f32; 4],
    widened_ellipse: [f32; 4],
    area_texels: f32,
    half_axes_texels: [f32; 2],
}

/// In texels along the view.
#[derive(Serialize)]
struct CutReport {
    direction: [f64; 2],
    displacement: f64,
    relief_depth: f64,
    ellipse: [f64; 2],
    hit: [f64; 2],
    /// Column, row, place, depth, place seen over, running horizon, visible length.
    points: Vec<(i32, i32, f64, f64, f64, f64, f64)>,
}

impl<'a> Report<'a> {
    fn new(seen: &'a Inspection, subject: &Subject) -> Self {
        let Inspection { sets, cut, ray, .. } = seen;
        Self {
            pixel: seen.pixel,
            width: subject.settings.width,
            height: subject.settings.height,
            mesh: seen.mesh,
            triangle: seen.triangle,
            material: seen.material,
            relief_depth: seen.relief_depth,
            base: ray.base,
            displacement: ray.displacement,
            hit_depth: ray.hit_depth,
            hit: ray.hit,
            readings: seen.readings.iter().map(ReadingReport::new).collect(),
            level: sets.level,
            texels_per_repeat: sets.texels_per_repeat,
            displacement_texels: sets.displacement,
            texels: &sets.all,
            visible: &sets.visible,
            hidden: &sets.hidden,
            skipped_by_two_ended: &sets.skipped,
            covered_by: &sets.covered_by,
            counted_twice: &sets.counted_twice,
            cut: CutReport::new(cut),
            light: seen.light.as_ref().map(LightReport::new),
        }
    }
}

impl LightReport {
    fn new(light: &PixelLight) -> Self {
        let Reaching { lights, sky, open } = &light.reaching;
        Self {
            lights: lights.iter().map(|light| (light.part, light.shown.to_array())).collect(),
            sky: sky.to_array(),
            open: *open,
            main: light.main,
            cut: light.cut.as_ref().map(CutReport::new),
        }
    }
}

impl ReadingReport {
    fn new(reading: &Reading) -> Self {
        let corner = |Corner { uv, offset }: Corner| [uv[0], uv[1], offset[0], offset[1]];
        Self {
            formulas: word(&reading.formulas),
            row: reading.row.map(corner),
            column: reading.column.map(corner),
            formula_2: ProjectedReport::new(&reading.flat),
            formula_3: ProjectedReport::new(&reading.relief),
        }
    }
}

impl ProjectedReport {
    fn new(projected: &Projected) -> Self {
        let numbers = |Ellipse { a, b, c, f }: Ellipse| [a, b, c, f];
        Self {
            dudx: projected.dx[0],
            dvdx: projected.dx[1],
            dudy: projected.dy[0],
            dvdy: projected.dy[1],
            center: projected.center,
            ellipse: numbers(projected.conic),
            widened_ellipse: numbers(projected.widened),
            area_texels: projected.area,
            half_axes_texels: projected.half_axes,
        }
    }
}

impl CutReport {
    fn new(cut: &Cut) -> Self {
        let points = cut.points.iter().map(|point| {
            let [x, y] = point.texel;
            (x, y, point.along, point.depth, point.projected, point.horizon, point.visible)
        });
        Self {
            direction: cut.direction,
            displacement: cut.displacement,
            relief_depth: cut.relief_depth,
            ellipse: cut.ellipse,
            hit: cut.hit,
            points: points.collect(),
        }
    }
}
