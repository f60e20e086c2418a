//! Attributes of a triangle as linear functions on the screen.
//!
//! With the corners' view-space rows `p_i = (x_i, y_i, w_i)`, an attribute `a` that is linear on
//! the triangle has `(a / w)(X, Y) = c . (X, Y, 1)` where `c . p_i = a_i` (Olano and Greer 1997).
//! So `c = (a_0 n_0 + a_1 n_1 + a_2 n_2) / det` with `n_0 = p_1 x p_2` and its like, `det = p_0 .
//! n_0`. No division by `w`: corners behind the eye are as good as others, and clipped pieces share
//! their triangle's functions.

use crate::simd::f64x8;
use std::ops::{Add, Div, Mul, Sub};

/// A linear function on the screen: `value = c[0] * x + c[1] * y + c[2]`, x to the right and y
/// down, in pixels; the centre of the first pixel lies at (0.5, 0.5).
pub type Plane = [f32; 3];

/// A slope of 1/w, in units of its largest value per pixel, from which a triangle counts as seen
/// edge on: a snapping step of 1/256 pixel would then change 1/w by a quarter, and the function
/// says nothing about the snapped triangle.
const EDGE_ON: f64 = 64.0;

/// What turns the values at a triangle's corners into a [`Plane`].
#[derive(Clone, Copy, Debug)]
pub struct ScreenBasis {
    /// `n_i / det`, about the frame's middle.
    rows: [[f64; 3]; 3],
    center: [f64; 2],
}

impl ScreenBasis {
    /// The basis of a triangle from its corners in view space; `center` is the frame's middle in
    /// pixels. A triangle seen edge on takes the values of its farthest corner everywhere.
    #[inline]
    pub fn new(view: [[f64; 3]; 3], center: [f64; 2]) -> Self {
        let rows = rows(view, 1.0);
        let (near, slope) = (view[0][2].min(view[1][2]).min(view[2][2]), slope(&rows, f64::abs));
        let is_edge_on = near > 0.0 && slope * near > EDGE_ON;
        let is_bounded = slope <= f64::from(f32::MAX);
        if is_edge_on || !is_bounded { Self::constant(view, center) } else { Self { rows, center } }
    }

    #[cold]
    fn constant(view: [[f64; 3]; 3], center: [f64; 2]) -> Self {
        let far = view[0][2].max(view[1][2]).max(view[2][2]);
        let corner = view.iter().position(|p| p[2] == far).unwrap_or(0);
        let mut rows = [[0.0; 3]; 3];
        rows[corner][2] = 1.0 / far;
        Self { rows, center }
    }

    /// The plane of 1 / w.
    #[inline]
    pub fn inverse_w(&self) -> Plane {
        self.plane([1.0; 3])
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
    center: [f64x8; 2],
}

impl BasisLanes {
    /// As [`ScreenBasis::new`].
    #[inline]
    pub(crate) fn new(view: [[f64x8; 3]; 3], center: [f64; 2]) -> Self {
        let rows = rows(view, f64x8::ONE);
        let mut basis = Self { rows, center: center.map(f64x8::splat) };
        let (near, slope) =
            (view[0][2].fast_min(view[1][2]).fast_min(view[2][2]), slope(&rows, f64x8::abs));
        let is_edge_on = near.simd_gt(f64x8::ZERO) & (slope * near).simd_gt(f64x8::splat(EDGE_ON));
        let is_bounded = slope.simd_le(f64x8::splat(f64::from(f32::MAX)));
        let special = is_edge_on.to_bitmask() | (!is_bounded.to_bitmask() & 0xff);
        if special != 0 {
            (0..8)
                .filter(|lane| special >> lane & 1 != 0)
                .for_each(|lane| basis.set_lane(lane, &view, center));
        }
        basis
    }

    #[cold]
    fn set_lane(&mut self, lane: usize, view: &[[f64x8; 3]; 3], center: [f64; 2]) {
        let one = ScreenBasis::new(view.map(|p| p.map(|c| c.as_array()[lane])), center);
        for (lanes, value) in self.rows.iter_mut().flatten().zip(one.rows.as_flattened()) {
            lanes.as_mut_array()[lane] = *value;
        }
    }

    /// The coefficients of the planes of 1 / w.
    #[inline]
    pub(crate) fn inverse_w(&self) -> [[f32; 8]; 3] {
        self.plane([f64x8::ONE; 3])
    }

    /// The coefficients of the planes of `a / w` from the values of `a` at the corners.
    #[inline]
    pub(crate) fn plane(&self, values: [f64x8; 3]) -> [[f32; 8]; 3] {
        plane(&self.rows, self.center, values).map(|lanes| lanes.to_array().map(|c| c as f32))
    }
}

/// A number or lanes of numbers.
trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
}

impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Div<Output = T>> Number for T {}

/// `n_i / det` from the corners.
#[inline(always)]
fn rows<T: Number>([p0, p1, p2]: [[T; 3]; 3], one: T) -> [[T; 3]; 3] {
    let normals = [cross(p1, p2), cross(p2, p0), cross(p0, p1)];
    let scale = one / (p0[0] * normals[0][0] + p0[1] * normals[0][1] + p0[2] * normals[0][2]);
    normals.map(|n| n.map(|v| v * scale))
}

/// How much 1 / w changes over a pixel, both ways together.
#[inline(always)]
fn slope<T: Number>(rows: &[[T; 3]; 3], abs: impl Fn(T) -> T) -> T {
    let along = |axis: usize| abs(rows[0][axis] + rows[1][axis] + rows[2][axis]);
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
