//! Clips a triangle against the near plane and the guard band (Sutherland and Hodgman 1974), in
//! homogeneous coordinates.
//!
//! A point is inside a plane where its distance from that is not below 0: `d - near`, and `GUARD w - x`
//! with its like, with the `w` of [`projection`](super::projection). Where an edge leaves, the new vertex is computed from the inside end to the
//! outside end, so both triangles of a shared edge compute the same numbers, whichever way round
//! they run through it.

use super::projection::{GUARD, Projection};

/// A point in view space: x, y, and the distance along the view.
pub(super) type Point = [f64; 3];
/// Most corners of a triangle cut by five planes.
const MAX_CORNERS: usize = 8;

/// A convex polygon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Polygon {
    corners: [Point; MAX_CORNERS],
    num_corners: usize,
}

impl Polygon {
    /// The corners in order.
    pub(super) fn corners(&self) -> &[Point] {
        &self.corners[..self.num_corners]
    }

    fn push(&mut self, point: Point) {
        // A polygon that rounding made concave may have a corner more than theory allows: without
        // area, and left out.
        if self.num_corners < MAX_CORNERS {
            self.corners[self.num_corners] = point;
            self.num_corners += 1;
        }
    }
}

/// The part of a finite triangle before the near plane and within the guard band; `None` if all of
/// it is out of the frame.
pub(super) fn clip(triangle: [Point; 3], projection: &Projection) -> Option<Polygon> {
    if is_out_of_frame(&triangle, projection) {
        return None;
    }
    let mut polygon = Polygon { corners: [[0.0; 3]; MAX_CORNERS], num_corners: 3 };
    polygon.corners[..3].copy_from_slice(&triangle);
    polygon = cut(&polygon, |p| p[2] - f64::from(projection.near));
    let w = |p: &Point| projection.lens.w(p[2]);
    polygon = cut(&polygon, |p| GUARD * w(p) - p[0]);
    polygon = cut(&polygon, |p| GUARD * w(p) + p[0]);
    polygon = cut(&polygon, |p| GUARD * w(p) - p[1]);
    polygon = cut(&polygon, |p| GUARD * w(p) + p[1]);
    (polygon.num_corners >= 3).then_some(polygon)
}

/// Whether all corners lie on the outer side of one of the frame's borders or of the near plane.
fn is_out_of_frame(triangle: &[Point; 3], projection: &Projection) -> bool {
    let [left, above] = projection.lens.center;
    let w = |p: &Point| projection.lens.w(p[2]);
    let (right, below) = (f64::from(projection.width) - left, f64::from(projection.height) - above);
    let all = |distance: &dyn Fn(&Point) -> f64| triangle.iter().all(|p| distance(p) < 0.0);
    all(&|p| p[2] - f64::from(projection.near))
        || all(&|p| right * w(p) - p[0])
        || all(&|p| left * w(p) + p[0])
        || all(&|p| below * w(p) - p[1])
        || all(&|p| above * w(p) + p[1])
}

fn cut(polygon: &Polygon, distance: impl Fn(&Point) -> f64) -> Polygon {
    let mut result = Polygon { corners: [[0.0; 3]; MAX_CORNERS], num_corners: 0 };
    let corners = polygon.corners();
    for (i, start) in corners.iter().enumerate() {
        let end = &corners[(i + 1) % corners.len()];
        let (from, to) = (distance(start), distance(end));
        if from >= 0.0 {
            result.push(*start);
        }
        match (from >= 0.0, to >= 0.0) {
            (true, false) => result.push(crossing(start, end, from, to)),
            (false, true) => result.push(crossing(end, start, to, from)),
            _ => {}
        }
    }
    result
}

/// The point between `inside` and `outside` at distance zero.
fn crossing(inside: &Point, outside: &Point, distance_inside: f64, distance_outside: f64) -> Point {
    let t = distance_inside / (distance_inside - distance_outside);
    std::array::from_fn(|i| inside[i] + (outside[i] - inside[i]) * t)
}
