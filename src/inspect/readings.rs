//! Formulas (1), (2) and (3) for one pixel, in both readings.

use super::ground::Quad;
use crate::filter::Ellipse;
use crate::settings::{Derivatives, Formulas, Settings};
use crate::texture::Surface;

/// Texture coordinates of a pixel and what the relief adds to them, in repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Coordinates on the polygon.
    pub uv: [f32; 2],
    /// What the relief adds: the paper's (m, r) at (x, y), (n, o) at (x+1, y), (p, s) at (x, y+1).
    pub offset: [f32; 2],
}

/// The ellipse `A U^2 + B U V + C V^2 = F`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conic {
    /// Factor of U^2.
    pub a: f32,
    /// Factor of U V.
    pub b: f32,
    /// Factor of V^2.
    pub c: f32,
    /// The right side.
    pub f: f32,
}

/// A pixel's projection on the texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projected {
    /// `(Ux, Vx) = (du/dx, dv/dx)` in repeats a pixel.
    pub dx: [f32; 2],
    /// `(Uy, Vy) = (du/dy, dv/dy)` in repeats a pixel.
    pub dy: [f32; 2],
    /// Its middle in texels of the level of [`Sets`](super::Sets), whose centres lie at halves.
    pub center: [f32; 2],
    /// Formula (1) in those texels.
    pub conic: Conic,
    /// The same with the reconstruction kernel added and its anisotropy bounded: whose texels are averaged.
    pub widened: Conic,
    /// Area of the widened ellipse in texels.
    pub area: f32,
    /// Half axes of the widened ellipse in texels: shorter, longer. Of a printed ellipse, as if its F were that of its A,
    /// B and C.
    pub half_axes: [f32; 2],
}

/// The formulas in one reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Which reading.
    pub formulas: Formulas,
    /// The quad's pixels in the row of the pixel (left, right): the x-difference is theirs.
    pub row: [Corner; 2],
    /// The quad's pixels in the column of the pixel (upper, lower): the y-difference is theirs.
    pub column: [Corner; 2],
    /// By formula (2), around the place on the polygon.
    pub flat: Projected,
    /// By formula (3), around the hit.
    pub relief: Projected,
}

impl Conic {
    /// `(A U^2 + B U V + C V^2) / F`: up to 1 inside.
    #[must_use]
    pub fn r2(&self, [u, v]: [f32; 2]) -> f32 {
        ((self.a * u + self.b * v) * u + self.c * v * v) / self.f
    }
}

impl From<Ellipse> for Conic {
    fn from(Ellipse { a, b, c, f }: Ellipse) -> Self {
        Self { a, b, c, f }
    }
}

/// The formulas as meant and as printed, in texels of a level.
pub(super) fn both(surface: &Surface, level: usize, quad: &Quad, settings: &Settings) -> [Reading; 2] {
    [Formulas::Meant, Formulas::Printed].map(|formulas| Reading {
        formulas,
        row: [quad.lane & !1, quad.lane | 1].map(|lane| corner(quad, lane)),
        column: [quad.lane & !2, quad.lane | 2].map(|lane| corner(quad, lane)),
        flat: projected(surface, level, quad, (Derivatives::Flat, formulas), settings),
        relief: projected(surface, level, quad, (Derivatives::Relief, formulas), settings),
    })
}

fn corner(quad: &Quad, lane: usize) -> Corner {
    let at = |lanes: &[crate::simd::PixelLanes; 2]| lanes.map(|lanes| lanes.as_array()[lane]);
    Corner { uv: at(&quad.uv), offset: at(&quad.offset) }
}

fn projected(
    surface: &Surface,
    level: usize,
    quad: &Quad,
    which: (Derivatives, Formulas),
    settings: &Settings,
) -> Projected {
    let footprint = quad.footprint(which);
    let texels = surface.texels_per_repeat(level);
    let ellipse = Ellipse::new(&footprint, texels, which.1);
    let widened = ellipse.widened(settings.max_anisotropy, which.1);
    Projected {
        dx: footprint.dx,
        dy: footprint.dy,
        center: [footprint.center[0] * texels[0], footprint.center[1] * texels[1]],
        conic: ellipse.into(),
        widened: widened.into(),
        area: widened.area(),
        half_axes: widened.squared_axes().map(f32::sqrt),
    }
}
