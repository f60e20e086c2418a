//! Ground truth: many rays a pixel, each traced to its exact hit.
//!
//! The samples have the density of the filter kernel, `exp(-2 r^2)` on the disc of radius one
//! pixel: sample i of n lies at the radius that encloses the share `(i + 1/2) / n` of the kernel, a
//! golden angle further round than the one before (Vogel 1979), so that every sample stands for an
//! equal share. Each is a ray of its own, through its own place on the screen, with its own texture
//! coordinates and slope; colour is bilinear at the base level at the hit. Shares no code with the
//! filters it judges, beyond texel access.

use crate::light::spiral;
use crate::texture::{Surface, Texel};

/// Offsets of `num` samples from the pixel's centre, in pixels.
pub(super) fn offsets(num: u32) -> Vec<[f32; 2]> {
    // 1 - exp(-2), the part of the whole Gaussian that the disc holds.
    let edge = 0.864_664_716_763_387_3;
    let offset = |([x, y], share): ([f64; 2], f64)| {
        let radius = (-0.5 * ln(1.0 - share * edge)).sqrt();
        [(radius * x) as f32, (radius * y) as f32]
    };
    spiral(num as usize).map(offset).collect()
}

/// The natural logarithm of a number from 0.1 to 1, by exact operations alone: the fourth root,
/// then the series of atanh.
fn ln(y: f64) -> f64 {
    let root = y.sqrt().sqrt();
    let z = (root - 1.0) / (root + 1.0);
    let square = z * z;
    // With z within -0.29 to 0 the terms after the twelfth are less than 1e-14 of the first.
    let series = (0..12).rev().fold(0.0, |sum, i| sum * square + 1.0 / f64::from(2 * i + 1));
    8.0 * z * series
}

/// Colour and normal of the base level, bilinear at a place in repeats.
pub(super) fn sample(surface: &Surface, place: [f32; 2]) -> Texel {
    let level = surface.base();
    let [u, v] = level.in_texels(place).map(|c| c - 0.5);
    let (x, y) = (u.floor(), v.floor());
    let (fx, fy) = (u - x, v - y);
    // Interpolated here and not by `points`: the truth shares no look-ups with what it judges.
    let weights = [(1.0 - fx) * (1.0 - fy), fx * (1.0 - fy), (1.0 - fx) * fy, fx * fy];
    let mut result = Texel::default();
    for (i, weight) in weights.into_iter().enumerate() {
        let texel = level.texel(x as i32 + (i as i32 & 1), y as i32 + (i as i32 >> 1));
        for c in 0..3 {
            result.color[c] += texel.color[c] * weight;
            result.normal[c] += texel.normal[c] * weight;
        }
    }
    result
}
