//! Attributes of a triangle as linear functions on the screen.
//!
//! With the corners' view-space rows `p_i = (x_i, y_i, w_i)`, an attribute `a` that is linear on the triangle has
//! `(a / w)(X, Y) = c . (X, Y, 1)` where `c . p_i = a_i` (Olano and Greer 1997). So `c = (a_0 n_0 + a_1 n_1 + a_2 n_2) / det`
//! with `n_0 = p_1 x p_2` and its like, `det = p_0 . n_0`. No division by `w`: corners behind the eye are as good as
//! others, and clipped pieces share their triangle's functions.

/// A linear function on the screen: `value = c[0] * x + c[1] * y + c[2]`, x to the right and y down, in pixels; the
/// centre of the first pixel lies at (0.5, 0.5).
pub type Plane = [f32; 3];

/// A slope of 1/w, in units of its largest value per pixel, from which a triangle counts as seen edge on: a snapping
/// step of 1/256 pixel would then change 1/w by a quarter, and the function says nothing about the snapped triangle.
const EDGE_ON: f64 = 64.0;

/// What turns the values at a triangle's corners into a [`Plane`].
#[derive(Clone, Copy, Debug)]
pub struct ScreenBasis {
    /// `n_i / det`, about the frame's middle.
    rows: [[f64; 3]; 3],
    center: [f64; 2],
}

impl ScreenBasis {
    /// The basis of a triangle from its corners in view space; `center` is the frame's middle in pixels. A triangle seen
    /// edge on takes the values of its farthest corner everywhere.
    #[must_use]
    #[inline]
    pub fn new(view: [[f64; 3]; 3], center: [f64; 2]) -> Self {
        let [p0, p1, p2] = view;
        let normals = [cross(p1, p2), cross(p2, p0), cross(p0, p1)];
        let scale = 1.0 / (p0[0] * normals[0][0] + p0[1] * normals[0][1] + p0[2] * normals[0][2]);
        let basis = Self { rows: normals.map(|n| n.map(|v| v * scale)), center };
        let [c0, c1, _] = basis.plane_f64([1.0; 3]);
        let slope = c0.abs() + c1.abs();
        let (near, far) = (p0[2].min(p1[2]).min(p2[2]), p0[2].max(p1[2]).max(p2[2]));
        let is_bounded = slope <= f64::from(f32::MAX);
        let is_edge_on = near > 0.0 && slope * near > EDGE_ON;
        if is_edge_on || !is_bounded { Self::constant(view, far, center) } else { basis }
    }

    #[cold]
    fn constant(view: [[f64; 3]; 3], far: f64, center: [f64; 2]) -> Self {
        let corner = view.iter().position(|p| p[2] == far).unwrap_or(0);
        let mut rows = [[0.0; 3]; 3];
        rows[corner][2] = 1.0 / far;
        Self { rows, center }
    }

    /// The plane of 1 / w.
    #[must_use]
    #[inline]
    pub fn inverse_w(&self) -> Plane {
        self.plane([1.0; 3])
    }

    /// The plane of `a / w` from the values of `a` at the corners.
    #[must_use]
    #[inline]
    pub fn plane(&self, values: [f64; 3]) -> Plane {
        self.plane_f64(values).map(|c| c as f32)
    }

    #[inline]
    fn plane_f64(&self, [a0, a1, a2]: [f64; 3]) -> [f64; 3] {
        let [n0, n1, n2] = self.rows;
        let [c0, c1, c2] = [0, 1, 2].map(|i| a0 * n0[i] + a1 * n1[i] + a2 * n2[i]);
        [c0, c1, c2 - c0 * self.center[0] - c1 * self.center[1]]
    }
}

#[inline]
fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
