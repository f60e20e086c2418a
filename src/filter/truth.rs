//! Ground truth: many rays a pixel, each traced to its exact hit.
//!
//! The samples have the density of the filter kernel, `exp(-2 r^2)` on the disc of radius one pixel: sample i of n lies at
//! the radius that encloses the share `(i + 1/2) / n` of the kernel, a golden angle further round than the one before
//! (Vogel 1979), so that every sample stands for an equal share. Each is a ray of its own, through its own place on the
//! screen, with its own texture coordinates and slope; colour is bilinear at the base level at the hit. Shares no code with
//! the filters it judges, beyond texel access.

use super::Filtered;
use crate::simd::PixelLanes;
use crate::texture::{Level, Surface, unpack_normal};

/// Cosine and sine of the golden angle, `pi (3 - sqrt 5)`.
const GOLDEN_TURN: [f64; 2] = [-0.737_368_878_078_319_8, 0.675_490_294_261_523_7];

/// Offsets of the samples from the pixel's centre, in pixels.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// Groups of eight samples: x, y, and 1 for a sample, 0 for padding.
    pub groups: Vec<[PixelLanes; 3]>,
}

impl Kernel {
    /// A kernel of `num` samples.
    #[must_use]
    pub fn new(num: u32) -> Self {
        // 1 - exp(-2), the part of the whole Gaussian that the disc holds.
        let edge = 0.864_664_716_763_387_3;
        let mut turn = [1.0_f64, 0.0];
        let mut offsets = Vec::with_capacity(num as usize);
        for i in 0..num {
            let share = (f64::from(i) + 0.5) / f64::from(num);
            let radius = (-0.5 * ln(1.0 - share * edge)).sqrt();
            offsets.push([(radius * turn[0]) as f32, (radius * turn[1]) as f32, 1.0]);
            let ([c, s], [x, y]) = (GOLDEN_TURN, turn);
            turn = [x * c - y * s, x * s + y * c];
        }
        let lanes = |group: &[[f32; 3]], i: usize| {
            PixelLanes::new(std::array::from_fn(|lane| group.get(lane).map_or(0.0, |offset| offset[i])))
        };
        Self { groups: offsets.chunks(8).map(|group| [0, 1, 2].map(|i| lanes(group, i))).collect() }
    }
}

/// The natural logarithm of a number from 0.1 to 1, by exact operations alone: the fourth root, then the series of atanh.
fn ln(y: f64) -> f64 {
    let root = y.sqrt().sqrt();
    let z = (root - 1.0) / (root + 1.0);
    let square = z * z;
    let series = (0..12).rev().fold(0.0, |sum, i| sum * square + 1.0 / f64::from(2 * i + 1));
    8.0 * z * series
}

/// Colour and normal of the base level, bilinear at a place in repeats.
#[must_use]
pub fn sample(surface: &Surface, place: [f32; 2]) -> Filtered {
    let level = &surface.levels[0];
    let texels = surface.texels_per_repeat(0);
    let [u, v] = [place[0] * texels[0] - 0.5, place[1] * texels[1] - 0.5];
    let (x, y) = (u.floor(), v.floor());
    let (fx, fy) = (u - x, v - y);
    let weights = [(1.0 - fx) * (1.0 - fy), fx * (1.0 - fy), (1.0 - fx) * fy, fx * fy];
    let mut result = Filtered::default();
    for (i, weight) in weights.into_iter().enumerate() {
        let texel = stored(level, x as i32 + (i as i32 & 1), y as i32 + (i as i32 >> 1));
        for c in 0..3 {
            result.color[c] += texel.color[c] * weight;
            result.normal[c] += texel.normal[c] * weight;
        }
    }
    result
}

fn stored(level: &Level, x: i32, y: i32) -> Filtered {
    let [red_green, blue_height, normal] = level.packed(x, y);
    let color = [red_green & 0xffff, red_green >> 16, blue_height & 0xffff].map(|c| c as f32);
    Filtered { color, normal: if level.has_normals() { unpack_normal(normal) } else { [0.0, 0.0, 1.0] } }
}
