//! Angles by exact operations alone, since sines of the platform differ from machine to machine.
//!
//! Angles are in turns: 1 is all the way round. Errors are below 1e-15 of a turn.

use std::f64::consts::{FRAC_PI_2, PI};

/// Cosine and sine of an angle in turns.
pub(crate) fn cos_sin(turns: f64) -> [f64; 2] {
    let quarters = (turns - turns.floor()) * 4.0;
    let nearest = (quarters + 0.5).floor();
    // Within an eighth of a turn on both sides of a quarter, the series are short.
    let x = (quarters - nearest) * FRAC_PI_2;
    let square = x * x;
    let series = |first: u32| {
        (0..9_u32).rev().fold(0.0, |sum, i| {
            let n = f64::from(2 * i + first);
            1.0 - square / ((n + 1.0) * (n + 2.0)) * sum
        })
    };
    let (cos, sin) = (series(0), x * series(1));
    match nearest as i32 & 3 {
        0 => [cos, sin],
        1 => [-sin, cos],
        2 => [-cos, -sin],
        _ => [sin, -cos],
    }
}

/// The angle of the point `(x, y)` from the x axis in turns, -1/2 to 1/2; 0 for no direction.
pub(crate) fn turns(y: f64, x: f64) -> f64 {
    let (long, short) = (x.abs().max(y.abs()), x.abs().min(y.abs()));
    if long == 0.0 {
        return 0.0;
    }
    // Half the angle twice, so that the series is short: tan(a / 2) = t / (1 + sqrt(1 + t^2)).
    let halved = |t: f64| t / (1.0 + (1.0 + t * t).sqrt());
    let t = halved(halved(short / long));
    let square = t * t;
    let series = (0..13_u32).rev().fold(0.0, |sum, i| 1.0 / f64::from(2 * i + 1) - square * sum);
    let octant = 4.0 * t * series / (2.0 * PI);
    let quadrant = if y.abs() > x.abs() { 0.25 - octant } else { octant };
    let half = if x < 0.0 { 0.5 - quadrant } else { quadrant };
    if y < 0.0 { -half } else { half }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_those_of_the_platform() {
        for i in -200..=200 {
            let angle = f64::from(i) * 0.013_7;
            let [cos, sin] = cos_sin(angle);
            let radians = angle * 2.0 * PI;
            assert!((cos - radians.cos()).abs() < 1e-14, "{angle}");
            assert!((sin - radians.sin()).abs() < 1e-14, "{angle}");
            let back = turns(sin * 3.0, cos * 3.0);
            let expected = radians.sin().atan2(radians.cos()) / (2.0 * PI);
            assert!((back - expected).abs() < 1e-14, "{angle}: {back} {expected}");
        }
        assert_eq!([turns(0.0, 0.0), turns(0.0, 1.0), turns(1.0, 0.0)], [0.0, 0.0, 0.25]);
        assert_eq!([turns(0.0, -2.0), turns(-1.0, 0.0)], [0.5, -0.25]);
    }
}
