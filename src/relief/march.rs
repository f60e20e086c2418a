//! The first hit of a view ray with the bilinear height field.
//!
//! The ray is at `b + t D` at the depth `t` (0 on the polygon, 1 deepest), where the relief's depth
//! is `1 - h`. It descends the pyramid of maxima: a node whose greatest height stays under the ray
//! is left at its far side, others are opened; in a cell the crossing of the ray with the bilinear
//! patch, a quadratic in t, is solved. So no feature is stepped over, however thin. Eight rays are
//! traced at once; a lane is a pixel.

use super::displacement::{MAX_SLOPE, finite};
use super::height_field::HeightField;
use crate::simd::{PixelLanes, as_unsigned, i32x8, lanes, mask};
use crate::texture::FULL_F32;

/// Most steps of a ray. A walk of 64 repeats over a map of any size that opens every node takes
/// fewer in practice; the bound makes the time of a hostile input finite, and the ray then ends
/// where it is.
const MAX_STEPS: usize = 1 << 14;

/// Most patterns from the first that a ray over a clamped map starts at: all beyond looks like its
/// edge.
const FARTHEST: f32 = 128.0;

/// Part of a texel, along the axis that it moves along fastest, that a ray is moved past a node's
/// edge, so that rounding cannot keep it inside.
const NUDGE: f32 = 1.0 / 1024.0;

/// What an f32 just under 1 can be moved by.
const LEAST_NUDGE: f32 = 1.0 / 8_388_608.0;

/// The depth `t`, 0 to 1, of the first hit of the rays from `base` along `displacement`, both in
/// repeats.
pub fn march(
    field: &HeightField,
    base: &[PixelLanes; 2],
    displacement: &[PixelLanes; 2],
) -> PixelLanes {
    let [nu, nv] = field.texels_per_repeat;
    // Whole repeats are taken off first, so that far tiles keep their precision.
    let start = |b: PixelLanes, n: f32, size: i32| {
        let patterns = finite(b * (n / size as f32));
        let whole = if field.is_clamped { PixelLanes::ZERO } else { patterns.floor() };
        (patterns - whole)
            .fast_max(PixelLanes::splat(-FARTHEST))
            .fast_min(PixelLanes::splat(FARTHEST))
            * size as f32
            - 0.5
    };
    let bounded = |d: PixelLanes| {
        finite(d).fast_max(PixelLanes::splat(-MAX_SLOPE)).fast_min(PixelLanes::splat(MAX_SLOPE))
    };
    let step = [bounded(displacement[0]) * nu, bounded(displacement[1]) * nv];
    // Each ray's own, so that its hit does not depend on the rays beside it.
    let longest = step[0].abs().fast_max(step[1].abs());
    let level = longest.to_array().map(|length| field.first_level(length));
    let mut rays = Rays {
        start: [start(base[0], nu, field.size[0]), start(base[1], nv, field.size[1])],
        step,
        inverse: step.map(|s| moves(s).select(PixelLanes::ONE / s, PixelLanes::ZERO)),
        late: step.map(|s| moves(s).select(PixelLanes::ZERO, PixelLanes::splat(2.0))),
        nudge: (PixelLanes::splat(NUDGE) / longest.fast_max(PixelLanes::ONE))
            .fast_max(PixelLanes::splat(LEAST_NUDGE)),
        depth: PixelLanes::ZERO,
        level: i32x8::new(level),
        parent: [i32x8::splat(i32::MIN); 2],
        is_done: i32x8::splat(0),
    };
    for _ in 0..MAX_STEPS {
        rays.advance(field);
        if rays.is_done.all() {
            break;
        }
    }
    rays.depth.fast_min(PixelLanes::ONE)
}

/// Whether a step leads anywhere.
fn moves(step: PixelLanes) -> PixelLanes {
    step.abs().simd_gt(PixelLanes::splat(1e-9))
}

/// Eight rays on their way. Places are in cells: texel centres lie at whole numbers.
struct Rays {
    start: [PixelLanes; 2],
    step: [PixelLanes; 2],
    /// One over the step; 0 along an axis that a ray does not move along, which it leaves late: at
    /// a depth of 2.
    inverse: [PixelLanes; 2],
    late: [PixelLanes; 2],
    /// The depth that a ray is moved past a node's edge.
    nudge: PixelLanes,
    depth: PixelLanes,
    level: i32x8,
    /// The parents of the nodes just passed; no node where the ray did not move on.
    parent: [i32x8; 2],
    is_done: i32x8,
}

/// Where eight rays are: the cell, the same folded into the stored pattern, and the edges of its
/// node.
struct Nodes {
    cell: [PixelLanes; 2],
    folded: [i32x8; 2],
    low: [PixelLanes; 2],
    high: [PixelLanes; 2],
}

impl Rays {
    /// Moves every ray by one node or one level.
    fn advance(&mut self, field: &HeightField) {
        // Find each ray's cell, and the node that holds it.
        let place =
            [self.start[0] + self.step[0] * self.depth, self.start[1] + self.step[1] * self.depth];
        // A ray on the edge of a cell is in the one that it moves into.
        let cell = [0, 1].map(|axis| {
            let backwards = self.step[axis].simd_lt(PixelLanes::ZERO);
            backwards.select(place[axis].ceil() - 1.0, place[axis].floor())
        });
        let folded = [0, 1].map(|axis| fold(field, axis, cell[axis]));
        self.climb(field, &folded);
        let nodes = self.nodes(field, cell, folded);
        let is_cell = self.level.simd_eq(i32x8::splat(0));
        // Find where the ray leaves the node, and whether it is above the relief until there.
        let heights = self.node_heights(field, &nodes.folded);
        let exit = self.depth_at_exit(&place, &nodes);
        let leave = (exit + self.nudge).fast_min(PixelLanes::ONE);
        // The ray descends, so it is lowest where it leaves the node.
        let is_above = mask(leave.simd_lt(PixelLanes::ONE - heights));
        let is_open = is_cell & !self.is_done;
        // Corners are looked up lane by lane: only worth it when a ray is in a cell.
        let hit = if is_open.any() {
            self.cell_hit(field, &place, &nodes, is_open)
        } else {
            PixelLanes::splat(2.0)
        };
        // A crossing beyond the edge is the next node's.
        let is_hit = is_open & mask(hit.simd_le(exit));
        let is_passed = (is_cell | is_above) & !is_hit & !self.is_done;
        // Move to the hit, past the node or, where it is opened, one level down.
        self.depth = lanes(is_hit).select(hit, lanes(is_passed).select(leave, self.depth));
        let up = as_unsigned(self.level + i32x8::splat(1));
        self.parent =
            [0, 1].map(|axis| is_passed.select(nodes.folded[axis] >> up, i32x8::splat(i32::MIN)));
        self.level =
            (is_passed | is_hit | self.is_done).select(self.level, self.level - i32x8::splat(1));
        // At full depth every height is met.
        self.is_done = self.is_done | is_hit | mask(self.depth.simd_ge(PixelLanes::ONE));
    }

    /// Takes rays that left the parent of the node they passed one level up.
    fn climb(&mut self, field: &HeightField, folded: &[i32x8; 2]) {
        let up = as_unsigned(self.level + i32x8::splat(1));
        let moved = !self.parent[0].simd_eq(i32x8::splat(i32::MIN));
        let stays =
            self.parent[0].simd_eq(folded[0] >> up) & self.parent[1].simd_eq(folded[1] >> up);
        let climbs = moved & !stays & self.level.simd_lt(i32x8::splat(field.num_levels() - 1));
        self.level = climbs.select(self.level + i32x8::splat(1), self.level);
    }

    fn nodes(&self, field: &HeightField, cell: [PixelLanes; 2], folded: [i32x8; 2]) -> Nodes {
        let by = as_unsigned(self.level);
        let is_cell = self.level.simd_eq(i32x8::splat(0));
        let edges = [0, 1].map(|axis| {
            let (size, at) = (i32x8::splat(field.size[axis]), folded[axis]);
            // The cell -1, beyond a clamped edge, belongs to the first node.
            let first = is_cell.select(at, (at.max(i32x8::splat(0)) >> by) << by);
            let last = (first + (i32x8::splat(1) << by)).min(size);
            if !field.is_clamped {
                // Move the edges from the stored pattern to the repeat that the ray is in.
                let offset = cell[axis] - PixelLanes::from_i32x8(at);
                return [
                    PixelLanes::from_i32x8(first) + offset,
                    PixelLanes::from_i32x8(last) + offset,
                ];
            }
            // Beyond a clamped edge its nodes go on for ever.
            let goes_on_low = first.simd_lt(is_cell.select(i32x8::splat(0), i32x8::splat(1)));
            let goes_on_high = last.simd_eq(size);
            [
                lanes(goes_on_low).select(PixelLanes::splat(-1e9), PixelLanes::from_i32x8(first)),
                lanes(goes_on_high).select(PixelLanes::splat(1e9), PixelLanes::from_i32x8(last)),
            ]
        });
        Nodes { cell, folded, low: edges.map(|e| e[0]), high: edges.map(|e| e[1]) }
    }

    /// The greatest height in each ray's node, 0 to 1; 1 for a cell.
    fn node_heights(&self, field: &HeightField, folded: &[i32x8; 2]) -> PixelLanes {
        let (levels, x, y) = (self.level.to_array(), folded[0].to_array(), folded[1].to_array());
        let height = |lane: usize| {
            if levels[lane] == 0 {
                FULL_F32
            } else {
                field.node_max(levels[lane], x[lane], y[lane])
            }
        };
        PixelLanes::new(std::array::from_fn(height)) * (1.0 / FULL_F32)
    }

    /// Depth at which the rays are at the edge of their nodes.
    fn depth_at_exit(&self, place: &[PixelLanes; 2], nodes: &Nodes) -> PixelLanes {
        let way = |axis: usize| {
            let forwards = self.step[axis].simd_gt(PixelLanes::ZERO);
            let edge = forwards.select(nodes.high[axis], nodes.low[axis]);
            ((edge - place[axis]) * self.inverse[axis]).abs() + self.late[axis]
        };
        (self.depth + way(0).fast_min(way(1))).fast_min(PixelLanes::ONE)
    }

    /// Depth of the first crossing with the patch of each ray's cell; more than 1 where there is
    /// none.
    ///
    /// Along the ray `f(tau) = depth + tau - 1 + h = a tau^2 + b tau + c`; the hit is the first
    /// `tau >= 0` with `f >= 0`.
    fn cell_hit(
        &self,
        field: &HeightField,
        place: &[PixelLanes; 2],
        nodes: &Nodes,
        is_open: i32x8,
    ) -> PixelLanes {
        let (xs, ys, is_open) =
            (nodes.folded[0].to_array(), nodes.folded[1].to_array(), is_open.to_array());
        // Look up the corners of open cells; what the other lanes compute is not asked for.
        let mut corners = [[0.0_f32; 8]; 4];
        for lane in (0..8).filter(|&lane| is_open[lane] != 0) {
            let heights = field.corners(xs[lane], ys[lane]);
            (0..4).for_each(|i| corners[i][lane] = heights[i]);
        }
        let [h00, h10, h01, h11] = corners.map(|c| PixelLanes::new(c) * (1.0 / FULL_F32));
        // Put the ray into the patch, from where the ray is now.
        let (x, y) = (place[0] - nodes.cell[0], place[1] - nodes.cell[1]);
        let (hx, hy, hxy) = (h10 - h00, h01 - h00, h00 - h10 - h01 + h11);
        let [dx, dy] = self.step;
        let a = hxy * dx * dy;
        let b = PixelLanes::ONE + hx * dx + hy * dy + hxy * (x * dy + y * dx);
        let c = self.depth - 1.0 + h00 + hx * x + hy * y + hxy * x * y;
        // A ray that is in the relief already has its hit where it is.
        c.simd_ge(PixelLanes::ZERO).select(self.depth, self.depth + first_root(a, b, c))
    }
}

/// The place of cells in the stored pattern; beyond a clamped pattern they are -1 and the last.
fn fold(field: &HeightField, axis: usize, cell: PixelLanes) -> i32x8 {
    let size = field.size[axis];
    if field.is_clamped {
        return cell
            .fast_max(PixelLanes::splat(-1.0))
            .fast_min(PixelLanes::splat((size - 1) as f32))
            .fast_trunc_int();
    }
    let cell = cell.fast_trunc_int();
    let patterns =
        (PixelLanes::from_i32x8(cell) * field.inverse_size[axis]).floor().fast_trunc_int();
    let size = i32x8::splat(size);
    let at = cell - patterns * size;
    // The product may round to the next whole number.
    let at = at.simd_lt(i32x8::splat(0)).select(at + size, at);
    at.simd_lt(size).select(at, at - size)
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
