//! The coordinates of a sweep: lines along the displacement, and the pixels on them.
//!
//! Rows are texel rows across the longer axis of the displacement, counted in the walking
//! direction: `q` is their distance from the middle of the patch. A line is known by `xi`, its
//! distance from the middle line where `q = 0`:
//!
//! ```text
//!   far end     \  |  /      lines run apart or together by the spread k
//!   ^   --*------\-|-/------  a row of texels: q rows from the middle, lines cross it at x
//!   |             \|/
//!   q   ---------- * ------- the middle of the patch: q = 0, xi = 0 on the middle line
//!   |             /|\        lines lean by the shear e: x = e q + xi (1 + k q)
//!   near end     / | \
//!                  xi ->     the walk goes from the near end to the far one
//! ```
//!
//! with the shear `e = D_x / D_y`. On a plane the displacements of a picture are `D(p) = c (p -
//! foot)`, where `foot` is the point under the eye: lines meet there, which is the spread `k = c /
//! D`, and a texel at `q` and depth `d` is seen at
//!
//! ```text
//! p = (q - d D) / (1 + d c)      from      q = p + d (D + c p).
//! ```
//!
//! Curved surfaces have other growths along and across the lines, and displacements that differ
//! from line to line.

use super::pixels::PixelsOnLines;
use crate::footprint::{Ellipses, Footprints};
use crate::simd::{PixelLanes, sum};
use crate::texture::{Rows, Surface, near_origin};

/// Displacements shorter than this many texels do not hide anything that a texel could show.
const FLAT: f32 = 1.0 / 64.0;

/// How far, in radii of its ellipse and squared, a pixel's displacement may be from what the lines
/// take it for.
const MOST_MISFIT: f32 = 0.25;

/// Least and greatest distance between lines over that in the middle of the patch.
const SPREAD: [f32; 2] = [0.6, 1.6];

/// Greatest growth `c`.
const MOST_GROWTH: f32 = 0.5;

/// Where lines and rows of a patch lie in one level.
#[derive(Clone, Debug)]
pub(super) struct SweepFrame<'a> {
    pub(super) rows: &'a Rows,
    /// Whether rows run along v.
    pub(super) is_turned: bool,
    /// Texels a repeat along the rows and across them.
    pub(super) texels: [f32; 2],
    /// The middle in repeats, and near the origin in texels, along the rows and across; texel centres
    /// lie at whole numbers.
    middle: [f32; 2],
    pub(super) origin: [f32; 2],
    /// 1 where the walk goes to higher rows, else -1.
    pub(super) toward: f32,
    pub(super) shear: f32,
    pub(super) spread: f32,
    /// Rows down to the deepest relief in the middle, and how they grow per row and per texel
    /// across.
    pub(super) depth: f32,
    pub(super) growth: f32,
    pub(super) tilt: f32,
    /// How displacements [bow](super::bow), in texels: along the lines, and across them.
    pub(super) bow: f32,
    pub(super) sway: f32,
    /// Mean depth of the surface, 0 to 1.
    pub(super) mean_depth: f32,
}

/// Sums over the picked lanes.
pub(super) fn total<T>(vectors: &[T], picked: &[PixelLanes], of: impl Fn(&T) -> PixelLanes) -> f32 {
    sum(vectors
        .iter()
        .zip(picked)
        .fold(PixelLanes::ZERO, |all, (vector, picked)| all + (of(vector) & *picked)))
}

/// The means over the picked lanes of place and displacement, in repeats.
pub(super) fn means(pixels: &[Footprints], picked: &[PixelLanes], num: usize) -> [[f32; 2]; 2] {
    // Relative to one pixel, so that large coordinates lose nothing.
    let lane = (0..8).find(|i| picked[0].as_array()[*i].to_bits() != 0).unwrap_or(0);
    let first = pixels[0].base.map(|lanes| lanes.as_array()[lane]);
    let inverse = 1.0 / num as f32;
    let center =
        [0, 1].map(|i| first[i] + total(pixels, picked, |p| p.base[i] - first[i]) * inverse);
    [center, [0, 1].map(|i| total(pixels, picked, |p| p.displacement[i]) * inverse)]
}

impl<'a> SweepFrame<'a> {
    /// The frame on a level around `middle` and `displacement` (means in repeats) of the picked
    /// pixels, without growth.
    pub(super) fn new(
        surface: &'a Surface,
        index: usize,
        [middle, displacement]: [[f32; 2]; 2],
        is_long_along_u: bool,
    ) -> Self {
        let level = &surface.levels()[index];
        let texels = level.texels_per_repeat();
        let [du, dv] = [displacement[0] * texels[0], displacement[1] * texels[1]];
        let is_flat = du.abs().max(dv.abs()) < FLAT;
        // Walk along the longer axis of the displacement: lines then lean a texel a row at most.
        let is_turned = if is_flat { is_long_along_u } else { du.abs() > dv.abs() };
        let turn = |[u, v]: [f32; 2]| if is_turned { [v, u] } else { [u, v] };
        let start = turn(near_origin(middle, surface.wrap()));
        let (middle, texels, [dx, dy]) = (turn(middle), turn(texels), turn([du, dv]));
        let toward = if dy < 0.0 { -1.0 } else { 1.0 };
        let (depth, shear) = if is_flat { (0.0, 0.0) } else { (dy.abs(), dx / dy * toward) };
        let origin = [0, 1].map(|i| start[i] * texels[i] - 0.5);
        Self {
            rows: level.rows(is_turned),
            is_turned,
            texels,
            middle,
            origin,
            toward,
            shear,
            spread: 0.0,
            depth,
            growth: 0.0,
            tilt: 0.0,
            bow: 0.0,
            sway: 0.0,
            mean_depth: surface.mean_depth(),
        }
    }

    pub(super) fn turn<T>(&self, [u, v]: [T; 2]) -> [T; 2] {
        if self.is_turned { [v, u] } else { [u, v] }
    }

    /// Place and displacement of pixels in this frame: along the rows and in the walking direction,
    /// from the middle.
    #[inline]
    fn place(&self, pixels: &Footprints) -> [[PixelLanes; 2]; 2] {
        let [x, y] = self.turn(pixels.base);
        let [dx, dy] = self.turn(pixels.displacement);
        let [tx, ty] = [self.texels[0], self.texels[1] * self.toward];
        [[(x - self.middle[0]) * tx, (y - self.middle[1]) * ty], [dx * tx, dy * ty]]
    }

    /// Finds how displacements grow over the picked pixels. `None` where they grow in another way.
    pub(super) fn fit(
        mut self,
        pixels: &[Footprints],
        ellipses: &[Ellipses],
        picked: &[PixelLanes],
    ) -> Option<Self> {
        if self.depth == 0.0 {
            return Some(self);
        }
        // Least squares, by the place on the middle's line and across it.
        let [mut qq, mut qx, mut xx, mut q_along, mut x_along, mut x_across] =
            [PixelLanes::ZERO; 6];
        for (pixels, &picked) in pixels.iter().zip(picked) {
            let [[x, q], [along, across]] = self.growths(pixels);
            let product = |a: PixelLanes, b: PixelLanes| (a * b) & picked;
            (qq, qx, xx) = (qq + product(q, q), qx + product(q, x), xx + product(x, x));
            (q_along, x_along) = (q_along + product(q, along), x_along + product(x, along));
            x_across += product(x, across);
        }
        let [qq, qx, xx, q_along, x_along, x_across] =
            [qq, qx, xx, q_along, x_along, x_across].map(sum);
        let determinant = qq * xx - qx * qx;
        if determinant > 1e-3 * qq * xx {
            self.growth = (q_along * xx - x_along * qx) / determinant;
            self.tilt = (x_along * qq - q_along * qx) / determinant;
            self.spread = x_across / (xx * self.depth);
        } else {
            // Pixels in one line, as two always are, do not tell the two directions apart: take the
            // least growth and tilt that there may be.
            let inverse = 1.0 / (qq + xx).max(f32::MIN_POSITIVE);
            (self.growth, self.tilt) = (q_along * inverse, x_along * inverse);
            self.spread = if xx > 1e-2 * qq { x_across / (xx * self.depth) } else { 0.0 };
        }
        // Measure what the fit leaves over in radii of each pixel's own ellipse.
        let mut misfit = PixelLanes::ZERO;
        for ((pixels, ellipse), &picked) in pixels.iter().zip(ellipses).zip(picked) {
            let [rx, ry] = self.residuals(pixels);
            let ([a, c], b) = (self.turn([ellipse.a, ellipse.c]), ellipse.b * self.toward);
            let r2 = (a * rx * rx + b * rx * ry + c * ry * ry) / ellipse.f;
            misfit = misfit.fast_max(r2 & picked);
        }
        // At the mean depth there is none, see `pixels_on_lines`.
        let farthest = self.mean_depth.max(1.0 - self.mean_depth);
        let is_fit = misfit.simd_le(PixelLanes::splat(MOST_MISFIT / (farthest * farthest))).all();
        (is_fit && self.growth.abs() <= MOST_GROWTH).then_some(self)
    }

    /// Pixels across and along the middle's line, and how their displacements differ from the
    /// middle's along and across it.
    #[inline]
    fn growths(&self, pixels: &Footprints) -> [[PixelLanes; 2]; 2] {
        let [[x, q], [dx, dq]] = self.place(pixels);
        [[x - q * self.shear, q], [dq - self.depth, dx - dq * self.shear]]
    }

    /// How far along the rows and across them pixels' displacements are from what the lines take
    /// them for.
    #[inline]
    fn residuals(&self, pixels: &Footprints) -> [PixelLanes; 2] {
        let [[x, q], [along, across]] = self.growths(pixels);
        let ry = along - q * self.growth - x * self.tilt;
        [across - x * (self.spread * self.depth) + ry * self.shear, ry]
    }

    /// The pixels' ellipses on the lines, moved to where the lines see what the pixels see at the
    /// mean depth.
    #[inline]
    pub(super) fn pixels_on_lines(
        &self,
        pixels: &Footprints,
        ellipses: &Ellipses,
    ) -> PixelsOnLines {
        let [[x, q], _] = self.place(pixels);
        let [rx, ry] = self.residuals(pixels);
        let x = x + rx * self.mean_depth - q * self.sway_ahead();
        let q = q + ry * self.mean_depth;
        // Find the line through the pixel, and how it leans there.
        let scale = q * self.spread + 1.0;
        let xi = (x - q * self.shear) / scale;
        let shear = xi * self.spread + self.shear;
        // Write the ellipse in the lines' coordinates.
        let ([a, c], b) = (self.turn([ellipses.a, ellipses.c]), ellipses.b * self.toward);
        // F = A C - B^2 / 4, which the shear keeps: so A' - B'^2 / 4C' is 1 / C F, without a
        // difference that cancels.
        let c = ((a * shear + b) * shear + c).fast_max(ellipses.f / a);
        let b = (a * shear * 2.0 + b) * scale;
        let width = c.sqrt() / scale;
        PixelsOnLines {
            xi,
            q,
            along: (c / ellipses.f).sqrt(),
            skew: b / (c * 2.0),
            across: PixelLanes::ONE / (width * width),
            half_width: width,
            half_height: a.sqrt(),
        }
    }

    /// Most rows down to the deepest relief between two lines, in their middles.
    pub(super) fn greatest_depth(&self, lines: [f32; 2]) -> f32 {
        lines.into_iter().fold(self.depth, |most, xi| most.max(self.depth + self.tilt * xi))
    }

    /// Whether the rays of seen places between two lines and two rows go down the way that the sweep
    /// walks. Around a place that faces the eye they go apart to all sides, and what is walked the other
    /// way is seen beyond its own row.
    pub(super) fn goes_one_way(&self, lines: [f32; 2], rows: [f32; 2]) -> bool {
        let least = |growth: f32, [a, b]: [f32; 2]| (growth * a).min(growth * b);
        self.depth + least(self.growth, rows) + least(self.tilt, lines) >= -FLAT
    }

    /// How much farther apart than in the middle lines are at row `q`.
    fn scale_at(&self, q: f32) -> f32 {
        1.0 + self.spread * q
    }

    /// The greatest distance between lines over that in the middle, between two rows; `None` where
    /// lines run together.
    pub(super) fn greatest_scale(&self, rows: [f32; 2]) -> Option<f32> {
        let [a, b] = rows.map(|q| self.scale_at(q));
        let is_regular = |scale: f32| (SPREAD[0]..=SPREAD[1]).contains(&scale);
        (is_regular(a) && is_regular(b)).then(|| a.max(b))
    }
}
