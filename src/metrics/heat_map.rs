//! Errors as colours.
//!
//! The ramp runs from black over violet, red and orange to pale yellow. Its lightness in Oklab (B.
//! Ottosson, 2020) grows evenly with the error, so that equal steps of error look equally large, to
//! the colour-blind too.

use super::picture::{Picture, check_sizes, is_compared};
use crate::error::{Error, Result};
use crate::frame::Frame;
use rayon::prelude::*;

/// The largest error of the three channels of each pixel as a colour: black is 0, pale yellow is
/// `full_scale` or more, a value above 0 and up to 1. Pixels that are not opaque in both pictures
/// are transparent.
///
/// # Errors
/// Says so when the sizes differ or `full_scale` is out of its range.
pub fn heat_map(a: &Picture, b: &Picture, full_scale: f32) -> Result<Frame> {
    check_sizes(a, b)?;
    check_scale(full_scale)?;
    let color = |(&a, &b): (&[f32; 4], &[f32; 4])| {
        let error = (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max);
        if is_compared(a, b) { ramp((error / full_scale).min(1.0)) } else { [0.0; 4] }
    };
    let pixels = a.pixels().par_iter().zip(b.pixels()).map(color).collect();
    Ok(Frame { width: a.width(), height: a.height(), pixels })
}

/// Errors, row by row, in the colours of [`heat_map`]: black is 0, pale yellow is `full_scale` or
/// more.
///
/// # Errors
/// Says so when there are not `width` times some rows of errors, or `full_scale` is not above 0 and
/// up to 1.
pub fn errors_as_colors(errors: &[f32], width: u32, full_scale: f32) -> Result<Frame> {
    check_scale(full_scale)?;
    if width == 0 || errors.is_empty() || !errors.len().is_multiple_of(width as usize) {
        return Err(Error::picture("errors", format!("{} are no rows of {width}", errors.len())));
    }
    let pixels = errors.iter().map(|error| ramp((error / full_scale).min(1.0))).collect();
    Ok(Frame { width, height: (errors.len() / width as usize) as u32, pixels })
}

fn check_scale(full_scale: f32) -> Result<()> {
    if full_scale > 0.0 && full_scale <= 1.0 {
        return Ok(());
    }
    Err(Error::setting("full_scale", format!("{full_scale} is not above 0 and up to 1")))
}

/// Opaque linear RGB of the ramp at `t`, 0 to 1.
fn ramp(t: f32) -> [f32; 4] {
    // A Bézier curve through Oklab's plane of hues, from the grey axis by violet and orange to a
    // pale yellow.
    let curve = |p1: f32, p2: f32, p3: f32| {
        let s = 1.0 - t;
        3.0 * s * s * t * p1 + 3.0 * s * t * t * p2 + t * t * t * p3
    };
    linear_from_oklab([0.97 * t, curve(0.09, 0.20, -0.02), curve(-0.22, 0.20, 0.08)])
}

fn linear_from_oklab([lightness, a, b]: [f32; 3]) -> [f32; 4] {
    let cube = |x: f32| x * x * x;
    let l = cube(lightness + 0.396_337_78 * a + 0.215_803_76 * b);
    let m = cube(lightness - 0.105_561_346 * a - 0.063_854_17 * b);
    let s = cube(lightness - 0.089_484_18 * a - 1.291_485_5 * b);
    let red = 4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s;
    let green = -1.268_438 * l + 2.609_757_4 * m - 0.341_319_4 * s;
    let blue = -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s;
    [red.clamp(0.0, 1.0), green.clamp(0.0, 1.0), blue.clamp(0.0, 1.0), 1.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramp_grows_lighter_from_black() {
        let luminance = |i: u16| {
            let [r, g, b, _] = ramp(f32::from(i) / 100.0);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        assert_eq!(ramp(0.0), [0.0, 0.0, 0.0, 1.0]);
        assert!((1..=100).all(|i| luminance(i) > luminance(i - 1)));
        assert!(luminance(100) > 0.85);
    }
}
