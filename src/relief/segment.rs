//! Where a straight piece of a path first meets the relief: one at a time, in f64.
//!
//! The path goes down or up, and need not begin on the polygon: on a curved mesh a view ray is a
//! chain of such pieces. It descends the pyramid of maxima as [`march`](super::march) does.

use super::height_field::HeightField;
use crate::texture::FULL_F32;

/// Most nodes of a piece: hostile texture coordinates make pieces of any length. Such a piece then
/// ends where it is.
const MAX_STEPS: u32 = 1 << 14;

/// A place in the relief of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReliefPlace {
    /// Texture coordinates in repeats.
    pub uv: [f64; 2],
    /// How deep below the polygon, 0 to 1.
    pub depth: f64,
}

impl ReliefPlace {
    /// The place that is so far, 0 to 1, on the way to another.
    #[must_use]
    pub fn toward(&self, end: &Self, part: f64) -> Self {
        let between = |a: f64, b: f64| a + (b - a) * part;
        let uv = [0, 1].map(|i| between(self.uv[i], end.uv[i]));
        Self { uv, depth: between(self.depth, end.depth) }
    }
}

/// A piece of a path in cells: texel centres lie at whole numbers.
struct Piece<'a> {
    field: &'a HeightField,
    start: [f64; 2],
    step: [f64; 2],
    depth: [f64; 2],
}

impl HeightField {
    /// How far, 0 to 1, it is on the straight way between two places to where relief is first met;
    /// 0 where the first lies in the relief already.
    pub fn first_hit(&self, from: &ReliefPlace, to: &ReliefPlace) -> Option<f64> {
        let cells = |place: &ReliefPlace, i: usize| {
            place.uv[i] * f64::from(self.texels_per_repeat[i]) - 0.5
        };
        let [start, end] = [from, to].map(|place| [0, 1].map(|i| cells(place, i)));
        let step = [0, 1].map(|i| end[i] - start[i]);
        // Whole patterns are taken off, so that cells can be counted.
        let start = [0, 1].map(|i| {
            let size = f64::from(self.size[i]);
            let whole = if self.is_clamped { 0.0 } else { (start[i] / size).floor() * size };
            (start[i] - whole).clamp(-1e9, 1e9)
        });
        let piece = Piece { field: self, start, step, depth: [from.depth, to.depth - from.depth] };
        if step.iter().chain(&piece.depth).all(|c| c.is_finite()) {
            piece.first_hit()
        } else {
            Some(0.0)
        }
    }
}

impl Piece<'_> {
    fn first_hit(&self) -> Option<f64> {
        let field = self.field;
        let longest = self.step[0].abs().max(self.step[1].abs());
        let top = field.first_level(longest as f32);
        let mut cell = self.start.map(|c| c.floor() as i64);
        let (mut at, mut level) = (0.0_f64, top);
        for _ in 0..MAX_STEPS {
            let folded = [0, 1].map(|i| field.fold(i, cell[i].clamp(-1 << 30, 1 << 30) as i32));
            // Beyond the edges of a clamped pattern there are cells alone.
            if field.is_clamped && (0..2).any(|i| folded[i] < 0 || i64::from(folded[i]) != cell[i])
            {
                level = 0;
            }
            let node = [0, 1].map(|i| self.node(i, cell[i], folded[i], level));
            let (exit, axis) = self.exit(&node, at);
            let end = exit.min(1.0);
            let deepest = self.depth[0] + (self.depth[1] * at).max(self.depth[1] * end);
            if deepest + field.height_above(level, folded) >= 1.0 {
                if level > 0 {
                    level -= 1;
                    continue;
                }
                if let Some(hit) = self.hit_in_cell(cell, folded, at, end) {
                    return Some(hit);
                }
            }
            if exit >= 1.0 {
                return None;
            }
            // Along the other axis the path is where it is, within the node.
            at = exit;
            let (other, [low, high]) = (1 - axis, node[1 - axis]);
            let place = (self.start[other] + self.step[other] * at).floor() as i64;
            cell[other] = place.clamp(low, high - 1);
            cell[axis] = if self.step[axis] < 0.0 { node[axis][0] - 1 } else { node[axis][1] };
            level = (level + 1).min(top);
        }
        Some(at)
    }

    /// The first cell of a level's node along an axis, and the first beyond it.
    fn node(&self, axis: usize, cell: i64, folded: i32, level: i32) -> [i64; 2] {
        let size = 1_i64 << level;
        let low = cell - (i64::from(folded) & (size - 1));
        // The last node of a pattern may be smaller than others.
        let end = cell + i64::from((self.field.size[axis] - folded).max(1));
        [low, end.min(low + size)]
    }

    /// How far it is to where the path leaves a node, and along which axis it does.
    fn exit(&self, node: &[[i64; 2]; 2], at: f64) -> (f64, usize) {
        let ways = [0, 1].map(|i| {
            let edge = node[i][usize::from(self.step[i] >= 0.0)];
            let way = (edge as f64 - self.start[i]) / self.step[i];
            if self.step[i] == 0.0 { f64::INFINITY } else { way.max(at) }
        });
        let axis = usize::from(ways[1] < ways[0]);
        (ways[axis], axis)
    }

    /// The first crossing with a cell's bilinear patch between two points of the way.
    fn hit_in_cell(&self, cell: [i64; 2], [i, j]: [i32; 2], at: f64, end: f64) -> Option<f64> {
        let heights = self.field.corners(i, j);
        let [h00, h10, h01, h11] = heights.map(|height| f64::from(height) / f64::from(FULL_F32));
        let [x, y] = [0, 1].map(|i| self.start[i] + self.step[i] * at - cell[i] as f64);
        let [dx, dy] = self.step;
        let (hx, hy, hxy) = (h10 - h00, h01 - h00, h00 - h10 - h01 + h11);
        // f(s) = a s^2 + b s + c: how far the path is below the relief, s on from `at`.
        let a = hxy * dx * dy;
        let b = self.depth[1] + hx * dx + hy * dy + hxy * (x * dy + y * dx);
        let c = self.depth[0] + self.depth[1] * at - 1.0 + h00 + hx * x + hy * y + hxy * x * y;
        if c >= 0.0 {
            return Some(at);
        }
        first_root([a, b, c]).filter(|root| at + root <= end).map(|root| at + root)
    }
}

/// The least root, above 0, of `a s^2 + b s + c` where `c < 0`.
fn first_root([a, b, c]: [f64; 3]) -> Option<f64> {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    // Both roots by the form that does not cancel.
    let root = discriminant.sqrt();
    let q = -0.5 * (b + if b >= 0.0 { root } else { -root });
    [c / q, q / a].into_iter().filter(|root| *root > 0.0).min_by(f64::total_cmp)
}
