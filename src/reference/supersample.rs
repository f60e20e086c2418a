//! A pixel by many rays, each marched densely.

use super::stored::{color, exp_negative, height};
use crate::footprint::Footprint;
use crate::texture::{Level, Surface};

/// A view ray: from a base place along the displacement down to the deepest relief, both in texels
/// of the base level.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it meets the polygon.
    pub base: [f64; 2],
    /// How far it moves down to the deepest relief.
    pub displacement: [f64; 2],
}

impl Ray {
    /// From places in texture repeats.
    pub fn new(surface: &Surface, base: [f32; 2], displacement: [f32; 2]) -> Self {
        let texels = surface.base().texels_per_repeat();
        let scaled = |p: [f32; 2]| [0, 1].map(|i| f64::from(p[i]) * f64::from(texels[i]));
        Self { base: scaled(base), displacement: scaled(displacement) }
    }

    /// The place at a depth, 0 to 1.
    pub fn at(&self, depth: f64) -> [f64; 2] {
        [0, 1].map(|i| self.base[i] + self.displacement[i] * depth)
    }

    /// How far the ray is above the bilinear relief at a depth; 1 is the whole relief.
    pub fn gap(&self, level: &Level, depth: f64) -> f64 {
        1.0 - depth - bilinear(self.at(depth), |texel| height(level, texel))
    }
}

/// The depth, 0 to 1, of the first hit, by `steps` steps a texel and halving.
pub fn first_hit(level: &Level, ray: &Ray, steps: f64) -> f64 {
    let longest = ray.displacement[0].abs().max(ray.displacement[1].abs());
    let num = (longest * steps).ceil().max(1.0);
    let mut i = 0.0;
    while i < num && ray.gap(level, i / num) > 0.0 {
        i += 1.0;
    }
    let (mut above, mut below) = ((i - 1.0).max(0.0) / num, i / num);
    for _ in 0..40 {
        let middle = 0.5 * (above + below);
        if ray.gap(level, middle) > 0.0 { above = middle } else { below = middle }
    }
    below
}

/// The colour of a pixel by `2 side x 2 side` rays over the square around the disc of radius one
/// pixel, each weighted with the kernel `exp(-2 r^2)`. The slope is the same for all; marches take
/// two steps a texel, then halve.
pub fn supersampled(surface: &Surface, footprint: &Footprint, side: i32) -> [f64; 3] {
    let level = surface.base();
    let middle = Ray::new(surface, footprint.base, footprint.displacement);
    let [dx, dy] = [footprint.dx, footprint.dy].map(|d| Ray::new(surface, d, d).base);
    let (mut sums, mut weights) = ([0.0; 3], 0.0);
    for (i, j) in (-side..side).flat_map(|j| (-side..side).map(move |i| (i, j))) {
        let [x, y] = [i, j].map(|k| (f64::from(k) + 0.5) / f64::from(side));
        let r2 = x * x + y * y;
        if r2 <= 1.0 {
            let base = [0, 1].map(|k| middle.base[k] + dx[k] * x + dy[k] * y);
            let ray = Ray { base, ..middle };
            let hit = ray.at(first_hit(level, &ray, 2.0));
            let weight = exp_negative(2.0 * r2);
            (0..3).for_each(|c| sums[c] += weight * bilinear(hit, |texel| color(level, texel)[c]));
            weights += weight;
        }
    }
    sums.map(|sum| sum / weights)
}

/// Bilinear between the four texels around a place in texels, whose centres lie at halves.
pub(super) fn bilinear(place: [f64; 2], value: impl Fn([i32; 2]) -> f64) -> f64 {
    let [u, v] = place.map(|p| p - 0.5);
    let ([x, y], fx, fy) = ([u, v].map(|p| p.floor() as i32), u - u.floor(), v - v.floor());
    let row = |y: i32| value([x, y]) + (value([x + 1, y]) - value([x, y])) * fx;
    row(y) + (row(y + 1) - row(y)) * fy
}
