//! The ellipse of a footprint, formula (1): `A U^2 + B U V + C V^2 = F`, in texels of a mip level.
//!
//! ```text
//! A = Vx^2 + Vy^2    B = -2 (Ux Vx + Uy Vy)    C = Ux^2 + Uy^2
//! F = (Ux Vy - Uy Vx)^2 as meant (Heckbert)    F = (Ux Vy + Uy Vx)^2 as printed
//! ```
//!
//! With `J` the matrix of the derivatives, `J J^T = [[C, -B/2], [-B/2, A]]` and `F = det(J J^T) = A
//! C - B^2/4`. What the paper leaves out (Heckbert 1989): a reconstruction kernel is added to A and
//! C, so that the ellipse never falls between texels, and the shorter axis is widened where the
//! longer exceeds the greatest anisotropy.

use super::Footprint;
use crate::settings::{Formulas, RECONSTRUCTION};
use crate::simd::TexelLanes;

/// Least half axis in texels: what a magnified pixel covers is that much at least, so that no
/// division overflows.
pub const LEAST_AXIS: f32 = 1.0 / 256.0;

/// The coefficients of formula (1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// `Vx^2 + Vy^2`.
    pub a: f32,
    /// `-2 (Ux Vx + Uy Vy)`.
    pub b: f32,
    /// `Ux^2 + Uy^2`.
    pub c: f32,
    /// The right side.
    pub f: f32,
}

impl Ellipse {
    /// Formula (1) for a footprint, in texels of a level with that many texels a repeat.
    pub fn new(footprint: &Footprint, texels: [f32; 2], formulas: Formulas) -> Self {
        let [ux, vx] = [footprint.dx[0] * texels[0], footprint.dx[1] * texels[1]];
        let [uy, vy] = [footprint.dy[0] * texels[0], footprint.dy[1] * texels[1]];
        let root = match formulas {
            Formulas::Meant => ux * vy - uy * vx,
            Formulas::Printed => ux * vy + uy * vx,
        };
        Self {
            a: vx * vx + vy * vy,
            b: -2.0 * (ux * vx + uy * vy),
            c: ux * ux + uy * uy,
            f: root * root,
        }
    }

    /// The ellipse with the reconstruction kernel added and its anisotropy bounded. A printed F
    /// stays as printed.
    pub fn widened(self, max_anisotropy: f32, formulas: Formulas) -> Self {
        let wide = Self { a: self.a + RECONSTRUCTION, c: self.c + RECONSTRUCTION, ..self };
        let bounded = wide.bounded(max_anisotropy);
        if formulas == Formulas::Meant { bounded } else { Self { f: self.f, ..bounded } }
    }

    /// The ellipse with its shorter axis widened to the longer over `max_anisotropy`, and at least
    /// to [`LEAST_AXIS`].
    pub fn bounded(self, max_anisotropy: f32) -> Self {
        self.bounded_with_axes(max_anisotropy).0
    }

    /// [`bounded`](Self::bounded), and its [`squared_axes`](Self::squared_axes).
    pub fn bounded_with_axes(self, max_anisotropy: f32) -> (Self, [f32; 2]) {
        let Self { a, b, c, .. } = self;
        let [short, long] = self.squared_axes();
        let least = LEAST_AXIS * LEAST_AXIS;
        let long = long.max(least);
        let lift = ((long / (max_anisotropy * max_anisotropy)).max(least) - short).max(0.0);
        if lift == 0.0 {
            return (Self { f: long * short, ..self }, [short, long]);
        }
        // The square of the short axis grows along its own direction, the eigenvector of `short`; a
        // circle all around.
        let (a, b, c) = if long - short > 1e-6 * long {
            let share = lift / (long - short);
            (a + share * (long - a).max(0.0), b - share * b, c + share * (long - c).max(0.0))
        } else {
            (a + lift, b, c + lift)
        };
        (Self { a, b, c, f: long * (short + lift) }, [short + lift, long])
    }

    /// Squares of the shorter and the longer half axis in texels: the eigenvalues of `[[C, -B/2],
    /// [-B/2, A]]`.
    pub fn squared_axes(&self) -> [f32; 2] {
        let Self { a, b, c, .. } = *self;
        let (mean, half) = ((a + c) * 0.5, ((a - c) * (a - c) * 0.25 + b * b * 0.25).sqrt());
        let long = mean + half;
        // The determinant over the longer one, which does not cancel as `mean - half` does.
        [((a * c - b * b * 0.25) / long.max(f32::MIN_POSITIVE)).max(0.0), long]
    }

    /// `r^2 = (A U^2 + B U V + C V^2) / F`: up to 1 inside.
    pub fn r2(&self, [u, v]: [f32; 2]) -> f32 {
        ((self.a * u + self.b * v) * u + self.c * v * v) / self.f
    }

    /// Area in square texels.
    pub fn area(&self) -> f32 {
        let determinant = (4.0 * self.a * self.c - self.b * self.b).max(f32::MIN_POSITIVE);
        2.0 * std::f32::consts::PI * self.f / determinant.sqrt()
    }

    /// Greatest |V| inside.
    pub fn half_height(&self) -> f32 {
        // F does not cancel against the determinant: a printed one differs from it.
        (4.0 * self.a * self.f / (4.0 * self.a * self.c - self.b * self.b).max(f32::MIN_POSITIVE))
            .sqrt()
    }

    /// The least and greatest U inside on the line of constant V; `None` where the line misses.
    pub fn row(&self, v: f32) -> Option<[f32; 2]> {
        // Solve A U^2 + B V U + C V^2 - F = 0 for U.
        let (half_b, c) = (self.b * 0.5 * v, self.c * v * v - self.f);
        let discriminant = half_b * half_b - self.a * c;
        (discriminant >= 0.0).then(|| {
            let root = discriminant.sqrt();
            [(-half_b - root) / self.a, (-half_b + root) / self.a]
        })
    }
}

/// `r^2 = (A U^2 + B U V + C V^2) / F` along a row of constant V.
#[derive(Clone, Copy, Debug)]
pub struct RowQuadric {
    a: f32,
    bv: f32,
    cvv: f32,
}

impl RowQuadric {
    /// The quadric of the row at V.
    pub fn new(ellipse: &Ellipse, v: f32) -> Self {
        // Divide by F once a row, and not at each texel.
        let inverse_f = 1.0 / ellipse.f;
        Self {
            a: ellipse.a * inverse_f,
            bv: ellipse.b * v * inverse_f,
            cvv: ellipse.c * v * v * inverse_f,
        }
    }

    /// `r^2` at eight places U.
    pub fn at(&self, u: TexelLanes) -> TexelLanes {
        (u * self.a + self.bv) * u + self.cvv
    }
}
