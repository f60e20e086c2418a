//! Numbers that are linear over a patch, fitted to its pixels.

use super::pixels::PixelOnLines;
use crate::light::NUM_AZIMUTHS;
use crate::relief::directions::diamond_angle;
use crate::simd::LineLanes;

/// A number that is linear in the line and the seen place.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Linear {
    pub(super) middle: f32,
    per_line: f32,
    per_row: f32,
}

impl Linear {
    #[inline(always)]
    pub(super) fn at(&self, xi: LineLanes, p: LineLanes) -> LineLanes {
        xi * self.per_line + p * self.per_row + self.middle
    }
}

/// How far pixels must lie apart for a slope to be told from them, in the squares of their ellipses'
/// half axes: those of a picture's patch lie hundreds of times as far.
const LEAST_SPREAD: f32 = 0.02;

/// Least squares over the places of pixels.
pub(super) struct Fit<'a> {
    pixels: &'a [PixelOnLines],
    pub(super) middle: [f32; 2],
    /// The inverse of the matrix of second moments: xx, xq, qq.
    inverse: [f32; 3],
}

impl<'a> Fit<'a> {
    pub(super) fn new(pixels: &'a [PixelOnLines]) -> Self {
        let num = 1.0 / pixels.len() as f32;
        let middle = pixels.iter().fold([0.0; 2], |sum, p| [sum[0] + p.xi, sum[1] + p.q]);
        let middle = middle.map(|sum: f32| sum * num);
        let mut moments = [0.0_f32; 3];
        for p in pixels {
            let [x, q] = [p.xi - middle[0], p.q - middle[1]];
            moments = [moments[0] + x * x, moments[1] + x * q, moments[2] + q * q];
        }
        // A little more on the diagonal leaves pixels in one line the least slope, and those that all
        // but share a place none: at an edge their lights may be far apart.
        let more = 1e-4 * (moments[0] + moments[2]);
        let size = |of: fn(&PixelOnLines) -> f32| {
            pixels.iter().map(|p| of(p) * of(p)).sum::<f32>() * LEAST_SPREAD
        };
        let [xx, xq, qq] = [
            moments[0] + more + size(|p| p.half_width),
            moments[1],
            moments[2] + more + size(|p| p.half_height),
        ];
        let determinant = xx * qq - xq * xq;
        let inverse = if determinant > 0.0 {
            [qq / determinant, -xq / determinant, xx / determinant]
        } else {
            [0.0; 3]
        };
        Self { pixels, middle, inverse }
    }

    pub(super) fn linear(&self, values: impl Iterator<Item = f32> + Clone) -> Linear {
        let middle = values.clone().sum::<f32>() / self.pixels.len() as f32;
        let [mut x, mut q] = [0.0_f32; 2];
        for (p, value) in self.pixels.iter().zip(values) {
            x += (p.xi - self.middle[0]) * (value - middle);
            q += (p.q - self.middle[1]) * (value - middle);
        }
        let [xx, xq, qq] = self.inverse;
        Linear { middle, per_line: xx * x + xq * q, per_row: xq * x + qq * q }
    }
}

/// Where a direction along the texture lies among the azimuths.
pub(super) fn azimuth(x: f32, y: f32) -> f32 {
    diamond_angle(x, y) * (NUM_AZIMUTHS as f32 * 0.25)
}
