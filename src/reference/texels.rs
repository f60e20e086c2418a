//! The texels of an ellipse, those of them that the eye sees, and their mean.

use super::formulas::Conic;
use super::stored::{color, exp_negative, height};
use crate::texture::Level;

/// How close a ray may pass relief, of its whole depth, for rounding to decide: a kernel adds up
/// the ray's height step by step in f32, and leaves out what rises by less than a sixteenth of a
/// stored unit above the ray.
pub const RAY_TIE: f64 = 1.0 / 65536.0;

/// The texels whose centre lies in the ellipse around `center` (in texels), with their `r^2`; those
/// up to `slack` outside are listed too.
pub fn texels(conic: &Conic, center: [f64; 2], slack: f64) -> Vec<([i32; 2], f64)> {
    let Conic { a, b, c, f } = *conic;
    let determinant = 4.0 * a * c - b * b;
    let reach = [c, a].map(|k| (4.0 * k * f * (1.0 + slack) / determinant).sqrt() + 1.0);
    let [xs, ys] = [0, 1]
        .map(|i| (center[i] - reach[i]).floor() as i32..=(center[i] + reach[i]).ceil() as i32);
    let places = ys.flat_map(|y| xs.clone().map(move |x| [x, y]));
    places
        .map(|texel| (texel, r2(conic, center, texel)))
        .filter(|(_, r2)| *r2 <= 1.0 + slack)
        .collect()
}

fn r2(conic: &Conic, center: [f64; 2], [x, y]: [i32; 2]) -> f64 {
    conic.r2(f64::from(x) + 0.5 - center[0], f64::from(y) + 0.5 - center[1])
}

/// How far the relief rises above the ray from a texel to the eye, of its whole depth: the texel is
/// hidden where this is above 0. `displacement` is in texels down to the deepest relief.
///
/// The ray is followed in steps of one texel along the longer axis, with the relief linear across.
pub fn ray_margin(level: &Level, texel: [i32; 2], displacement: [f64; 2]) -> f64 {
    let [dx, dy] = displacement;
    let longest = dx.abs().max(dy.abs()).max(1e-3);
    let along_x = dx.abs() > dy.abs();
    let start = height(level, texel);
    let mut most = f64::NEG_INFINITY;
    let mut step = 1.0;
    loop {
        let ray = start + step / longest;
        let place =
            [f64::from(texel[0]) - dx / longest * step, f64::from(texel[1]) - dy / longest * step];
        let [x, y] = place.map(|p| if (p - p.round()).abs() < 1e-9 { p.round() } else { p });
        let (near, part) = (
            [x.floor() as i32, y.floor() as i32],
            if along_x { y - y.floor() } else { x - x.floor() },
        );
        let far = if along_x { [near[0], near[1] + 1] } else { [near[0] + 1, near[1]] };
        let relief = height(level, near) + (height(level, far) - height(level, near)) * part;
        most = most.max(relief - ray);
        if ray >= 1.0 {
            return most;
        }
        step += 1.0;
    }
}

/// The mean colour of texels with the weight `exp(-2 r^2)`; `None` of none.
pub fn mean(
    level: &Level,
    texels: &[[i32; 2]],
    conic: &Conic,
    center: [f64; 2],
) -> Option<[f64; 3]> {
    let (mut sums, mut weights) = ([0.0; 3], 0.0);
    for &texel in texels {
        let weight = exp_negative(2.0 * r2(conic, center, texel).clamp(0.0, 1.0));
        sums.iter_mut().zip(color(level, texel)).for_each(|(sum, c)| *sum += c * weight);
        weights += weight;
    }
    (weights > 0.0).then(|| sums.map(|sum| sum / weights))
}
