//! The weights of the floating horizon, seen through textures in which one texel at a time is lit.

use super::check::{Checked, ensure};
use super::pixel::filtered;
use super::pixel::on_base_level;
use crate::footprint::Footprint;
use crate::reference::{Conic, Lines, RAY_TIE, ray_margin, texels};
use crate::settings::{Filter, Horizon};
use crate::texture::{ColorImage, Surface, SurfaceMaps};

/// How far the weights of all texels may be from adding up to 1: in f32, and by what a mip level
/// rounds each texel.
const SUM_ROUNDING: f64 = 2e-4;
const TEXEL_ROUNDING: f64 = 1.0 / 32767.0;

/// The horizon weighs every texel of the texture 0 or more, and all weights add up to 1 whatever
/// the relief. Takes a render of the pixel for every three texels, so the texture should be small.
///
/// # Errors
/// Says what broke.
pub fn horizon_weights(maps: &SurfaceMaps, pixel: &Footprint, horizon: &Horizon) -> Checked {
    let size = Surface::new(maps.clone()).map_err(|e| e.to_string())?.base().size();
    let filter = Filter::Horizon(*horizon);
    let repeats = if maps.wrap == crate::texture::Wrap::Mirror { 2 } else { 1 };
    let (w, h) = (size[0] as u32 / repeats, size[1] as u32 / repeats);
    let mut sum = 0.0;
    for first in (0..w * h).step_by(3) {
        let lit =
            |x: u32, y: u32| [0, 1, 2].map(|i| if y * w + x == first + i { 1.0 } else { 0.0 });
        let maps = SurfaceMaps { albedo: Some(ColorImage::from_fn(w, h, lit)), ..maps.clone() };
        let surface = Surface::new(maps).map_err(|e| e.to_string())?;
        let color = filtered(&surface, pixel, &filter);
        ensure(color.iter().all(|c| *c >= 0.0), || {
            format!("texels {first} to {} weigh {color:?}", first + 2)
        })?;
        sum += color.iter().map(|c| f64::from(*c)).sum::<f64>();
    }
    let rounding = SUM_ROUNDING + f64::from(w * h) * TEXEL_ROUNDING;
    ensure((sum - 1.0).abs() < rounding, || format!("the weights add up to {sum}"))
}

/// A texel makes a new record on the line through its centre exactly if the ray from it to the eye
/// is free, up to ties: places where the ray passes the relief by less than rounding tells. Looks
/// at the first 1024 texels of the ellipse.
///
/// # Errors
/// Says what broke.
pub fn records_are_visible(surface: &Surface, pixel: &Footprint, max_anisotropy: f32) -> Checked {
    let level = surface.base();
    let (ellipse, [center, displacement]) = on_base_level(surface, pixel, max_anisotropy);
    let (conic, center, displacement) =
        (Conic::from(&ellipse), center.map(f64::from), displacement.map(f64::from));
    for (texel, _) in texels(&conic, center, 0.0).into_iter().take(1024) {
        let margin = ray_margin(level, texel, displacement);
        // One line, through the texel's centre, in a footprint that reaches from before its place
        // to behind it.
        let middle = texel.map(|c| f64::from(c) + 0.5);
        let is_record =
            Lines { level, conic, center: middle, displacement, spacing: 1.0, steps_per_row: 1 }
                .is_record(texel);
        ensure(is_record == (margin <= 0.0) || margin.abs() < RAY_TIE, || {
            format!("{texel:?}: record {is_record}, relief {margin} of its depth above the ray")
        })?;
    }
    Ok(())
}
