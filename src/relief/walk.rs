//! Sixteen rays on their way from node to node of the pyramid of maxima.
//!
//! Places are in cells: texel centres lie at whole numbers. An axis along which a ray moves
//! backwards is mirrored, so that all rays move forwards here:
//!
//! ```text
//! cells        | -3 | -2 | -1 |  0 |  1 |  2 |
//! mirrored     |  2 |  1 |  0 | -1 | -2 | -3 |      all bits of the number are turned
//! ```
//!
//! A ray's cell is counted, not found from its depth: it leaves a node by the nearer of two edges,
//! whose number is that of the next cell along that axis. So every step leads on, whatever is
//! rounded, and the depth at an edge is the same by whichever nodes a ray came there.

use super::height_field::HeightField;
use super::patch::{Corners, crossing};
use crate::simd::{
    PixelLanes, RayLanes, as_ray_mask, as_unsigned_words, i32x8, i32x16, lane_mask, ray_lanes,
    set_bits,
};
use crate::texture::FULL_F32;

/// An edge that no ray reaches.
const NEVER: i32 = 1 << 30;

/// What is known of a ray before it goes, a vector of eight or sixteen of them or one.
#[derive(Clone, Copy)]
pub(super) struct Course<F, I> {
    /// Where it starts, and how far it moves down to the deepest relief.
    pub(super) start: [F; 2],
    pub(super) step: [F; 2],
    /// One over the step; 0 along an axis that a ray does not move along, whose edges it meets
    /// late: at a depth of 2.
    pub(super) inverse: [F; 2],
    pub(super) late: [F; 2],
    /// All bits where an axis is mirrored.
    pub(super) mirror: [I; 2],
    /// The first cell, and the level of its node.
    pub(super) cell: [I; 2],
    pub(super) level: I,
}

/// Sixteen rays on their way.
pub(super) struct Walk<'a> {
    field: &'a HeightField,
    /// Their cells and levels are those of where they are.
    rays: Course<RayLanes, i32x16>,
    /// Depth at which a ray came into its cell, at last that of its hit.
    pub(super) depth: RayLanes,
    /// Steps that a ray may still take.
    steps_left: i32x16,
}

/// Where rays leave their nodes.
struct Exits {
    /// The cells in the stored pattern, counted the way that the ray goes.
    turned: [i32x16; 2],
    /// The next cell along each axis, and the depth at which a ray comes to it.
    edge: [i32x16; 2],
    depth: [RayLanes; 2],
}

impl<'a> Walk<'a> {
    /// No ray yet: all lanes wait for good.
    pub(super) fn new(field: &'a HeightField) -> Self {
        let (none, zero) = ([RayLanes::ZERO; 2], i32x16::splat(0));
        let late = [RayLanes::splat(2.0); 2];
        let rays = Course {
            start: none,
            step: none,
            inverse: none,
            late,
            mirror: [zero; 2],
            cell: [zero; 2],
            level: zero,
        };
        Self { field, rays, depth: RayLanes::ONE, steps_left: zero }
    }

    /// Puts a ray with so many steps into a lane.
    pub(super) fn put(&mut self, lane: usize, ray: &Course<f32, i32>, steps: i32) {
        let rays = &mut self.rays;
        for axis in 0..2 {
            rays.start[axis].as_mut_array()[lane] = ray.start[axis];
            rays.step[axis].as_mut_array()[lane] = ray.step[axis];
            rays.inverse[axis].as_mut_array()[lane] = ray.inverse[axis];
            rays.late[axis].as_mut_array()[lane] = ray.late[axis];
            rays.mirror[axis].as_mut_array()[lane] = ray.mirror[axis];
            rays.cell[axis].as_mut_array()[lane] = ray.cell[axis];
        }
        rays.level.as_mut_array()[lane] = ray.level;
        self.depth.as_mut_array()[lane] = 0.0;
        self.steps_left.as_mut_array()[lane] = steps;
    }

    /// Moves rays on by a node or a level, but for those that wait, a bit each: in a cell whose
    /// relief they may hit, or at their end.
    #[inline(always)]
    pub(super) fn advance(&mut self) -> u32 {
        let at = self.stored();
        let exits = self.exits(&at);
        let is_cell = self.rays.level.simd_eq(i32x16::splat(0));
        // A ray descends, so it is lowest where it leaves the node.
        let height =
            self.field.maxima().above(self.rays.level, at.map(|c| c.max(i32x16::splat(0))));
        let is_above = as_ray_mask((exits.first() + height).simd_lt(RayLanes::ONE));
        let waits = (is_cell & !is_above) | self.steps_left.simd_lt(i32x16::splat(1));
        // Pass the node, or open it.
        self.pass(is_above & !waits, &exits);
        self.rays.level += !is_above & !waits;
        self.steps_left += !waits;
        as_unsigned_words(waits).to_bitmask()
    }

    /// Moves waiting rays to their hits, or out of their cells where there is none. Gives those
    /// that are at their end.
    pub(super) fn meet(&mut self, waiting: u32) -> u32 {
        let at = self.stored();
        let exits = self.exits(&at);
        let exit = exits.first();
        let corners = self.corners(&at, waiting);
        let within = [0, 1].map(|axis| {
            let place = self.rays.start[axis] + self.rays.step[axis] * self.depth;
            place - RayLanes::from_i32x16(self.rays.cell[axis])
        });
        let hit = crossing(corners, self.depth, within, self.rays.step);
        let is_cell = self.rays.level.simd_eq(i32x16::splat(0));
        let is_met = lane_mask(waiting) & is_cell;
        // A crossing beyond the edge is the next cell's.
        let is_hit = is_met & as_ray_mask(hit.simd_le(exit));
        let passes = is_met & !is_hit;
        self.pass(passes, &exits);
        self.depth = ray_lanes(is_hit).select(hit, self.depth);
        self.steps_left += is_met;
        // At full depth every height is met.
        let goes_on = passes & as_ray_mask(exit.simd_lt(RayLanes::ONE));
        waiting & !as_unsigned_words(goes_on).to_bitmask()
    }

    /// Moves rays to the next node.
    #[inline(always)]
    fn pass(&mut self, passes: i32x16, exits: &Exits) {
        let rays = &mut self.rays;
        let exit = exits.first();
        let is_first = as_ray_mask(exits.depth[0].simd_le(exits.depth[1]));
        for (axis, crosses) in [is_first, !is_first].into_iter().enumerate() {
            // Along the other axis a ray is where it is, within the node.
            let place = rays.start[axis] + rays.step[axis] * exit;
            let place = place.floor().fast_trunc_int();
            let place = place.max(rays.cell[axis]).min(exits.edge[axis] - i32x16::splat(1));
            let next = crosses.select(exits.edge[axis], place);
            rays.cell[axis] = passes.select(next, rays.cell[axis]);
        }
        self.depth = ray_lanes(passes).select(exit, self.depth);
        // The edge of an odd node is its parent's, too: that is left as well.
        let turned = is_first.select(exits.turned[0], exits.turned[1]);
        let is_odd = (turned >> as_unsigned_words(rays.level)) & i32x16::splat(1);
        let last = i32x16::splat(self.field.maxima().num_levels() - 1);
        rays.level = (rays.level + (is_odd & passes)).min(last);
    }

    /// The rays' cells in the stored pattern; beyond a clamped pattern they are -1 and the last.
    #[inline(always)]
    fn stored(&self) -> [i32x16; 2] {
        let rays = &self.rays;
        let [x, y] = [0, 1].map(|axis| rays.cell[axis] ^ rays.mirror[axis]);
        self.field.fold_lanes([x, y])
    }

    /// Where the rays leave their nodes.
    #[inline(always)]
    fn exits(&self, at: &[i32x16; 2]) -> Exits {
        let rays = &self.rays;
        let one = i32x16::splat(1);
        let ones = (one << as_unsigned_words(rays.level)) - one;
        let ways = [0, 1].map(|axis| self.way_out(axis, at[axis], ones));
        let edge = ways.map(|[_, edge]| edge);
        let depth = [0, 1].map(|axis| {
            let edge = RayLanes::from_i32x16(edge[axis]);
            (edge - rays.start[axis]) * rays.inverse[axis] + rays.late[axis]
        });
        Exits { turned: ways.map(|[turned, _]| turned), edge, depth }
    }

    /// Cells from the pattern's near end along an axis, and the cell beyond the node; `ones` is one
    /// less than how many cells a node spans.
    #[inline(always)]
    fn way_out(&self, axis: usize, at: i32x16, ones: i32x16) -> [i32x16; 2] {
        let (zero, one) = (i32x16::splat(0), i32x16::splat(1));
        let size = i32x16::splat(self.field.size[axis]);
        let (mirror, cell) = (self.rays.mirror[axis], self.rays.cell[axis]);
        if !self.field.is_clamped {
            let turned = at ^ mirror;
            // The last node may be smaller than others.
            let room = mirror.select(i32x16::splat(NEVER), size - at);
            return [turned, cell + ((!turned & ones) + one).min(room)];
        }
        // The cell -1, beyond a clamped edge, belongs to the first node.
        let is_cell = ones.simd_eq(zero);
        let at = is_cell.select(at, at.max(zero));
        let turned = at ^ mirror;
        let ahead = ((!turned & ones) + one).min(mirror.select(i32x16::splat(NEVER), size - at));
        // Beyond a clamped edge its nodes go on for ever.
        let first = at + one - ahead;
        let goes_on_low = first.simd_lt(is_cell.select(zero, one));
        let goes_on_high = (at + ahead).simd_eq(size);
        let goes_on = mirror.select(goes_on_low, goes_on_high);
        [turned, goes_on.select(i32x16::splat(NEVER), turned + ahead)]
    }

    /// The heights at the corners of the cells of waiting rays; those of others are not asked for.
    fn corners(&self, at: &[i32x16; 2], waiting: u32) -> Corners {
        let [xs, ys] = at.map(|cells| cells.to_array());
        let mirror = self.rays.mirror.map(|lanes| lanes.to_array());
        let mut corners = [[0.0; 16]; 4];
        for lane in set_bits(waiting) {
            let heights = self.field.corners(xs[lane], ys[lane]);
            // Corners of a mirrored cell change places.
            let turn = (mirror[0][lane] & 1 | mirror[1][lane] & 2) as usize;
            (0..4).for_each(|i| corners[i ^ turn][lane] = heights[i]);
        }
        corners.map(|heights| RayLanes::new(heights) * (1.0 / FULL_F32))
    }
}

impl Exits {
    /// Depth at which rays leave, 1 at most.
    #[inline(always)]
    fn first(&self) -> RayLanes {
        self.depth[0].fast_min(self.depth[1]).fast_min(RayLanes::ONE)
    }
}

impl Course<PixelLanes, i32x8> {
    /// One of eight rays.
    pub(super) fn lane(&self, lane: usize) -> Course<f32, i32> {
        let number = |pair: &[PixelLanes; 2]| pair.each_ref().map(|lanes| lanes.as_array()[lane]);
        let whole = |pair: &[i32x8; 2]| pair.each_ref().map(|lanes| lanes.as_array()[lane]);
        Course {
            start: number(&self.start),
            step: number(&self.step),
            inverse: number(&self.inverse),
            late: number(&self.late),
            mirror: whole(&self.mirror),
            cell: whole(&self.cell),
            level: self.level.as_array()[lane],
        }
    }
}
