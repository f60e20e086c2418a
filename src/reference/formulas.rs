//! Formulas (1), (2) and (3) as the paper prints them and as they are meant.

use crate::footprint::FootprintRule;
use crate::settings::{Derivatives, Formulas};

/// `[du/dx, dv/dx, du/dy, dv/dy]` from coordinates `[u, v]` and relief offsets at (x, y), (x+1, y)
/// and (x, y+1).
///
/// The letters are the paper's: offsets (m, r) at (x, y), (n, o) at (x+1, y), (p, s) at (x, y+1).
pub fn derivatives(uv: [[f32; 2]; 3], offsets: [[f32; 2]; 3], rule: &FootprintRule) -> [f32; 4] {
    let [[u, v], [u_right, v_right], [u_below, v_below]] = uv;
    let [[m, r], [n, o], [p, s]] = offsets;
    match (rule.derivatives, rule.formulas) {
        (Derivatives::Flat, Formulas::Meant) => {
            [u_right - u, v_right - v, u_below - u, v_below - v]
        }
        (Derivatives::Flat, Formulas::Printed) => {
            [u_right - u, v_right - u, u_below - u, v_below - u]
        }
        (Derivatives::Relief, Formulas::Meant) => [
            (u_right + n) - (u + m),
            (v_right + o) - (v + r),
            (u_below + p) - (u + m),
            (v_below + s) - (v + r),
        ],
        (Derivatives::Relief, Formulas::Printed) => {
            [u_right + n - u + m, v_right + o - u + m, u_below + p - v + r, v_below + s - v + r]
        }
    }
}

/// The ellipse `A U^2 + B U V + C V^2 = F` of formula (1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conic {
    /// `Vx^2 + Vy^2`.
    pub a: f64,
    /// `-2 (Ux Vx + Uy Vy)`.
    pub b: f64,
    /// `Ux^2 + Uy^2`.
    pub c: f64,
    /// The right side.
    pub f: f64,
}

impl Conic {
    /// Formula (1) from `[Ux, Vx, Uy, Vy]`.
    pub fn new([ux, vx, uy, vy]: [f64; 4], formulas: Formulas) -> Self {
        let f = match formulas {
            Formulas::Meant => (ux * vy - uy * vx) * (ux * vy - uy * vx),
            Formulas::Printed => (ux * vy + uy * vx) * (ux * vy + uy * vx),
        };
        Self { a: vx * vx + vy * vy, b: -2.0 * (ux * vx + uy * vy), c: ux * ux + uy * uy, f }
    }

    /// With `kernel` added to A and C, and the shorter axis at least `least` and the longer over
    /// `max_anisotropy`.
    ///
    /// The axes squared are the eigenvalues of `[[C, -B/2], [-B/2, A]]`; the shorter grows along
    /// its eigenvector.
    pub fn widened(self, kernel: f64, max_anisotropy: f64, least: f64) -> Self {
        let (a, b, c) = (self.a + kernel, self.b, self.c + kernel);
        let half = (0.25 * (a - c) * (a - c) + 0.25 * b * b).sqrt();
        let long = (0.5 * (a + c) + half).max(least * least);
        let short = ((a * c - 0.25 * b * b) / long).max(0.0);
        let lift = ((long / (max_anisotropy * max_anisotropy)).max(least * least) - short).max(0.0);
        let share = if half > 0.0 { lift / (2.0 * half) } else { 0.0 };
        let (a, b, c) = (a + share * (long - a), b - share * b, c + share * (long - c));
        Self { a, b, c, f: long * (short + lift) }
    }

    /// `(A U^2 + B U V + C V^2) / F`.
    pub fn r2(&self, u: f64, v: f64) -> f64 {
        (self.a * u * u + self.b * u * v + self.c * v * v) / self.f
    }
}

impl From<&crate::footprint::Ellipse> for Conic {
    fn from(ellipse: &crate::footprint::Ellipse) -> Self {
        let [a, b, c, f] = [ellipse.a, ellipse.b, ellipse.c, ellipse.f].map(f64::from);
        Self { a, b, c, f }
    }
}
