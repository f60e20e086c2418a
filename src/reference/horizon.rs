//! The floating horizon, line by line.
//!
//! A line at `xi` across runs along the displacement `D`; texel rows cross it at whole places. Row
//! i lies at `eta_i` along the line, from the middle of the ellipse, and is seen over
//! `p_i = eta_i - d_i |D|`. The line's part of the kernel is `exp(-2 r^2)`,
//! `r^2 = r0^2 + C' (eta - eta0)^2`, and the eye sees what makes a new record of `p`. A bilinear
//! surface bends between two rows where a line leans: such lines are read half way between, too.

use super::formulas::Conic;
use super::stored::{color, exp_negative, height, integral};
use crate::texture::Level;
use std::collections::BTreeMap;

/// A sweep of parallel lines over one level.
#[derive(Clone, Copy, Debug)]
pub struct Lines<'a> {
    /// The level that is swept.
    pub level: &'a Level,
    /// The footprint's ellipse in texels.
    pub conic: Conic,
    /// Its middle in texels.
    pub center: [f64; 2],
    /// Texels down to the deepest relief.
    pub displacement: [f64; 2],
    /// Distance between two lines in texels, measured across.
    pub spacing: f64,
    /// 1; or 2 where lines are read half way between rows, too.
    pub steps_per_row: i64,
}

/// A place on a line: the texels around it with their shares, and where it is seen.
struct Crossing {
    p: f64,
    texels: [([i32; 2], f64); 4],
}

impl Lines<'_> {
    /// The share of every texel in the pixel's colour. They add up to 1.
    pub fn weights(&self) -> BTreeMap<[i32; 2], f64> {
        let mut weights = BTreeMap::new();
        let half_width = self.half_width();
        let num = (half_width / self.spacing).ceil() as i32;
        for k in -num..num {
            let xi = (f64::from(k) + 0.5) * self.spacing;
            if xi.abs() < half_width {
                self.sweep(xi, &mut weights);
            }
        }
        let total: f64 = weights.values().sum();
        weights.values_mut().for_each(|weight| *weight /= total);
        weights
    }

    /// The pixel's colour.
    pub fn mean(&self) -> [f64; 3] {
        self.weights().into_iter().fold([0.0; 3], |sum, (texel, weight)| {
            let color = color(self.level, texel);
            std::array::from_fn(|i| sum[i] + color[i] * weight)
        })
    }

    /// Whether a texel makes a new record on the line through the ellipse's middle, which must be
    /// the texel's centre.
    pub fn is_record(&self, texel: [i32; 2]) -> bool {
        let own = -(1.0 - height(self.level, texel)) * self.depth().abs();
        // Rows nearer than the deepest relief cannot reach over the texel's place.
        let first = -(self.depth().abs().ceil() as i64) - 1;
        (first..0).all(|i| self.crossing(i, 0.0).p <= own)
    }

    /// The same lines, read half way between rows where the sweep does so on the base level.
    pub fn with_half_rows(self) -> Self {
        let is_kinked = self.shear().abs() > 0.15 && self.half_width() < 4.0;
        Self { steps_per_row: if is_kinked { 2 } else { 1 }, ..self }
    }

    /// Half the width of the ellipse across the lines.
    pub fn half_width(&self) -> f64 {
        let [a, b, c] = self.sheared();
        1.0 / (a - b * b / (4.0 * c)).sqrt()
    }

    /// Displacements shorter than a 64th texel hide nothing.
    fn is_flat(&self) -> bool {
        self.displacement.iter().all(|d| d.abs() < 1.0 / 64.0)
    }

    /// Whether lines run along x: the longer axis of the displacement, or of the ellipse where
    /// there is none.
    fn is_turned(&self) -> bool {
        let [dx, dy] = self.displacement.map(f64::abs);
        if self.is_flat() { self.conic.a < self.conic.c } else { dx > dy }
    }

    /// The displacement across and along the rows.
    fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        if self.is_turned() { [y, x] } else { [x, y] }
    }

    /// Texels across per row.
    fn shear(&self) -> f64 {
        let [dx, dy] = self.turned(self.displacement);
        if self.is_flat() { 0.0 } else { dx / dy }
    }

    /// `A', B', C'` of `r^2 = A' xi^2 + B' xi eta + C' eta^2`.
    fn sheared(&self) -> [f64; 3] {
        let Conic { a, b, c, f } = self.conic;
        let ([a, c], e) = (self.turned([a, c]), self.shear());
        [a / f, (2.0 * a * e + b) / f, ((a * e + b) * e + c) / f]
    }

    /// Texels along the rows' axis down to the deepest relief.
    fn depth(&self) -> f64 {
        if self.is_flat() { 0.0 } else { self.turned(self.displacement)[1] }
    }

    fn toward(&self) -> f64 {
        if self.depth() < 0.0 { -1.0 } else { 1.0 }
    }

    /// The line at `xi` at step `i`, counted from the middle in the walking direction: where it
    /// crosses a row, or half way to the next.
    fn crossing(&self, i: i64, xi: f64) -> Crossing {
        let toward = self.toward();
        let [x0, y0] = self.turned([self.center[0] - 0.5, self.center[1] - 0.5]);
        let step = i as f64 / self.steps_per_row as f64;
        let y = (toward * y0).floor() + step.floor();
        let down = step - step.floor();
        let eta = y + down - toward * y0;
        let x = x0 + self.shear() * toward * eta + xi;
        let part = x - x.floor();
        let corners = [
            (0.0, 0.0, (1.0 - part) * (1.0 - down)),
            (1.0, 0.0, part * (1.0 - down)),
            (0.0, 1.0, (1.0 - part) * down),
            (1.0, 1.0, part * down),
        ];
        let texels = corners.map(|(across, along, share)| {
            (self.turned([x.floor() + across, toward * (y + along)]).map(|c| c as i32), share)
        });
        let height: f64 =
            texels.iter().map(|(texel, share)| height(self.level, *texel) * share).sum();
        Crossing { p: eta - (1.0 - height) * self.depth().abs(), texels }
    }

    fn sweep(&self, xi: f64, weights: &mut BTreeMap<[i32; 2], f64>) {
        let [a, b, c] = self.sheared();
        let toward = self.toward();
        let r0 = xi * xi * (a - b * b / (4.0 * c));
        let half = ((1.0 - r0) / c).sqrt();
        let middle = -toward * b * xi / (2.0 * c);
        let (entry, exit) = (middle - half, middle + half);
        let integral_at = |p: f64| integral((p - middle) * c.sqrt());
        let first = (entry.floor() as i64 - 2) * self.steps_per_row;
        let last = ((exit + self.depth().abs()).ceil() as i64 + 2) * self.steps_per_row;
        let (mut previous, mut horizon) = (self.crossing(first, xi), entry);
        for next in (first + 1..=last).map(|i| self.crossing(i, xi)) {
            let record = next.p.min(exit).max(horizon);
            // The kernel changes along a long segment: cut it.
            let num_parts = ((record - horizon) / half * 64.0).ceil();
            let length = (record - horizon) / num_parts;
            for part in 0..num_parts as u32 {
                let from = horizon + length * f64::from(part);
                let weight =
                    (integral_at(from + length) - integral_at(from)) * exp_negative(2.0 * r0);
                let t =
                    ((from + 0.5 * length - previous.p) / (next.p - previous.p)).clamp(0.0, 1.0);
                add(weights, &previous, weight * (1.0 - t));
                add(weights, &next, weight * t);
            }
            (horizon, previous) = (record, next);
        }
    }
}

fn add(weights: &mut BTreeMap<[i32; 2], f64>, crossing: &Crossing, weight: f64) {
    for (texel, share) in crossing.texels.into_iter().filter(|(_, share)| *share > 0.0) {
        *weights.entry(texel).or_default() += weight * share;
    }
}
