//! Triangle set-up: cull, clip where needed, and make [`ScreenTriangle`]s.
//!
//! The orientation is the sign of `area = (b - a) x (c - a)` of the snapped corners, y down: positive is clockwise as
//! displayed, which is the back. Every screen triangle leaves with a positive area.

use super::clip::clip;
use super::plane::ScreenBasis;
use super::projection::{Projection, ScreenVertex};
use super::samples::{offset_bounds, pixel_range, sample_offsets};
use super::{Plane, ScreenTriangle};
use crate::settings::Settings;
use std::ops::Range;

type Corners = [[i32; 2]; 3];

/// What set-up needs to know of the frame.
pub(super) struct Setup<'a> {
    projection: &'a Projection,
    offsets: &'static [[i32; 2]],
    /// Least and largest sample offset along both axes.
    offset_bounds: [i32; 2],
    culls_back_faces: bool,
}

impl<'a> Setup<'a> {
    pub(super) fn new(projection: &'a Projection, settings: &Settings) -> Self {
        Self {
            projection,
            offsets: sample_offsets(settings.msaa),
            offset_bounds: offset_bounds(settings.msaa),
            culls_back_faces: settings.cull_back_faces,
        }
    }

    /// Appends the screen triangles of the triangles `range` of a mesh.
    pub(super) fn set_up(
        &self,
        mesh: usize,
        range: Range<usize>,
        triangles: &[[u32; 3]],
        vertices: &[ScreenVertex],
        out: &mut Vec<ScreenTriangle>,
    ) {
        for (index, indices) in range.clone().zip(&triangles[range]) {
            let corners = indices.map(|i| vertices[i as usize]);
            let [Some(a), Some(b), Some(c)] = corners.map(|corner| corner.snapped()) else {
                self.set_up_clipped(corners.map(|c| c.view), [mesh as u32, index as u32], out);
                continue;
            };
            if let Some(corners_snapped) = self.oriented([a, b, c]) {
                let view = corners.map(|c| c.view.map(f64::from));
                let depth = ScreenBasis::new(view, self.projection.center).inverse_w();
                out.push(ScreenTriangle { corners: corners_snapped, depth, mesh: mesh as u32, triangle: index as u32 });
            }
        }
    }

    #[cold]
    fn set_up_clipped(&self, view: [[f32; 3]; 3], [mesh, triangle]: [u32; 2], out: &mut Vec<ScreenTriangle>) {
        if !view.iter().flatten().all(|v| v.is_finite()) {
            return;
        }
        let view = view.map(|corner| corner.map(f64::from));
        let Some(polygon) = clip(view, self.projection) else {
            return;
        };
        let depth: Plane = ScreenBasis::new(view, self.projection.center).inverse_w();
        let first = self.projection.snap(polygon.corners()[0]);
        let pieces = polygon.corners()[1..].windows(2);
        let pieces = pieces.map(|pair| [first, self.projection.snap(pair[0]), self.projection.snap(pair[1])]);
        // Snapping may turn a sliver over; it then lies within the other pieces and must not count again.
        let is_back = pieces.clone().map(twice_area).sum::<i64>() > 0;
        for piece in pieces.filter(|&piece| (twice_area(piece) > 0) == is_back) {
            if let Some(corners) = self.oriented(piece) {
                out.push(ScreenTriangle { corners, depth, mesh, triangle });
            }
        }
    }

    /// The corners in positive orientation; `None` if culled or without a sample.
    #[inline]
    fn oriented(&self, [a, b, c]: Corners) -> Option<Corners> {
        let area = twice_area([a, b, c]);
        if area == 0 || (area > 0 && self.culls_back_faces) {
            return None;
        }
        let corners = if area > 0 { [a, b, c] } else { [a, c, b] };
        self.may_hold_sample(&corners).then_some(corners)
    }

    /// Whether the bounding box holds a sample of the frame; if it holds one pixel's only, whether the triangle does.
    #[inline]
    fn may_hold_sample(&self, corners: &Corners) -> bool {
        let [a, b, c] = *corners;
        let bounds = [0, 1].map(|i| (a[i].min(b[i]).min(c[i]), a[i].max(b[i]).max(c[i])));
        let [least, most] = self.offset_bounds;
        let size = [self.projection.width, self.projection.height];
        let pixels = [0, 1].map(|i| {
            let (min, max) = bounds[i];
            ((min - most + 255) >> 8, (max - least) >> 8, size[i] as i32)
        });
        if pixels.iter().any(|&(first, last, size)| first > last || last < 0 || first >= size) {
            return false;
        }
        let is_small = pixels.iter().all(|&(first, last, _)| last - first <= 1);
        !is_small || self.holds_sample(corners, bounds)
    }

    /// For triangles of at most two pixels a side: whether a sample lies in the bounding box and inside all edges.
    #[inline]
    fn holds_sample(&self, corners: &Corners, [x, y]: [(i32, i32); 2]) -> bool {
        self.offsets.iter().any(|offset| {
            let (x0, x1) = pixel_range(x.0, x.1, offset[0]);
            let (y0, y1) = pixel_range(y.0, y.1, offset[1]);
            let mut pixels = (y0..=y1).flat_map(|py| (x0..=x1).map(move |px| [px, py]));
            pixels.any(|p| is_inside(corners, [p[0] * 256 + offset[0], p[1] * 256 + offset[1]]))
        })
    }
}

/// Positive where the corners run clockwise as displayed.
#[inline]
fn twice_area([a, b, c]: Corners) -> i64 {
    let [(ux, uy), (vx, vy)] = [b, c].map(|p| (i64::from(p[0] - a[0]), i64::from(p[1] - a[1])));
    ux * vy - uy * vx
}

/// Whether a point lies in a small triangle of positive area or on any of its edges.
#[inline]
fn is_inside(corners: &Corners, p: [i32; 2]) -> bool {
    (0..3).all(|i| {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        // Differences are below 2^10 here.
        (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) >= 0
    })
}
