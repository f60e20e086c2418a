//! Triangle set-up, eight triangles at a time: cull, clip where needed, and make
//! [`ScreenTriangle`]s.
//!
//! Every screen triangle leaves with a positive area, y down: clockwise as displayed.

use super::ScreenTriangle;
use super::clip::clip;
use super::cull::{Culler, twice_area};
use super::plane::{BasisLanes, ScreenBasis};
use super::projection::{Projection, ScreenVertices, UNSNAPPED};
use crate::settings::Settings;
use crate::simd::{f64x8, i32x8};
use std::ops::Range;

/// What set-up needs to know of the frame.
pub(super) struct Setup<'a> {
    projection: &'a Projection,
    culler: Culler,
}

/// Triangles that wait for their depth.
#[derive(Default)]
struct Queue {
    corners: [[[i32; 2]; 3]; 8],
    view: [[[f32; 8]; 3]; 3],
    triangles: [u32; 8],
    num: usize,
}

impl<'a> Setup<'a> {
    pub(super) fn new(projection: &'a Projection, settings: &Settings) -> Self {
        Self { projection, culler: Culler::new(projection, settings) }
    }

    /// Appends the screen triangles of the triangles `range` of a mesh.
    #[inline(never)] // By itself it is optimised alike whatever is compiled around it.
    pub(super) fn set_up(
        &self,
        mesh: usize,
        range: Range<usize>,
        triangles: &[[u32; 3]],
        vertices: &ScreenVertices,
        out: &mut Vec<ScreenTriangle>,
    ) {
        let mut queue = Queue::default();
        let mut first = range.start;
        for indices in triangles[range].chunks(8) {
            let corners = snapped_corners(indices, &vertices.snapped);
            let lanes = corners.map(|corner| corner.map(i32x8::new));
            let kept = self.culler.keep(&lanes);
            let is_unsnapped =
                unsnapped(&corners[0][0]) | unsnapped(&corners[1][0]) | unsnapped(&corners[2][0]);
            let mut left =
                (kept.lanes & !is_unsnapped) | (is_unsnapped & ((1 << indices.len()) - 1));
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                let triangle = (first + lane) as u32;
                let view = indices[lane].map(|i| vertices.view[i as usize]);
                if is_unsnapped >> lane & 1 != 0 {
                    queue.finish(self.projection, mesh, out);
                    self.set_up_clipped(view, [mesh as u32, triangle], out);
                } else {
                    queue.push(oriented(&corners, lane, kept.is_back), &view, triangle);
                    if queue.num == 8 {
                        queue.finish(self.projection, mesh, out);
                    }
                }
            }
            first += indices.len();
        }
        queue.finish(self.projection, mesh, out);
    }

    #[cold]
    fn set_up_clipped(
        &self,
        view: [[f32; 3]; 3],
        [mesh, triangle]: [u32; 2],
        out: &mut Vec<ScreenTriangle>,
    ) {
        if !view.iter().flatten().all(|v| v.is_finite()) {
            return;
        }
        let view = view.map(|corner| corner.map(f64::from));
        let Some(polygon) = clip(view, self.projection) else {
            return;
        };
        let depth = ScreenBasis::new(view, &self.projection.lens).nearness();
        // At most six pieces around the first corner; lanes beyond have no area.
        let mut corners = [[[0; 8]; 2]; 3];
        let snapped = |i: usize| self.projection.snap(polygon.corners()[i]);
        for piece in 0..polygon.corners().len() - 2 {
            for (corner, of) in corners.iter_mut().zip([0, piece + 1, piece + 2]) {
                let place = snapped(of);
                (0..2).for_each(|axis| corner[axis][piece] = place[axis]);
            }
        }
        let lanes = corners.map(|corner| corner.map(i32x8::new));
        let kept = self.culler.keep(&lanes);
        // Snapping may turn a sliver over; it then lies within the other pieces and must not count
        // again.
        let is_back = twice_area(&lanes).to_array().iter().sum::<f64>() > 0.0;
        for piece in (0..6).filter(|piece| {
            kept.lanes >> piece & 1 != 0 && (kept.is_back >> piece & 1 != 0) == is_back
        }) {
            out.push(ScreenTriangle {
                corners: oriented(&corners, piece, kept.is_back),
                depth,
                mesh,
                triangle,
            });
        }
    }
}

impl Queue {
    #[inline(always)]
    fn push(&mut self, corners: [[i32; 2]; 3], view: &[[f32; 3]; 3], triangle: u32) {
        self.corners[self.num] = corners;
        self.triangles[self.num] = triangle;
        for (lanes, &value) in self.view.as_flattened_mut().iter_mut().zip(view.as_flattened()) {
            lanes[self.num] = value;
        }
        self.num += 1;
    }

    /// Computes the depths and appends the triangles.
    #[inline]
    fn finish(&mut self, projection: &Projection, mesh: usize, out: &mut Vec<ScreenTriangle>) {
        if self.num == 0 {
            return;
        }
        let view = self.view.map(|corner| corner.map(|lanes| f64x8::new(lanes.map(f64::from))));
        let depth = BasisLanes::new(view, &projection.lens).nearness();
        out.extend((0..self.num).map(|lane| ScreenTriangle {
            corners: self.corners[lane],
            depth: depth.map(|lanes| lanes[lane]),
            mesh: mesh as u32,
            triangle: self.triangles[lane],
        }));
        self.num = 0;
    }
}

/// Places of the corners of up to eight triangles; lanes beyond have no area.
#[inline(always)]
fn snapped_corners(triangles: &[[u32; 3]], snapped: &[[i32; 2]]) -> [[[i32; 8]; 2]; 3] {
    let mut corners = [[[0; 8]; 2]; 3];
    for (lane, indices) in triangles.iter().enumerate() {
        for (corner, &i) in corners.iter_mut().zip(indices) {
            let [x, y] = snapped[i as usize];
            (corner[0][lane], corner[1][lane]) = (x, y);
        }
    }
    corners
}

/// A bit for each vertex that has no place.
#[inline(always)]
fn unsnapped(x: &[i32; 8]) -> u32 {
    i32x8::new(*x).simd_eq(i32x8::splat(UNSNAPPED[0])).to_bitmask()
}

/// The corners of a lane, so that their area is positive.
#[inline(always)]
fn oriented(corners: &[[[i32; 8]; 2]; 3], lane: usize, is_back: u32) -> [[i32; 2]; 3] {
    let [a, b, c] = [0, 1, 2].map(|corner: usize| corners[corner].map(|lanes| lanes[lane]));
    if is_back >> lane & 1 != 0 { [a, b, c] } else { [a, c, b] }
}
