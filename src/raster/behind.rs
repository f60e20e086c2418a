//! What rays meet behind the polygons of a tile: relief, that of a polygon behind it, or nothing.
//!
//! Polygons say what a sample sees, but for two kinds of samples: those whose ray may pass the relief
//! of the polygon, at the outlines of curved surfaces, and those where a polygon of another mesh
//! lies within the relief. Their polygons are gone through from the nearest on, and each ray is
//! followed to what it meets there, until no polygon is nearer than that:
//!
//! ```text
//!   eye ──────────A────────B──────C────          polygons on the ray
//!                    ├ relief of A ┤             the ray meets A's relief behind B: what B has is
//!                          ├ relief of B ┤       asked next. If that is nearer than what A has,
//!                                                it is seen, and else A's. C need not be asked.
//! ```
//!
//! Which samples are asked hangs on their polygons alone, and so the picture not on the tiling.

use super::edge::{Rect, Row};
use super::grid::bounds;
use super::tile::{FARTHEST, NONE, VisibilityBuffer, cover};
use crate::geometry::{Geometry, Plane, offset_bounds};
use crate::simd::{f32x8, set_bits, u32x8};
use glam::Vec3;

/// Most polygons that a ray is followed through; it then sees what it has met, or nothing.
const MOST_POLYGONS: usize = 64;

/// How much nearer than where a ray left a relief the polygon there may seem, as a share of the distance.
const ROUNDING: f32 = 1e-4;

/// What a ray through a polygon meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Behind {
    /// The polygon's surface, at a distance along the view that is not less than the polygon's.
    Surface(f32),
    /// Nothing: it comes out of the relief again, at a distance along the view.
    Nothing(f32),
}

/// Follows rays behind polygons, which go by the index of their mesh and in it.
pub trait Follow: Sync {
    /// Whether a mesh has relief.
    fn has_relief(&self, mesh: u32) -> bool;
    /// Where on the screen rays from the eye may pass the relief of a triangle: where this is below 0;
    /// `None` where none may.
    fn passable(&self, triangle: [u32; 2]) -> Option<Plane>;
    /// Whether a triangle is seen from behind.
    fn is_seen_from_behind(&self, triangle: [u32; 2]) -> bool;
    /// The corners of a triangle where the relief of its mesh is deepest, along the view as the
    /// [`Geometry`] has it: x, y and the distance. `None` without relief.
    fn deepest(&self, triangle: [u32; 2]) -> Option<[Vec3; 3]>;
    /// Whether the ray through a place of the screen, in pixels, surely hits the relief of a triangle,
    /// and a distance along the view by which it has: quicker than to follow it. The same holds of all
    /// rays that are no farther than so many pixels `around` it, and enter the relief of the mesh before
    /// that distance.
    fn probe(&self, triangle: [u32; 2], place: [f64; 2], around: f64) -> Option<f32>;
    /// What the ray through a place of the screen, in pixels, meets behind a triangle.
    fn follow(&self, triangle: [u32; 2], place: [f64; 2]) -> Behind;
}

/// Eight samples whose rays are followed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Followed {
    /// All bits of those that are, and of those of which more is asked.
    pub(super) is_followed: u32x8,
    pub(super) is_asked: u32x8,
    /// Depth of the polygon that was asked last, and of the next one with its local index.
    last: f32x8,
    pub(super) next: f32x8,
    pub(super) triangle: u32x8,
    /// The nearest that was met so far, with the polygon before it.
    best: f32x8,
    best_triangle: u32x8,
    best_polygon: f32x8,
    /// A bit for each where what was met may be nearer than that.
    pub(super) is_bound: u8,
    /// A bit for each that has met something before its polygon was asked.
    pub(super) has_met: u8,
    /// The side of a mesh by which a ray came out of it last, and where: up to there that side is
    /// within the shell that the ray passed, and is not seen.
    passed: u32x8,
    passed_at: f32x8,
}

/// Buffers of following rays, kept between tiles.
#[derive(Debug, Default)]
pub(super) struct FollowScratch {
    pub(super) samples: Vec<Followed>,
    /// Of each triangle of the list: twice its mesh, and one more if it is seen from behind.
    sides: Vec<u32>,
    /// Of each triangle of the list, [`Follow::passable`].
    pub(super) passable: Vec<Option<Plane>>,
    /// Of each triangle of the list, the nearness of its deepest relief.
    pub(super) deepest: Vec<Option<Plane>>,
    /// Of each sample, the least nearness of the relief that its polygon has, and the mesh.
    pub(super) reaches: Vec<(f32x8, u32x8)>,
}

/// What all of a tile is asked with.
pub(super) struct Asked<'a> {
    pub(super) geometry: &'a Geometry,
    pub(super) list: &'a [u32],
    pub(super) rect: &'a Rect,
    pub(super) follow: &'a dyn Follow,
}

impl Asked<'_> {
    pub(super) fn triangle(&self, local: usize) -> [u32; 2] {
        let triangle = self.geometry.triangle(self.list[local]);
        [triangle.mesh, triangle.triangle]
    }
}

impl Followed {
    /// A lane's ray meets, behind its next polygon, so near a surface.
    pub(super) fn meet(&mut self, lane: usize, local: u32, nearness: f32) {
        let polygon = self.next.as_array()[lane];
        // Not before its polygon, whatever is rounded.
        let depth = nearness.min(polygon);
        if depth > self.best.as_array()[lane] {
            self.best.as_mut_array()[lane] = depth;
            self.best_triangle.as_mut_array()[lane] = local;
            self.best_polygon.as_mut_array()[lane] = polygon;
        }
    }

    /// What a lane's ray has met is so near, nearer than its bound.
    fn nearer(&mut self, lane: usize, nearness: f32) {
        self.best.as_mut_array()[lane] = nearness.min(self.best_polygon.as_array()[lane]);
    }
}

impl FollowScratch {
    /// Makes samples of the tile see what their rays meet. Depths stay those of polygons.
    pub(super) fn find<const S: usize>(&mut self, buffer: &mut VisibilityBuffer, asked: &Asked) {
        let all = 0..asked.list.len();
        self.passable.clear();
        self.passable.extend(all.clone().map(|local| asked.follow.passable(asked.triangle(local))));
        let first_mesh = asked.triangle(0)[0];
        let has_several = all.clone().any(|local| asked.triangle(local)[0] != first_mesh)
            && all.clone().any(|local| asked.follow.has_relief(asked.triangle(local)[0]));
        if !has_several && self.passable.iter().all(Option::is_none) {
            return;
        }
        self.begin::<S>(buffer);
        if has_several {
            self.ask_contacts::<S>(buffer, asked);
        }
        if self.samples.iter().all(|samples| samples.is_asked == u32x8::ZERO) {
            return;
        }
        self.sides.clear();
        self.sides.extend(all.map(|local| {
            let triangle = asked.triangle(local);
            2 * triangle[0] + u32::from(asked.follow.is_seen_from_behind(triangle))
        }));
        self.probe_together::<S>(buffer, asked);
        for _ in 0..MOST_POLYGONS {
            self.follow_all::<S>(buffer, asked);
            if !self.next_polygons::<S>(buffer, asked) {
                break;
            }
        }
        self.end(buffer);
    }

    /// Asks for samples whose rays may pass their polygon.
    fn begin<const S: usize>(&mut self, buffer: &VisibilityBuffer) {
        let none = f32x8::splat(FARTHEST);
        let passable = &self.passable;
        let seen = buffer.nearness.iter().zip(&buffer.triangles).enumerate();
        self.samples.clear();
        self.samples.extend(seen.map(|(at, (depth, triangles))| {
            let [x, y] = buffer.place::<S>(at, 0).map(|c| c as f32);
            let mut is_asked = [0; 8];
            for (lane, local) in triangles.to_array().into_iter().enumerate() {
                let Some([a, b, c]) = passable.get(local as usize).copied().flatten() else {
                    continue;
                };
                let may_pass = a * (x + lane as f32) + b * y + c < 0.0;
                is_asked[lane] = if may_pass { u32::MAX } else { 0 };
            }
            let is_asked = u32x8::new(is_asked);
            Followed {
                is_followed: is_asked,
                is_asked,
                last: *depth,
                next: *depth,
                triangle: *triangles,
                best: none,
                best_triangle: u32x8::splat(NONE),
                best_polygon: none,
                is_bound: 0,
                has_met: 0,
                passed: u32x8::splat(NONE),
                passed_at: none,
            }
        }));
    }

    /// Follows the rays of the samples that are asked, each behind its next polygon.
    fn follow_all<const S: usize>(&mut self, buffer: &VisibilityBuffer, asked: &Asked) {
        let (sides, passable) = (&self.sides, &self.passable);
        let nearness = |distance: f32| asked.geometry.projection().nearness(distance);
        for (at, samples) in self.samples.iter_mut().enumerate() {
            let has_met = u32::from(std::mem::take(&mut samples.has_met));
            for lane in set_bits(samples.is_asked.to_bitmask() & !has_met) {
                let local = samples.triangle.as_array()[lane];
                let (triangle, place) =
                    (asked.triangle(local as usize), buffer.place::<S>(at, lane));
                let is_first = samples.best_triangle.as_array()[lane] == NONE;
                let is_probed = is_first && passable[local as usize].is_some();
                let probed =
                    if is_probed { asked.follow.probe(triangle, place, 0.0) } else { None };
                if let Some(w) = probed {
                    samples.is_bound |= 1 << lane;
                    samples.meet(lane, local, nearness(w));
                    continue;
                }
                if samples.is_bound >> lane & 1 != 0 {
                    // Another polygon is nearer than the bound: now what is met must be known.
                    samples.is_bound &= !(1 << lane);
                    let best = samples.best_triangle.as_array()[lane] as usize;
                    if let Behind::Surface(w) = asked.follow.follow(asked.triangle(best), place) {
                        samples.nearer(lane, nearness(w));
                    }
                    if samples.best.as_array()[lane] >= samples.next.as_array()[lane] {
                        continue;
                    }
                }
                match asked.follow.follow(triangle, place) {
                    Behind::Surface(w) => samples.meet(lane, local, nearness(w)),
                    Behind::Nothing(w) => {
                        samples.passed.as_mut_array()[lane] = sides[local as usize] ^ 1;
                        samples.passed_at.as_mut_array()[lane] = nearness(w * (1.0 + ROUNDING));
                    }
                }
            }
        }
    }

    /// Finds the polygon behind the last one of each sample that is asked; no more is asked of
    /// those where none is nearer than what was met. Says whether any is left.
    fn next_polygons<const S: usize>(&mut self, buffer: &VisibilityBuffer, asked: &Asked) -> bool {
        let Asked { geometry, list, rect, .. } = asked;
        for samples in &mut self.samples {
            samples.last = samples.next;
            samples.next = samples.best;
            samples.triangle = u32x8::splat(NONE);
        }
        let (mut last, mut last_index) = ((u32::MAX, u32::MAX), 0);
        for (index, &triangle) in list.iter().enumerate() {
            let triangle = geometry.triangle(triangle);
            // Pieces of a triangle go by the first one's index.
            if (triangle.mesh, triangle.triangle) != last {
                (last, last_index) = ((triangle.mesh, triangle.triangle), index as u32);
            }
            let (side, local) = (u32x8::splat(self.sides[index]), u32x8::splat(last_index));
            let samples = &mut self.samples;
            let around = bounds(triangle, rect, offset_bounds(S as u32));
            cover::<S>(triangle, &around, &mut |row: Row| {
                let (at, nearness) = buffer.row::<S>(&row, triangle.depth);
                let samples = &mut samples[at];
                let is_within = nearness.simd_lt(samples.last) & nearness.simd_gt(samples.next);
                let is_passed =
                    samples.passed.simd_eq(side) & nearness.simd_ge(samples.passed_at).to_bits();
                let is_next =
                    is_within.to_bits() & row.mask.cast_unsigned() & samples.is_asked & !is_passed;
                samples.next = f32x8::from_bits(is_next).bitselect(nearness, samples.next);
                samples.triangle = is_next.bitselect(local, samples.triangle);
            });
        }
        let mut is_any_left = false;
        for samples in &mut self.samples {
            let is_left = !samples.triangle.simd_eq(u32x8::splat(NONE));
            samples.is_asked &= is_left;
            is_any_left |= samples.is_asked != u32x8::ZERO;
        }
        is_any_left
    }

    /// Makes the buffer see what was found.
    fn end(&self, buffer: &mut VisibilityBuffer) {
        let seen = buffer.triangles.iter_mut().zip(&mut buffer.nearness);
        for ((triangles, depth), samples) in seen.zip(&self.samples) {
            let Followed { is_followed, best_triangle, best_polygon, .. } = *samples;
            *triangles = is_followed.bitselect(best_triangle, *triangles);
            *depth = f32x8::from_bits(is_followed).bitselect(best_polygon, *depth);
        }
    }
}
