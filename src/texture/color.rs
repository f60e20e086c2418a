//! sRGB transfer function (IEC 61966-2-1), both ways.

/// Linear light, 0 to 1, from an sRGB-encoded value, 0 to 1.
#[must_use]
pub fn linear_from_srgb(encoded: f32) -> f32 {
    let c = f64::from(encoded);
    (if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }) as f32
}

/// An sRGB-encoded value, 0 to 1, from linear light; clamped, NaN gives 0.
#[must_use]
pub fn srgb_from_linear(linear: f32) -> f32 {
    let c = f64::from(linear.max(0.0).min(1.0));
    (if c <= 0.003_130_8 { c * 12.92 } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }) as f32
}
