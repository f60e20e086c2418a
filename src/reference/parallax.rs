//! Common practice: one ray in linear steps, then a secant step.

use super::stored::{color, height};
use super::supersample::{Ray, bilinear};
use crate::footprint::Footprint;
use crate::texture::{Level, Surface};

/// Steps down to the deepest relief, and the greatest anisotropy.
const NUM_STEPS: i32 = 32;
const ANISOTROPY: f64 = 16.0;

/// What the ray through the middle of a pixel with so many rays finds: heights and colour are
/// trilinear at the level of 16x anisotropic filtering.
pub fn parallax(surface: &Surface, footprint: &Footprint, num_rays: u32) -> [f64; 3] {
    parallax_with_margin(surface, footprint, num_rays).0
}

/// [`parallax`], and how far the ray is from the relief at least, in heights, at the step that goes
/// under it and at all before: another precision finds the same step where it errs by less.
pub fn parallax_with_margin(
    surface: &Surface,
    footprint: &Footprint,
    num_rays: u32,
) -> ([f64; 3], f64) {
    let size = texel_size(surface, footprint) / f64::from(num_rays).sqrt();
    let ray = Ray::new(surface, footprint.base, footprint.displacement);
    let gap = |depth: f64| 1.0 - depth - trilinear(surface, ray.at(depth), size, height);
    let step = |i: i32| f64::from(i) / f64::from(NUM_STEPS);
    let last = (0..=NUM_STEPS).find(|&i| gap(step(i)) <= 0.0).unwrap_or(NUM_STEPS);
    let margin = (0..=last).map(|i| gap(step(i)).abs()).fold(f64::INFINITY, f64::min);
    let hit = match last {
        0 => 0.0,
        under => {
            let [above, below] = [step(under - 1), step(under)];
            above + (below - above) * gap(above) / (gap(above) - gap(below))
        }
    };
    let at = ray.at(hit);
    let color =
        [0, 1, 2].map(|c| trilinear(surface, at, size, |level, texel| color(level, texel)[c]));
    (color, margin)
}

/// The shorter derivative in base texels, a sixteenth of the longer at least.
fn texel_size(surface: &Surface, footprint: &Footprint) -> f64 {
    let length = |d| {
        let [u, v] = Ray::new(surface, d, d).base;
        u.hypot(v)
    };
    let (x, y) = (length(footprint.dx), length(footprint.dy));
    x.min(y).max(x.max(y) / ANISOTROPY)
}

/// Blended between the two levels whose texels are next to `size`, linear in size; the place is in
/// texels of the base level.
fn trilinear(
    surface: &Surface,
    place: [f64; 2],
    size: f64,
    value: impl Fn(&Level, [i32; 2]) -> f64,
) -> f64 {
    let base = surface.base().texels_per_repeat();
    let last = surface.levels().len() - 1;
    let at = |level: usize| {
        let level = &surface.levels()[level.min(last)];
        let texels = level.texels_per_repeat();
        let place = [0, 1].map(|i| place[i] * f64::from(texels[i]) / f64::from(base[i]));
        bilinear(place, |texel| value(level, texel))
    };
    let level = size.max(1.0).log2().floor();
    let blend = size.max(1.0) / level.exp2() - 1.0;
    at(level as usize) * (1.0 - blend) + at(level as usize + 1) * blend
}
