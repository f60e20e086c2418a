//! Whether a ray that leaves the relief upwards comes out of it: what light reaches a hit.
//!
//! One ray at a time, cell by cell, in f64: this is the truth, and need not be fast.
//!
//! ```text
//!            light
//!        lit  /              __ a point lies on the relief by definition: the march's depth is not
//!      ______/      ______  /   used, so that nothing has to be let pass near the start. In its own
//!     /     p\     /      \     cell one root of the ray's quadratic is the point itself, exactly.
//!   _/        \___/__q_____\    If the ray starts inwards, or the other root lies ahead: dark.
//! ```

use super::MAX_SLOPE;
use super::height_field::HeightField;
use crate::texture::FULL_F32;

/// A ray as near as this to the relief, in whole depths, is on it: what rounding leaves of 0.
const TOUCHES: f64 = 1e-12;

/// A ray from the relief upwards.
#[derive(Clone, Copy, Debug)]
pub struct Climb {
    /// Its place in cells: texel centres lie at whole numbers.
    place: [f64; 2],
    /// How far it moves, in cells, while it rises from the deepest relief to the polygon.
    step: [f64; 2],
    /// Where it starts, 0 the deepest relief and 1 the polygon.
    height: f64,
}

impl Climb {
    /// From the relief at `place`, in repeats, along a direction that goes along u, along v (in
    /// repeats) and up (in world lengths of a repeat); `None` if it goes down. As flat as view rays
    /// may be: what is flatter than 1 in 64 is followed at that slope.
    pub fn new(field: &HeightField, place: [f32; 2], [u, v, up]: [f64; 3]) -> Option<Self> {
        if up.is_nan() || up <= 0.0 {
            return None;
        }
        let along = (u * u + v * v).sqrt();
        let scale = f64::from(field.relief_depth) / up.max(along / f64::from(MAX_SLOPE));
        let per_repeat = field.texels_per_repeat.map(f64::from);
        let step = [u * scale * per_repeat[0], v * scale * per_repeat[1]];
        let place = [0, 1].map(|axis| {
            let size = f64::from(field.size[axis]);
            let texels = f64::from(place[axis]) * per_repeat[axis];
            // Whole patterns are taken off, so that cells can be counted.
            let whole = if field.is_clamped { 0.0 } else { (texels / size).floor() * size };
            (texels - whole).clamp(-128.0 * size, 128.0 * size) - 0.5
        });
        let height = field.height_at(place[0] + 0.5, place[1] + 0.5);
        let is_finite = step.iter().all(|step| step.abs() < 1e12);
        is_finite.then_some(Self { place, step, height })
    }

    /// How deep the place lies below the polygon, 0 to 1.
    pub fn depth(&self) -> f64 {
        1.0 - self.height
    }

    /// Whether nothing is met on the way up to the polygon, or up to a height of `most` above the
    /// start, in whole depths.
    pub fn is_free(&self, field: &HeightField, most: f64) -> bool {
        let end = most.min(1.0 - self.height);
        let forwards = self.step.map(|step| step >= 0.0);
        let mut cell = self.place.map(|c| c.floor() as i64);
        let mut risen = 0.0;
        while risen < end {
            // Find where the ray leaves the cell.
            let exits = [0, 1].map(|axis| {
                let edge = cell[axis] + i64::from(forwards[axis]);
                let way = (edge as f64 - self.place[axis]) / self.step[axis];
                if self.step[axis] == 0.0 { f64::INFINITY } else { way }
            });
            let first = usize::from(exits[1] < exits[0]);
            let exit = exits[first].max(risen);
            // A ray that starts on an edge is not in the cell behind it.
            if exit > risen && self.meets(field, cell, [risen, exit.min(end)]) {
                return false;
            }
            risen = exit;
            cell[first] += if forwards[first] { 1 } else { -1 };
        }
        true
    }

    /// Whether the ray meets the bilinear patch of a cell between two heights above its start.
    fn meets(&self, field: &HeightField, cell: [i64; 2], [from, to]: [f64; 2]) -> bool {
        let [i, j] = [0, 1].map(|axis| field.fold(axis, cell[axis] as i32));
        let [h00, h10, h01, h11] =
            field.corners(i, j).map(|height| f64::from(height) / f64::from(FULL_F32));
        let height = self.height + from;
        if h00.max(h10).max(h01).max(h11) < height - TOUCHES {
            return false;
        }
        // f(t) = a t^2 + b t + c: how far the relief is above the ray, t above `from`.
        let [x, y] =
            [0, 1].map(|axis| self.place[axis] + self.step[axis] * from - cell[axis] as f64);
        let [dx, dy] = self.step;
        let (hx, hy, hxy) = (h10 - h00, h01 - h00, h00 - h10 - h01 + h11);
        let a = hxy * dx * dy;
        let b = hx * dx + hy * dy + hxy * (x * dy + y * dx) - 1.0;
        let c = h00 + hx * x + hy * y + hxy * x * y - height;
        let ahead = to - from;
        if c > -TOUCHES {
            // On the relief: of the two roots 0 is the place itself.
            return b > 0.0 || (a > 0.0 && -b < a * ahead);
        }
        rises_above(a, b, c, ahead)
    }
}

/// Whether `a t^2 + b t + c`, below 0 at 0, comes to 0 by `end`.
fn rises_above(a: f64, b: f64, c: f64, end: f64) -> bool {
    if (a * end + b) * end + c >= 0.0 {
        return true;
    }
    // Else only a maximum between the two ends can.
    a < 0.0 && b > 0.0 && b < -2.0 * a * end && b * b >= 4.0 * a * c
}
