//! The weight of a texel: `exp(-2 s)` by polynomials through its values at the roots of Chebyshev's
//! polynomial, off by at most 2e-5. Terms in pairs, since the next row's work waits for the weight.

use crate::simd::LineLanes;

/// Coefficients for s up to 1, from the constant one on.
const UP_TO_1: [f32; 6] =
    [0.999_980_9, -1.998_622_1, 1.983_557_7, -1.259_850_5, 0.511_914_9, -0.101_660_05];

/// Coefficients for s up to 2.25.
const UP_TO_2_25: [f32; 8] = [
    0.999_980_3,
    -1.998_874_1,
    1.989_238_6,
    -1.293_264_7,
    0.591_073_8,
    -0.185_189_3,
    0.035_439_05,
    -0.003_077_990_3,
];

/// `exp(-2 s)` for s within 0 to 1, or within 0 to 2.25.
#[inline(always)]
pub(super) fn gaussian<const IS_WIDE: bool>(s: LineLanes) -> LineLanes {
    let s2 = s * s;
    let pair = |constant: f32, linear: f32| s * linear + constant;
    if IS_WIDE {
        // The longer range takes two terms more for the same error.
        let [a, b, c, d, e, f, g, h] = UP_TO_2_25;
        let (low, high) = (pair(a, b) + pair(c, d) * s2, pair(e, f) + pair(g, h) * s2);
        high * (s2 * s2) + low
    } else {
        let [a, b, c, d, e, f] = UP_TO_1;
        (pair(e, f) * s2 + pair(c, d)) * s2 + pair(a, b)
    }
}
