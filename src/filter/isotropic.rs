//! The filters that take the footprint for a square: nearest, bilinear, trilinear.

use super::{Filtered, Footprint};
use crate::texture::{Level, Surface, unpack_normal};

/// The texel under a place in repeats.
#[must_use]
pub fn nearest(surface: &Surface, place: [f32; 2]) -> Filtered {
    let [x, y] = in_texels(surface, 0, place).map(|c| c.floor() as i32);
    texel(&surface.levels[0], x, y)
}

/// Interpolates between the four texels of a level around a place in repeats.
#[must_use]
pub fn bilinear(surface: &Surface, level: usize, place: [f32; 2]) -> Filtered {
    let [u, v] = in_texels(surface, level, place).map(|c| c - 0.5);
    let ([x, y], [fx, fy]) = ([u, v].map(|c| c.floor() as i32), [u - u.floor(), v - v.floor()]);
    let level = &surface.levels[level];
    let column = |x: i32| texel(level, x, y).lerp(&texel(level, x, y + 1), fy);
    column(x).lerp(&column(x + 1), fx)
}

/// Bilinear on the two levels whose texels are next to `size` base texels in size, blended.
#[must_use]
pub fn trilinear(surface: &Surface, place: [f32; 2], size: f32) -> Filtered {
    let last = surface.levels.len() - 1;
    let (level, blend) = level_of_size(size);
    let fine = bilinear(surface, level.min(last), place);
    if blend == 0.0 || level >= last { fine } else { fine.lerp(&bilinear(surface, level + 1, place), blend) }
}

/// The finer level and the share of the coarser one for a texel size, in base texels: linear in size between two levels.
#[must_use]
pub fn level_of_size(size: f32) -> (usize, f32) {
    if size.is_nan() || size <= 1.0 {
        return (0, 0.0);
    }
    // The exponent of a float is the whole part of its logarithm.
    let exponent = (size.to_bits() >> 23) as i32 - 127;
    let mantissa = f32::from_bits(size.to_bits() & 0x007f_ffff | 0x3f80_0000);
    (exponent as usize, mantissa - 1.0)
}

/// The longer derivative of a footprint in base texels: the texel size that a square filter needs.
#[must_use]
pub fn longest_side(surface: &Surface, footprint: &Footprint) -> f32 {
    let texels = surface.texels_per_repeat(0);
    let length = |d: [f32; 2]| {
        let [u, v] = [d[0] * texels[0], d[1] * texels[1]];
        (u * u + v * v).sqrt()
    };
    length(footprint.dx).max(length(footprint.dy))
}

fn in_texels(surface: &Surface, level: usize, place: [f32; 2]) -> [f32; 2] {
    let texels = surface.texels_per_repeat(level);
    [place[0] * texels[0], place[1] * texels[1]]
}

fn texel(level: &Level, x: i32, y: i32) -> Filtered {
    let [red_green, blue_height, normal] = level.packed(x, y);
    let color = [red_green & 0xffff, red_green >> 16, blue_height & 0xffff].map(|c| c as f32);
    Filtered { color, normal: if level.has_normals() { unpack_normal(normal) } else { [0.0, 0.0, 1.0] } }
}
