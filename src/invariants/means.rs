//! What holds of any weighted mean of texels: linear in the texture, the same for the same ellipse,
//! untouched by flat relief.

use super::check::{Checked, difference, ensure};
use super::pixel::filtered;
use crate::footprint::Footprint;
use crate::settings::{Filter, Visible};
use crate::texture::{ColorImage, HeightImage, Surface, SurfaceMaps};

/// How far the mean of two colours may be from the colour of the mean texture: texels are stored in
/// 15 bits, and each mip level rounds once more.
const STORED_ROUNDING: f32 = 4e-4;

/// The surface of `maps` with another albedo.
fn with_albedo(maps: &SurfaceMaps, albedo: ColorImage) -> Result<Surface, String> {
    Surface::new(SurfaceMaps { albedo: Some(albedo), ..maps.clone() }).map_err(|e| e.to_string())
}

/// The colour is linear in the texture: that of the mean of the maps' albedo (white where there is
/// none) and of `other`, which must be of its size and scale, is the mean of their colours.
///
/// # Errors
/// Says what broke, or why the maps are no surface.
pub fn linear_in_texture(
    maps: &SurfaceMaps,
    other: &ColorImage,
    pixel: &Footprint,
    filter: &Filter,
) -> Checked {
    let white = || ColorImage { texels: vec![[65535; 3]; other.texels.len()], ..other.clone() };
    let one = maps.albedo.clone().unwrap_or_else(white);
    ensure(one.texels.len() == other.texels.len() && one.scale == other.scale, || {
        "albedos differ in size".into()
    })?;
    let mean = |a: u16, b: u16| ((u32::from(a) + u32::from(b)) / 2) as u16;
    let texels = one
        .texels
        .iter()
        .zip(&other.texels)
        .map(|(a, b)| [0, 1, 2].map(|i| mean(a[i], b[i])))
        .collect();
    let both = ColorImage { texels, ..one.clone() };
    let color = |albedo| Ok::<_, String>(filtered(&with_albedo(maps, albedo)?, pixel, filter));
    let (a, b, both) = (color(one)?, color(other.clone())?, color(both)?);
    let expected = [0, 1, 2].map(|i| (a[i] + b[i]) * 0.5);
    ensure(difference(expected, both) <= STORED_ROUNDING, || {
        format!("{a:?} and {b:?} have the mean {both:?}")
    })
}

/// Derivatives that are swapped or point the other way span the same ellipse and give the same
/// colour, to the bit.
///
/// # Errors
/// Says what broke.
pub fn same_for_same_ellipse(surface: &Surface, pixel: &Footprint, filter: &Filter) -> Checked {
    let expected = filtered(surface, pixel, filter);
    let negated = |d: [f32; 2]| d.map(|c| -c);
    let [dx, dy] = [pixel.dx, pixel.dy];
    for [dx, dy] in [[dy, dx], [negated(dx), dy], [dx, negated(dy)], [negated(dy), negated(dx)]] {
        let mut other = *pixel;
        (other.dx, other.dy) = (dx, dy);
        let found = filtered(surface, &other, filter);
        ensure(found == expected, || {
            format!("{expected:?} became {found:?} with dx {dx:?}, dy {dy:?}")
        })?;
    }
    Ok(())
}

/// Relief of one height everywhere hides nothing: `Visible` is what it is from straight above, to
/// the bit, whatever the view.
///
/// # Errors
/// Says what broke, or why the maps are no surface.
pub fn flat_relief_hides_nothing(
    maps: &SurfaceMaps,
    height: u16,
    pixel: &Footprint,
    visible: &Visible,
) -> Checked {
    let flat = HeightImage { width: 1, height: 1, texels: vec![height] };
    let surface = Surface::new(SurfaceMaps { height: Some(flat), ..maps.clone() })
        .map_err(|e| e.to_string())?;
    let filter = Filter::Visible(*visible);
    let from = |displacement| filtered(&surface, &Footprint { displacement, ..*pixel }, &filter);
    let (all, visible) = (from([0.0; 2]), from(pixel.displacement));
    ensure(all == visible, || format!("{visible:?} is left of {all:?} at height {height}"))
}
