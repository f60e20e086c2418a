//! Samples beside each other whose rays are probed together.
//!
//! Most rays near outlines hit the next stone, well within it, and so do those around them: one probe
//! in the middle of some pixels tells of all their samples.

use super::behind::{Asked, FollowScratch};
use super::tile::VisibilityBuffer;
use crate::geometry::sample_offsets;
use crate::simd::set_bits;

/// Pixels a side of the groups that are probed, one kind after the other.
const SIDES: [usize; 3] = [4, 2, 1];

/// A sample: where it is kept, and its lane.
type Place = (usize, usize);

impl FollowScratch {
    /// Probes asked samples whose rays may pass their polygon, group by group.
    pub(super) fn probe_together<const S: usize>(
        &mut self,
        buffer: &VisibilityBuffer,
        asked: &Asked,
    ) {
        let mut group = Vec::with_capacity(4 * S);
        for side in SIDES.into_iter().filter(|side| side * side * S > 1) {
            let around = reach(S, side);
            let [num_columns, num_rows] = buffer.size();
            for (row, column) in
                (0..num_rows).step_by(side).flat_map(|row| (0..num_columns).map(move |c| (row, c)))
            {
                let rows = || {
                    (0..S).flat_map(move |s| (row..num_rows.min(row + side)).map(move |y| (s, y)))
                };
                let at = |(sample, y)| (sample * num_rows + y) * num_columns + column;
                if rows().all(|row| self.left(at(row)) == 0) {
                    continue;
                }
                for first in (0..8).step_by(side) {
                    let lanes = ((1_u32 << side) - 1) << first;
                    group.clear();
                    for at in rows().map(at) {
                        group.extend(set_bits(self.left(at) & lanes).map(|lane| (at, lane)));
                    }
                    let corner = buffer.corner(at((0, row)), first);
                    let middle = corner.map(|c| c + side as f64 * 0.5);
                    self.probe_group(&group, (middle, around), asked);
                }
            }
        }
    }

    /// A bit for each lane that is asked, has met nothing and may pass its polygon.
    fn left(&self, at: usize) -> u32 {
        let samples = &self.samples[at];
        let asked = samples.is_asked.to_bitmask() & !u32::from(samples.has_met);
        let may_pass = |lane: &usize| {
            let local = samples.triangle.as_array()[*lane] as usize;
            self.passable.get(local).is_some_and(Option::is_some)
        };
        set_bits(asked).filter(may_pass).map(|lane| 1 << lane).sum()
    }

    /// Probes by one ray, from the polygon that the first of some samples sees.
    fn probe_group(&mut self, group: &[Place], (middle, around): ([f64; 2], f64), asked: &Asked) {
        let &[(at, lane), _, ..] = group else { return };
        let first = self.samples[at].triangle.as_array()[lane];
        let triangle = asked.triangle(first as usize);
        let Some(distance) = asked.follow.probe(triangle, middle, around) else { return };
        let nearness = asked.geometry.projection().nearness(distance);
        for &(at, lane) in group {
            let local = self.samples[at].triangle.as_array()[lane];
            let is_same = asked.triangle(local as usize)[0] == triangle[0];
            let samples = &mut self.samples[at];
            // What lies behind that place is another part of the mesh.
            if is_same && samples.next.as_array()[lane] >= nearness {
                samples.is_bound |= 1 << lane;
                samples.has_met |= 1 << lane;
                samples.meet(lane, local, nearness);
            }
        }
    }
}

/// How far the samples of a square of pixels are from its middle, in pixels.
fn reach(num_samples: usize, side: usize) -> f64 {
    let half = side as f64 * 0.5;
    let farthest = |c: i32| {
        let from_left = f64::from(c) / 256.0;
        (half - from_left).abs().max((half - 1.0 + from_left).abs())
    };
    let offsets = sample_offsets(num_samples as u32).iter();
    offsets.fold(0.0, |most: f64, [x, y]| most.max(farthest(*x).hypot(farthest(*y))))
}
