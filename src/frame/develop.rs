//! Light to the range of a picture: exposure, then tone.

use crate::settings::{Settings, Tone};
use std::f64::consts::LN_2;

/// What is done to the pixels of a frame before they are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Development {
    /// What colours are multiplied with.
    scale: f32,
    tone: Tone,
}

impl Development {
    /// Of frames whose pixels are a picture's, or light.
    pub(crate) fn of(settings: &Settings, is_picture: bool) -> Self {
        let tone = if is_picture { settings.tone } else { Tone::None };
        Self { scale: power_of_two(settings.exposure), tone }
    }

    /// A tone alone.
    pub(super) fn of_tone(tone: Tone) -> Self {
        Self { scale: 1.0, tone }
    }

    /// Whether it leaves all pixels as they are.
    pub(crate) fn is_none(&self) -> bool {
        self.scale == 1.0 && self.tone == Tone::None
    }

    /// A pixel, premultiplied by its opacity.
    pub(crate) fn apply(&self, [r, g, b, opacity]: [f32; 4]) -> [f32; 4] {
        let rgb = [r, g, b].map(|c| c * self.scale);
        let [r, g, b] = match self.tone {
            Tone::None => rgb,
            Tone::Neutral if opacity > 0.0 => {
                neutral(rgb.map(|c| c / opacity)).map(|c| c * opacity)
            }
            Tone::Neutral => rgb,
        };
        [r, g, b, opacity]
    }
}

/// 2 to the power `x`, exactly where `x` is whole, by exact operations alone.
fn power_of_two(x: f32) -> f32 {
    let x = f64::from(x);
    let whole = x.floor();
    // Taylor's series: with less than ln 2 its 20th term is below 1e-21.
    let y = (x - whole) * LN_2;
    let mut power = (1..=20_u32).rev().fold(1.0, |sum, i| 1.0 + sum * y / f64::from(i));
    let factor = if whole < 0.0 { 0.5 } else { 2.0 };
    (0..whole.abs() as u32).for_each(|_| power *= factor);
    power as f32
}

/// Khronos PBR Neutral (2024): colours up to about 0.8 stay as they are but for the 4 % that a
/// dielectric reflects of white, which is taken off; brighter ones come to 1 slowly, and go white.
fn neutral([r, g, b]: [f32; 3]) -> [f32; 3] {
    const REFLECTED: f32 = 0.04;
    const START: f32 = 0.8 - REFLECTED;
    const DESATURATION: f32 = 0.15;
    let least = r.min(g).min(b);
    let offset = if least < 2.0 * REFLECTED { least - 6.25 * least * least } else { REFLECTED };
    let rgb = [r, g, b].map(|c| c - offset);
    let peak = rgb[0].max(rgb[1]).max(rgb[2]);
    if peak.is_nan() || peak < START {
        return rgb;
    }
    let room = 1.0 - START;
    let new_peak = 1.0 - room * room / (peak + room - START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    rgb.map(|c| {
        let c = c * (new_peak / peak);
        c + (new_peak - c) * white
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_exposures_are_exact() {
        for x in -32..=32 {
            assert_eq!(power_of_two(x as f32), 2.0_f32.powi(x), "{x}");
        }
        for i in -100..100 {
            let x = i as f32 * 0.137;
            let expected = f64::from(x).exp2() as f32;
            assert!((power_of_two(x) / expected - 1.0).abs() < 2e-7, "{x}");
        }
    }

    #[test]
    fn neutral_keeps_dark_colours_and_brings_all_within_one() {
        // By hand: what is reflected is taken off, and nothing else.
        let [r, g, b] = neutral([0.5, 0.3, 0.1]);
        assert!((r - 0.46).abs() < 1e-6 && (g - 0.26).abs() < 1e-6 && (b - 0.06).abs() < 1e-6);
        assert_eq!(neutral([0.0; 3]), [0.0; 3]);
        let mut last = 0.0;
        for i in 0..200 {
            let c = (i as f32 * 0.05) * (i as f32 * 0.05);
            let gray = neutral([c; 3]);
            assert!(gray[0] >= last && gray[0] <= 1.0 && gray[0] == gray[2], "{c}: {gray:?}");
            last = gray[0];
            assert!(neutral([c, 0.2, 0.0]).iter().all(|c| (0.0..=1.0).contains(c)), "{c}");
        }
        assert!(last > 0.99);
    }

    #[test]
    fn opacity_stays_and_colours_are_straight_where_toned() {
        let tone = Development { scale: 2.0, tone: Tone::Neutral };
        let opaque = tone.apply([1.0, 0.5, 0.25, 1.0]);
        let half = tone.apply([0.5, 0.25, 0.125, 0.5]);
        assert_eq!(half, opaque.map(|c| c * 0.5));
        assert_eq!(tone.apply([0.0; 4]), [0.0; 4]);
    }
}
