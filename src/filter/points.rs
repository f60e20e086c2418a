//! Look-ups of one place: nearest, bilinear, trilinear.

use crate::footprint::levels;
use crate::texture::{Level, Surface, Texel};

/// The texel of a level under a place in repeats.
pub fn nearest(level: &Level, place: [f32; 2]) -> Texel {
    let [x, y] = level.in_texels(place).map(|c| c.floor() as i32);
    level.texel(x, y)
}

/// Interpolates between the four texels of a level around a place in repeats.
pub fn bilinear(level: &Level, place: [f32; 2]) -> Texel {
    let [u, v] = level.in_texels(place).map(|c| c - 0.5);
    let ([x, y], [fx, fy]) = ([u, v].map(|c| c.floor() as i32), [u - u.floor(), v - v.floor()]);
    let column = |x: i32| level.texel(x, y).lerp(&level.texel(x, y + 1), fy);
    column(x).lerp(&column(x + 1), fx)
}

/// Bilinear on the two levels whose texels are next to `size` base texels in size, blended.
pub fn trilinear(surface: &Surface, place: [f32; 2], size: f32) -> Texel {
    let last = surface.last_level();
    let (level, blend) = levels::of_size(size);
    let fine = bilinear(&surface.levels()[level.min(last)], place);
    if blend == 0.0 || level >= last {
        return fine;
    }
    fine.lerp(&bilinear(&surface.levels()[level + 1], place), blend)
}
