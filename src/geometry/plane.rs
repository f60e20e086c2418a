//! Attributes of a triangle as linear functions on the screen.
//!
//! With the corners' view-space rows `p_i = (x_i, y_i, w_i)`, an attribute `a` that is linear on
//! the triangle has `(a / w)(X, Y) = c . (X, Y, 1)` where `c . p_i = a_i` (Olano and Greer 1997).
//! So `c = (a_0 n_0 + a_1 n_1 + a_2 n_2) / det` with `n_0 = p_1 x p_2` and its like, `det = p_0 .
//! n_0`. No division by `w`: corners behind the eye are as good as others, and clipped pieces share
//! their triangle's functions. Where rays are parallel `w` is 1, and the same holds of `a` itself.

use crate::simd::f64x8;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A linear function on the screen: `value = c[0] * x + c[1] * y + c[2]`, x to the right and y
/// down, in pixels; the centre of the first pixel lies at (0.5, 0.5).
pub type Plane = [f32; 3];

/// A slope of the nearness, in units of its largest value per pixel, from which a triangle counts as
/// seen edge on: a snapping step of 1/256 pixel would then change it by a quarter, and the function
/// says nothing about the snapped triangle. Where rays are parallel the unit is the picture's height.
const EDGE_ON: f64 = 64.0;

/// How rays go through the frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lens {
    /// The optical axis in pixels from the frame's upper left corner.
    pub(super) center: [f64; 2],
    /// The picture's height in world units where rays are parallel.
    pub(super) parallel: Option<f64>,
}

impl Lens {
    /// What a view-space point at a distance along the view is divided by on the screen.
    #[inline]
    pub(super) fn w(&self, distance: f64) -> f64 {
        if self.parallel.is_some() { 1.0 } else { distance }
    }

    /// How far from the eye a slope of the nearness counts as one of a triangle seen edge on, whose
    /// nearest corner is so far: one over the nearness's unit.
    fn reach(&self, nearest: f64) -> f64 {
        self.parallel.map_or(nearest, |height| 1.0 / height)
    }
}

/// What turns the values at a triangle's corners into a [`Plane`].
#[derive(Clone, Copy, Debug)]
pub struct ScreenBasis {
    /// `n_i / det`, about the frame's middle.
    rows: [[f64; 3]; 3],
    /// The corners' nearness times `w`.
    nearness: [f64; 3],
    center: [f64; 2],
}

impl ScreenBasis {
    /// The basis of a triangle from its corners in view space: x, y, and the distance along the view.
    /// A triangle seen edge on takes the values of its farthest corner everywhere.
    #[inline]
    pub fn new(view: [[f64; 3]; 3], lens: &Lens) -> Self {
        let (points, nearness) = homogeneous(view, lens, 1.0);
        let rows = rows(points, 1.0);
        let nearest = view[0][2].min(view[1][2]).min(view[2][2]);
        let slope = slope(&rows, nearness, f64::abs);
        let is_edge_on = nearest > 0.0 && slope * lens.reach(nearest) > EDGE_ON;
        let is_bounded = slope <= f64::from(f32::MAX);
        if is_edge_on || !is_bounded {
            Self::constant(view, lens)
        } else {
            Self { rows, nearness, center: lens.center }
        }
    }

    #[cold]
    fn constant(view: [[f64; 3]; 3], lens: &Lens) -> Self {
        let far = view[0][2].max(view[1][2]).max(view[2][2]);
        let corner = view.iter().position(|p| p[2] == far).unwrap_or(0);
        let mut rows = [[0.0; 3]; 3];
        rows[corner][2] = 1.0 / lens.w(far);
        Self { rows, nearness: homogeneous(view, lens, 1.0).1, center: lens.center }
    }

    /// The plane of the [nearness](super::projection).
    #[inline]
    pub fn nearness(&self) -> Plane {
        self.plane(self.nearness)
    }

    /// The plane of `a / w` from the values of `a` at the corners.
    #[inline]
    pub fn plane(&self, values: [f64; 3]) -> Plane {
        plane(&self.rows, self.center, values).map(|c| c as f32)
    }
}

/// The [`ScreenBasis`] of eight triangles at once, to the same bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BasisLanes {
    rows: [[f64x8; 3]; 3],
    nearness: [f64x8; 3],
    center: [f64x8; 2],
    is_parallel: bool,
}

impl BasisLanes {
    /// As [`ScreenBasis::new`].
    #[inline]
    pub(crate) fn new(view: [[f64x8; 3]; 3], lens: &Lens) -> Self {
        let (points, nearness) = homogeneous(view, lens, f64x8::ONE);
        let rows = rows(points, f64x8::ONE);
        let is_parallel = lens.parallel.is_some();
        let mut basis = Self { rows, nearness, center: lens.center.map(f64x8::splat), is_parallel };
        let nearest = view[0][2].fast_min(view[1][2]).fast_min(view[2][2]);
        let slope = slope(&rows, nearness, f64x8::abs);
        let reach = lens.parallel.map_or(nearest, |height| f64x8::splat(1.0 / height));
        let is_edge_on =
            nearest.simd_gt(f64x8::ZERO) & (slope * reach).simd_gt(f64x8::splat(EDGE_ON));
        let is_bounded = slope.simd_le(f64x8::splat(f64::from(f32::MAX)));
        let special = is_edge_on.to_bitmask() | (!is_bounded.to_bitmask() & 0xff);
        if special != 0 {
            (0..8)
                .filter(|lane| special >> lane & 1 != 0)
                .for_each(|lane| basis.set_lane(lane, &view, lens));
        }
        basis
    }

    #[cold]
    fn set_lane(&mut self, lane: usize, view: &[[f64x8; 3]; 3], lens: &Lens) {
        let one = ScreenBasis::new(view.map(|p| p.map(|c| c.as_array()[lane])), lens);
        for (lanes, value) in self.rows.iter_mut().flatten().zip(one.rows.as_flattened()) {
            lanes.as_mut_array()[lane] = *value;
        }
    }

    /// The coefficients of the planes of 1 / w.
    #[inline]
    pub(crate) fn inverse_w(&self) -> [[f32; 8]; 3] {
        if self.is_parallel {
            // Without the rounding of the sum below.
            return [[0.0; 8], [0.0; 8], [1.0; 8]];
        }
        self.plane([f64x8::ONE; 3])
    }

    /// The coefficients of the planes of the [nearness](super::projection).
    #[inline]
    pub(crate) fn nearness(&self) -> [[f32; 8]; 3] {
        self.plane(self.nearness)
    }

    /// The coefficients of the planes of `a / w` from the values of `a` at the corners.
    #[inline]
    pub(crate) fn plane(&self, values: [f64x8; 3]) -> [[f32; 8]; 3] {
        plane(&self.rows, self.center, values).map(|lanes| lanes.to_array().map(|c| c as f32))
    }
}

/// A number or lanes of numbers.
trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
}

impl Number for f64 {}
impl Number for f64x8 {}

/// The corners as rows `(x, y, w)`, and their nearness times `w`.
#[inline(always)]
fn homogeneous<T: Number>(view: [[T; 3]; 3], lens: &Lens, one: T) -> ([[T; 3]; 3], [T; 3]) {
    match lens.parallel {
        Some(_) => (view.map(|[x, y, _]| [x, y, one]), view.map(|[_, _, d]| -d)),
        None => (view, [one; 3]),
    }
}

/// `n_i / det` from the corners.
#[inline(always)]
fn rows<T: Number>([p0, p1, p2]: [[T; 3]; 3], one: T) -> [[T; 3]; 3] {
    let normals = [cross(p1, p2), cross(p2, p0), cross(p0, p1)];
    let scale = one / (p0[0] * normals[0][0] + p0[1] * normals[0][1] + p0[2] * normals[0][2]);
    normals.map(|n| n.map(|v| v * scale))
}

/// How much a value over w changes over a pixel, both ways together.
#[inline(always)]
fn slope<T: Number>(rows: &[[T; 3]; 3], [a0, a1, a2]: [T; 3], abs: impl Fn(T) -> T) -> T {
    let along = |axis: usize| abs(a0 * rows[0][axis] + a1 * rows[1][axis] + a2 * rows[2][axis]);
    along(0) + along(1)
}

#[inline(always)]
fn plane<T: Number>(rows: &[[T; 3]; 3], center: [T; 2], [a0, a1, a2]: [T; 3]) -> [T; 3] {
    let [n0, n1, n2] = *rows;
    let [c0, c1, c2] = [0, 1, 2].map(|i| a0 * n0[i] + a1 * n1[i] + a2 * n2[i]);
    [c0, c1, c2 - c0 * center[0] - c1 * center[1]]
}

#[inline(always)]
fn cross<T: Number>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
