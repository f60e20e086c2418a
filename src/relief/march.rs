//! The first hit of a view ray with the bilinear height field.
//!
//! The ray is at `b + t D` at the depth `t` (0 on the polygon, 1 deepest), where the relief's depth is `1 - h`. It
//! descends the pyramid of maxima: a node whose greatest height stays under the ray is left at its far side, others are
//! opened; in a cell the crossing of the ray with the bilinear patch, a quadratic in t, is solved. So no feature is
//! stepped over, however thin. Eight rays are traced at once; a lane is a pixel.

use super::{HeightField, MAX_SLOPE, finite};
use crate::simd::PixelLanes;

/// Most steps of a ray. A walk of 64 repeats over a map of any size that opens every node takes fewer in practice;
/// the bound makes the time of a hostile input finite, and the ray then ends where it is.
const MAX_STEPS: usize = 1 << 14;

/// Most patterns from the first that a ray over a clamped map starts at: all beyond looks like its edge.
const FARTHEST: f32 = 128.0;

/// Part of a texel that a ray is moved past a node's edge, so that rounding cannot keep it inside.
const NUDGE: f32 = 1.0 / 1024.0;

/// The depth `t`, 0 to 1, of the first hit of the rays from `base` along `displacement`, both in repeats.
#[must_use]
pub fn march(field: &HeightField, base: &[PixelLanes; 2], displacement: &[PixelLanes; 2]) -> PixelLanes {
    let [nu, nv] = field.texels_per_repeat;
    // Whole repeats are taken off first, so that far tiles keep their precision.
    let start = |b: PixelLanes, n: f32, size: i32| {
        let patterns = finite(b * (n / size as f32));
        let whole = if field.is_clamped { PixelLanes::ZERO } else { patterns.floor() };
        (patterns - whole).fast_max(PixelLanes::splat(-FARTHEST)).fast_min(PixelLanes::splat(FARTHEST)) * size as f32 - 0.5
    };
    let bounded = |d: PixelLanes| finite(d).fast_max(PixelLanes::splat(-MAX_SLOPE)).fast_min(PixelLanes::splat(MAX_SLOPE));
    let mut rays = Rays {
        start: [start(base[0], nu, field.size[0]), start(base[1], nv, field.size[1])],
        step: [bounded(displacement[0]) * nu, bounded(displacement[1]) * nv],
        depth: PixelLanes::ZERO,
        level: [field.num_levels() - 1; 8],
        is_done: 0,
    };
    for _ in 0..MAX_STEPS {
        rays.advance(field);
        if rays.is_done == 0xff {
            break;
        }
    }
    rays.depth.fast_min(PixelLanes::ONE)
}

/// Eight rays on their way. Places are in cells: texel centres lie at whole numbers.
struct Rays {
    start: [PixelLanes; 2],
    step: [PixelLanes; 2],
    depth: PixelLanes,
    level: [i32; 8],
    is_done: u32,
}

impl Rays {
    /// Moves every ray by one node or one level.
    fn advance(&mut self, field: &HeightField) {
        let place = [self.start[0] + self.step[0] * self.depth, self.start[1] + self.step[1] * self.depth];
        let cell = place.map(PixelLanes::floor);
        let (xs, ys) = (cell[0].to_array(), cell[1].to_array());
        let mut nodes = Nodes::default();
        let mut folded = [[0; 2]; 8];
        for lane in 0..8 {
            if self.is_done >> lane & 1 == 1 {
                continue;
            }
            let (x, y, level) = (xs[lane] as i32, ys[lane] as i32, self.level[lane]);
            folded[lane] = [field.fold(0, x), field.fold(1, y)];
            nodes.set(lane, field, [x, y], folded[lane], level);
        }
        let [exit, leave] = [0.0, NUDGE].map(|nudge| self.depth_at_exit(&place, &nodes, nudge));
        let height = PixelLanes::new(nodes.max_height) * (1.0 / 65535.0);
        // The ray descends, so it is lowest where it leaves the node.
        let is_above = (PixelLanes::ONE - leave).simd_gt(height).to_bitmask();
        let hit = if (nodes.is_cell & !self.is_done) != 0 { self.cell_hit(field, &place, &cell, &folded) } else { leave };
        // A crossing beyond the edge is the next node's.
        let is_hit = hit.simd_le(exit).to_bitmask() & nodes.is_cell;
        self.settle(field, [leave, hit], is_hit, nodes.is_cell | is_above);
    }

    /// Depth at which the rays are a nudge beyond their nodes.
    fn depth_at_exit(&self, place: &[PixelLanes; 2], nodes: &Nodes, nudge: f32) -> PixelLanes {
        let mut advance = PixelLanes::splat(2.0);
        for axis in 0..2 {
            let step = self.step[axis];
            let forwards = step.simd_gt(PixelLanes::ZERO);
            let low = PixelLanes::new(nodes.low[axis]) - place[axis] - nudge;
            let high = PixelLanes::new(nodes.high[axis]) - place[axis] + nudge;
            let distance = forwards.select(high, low);
            let is_moving = step.abs().simd_gt(PixelLanes::splat(1e-12));
            let depth = is_moving.select(distance / is_moving.select(step, PixelLanes::ONE), PixelLanes::splat(2.0));
            advance = advance.fast_min(depth);
        }
        (self.depth + advance.fast_max(PixelLanes::ZERO)).fast_min(PixelLanes::ONE)
    }

    /// Depth of the first crossing with the patch of each ray's cell; 2 where there is none.
    ///
    /// Along the ray `f(tau) = depth + tau - 1 + h = a tau^2 + b tau + c`; the hit is the first `tau >= 0` with `f >= 0`.
    fn cell_hit(&self, field: &HeightField, place: &[PixelLanes; 2], cell: &[PixelLanes; 2], folded: &[[i32; 2]; 8]) -> PixelLanes {
        let mut corners = [[0.0_f32; 8]; 4];
        for lane in 0..8 {
            let heights = field.corners(folded[lane][0], folded[lane][1]);
            (0..4).for_each(|i| corners[i][lane] = heights[i]);
        }
        let [h00, h10, h01, h11] = corners.map(|c| PixelLanes::new(c) * (1.0 / 65535.0));
        let (x, y) = (place[0] - cell[0], place[1] - cell[1]);
        let (hx, hy, hxy) = (h10 - h00, h01 - h00, h00 - h10 - h01 + h11);
        let [dx, dy] = self.step;
        let a = hxy * dx * dy;
        let b = PixelLanes::ONE + hx * dx + hy * dy + hxy * (x * dy + y * dx);
        let c = self.depth - 1.0 + h00 + hx * x + hy * y + hxy * x * y;
        let tau = first_root(a, b, c);
        c.simd_ge(PixelLanes::ZERO).select(self.depth, self.depth + tau)
    }

    /// Takes the new depths over and chooses each ray's next level.
    fn settle(&mut self, field: &HeightField, [leave, hit]: [PixelLanes; 2], is_hit: u32, is_passed: u32) {
        let (leave, hit, mut depth) = (leave.to_array(), hit.to_array(), self.depth.to_array());
        for lane in 0..8 {
            let bit = 1 << lane;
            if self.is_done & bit != 0 {
                continue;
            }
            if is_hit & bit != 0 {
                depth[lane] = hit[lane];
                self.is_done |= bit;
            } else if is_passed & bit != 0 {
                depth[lane] = leave[lane];
                self.level[lane] = (self.level[lane] + 1).min(field.num_levels() - 1);
                // At full depth every height is met.
                self.is_done |= if leave[lane] >= 1.0 { bit } else { 0 };
            } else {
                self.level[lane] -= 1;
            }
        }
        self.depth = PixelLanes::new(depth);
    }
}

/// The least root, 0 or more, of `a x^2 + b x + c` where `c < 0`; 2 where there is none.
fn first_root(a: PixelLanes, b: PixelLanes, c: PixelLanes) -> PixelLanes {
    let discriminant = b * b - a * c * 4.0;
    // Both roots by the form that does not cancel; q has the sign of -b.
    let root = discriminant.fast_max(PixelLanes::ZERO).sqrt();
    let q = (b + b.simd_ge(PixelLanes::ZERO).select(root, -root)) * -0.5;
    let none = PixelLanes::splat(2.0);
    let valid = |x: PixelLanes| (x.simd_ge(PixelLanes::ZERO) & x.simd_le(none)).select(x, none);
    let (r1, r2) = (valid(c / q), valid(q / a));
    discriminant.simd_ge(PixelLanes::ZERO).select(r1.fast_min(r2), none)
}

/// The nodes that eight rays are in.
#[derive(Default)]
struct Nodes {
    low: [[f32; 8]; 2],
    high: [[f32; 8]; 2],
    max_height: [f32; 8],
    is_cell: u32,
}

impl Nodes {
    fn set(&mut self, lane: usize, field: &HeightField, cell: [i32; 2], folded: [i32; 2], level: i32) {
        for axis in 0..2 {
            let (size, at) = (field.size[axis], folded[axis]);
            let first = if level == 0 { at } else { at.max(0) >> level << level };
            let last = (first + (1 << level)).min(size);
            // Beyond a clamped edge its nodes go on for ever.
            let goes_on = |edge: bool| field.is_clamped && edge;
            let offset = if field.is_clamped { 0 } else { cell[axis] - at };
            self.low[axis][lane] = if goes_on(first <= -i32::from(level == 0)) { -1e9 } else { (first + offset) as f32 };
            self.high[axis][lane] = if goes_on(last == size) { 1e9 } else { (last + offset) as f32 };
        }
        if level == 0 {
            self.is_cell |= 1 << lane;
            self.max_height[lane] = 65535.0;
        } else {
            self.max_height[lane] = field.node_max(level, folded[0], folded[1]);
        }
    }
}
