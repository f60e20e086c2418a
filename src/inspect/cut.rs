//! A cut through the relief along the view: polygon, ray, running horizon, visible lengths.
//!
//! The line runs through the place where the ray meets the polygon, in the direction of the
//! displacement `D`. A texel row across crosses it at `s_i`, where the relief is `d_i` deep, 0 to
//! 1, and is seen over `p_i = s_i - d_i |D|`. With the entry and exit of the ellipse of formula
//! (2), the running horizon is `M_i = max(M_(i-1), min(p_i, exit))`, and the visible length of the
//! relief between two rows is `M_i - M_(i-1)`. All in texels of the level along the line.

use super::ground::QuadPixel;
use super::ray::Ray;
use crate::footprint::{Ellipse, FootprintRule};
use crate::settings::Formulas;
use crate::texture::{Level, Surface};

/// A shorter displacement, in texels, hides nothing.
const FLAT: f64 = 1.0 / 64.0;

/// Most rows of a cut before the entry and behind the exit, as a part of the way between.
const MARGIN: f64 = 0.15;

/// The relief along the view ray. Lengths are texels along the line, 0 where the ray meets the
/// polygon.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    /// Unit vector along the line, in texels.
    pub direction: [f64; 2],
    /// How far the ray moves down to the deepest relief: |D|.
    pub displacement: f64,
    /// Depth of the deepest relief, in texels along the line.
    pub relief_depth: f64,
    /// Where the line enters and leaves the ellipse of formula (2).
    pub ellipse: [f64; 2],
    /// Where the ray meets the relief, and the depth there, 0 to 1.
    pub hit: [f64; 2],
    /// The texel rows that the line crosses, from the near end to the far one.
    pub points: Vec<CutPoint>,
}

/// Where the line crosses a row of texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutPoint {
    /// The nearest texel.
    pub texel: [i32; 2],
    /// Place along the line.
    pub along: f64,
    /// Depth of the relief, 0 to 1.
    pub depth: f64,
    /// The place on the polygon over which it is seen.
    pub projected: f64,
    /// The running horizon with this row.
    pub horizon: f64,
    /// By how much it rose: the visible length of the relief since the row before.
    pub visible: f64,
}

impl Cut {
    /// The cut of a pixel through a level.
    pub(super) fn new(
        surface: &Surface,
        seen: &QuadPixel,
        level: usize,
        max_anisotropy: f32,
    ) -> Self {
        let Ray { base, displacement, .. } = seen.ray;
        Self::along((surface, level), seen, [base, displacement], max_anisotropy)
    }

    /// The cut of the full texture along light that moves by `displacement` down to the deepest relief
    /// and reaches the pixel's hit, if nothing is in its way.
    pub(super) fn of_light(
        surface: &Surface,
        seen: &QuadPixel,
        displacement: [f32; 2],
        max_anisotropy: f32,
    ) -> Self {
        let base = [0, 1].map(|i| seen.ray.hit[i] - displacement[i] * seen.ray.hit_depth);
        Self::along((surface, 0), seen, [base, displacement], max_anisotropy)
    }

    /// The cut of a level along a ray to the pixel's hit, by where it meets the polygon and how far it
    /// moves.
    fn along(
        (surface, level): (&Surface, usize),
        seen: &QuadPixel,
        [base, displacement]: [[f32; 2]; 2],
        max_anisotropy: f32,
    ) -> Self {
        let level = &surface.levels()[level];
        let texels = level.texels_per_repeat();
        let ellipse = Ellipse::new(&seen.footprint(&FootprintRule::FLAT), texels, Formulas::Meant);
        let texels = texels.map(f64::from);
        let scaled = |p: [f32; 2]| [f64::from(p[0]) * texels[0], f64::from(p[1]) * texels[1]];
        let line = Line::new(level, scaled(base), scaled(displacement));
        let half = line.half_chord(&ellipse.bounded(max_anisotropy));
        let hit_depth = f64::from(seen.ray.hit_depth);
        // What a repeat is long on this line: the hypotenuse of its parts along u and v.
        let repeat = {
            let [u, v] = [line.direction[0] / texels[0], line.direction[1] / texels[1]];
            1.0 / (u * u + v * v).sqrt()
        };
        Self {
            direction: line.direction,
            displacement: line.displacement,
            relief_depth: f64::from(surface.relief_depth()) * repeat,
            ellipse: [-half, half],
            hit: [hit_depth * line.displacement, hit_depth],
            points: line.walk(half),
        }
    }
}

impl Cut {
    /// How many of the rows between the ellipse's entry and the row that closes the horizon are
    /// seen, and how many there are.
    pub fn num_seen(&self) -> [usize; 2] {
        let [entry, exit] = self.ellipse;
        let last = self
            .points
            .iter()
            .position(|point| point.horizon >= exit)
            .unwrap_or(self.points.len() - 1);
        let first = self.points.iter().position(|point| point.along > entry).unwrap_or(0);
        let walked = &self.points[first.min(last)..=last];
        [walked.iter().filter(|point| point.visible > 0.0).count(), walked.len()]
    }
}

/// A line over a level.
struct Line<'a> {
    level: &'a Level,
    /// Where it begins; texel centres lie at whole numbers.
    start: [f64; 2],
    direction: [f64; 2],
    /// Length of the displacement.
    displacement: f64,
    /// The axis that rows are counted along: the longer one of the direction.
    axis: usize,
}

impl<'a> Line<'a> {
    fn new(level: &'a Level, base: [f64; 2], displacement: [f64; 2]) -> Self {
        let length = displacement[0].hypot(displacement[1]);
        let is_flat = length < FLAT;
        let direction = if is_flat { [1.0, 0.0] } else { displacement.map(|d| d / length) };
        let axis = usize::from(direction[1].abs() >= direction[0].abs());
        let displacement = if is_flat { 0.0 } else { length };
        Self { level, start: base.map(|b| b - 0.5), direction, displacement, axis }
    }

    /// Half the length of the line in an ellipse around its start.
    fn half_chord(&self, ellipse: &Ellipse) -> f64 {
        let [u, v] = self.direction;
        let [a, b, c, f] = [ellipse.a, ellipse.b, ellipse.c, ellipse.f].map(f64::from);
        (f / (a * u * u + b * u * v + c * v * v)).sqrt()
    }

    /// The crossings around an ellipse that reaches `half` before and behind the start.
    fn walk(&self, half: f64) -> Vec<CutPoint> {
        let per_row = 1.0 / self.direction[self.axis].abs();
        let margin = MARGIN * (2.0 * half + self.displacement) + 2.0 * per_row;
        let toward = self.direction[self.axis].signum();
        let row_of = |s: f64| toward * self.start[self.axis] + s / per_row;
        let rows = row_of(-half - margin).floor() as i64
            ..=row_of(half + self.displacement + margin).ceil() as i64;
        let mut horizon = -half;
        let at = |row: i64| self.crossing((toward * row as f64) as i64);
        rows.map(|row| {
            let (texel, along, depth) = at(row);
            let projected = along - depth * self.displacement;
            let before = horizon;
            horizon = projected.min(half).max(horizon);
            CutPoint { texel, along, depth, projected, horizon, visible: horizon - before }
        })
        .collect()
    }

    /// Nearest texel, place along the line and depth where it crosses row or column `row`.
    fn crossing(&self, row: i64) -> ([i32; 2], f64, f64) {
        let along = (row as f64 - self.start[self.axis]) / self.direction[self.axis];
        let across = 1 - self.axis;
        let place = self.start[across] + along * self.direction[across];
        let texel = |c: f64| {
            let mut texel = [row as i32; 2];
            texel[across] = c as i32;
            texel
        };
        let [near, far] = [0.0, 1.0].map(|step| {
            let [x, y] = texel(place.floor() + step);
            1.0 - f64::from(self.level.height_at(x, y))
        });
        (texel(place.round()), along, near + (far - near) * (place - place.floor()))
    }
}
