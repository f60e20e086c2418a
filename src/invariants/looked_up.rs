//! What holds of colours that are looked up along one ray, and in tables of the far field.

use super::check::{Checked, difference, ensure};
use super::pixel::texel_range;
use crate::filter::Prepared;
use crate::footprint::Footprint;
use crate::reference::parallax_with_margin;
use crate::settings::{Filter, Horizon, Rays};
use crate::texture::Surface;

/// What a table's word rounds a colour by: roots in ten and eleven bits, blended and averaged.
const TABLE_ROUNDING: f64 = 1.2e-3;

/// Depth of a step of common practice.
const STEP: f64 = 1.0 / 32.0;

/// Common practice in lanes finds the colour that one ray in f64 finds. Rays that touch the relief
/// at a step within what f32 rounds may go under it or pass, and are not looked at.
///
/// # Errors
/// Says what broke.
pub fn steps_find_the_references_hit(
    surface: &Surface,
    pixel: &Footprint,
    samples: u32,
) -> Checked {
    let (expected, margin) = parallax_with_margin(surface, pixel, samples);
    let filter = Filter::Parallax(Rays { samples });
    let found = Prepared::new(surface.clone()).colors(&filter, &[*pixel])[0];
    let texels = surface.base().texels_per_repeat().map(f64::from);
    let longest = |v: [f32; 2]| {
        let [u, v] = [0, 1].map(|i| (f64::from(v[i]) * texels[i]).abs());
        u.max(v)
    };
    let reach = longest(pixel.displacement);
    // Places in texels are known to a few of an f32's digits; heights and colours differ by at most
    // their range from one texel to the next.
    let place = 1e-5 + 4e-7 * (longest(pixel.base) + reach);
    if margin < 1e-3 + 8.0 * place {
        return Ok(());
    }
    // The secant step moves the hit by as much as the gaps err, over how far apart they are.
    let bound = 1e-3 + 4.0 * place * (1.0 + STEP * reach / margin);
    let scale = f64::from(surface.color_scale());
    let error =
        (0..3).map(|c| (f64::from(found[c]) / scale - expected[c]).abs()).fold(0.0, f64::max);
    ensure(error <= bound, || {
        format!("{found:?} is not {expected:?}: {error} apart, {bound} allowed, margin {margin}")
    })
}

/// The colours of pixels with the far field are finite and within the least and greatest texel, up
/// to the rounding of a table's word; and the same, to the bit, whatever was asked of the tables
/// before.
///
/// # Errors
/// Says what broke.
pub fn tables_give_texels_in_any_order(
    surface: &Surface,
    pixels: &[Footprint],
    horizon: &Horizon,
) -> Checked {
    let filter = Filter::Horizon(Horizon { far_field: true, ..*horizon });
    let fresh = || Prepared::new(surface.clone());
    let colors = fresh().colors(&filter, pixels);
    let (least, most) = texel_range(surface);
    let scale = surface.color_scale();
    for (color, pixel) in colors.iter().zip(pixels) {
        let is_within = |c: usize| {
            let value = f64::from(color[c] / scale);
            value >= least[c] - TABLE_ROUNDING && value <= most[c] + TABLE_ROUNDING
        };
        ensure((0..3).all(is_within), || {
            format!("{color:?} of scale {scale} is not within {least:?} to {most:?}: {pixel:?}")
        })?;
    }
    // The last pixel's tables are built first.
    let (again, mut backwards) = (fresh(), Vec::new());
    backwards.extend(pixels.iter().rev().map(|pixel| again.colors(&filter, &[*pixel])[0]));
    for (one, other) in colors.iter().zip(backwards.iter().rev()) {
        ensure(one == other, || format!("{one:?} became {other:?} in another order"))?;
    }
    Ok(())
}

/// Relief of one height hides nothing: a footprint of many repeats has the mean colour, whether
/// tables or sweeps give it.
///
/// # Errors
/// Says what broke.
pub fn flat_tables_give_the_mean(
    surface: &Surface,
    pixel: &Footprint,
    horizon: &Horizon,
) -> Checked {
    let last = &surface.levels()[surface.last_level()];
    let mean = crate::reference::color(last, [0, 0]).map(|c| c as f32);
    let filter = Filter::Horizon(Horizon { far_field: true, ..*horizon });
    let scale = surface.color_scale();
    let found = Prepared::new(surface.clone()).colors(&filter, &[*pixel])[0].map(|c| c / scale);
    ensure(difference(found, mean) < 0.02, || format!("{found:?} where all have {mean:?}"))
}
