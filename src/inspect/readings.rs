//! Formulas (1), (2) and (3) for one pixel, in both readings.

use super::ground::QuadPixel;
use crate::footprint::{Ellipse, FootprintRule};
use crate::settings::{Derivatives, Formulas};
use crate::texture::{Level, Surface};

/// Texture coordinates of a pixel and what the relief adds to them, in repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Coordinates on the polygon.
    pub uv: [f32; 2],
    /// What the relief adds: the paper's (m, r) at (x, y), (n, o) at (x+1, y), (p, s) at (x, y+1).
    pub offset: [f32; 2],
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
    pub conic: Ellipse,
    /// The same with the reconstruction kernel added and its anisotropy bounded: whose texels are
    /// averaged.
    pub widened: Ellipse,
    /// Area of the widened ellipse in texels.
    pub area: f32,
    /// Half axes of the widened ellipse in texels: shorter, longer. Of a printed ellipse, as if its
    /// F were that of its A, B and C.
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

/// The formulas as meant and as printed, in texels of a level.
pub(super) fn both(
    surface: &Surface,
    level: usize,
    seen: &QuadPixel,
    max_anisotropy: f32,
) -> [Reading; 2] {
    let level = &surface.levels()[level];
    let corner = |lane: usize| {
        let [uv, offset] = seen.corner(lane);
        Corner { uv, offset }
    };
    [Formulas::Meant, Formulas::Printed].map(|formulas| {
        let projected =
            |derivatives| projected(level, seen, (derivatives, formulas), max_anisotropy);
        Reading {
            formulas,
            row: [seen.lane & !1, seen.lane | 1].map(corner),
            column: [seen.lane & !2, seen.lane | 2].map(corner),
            flat: projected(Derivatives::Flat),
            relief: projected(Derivatives::Relief),
        }
    })
}

fn projected(
    level: &Level,
    seen: &QuadPixel,
    (derivatives, formulas): (Derivatives, Formulas),
    max_anisotropy: f32,
) -> Projected {
    // Formula (2) stands around the place on the polygon, formula (3) around the hit.
    let is_traced = derivatives == Derivatives::Relief;
    let footprint =
        seen.footprint(&FootprintRule { derivatives, formulas, max_stretch: 0.0, is_traced });
    let conic = Ellipse::new(&footprint, level.texels_per_repeat(), formulas);
    let widened = conic.widened(max_anisotropy, formulas);
    Projected {
        dx: footprint.dx,
        dy: footprint.dy,
        center: level.in_texels(footprint.hit),
        conic,
        widened,
        area: widened.area(),
        half_axes: widened.squared_axes().map(f32::sqrt),
    }
}
