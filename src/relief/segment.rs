//! Where a straight piece of a path first meets the relief: one at a time, in f64.
//!
//! The path goes down or up, and need not begin on the polygon: on a curved mesh a view ray is a
//! chain of such pieces. It descends the pyramid of maxima as [`march`](super::march) does.

use super::height_field::HeightField;
use crate::texture::FULL_F32;

/// Most steps of a path, over all its pieces: hostile texture coordinates make pieces of any length,
/// and a ray has thousands of them. The most on a torus of four million triangles under a texture of
/// 2048 x 2048, seen flat, are 2364.
pub const MOST_STEPS: u32 = 1 << 14;

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
    /// One over the step.
    inverse: [f64; 2],
    depth: [f64; 2],
}

/// Where a path is along an axis.
#[derive(Clone, Copy)]
struct Axis {
    /// Its cell, and that in the stored pattern.
    cell: i32,
    stored: i32,
}

impl HeightField {
    /// Whether a place lies within the relief.
    pub fn holds(&self, place: &ReliefPlace) -> bool {
        let [u, v] = [0, 1].map(|i| place.uv[i] * f64::from(self.texels_per_repeat[i]));
        self.height_at(u, v) + place.depth >= 1.0
    }

    /// How far, 0 to 1, it is on the straight way between two places to where relief is first met;
    /// 0 where the first lies in the relief already.
    ///
    /// Each node that is looked at takes one of the steps that the whole path has left, and each piece
    /// at least one. When none is left the path ends where it is, as if it hit relief there.
    pub fn first_hit(
        &self,
        from: &ReliefPlace,
        to: &ReliefPlace,
        steps_left: &mut u32,
    ) -> Option<f64> {
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
        let inverse = step.map(|step| 1.0 / step);
        let depth = [from.depth, to.depth - from.depth];
        let piece = Piece { field: self, start, step, inverse, depth };
        let is_finite = step.iter().chain(&depth).all(|c| c.is_finite());
        if is_finite { piece.first_hit(steps_left) } else { Some(0.0) }
    }
}

impl Piece<'_> {
    fn first_hit(&self, steps_left: &mut u32) -> Option<f64> {
        let field = self.field;
        let longest = self.step[0].abs().max(self.step[1].abs());
        let top = field.first_level(longest as f32);
        let mut axes = [0, 1].map(|i| {
            let cell = self.start[i].floor() as i32;
            Axis { cell, stored: field.fold(i, cell) }
        });
        let (mut at, mut level) = (0.0_f64, top);
        while *steps_left > 0 {
            *steps_left -= 1;
            // Beyond the edges of a clamped pattern there are cells alone.
            if field.is_clamped
                && axes.iter().any(|axis| axis.stored < 0 || axis.stored != axis.cell)
            {
                level = 0;
            }
            let nodes = [0, 1].map(|i| self.node(i, axes[i], level));
            let (exit, first) = self.exit(&nodes, at);
            let end = exit.min(1.0);
            // The path is lowest at one of its ends.
            let deepest =
                self.depth[0] + self.depth[1] * if self.depth[1] > 0.0 { end } else { at };
            let stored = axes.map(|axis| axis.stored);
            if deepest + field.height_above(level, stored) >= 1.0 {
                if level > 0 {
                    level -= 1;
                    continue;
                }
                if let Some(hit) = self.hit_in_cell(&axes, at, end) {
                    return Some(hit);
                }
            }
            if exit >= 1.0 {
                return None;
            }
            at = exit;
            axes = [0, 1].map(|i| {
                let [low, high] = nodes[i];
                let next = match i == first {
                    true if self.step[i] < 0.0 => low - 1,
                    true => high,
                    // Along the other axis the path is where it is, within the node.
                    false => {
                        ((self.start[i] + self.step[i] * at).floor() as i32).clamp(low, high - 1)
                    }
                };
                self.moved(i, axes[i], next)
            });
            level = (level + 1).min(top);
        }
        Some(at)
    }

    /// The first cell of a level's node along an axis, and the first beyond it.
    #[inline(always)]
    fn node(&self, i: usize, axis: Axis, level: i32) -> [i32; 2] {
        let size = 1 << level;
        let low = axis.cell - (axis.stored & (size - 1));
        // The last node of a pattern may be smaller than others.
        let end = axis.cell + (self.field.size[i] - axis.stored).max(1);
        [low, end.min(low + size)]
    }

    /// How far it is to where the path leaves a node, and along which axis it does.
    #[inline(always)]
    fn exit(&self, nodes: &[[i32; 2]; 2], at: f64) -> (f64, usize) {
        let ways = [0, 1].map(|i| {
            let edge = if self.step[i] < 0.0 { nodes[i][0] } else { nodes[i][1] };
            let way = (f64::from(edge) - self.start[i]) * self.inverse[i];
            if self.step[i] == 0.0 { f64::INFINITY } else { way.max(at) }
        });
        let first = usize::from(ways[1] < ways[0]);
        (ways[first], first)
    }

    /// The place of another cell, of the same pattern or one beside it.
    #[inline(always)]
    fn moved(&self, i: usize, axis: Axis, cell: i32) -> Axis {
        let size = self.field.size[i];
        let stored = axis.stored + (cell - axis.cell);
        let stored = match self.field.is_clamped {
            true => self.field.fold(i, cell),
            false if stored >= size => stored - size,
            false if stored < 0 => stored + size,
            false => stored,
        };
        Axis { cell, stored }
    }

    /// The first crossing with a cell's bilinear patch between two points of the way.
    fn hit_in_cell(&self, axes: &[Axis; 2], at: f64, end: f64) -> Option<f64> {
        let heights = self.field.corners(axes[0].stored, axes[1].stored);
        let [h00, h10, h01, h11] = heights.map(|height| f64::from(height) / f64::from(FULL_F32));
        let [x, y] = [0, 1].map(|i| self.start[i] + self.step[i] * at - f64::from(axes[i].cell));
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
