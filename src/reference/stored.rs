//! Stored texels as numbers, and the kernel.

use crate::texture::{FULL, Level};

/// Red, green and blue of a stored texel, 0 to 1.
pub(crate) fn color(level: &Level, [x, y]: [i32; 2]) -> [f64; 3] {
    level.texel(x, y).color.map(|c| f64::from(c) / f64::from(FULL))
}

/// Height of a stored texel, 0 to 1.
pub(super) fn height(level: &Level, [x, y]: [i32; 2]) -> f64 {
    f64::from(level.rows(false).packed(x, y)[1] >> 16) / f64::from(FULL)
}

/// `exp(-x)` for x of 0 to 4, by its series, to the last bits.
pub(super) fn exp_negative(x: f64) -> f64 {
    (1..=40).rev().fold(1.0, |sum, i| 1.0 - sum * x / f64::from(i))
}

/// The integral of `exp(-2 z^2)` from 0 to z, for |z| up to 1, by its series.
pub(super) fn integral(z: f64) -> f64 {
    // Term k is (-2)^k z^(2k+1) / (k! (2k+1)).
    let mut power = z;
    (0..40).fold(0.0, |sum, k| {
        let term = power / f64::from(2 * k + 1);
        power *= -2.0 * z * z / f64::from(k + 1);
        sum + term
    })
}
