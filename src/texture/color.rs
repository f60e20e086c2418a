//! sRGB transfer function (IEC 61966-2-1), both ways, with the same bytes on every machine.
//!
//! ```text
//! linear  = encoded / 12.92                    up to encoded 0.04045,   else ((encoded + 0.055) / 1.055)^2.4
//! encoded = linear * 12.92                     up to linear 0.0031308,  else 1.055 * linear^(1 / 2.4) - 0.055
//! ```
//!
//! `powf` differs between platforms, so both powers are made of `+ - * /` and `sqrt`, which IEEE
//! 754 rounds exactly: `x^2.4 = x^2 * fifth_root(x^2)` and `x^(5/12) = cube_root(x * x^(1/4))`, the
//! roots by Halley's iteration.

use crate::simd::{HAS_SHUFFLE, LineLanes, from_words, pick, u32x16, words};

/// Linear light, 0 to 1, from an sRGB-encoded value, 0 to 1; clamped, NaN gives 0.
pub fn linear_from_srgb(encoded: f32) -> f32 {
    decode(f64::from(clamped(encoded, 0.0))) as f32
}

/// Linear light, 0 to 1, from an 8-bit sRGB-encoded value: [`linear_from_srgb`] of `encoded / 255`,
/// from a table.
pub fn linear_from_srgb8(encoded: u8) -> f32 {
    const LINEAR: [f32; 256] = {
        let mut linear = [0.0; 256];
        let mut i = 0;
        while i < 256 {
            linear[i] = decode((i as f32 / 255.0) as f64) as f32;
            i += 1;
        }
        linear
    };
    LINEAR[usize::from(encoded)]
}

/// An sRGB-encoded value, 0 to 1, from linear light; clamped, NaN gives 0.
pub fn srgb_from_linear(linear: f32) -> f32 {
    encode(f64::from(clamped(linear, 0.0))) as f32
}

/// The nearest 8-bit sRGB-encoded value of linear light; clamped, NaN gives 0.
///
/// A byte is the number of thresholds at or below the light. Light is cut into steps so fine that
/// each holds at most one threshold, and `BELOW` knows how many lie below each step.
pub fn srgb8_from_linear(linear: f32) -> u8 {
    let linear = clamped(linear, FIRST_STEP);
    let below = BELOW[step(linear)];
    // Step 255 is full: the table of thresholds ends with an infinity.
    below + u8::from(linear >= THRESHOLDS[below as usize])
}

/// [`srgb8_from_linear`] of four opaque pixels.
///
/// `255 encoded + 1/2` by a polynomial; where that is so near a whole number that its error may
/// matter, by the thresholds.
#[inline]
pub(crate) fn srgb8_of_four(linear: &[[f32; 4]; 4]) -> [u8; 16] {
    if !HAS_SHUFFLE {
        return by_thresholds(linear);
    }
    let lanes = LineLanes::new(*linear.as_flattened().first_chunk().expect("sixteen numbers"));
    let lanes =
        lanes.simd_gt(LineLanes::ZERO).select(lanes.fast_min(LineLanes::ONE), LineLanes::ZERO);
    // As 2^-octave times 1 to 2.
    let bits = words(lanes.fast_max(LineLanes::splat(LEAST_POWER)));
    let octave = (bits >> 23_u32) - u32x16::splat(LEAST_POWER.to_bits() >> 23);
    let x = from_words(bits & u32x16::splat(0x007f_ffff) | u32x16::splat(0x3f80_0000)) - 1.5;
    let x2 = x * x;
    let [c0, c1, c2, c3, c4, c5, c6] = FIVE_TWELFTHS;
    // In this order few steps wait for each other.
    let power = (x * c1 + c0) + (x * c3 + c2) * x2 + ((x * c5 + c4) + x2 * c6) * (x2 * x2);
    let power = power * from_words(pick(words(LineLanes::new(POWER_SCALES)), octave))
        + (0.5 - 255.0 * 0.055);
    let linear_part = lanes * (255.0 * 12.92) + 0.5;
    let rounded = lanes.simd_le(LineLanes::splat(0.003_130_8)).select(linear_part, power);
    let bytes = rounded.fast_trunc_int();
    let rest = rounded - LineLanes::from_i32x16(bytes);
    if (rest - 0.5).abs().simd_gt(LineLanes::splat(0.5 - UNSURE)).any() {
        return by_thresholds(linear);
    }
    bytes.to_array().map(|byte| byte as u8)
}

#[inline(never)]
fn by_thresholds(linear: &[[f32; 4]; 4]) -> [u8; 16] {
    std::array::from_fn(|i| srgb8_from_linear(linear[i / 4][i % 4]))
}

/// Where the polynomial for the power begins: below the end of the linear part.
const LEAST_POWER: f32 = 1.0 / 512.0;
/// `x^(5/12)` for x within 1 to 2 by powers of `x - 1.5`: a fit at Chebyshev's nodes, off by 2e-7.
const FIVE_TWELFTHS: [f32; 7] = [
    1.184_053_7,
    0.328_906_27,
    -0.063_956_715,
    0.022_423_48,
    -0.009_625_546,
    0.005_237_355_4,
    -0.002_744_525_2,
];
/// `255 * 1.055 * 2^(5/12 (i - 9))`, from [`LEAST_POWER`] on.
const POWER_SCALES: [f32; 16] = {
    let mut scales = [0.0; 16];
    let mut scale = 255.0 * 1.055;
    let mut i = 10;
    while i > 0 {
        i -= 1;
        scales[i] = scale as f32;
        scale /= 1.334_839_854_170_034_4;
    }
    scales
};
/// How near a whole number the polynomial, off by 1e-4, is not trusted.
const UNSURE: f32 = 1.0 / 2048.0;

/// `value` within `least` to 1; NaN, which `f32::clamp` would keep, gives `least`.
fn clamped(value: f32, least: f32) -> f32 {
    if value > least { value.min(1.0) } else { least }
}

/// A power of two below the least threshold, 0.5 / 255 / 12.92.
const FIRST_STEP: f32 = 1.0 / 8192.0;
/// Steps are numbered by the exponent and the first 7 bits of the mantissa: 128 steps from each
/// power of two to the next.
const NUM_STEPS: usize = step(1.0) + 1;
/// The least light of each byte but 0, and an infinity.
static THRESHOLDS: [f32; 256] = thresholds();
/// How many thresholds lie at or below the start of each step.
static BELOW: [u8; NUM_STEPS] = thresholds_below_steps();

const fn step(linear: f32) -> usize {
    ((linear.to_bits() - FIRST_STEP.to_bits()) >> 16) as usize
}

const fn thresholds() -> [f32; 256] {
    let mut thresholds = [f32::INFINITY; 256];
    let mut i = 0;
    while i < 255 {
        let exact = decode((i as f64 + 0.5) / 255.0);
        let nearest = exact as f32;
        thresholds[i] = if (nearest as f64) < exact { nearest.next_up() } else { nearest };
        i += 1;
    }
    thresholds
}

const fn thresholds_below_steps() -> [u8; NUM_STEPS] {
    let mut below = [0; NUM_STEPS];
    let mut num = 0;
    let mut i = 0;
    while i < NUM_STEPS {
        let start = f32::from_bits(FIRST_STEP.to_bits() + ((i as u32) << 16));
        while THRESHOLDS[num as usize] <= start {
            num += 1;
        }
        below[i] = num;
        i += 1;
    }
    below
}

/// `encoded` within 0 to 1.
const fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        let x = (encoded + 0.055) / 1.055;
        x * x * two_fifths_power(x)
    }
}

/// `linear` within 0 to 1.
fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * five_twelfths_power(linear) - 0.055 }
}

/// `x^(2/5)` for x within 0.09 to 1: the fifth root `y` of `a = x^2`.
const fn two_fifths_power(x: f64) -> f64 {
    let a = x * x;
    // Within 0.03 of the root; Halley's step takes a relative error e to about 2 e^3, so three
    // steps reach 1e-15.
    let mut y = 0.285 + x * (1.24 - 0.54 * x);
    let mut i = 0;
    while i < 3 {
        let y5 = y * y * y * y * y;
        y *= (2.0 * y5 + 3.0 * a) / (3.0 * y5 + 2.0 * a);
        i += 1;
    }
    y
}

/// `x^(5/12)` for x within 0.003 to 1: the cube root `y` of `a = x * x^(1/4)`.
fn five_twelfths_power(x: f64) -> f64 {
    let fourth_root = x.sqrt().sqrt();
    let a = x * fourth_root;
    // x^(3/8) is at most 1.28 times off; Halley's step takes a relative error e to about 2/3 e^3.
    let mut y = fourth_root * fourth_root.sqrt();
    for _ in 0..3 {
        let y3 = y * y * y;
        y *= (y3 + 2.0 * a) / (2.0 * y3 + a);
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps from 0 to 1, dense enough to meet each of the two branches and their ends.
    fn unit_interval() -> impl Iterator<Item = f64> {
        (0..=1_000_000).map(|i| f64::from(i) / 1e6)
    }

    fn nearest_byte(linear: f32) -> u8 {
        (encode(f64::from(linear)) * 255.0 + 0.5) as u8
    }

    #[test]
    fn both_ways_match_powf() {
        for x in unit_interval() {
            let decoded = if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) };
            let encoded =
                if x <= 0.003_130_8 { x * 12.92 } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
            assert!((decode(x) - decoded).abs() < 1e-12, "decode {x}: {} {decoded}", decode(x));
            assert!((encode(x) - encoded).abs() < 1e-12, "encode {x}: {} {encoded}", encode(x));
        }
    }

    #[test]
    fn out_of_range_is_clamped() {
        for (value, expected) in
            [(f32::NAN, 0.0), (-1.0, 0.0), (f32::INFINITY, 1.0), (1.5, 1.0), (1.0, 1.0)]
        {
            assert_eq!(srgb_from_linear(value), expected);
            assert_eq!(linear_from_srgb(value), expected);
            assert_eq!(srgb8_from_linear(value), if expected == 0.0 { 0 } else { 255 });
        }
    }

    #[test]
    fn each_byte_begins_where_rounding_says() {
        for (i, &threshold) in THRESHOLDS[..255].iter().enumerate() {
            let around = [
                threshold.next_down().next_down(),
                threshold.next_down(),
                threshold,
                threshold.next_up(),
            ];
            let expected = around.map(nearest_byte);
            assert_eq!(around.map(srgb8_from_linear), expected, "threshold {i}");
            assert_eq!([expected[1], expected[2]], [i as u8, i as u8 + 1], "threshold {i}");
        }
    }

    #[test]
    fn table_of_steps_agrees_with_rounding_everywhere() {
        for bits in (0..=1.0_f32.to_bits()).step_by(97) {
            let linear = f32::from_bits(bits);
            assert_eq!(srgb8_from_linear(linear), nearest_byte(linear), "{linear}");
        }
    }

    #[test]
    fn four_pixels_are_their_bytes() {
        let around = |c: f32| [c.next_down(), c, c.next_up()];
        let near = THRESHOLDS[..255]
            .iter()
            .copied()
            .chain([0.003_130_8, LEAST_POWER, 1.0])
            .flat_map(around);
        let all = (0..=1.01_f32.to_bits()).step_by(997).map(f32::from_bits).chain(near);
        let odd = [f32::NAN, -1.0, -0.0, f32::INFINITY, f32::NEG_INFINITY, 2.0];
        let numbers: Vec<_> = all.chain(odd).collect();
        for (i, chunk) in numbers.chunks(12).enumerate() {
            let four = std::array::from_fn(|p| {
                let [r, g, b] = [0, 1, 2].map(|c| chunk[(3 * p + c) % chunk.len()]);
                [r, g, b, 1.0]
            });
            assert_eq!(srgb8_of_four(&four), by_thresholds(&four), "{i}: {four:?}");
        }
    }

    #[test]
    fn bytes_survive_the_round_trip() {
        for byte in 0..=255 {
            assert_eq!(srgb8_from_linear(linear_from_srgb8(byte)), byte);
            assert_eq!(linear_from_srgb8(byte), linear_from_srgb(f32::from(byte) / 255.0));
        }
    }
}
