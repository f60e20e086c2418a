//! A texture shifted, turned or mirrored with the view gives the same colour; relief and view
//! scaled together hide the same.
//!
//! Sums run over the same texels in another order, so colours agree up to rounding; but rounding
//! also decides which texels on the very edge of an ellipse belong to it, so the callers state the
//! tolerance.

use super::check::{Checked, difference, ensure};
use super::pixel::filtered;
use super::pixel::on_base_level;
use crate::filter::visible::{Occlusion, TexelSet, remove_hidden};
use crate::footprint::Footprint;
use crate::reference::{RAY_TIE, ray_margin};
use crate::settings::{Filter, Horizon, Visibility};
use crate::texture::{ColorImage, HeightImage, Surface, SurfaceMaps};
use std::collections::BTreeSet;

/// The same pixel of two textures.
fn agree(
    maps: [SurfaceMaps; 2],
    pixels: [&Footprint; 2],
    filter: &Filter,
    tolerance: f32,
) -> Checked {
    let [a, b] = maps.map(|maps| Surface::new(maps).map_err(|e| e.to_string()));
    let [a, b] = [filtered(&a?, pixels[0], filter), filtered(&b?, pixels[1], filter)];
    let error = difference(a, b);
    ensure(error <= tolerance, || format!("{a:?} became {b:?}, {error} apart"))
}

/// The maps with every texel moved: the new texel at `(x, y)` of a map of the new size is the old
/// one at `from(x, y)`.
fn moved(
    maps: &SurfaceMaps,
    is_turned: bool,
    from: impl Fn([u32; 2], [u32; 2]) -> [u32; 2],
) -> SurfaceMaps {
    let places = |w: u32, h: u32| {
        let [new_w, new_h] = if is_turned { [h, w] } else { [w, h] };
        let index = |[x, y]: [u32; 2]| (y * w + x) as usize;
        let order: Vec<usize> = (0..new_h)
            .flat_map(|y| (0..new_w).map(move |x| [x, y]))
            .map(|place| index(from(place, [w, h])))
            .collect();
        (new_w, new_h, order)
    };
    let albedo = maps.albedo.as_ref().map(|image| {
        let (width, height, order) = places(image.width, image.height);
        ColorImage {
            width,
            height,
            texels: order.iter().map(|&i| image.texels[i]).collect(),
            scale: image.scale,
        }
    });
    let heights = maps.height.as_ref().map(|image| {
        let (width, height, order) = places(image.width, image.height);
        HeightImage { width, height, texels: order.iter().map(|&i| image.texels[i]).collect() }
    });
    SurfaceMaps { albedo, height: heights, normal: None, ..maps.clone() }
}

/// The size of the colour or height map, which must be the same where there are both.
fn size(maps: &SurfaceMaps) -> [u32; 2] {
    let albedo = maps.albedo.as_ref().map(|m| [m.width, m.height]);
    albedo.or(maps.height.as_ref().map(|m| [m.width, m.height])).unwrap_or([1, 1])
}

/// A repeating texture shifted by whole texels with the pixel gives the same colour. Coarser levels
/// shift by whole texels too only where `by` is a multiple of theirs and the size a power of two.
///
/// # Errors
/// Says what broke.
pub fn shifted(
    maps: &SurfaceMaps,
    pixel: &Footprint,
    filter: &Filter,
    by: [u32; 2],
    tolerance: f32,
) -> Checked {
    let back =
        |[x, y]: [u32; 2], [w, h]: [u32; 2]| [(x + w - by[0] % w) % w, (y + h - by[1] % h) % h];
    let mut there = *pixel;
    let [w, h] = size(maps);
    there.base[0] += by[0] as f32 / w as f32;
    there.base[1] += by[1] as f32 / h as f32;
    there.hit = there.base;
    agree([maps.clone(), moved(maps, false, back)], [pixel, &there], filter, tolerance)
}

/// A texture turned by 90 degrees with the pixel gives the same colour.
///
/// # Errors
/// Says what broke.
pub fn turned(maps: &SurfaceMaps, pixel: &Footprint, filter: &Filter, tolerance: f32) -> Checked {
    let turn = |[u, v]: [f32; 2]| [-v, u];
    let mut there = *pixel;
    // About the texture's middle, so that texels come to lie on texels.
    there.base = [1.0 - there.base[1], there.base[0]];
    there.hit = there.base;
    (there.dx, there.dy) = (turn(there.dx), turn(there.dy));
    there.displacement = turn(there.displacement);
    // The new (x, y) was at (y, h - 1 - x).
    let turned = moved(maps, true, |[x, y], [_, h]| [y, h - 1 - x]);
    agree([maps.clone(), turned], [pixel, &there], filter, tolerance)
}

/// A texture mirrored along u with the pixel gives the same colour.
///
/// # Errors
/// Says what broke.
pub fn mirrored(maps: &SurfaceMaps, pixel: &Footprint, filter: &Filter, tolerance: f32) -> Checked {
    let flip = |[u, v]: [f32; 2]| [-u, v];
    let mut there = *pixel;
    there.base[0] = 1.0 - there.base[0];
    there.hit = there.base;
    (there.dx, there.dy) = (flip(there.dx), flip(there.dy));
    there.displacement = flip(there.displacement);
    let mirrored = moved(maps, false, |[x, y], [w, _]| [w - 1 - x, y]);
    agree([maps.clone(), mirrored], [pixel, &there], filter, tolerance)
}

/// Relief of half the height under a view of twice the slope hides the same texels, up to ties, and
/// the horizon gives the same colour. Heights must be 2 more than a multiple of 4, so that half of
/// their depth is stored exactly, and maps of one size.
///
/// # Errors
/// Says what broke.
pub fn same_when_scaled(
    maps: &SurfaceMaps,
    pixel: &Footprint,
    horizon: &Horizon,
    tolerance: f32,
) -> Checked {
    let mut shallow = maps.clone();
    if let Some(heights) = &mut shallow.height {
        heights.texels.iter_mut().for_each(|h| *h = 2 * (32767 - (32767 - *h / 2) / 2));
    }
    let mut slanted = *pixel;
    slanted.displacement = slanted.displacement.map(|d| d * 2.0);
    let visible = |maps: &SurfaceMaps, pixel: &Footprint| {
        let surface = Surface::new(maps.clone()).map_err(|e| e.to_string())?;
        let (ellipse, [center, displacement]) =
            on_base_level(&surface, pixel, horizon.max_anisotropy);
        let mut set = TexelSet::default();
        set.fill_ellipse(&ellipse, center);
        remove_hidden(&mut set, &Occlusion::new(surface.base(), displacement), Visibility::Exact);
        let margin = move |texel| ray_margin(surface.base(), texel, displacement.map(f64::from));
        Ok::<_, String>((set.iter().collect::<BTreeSet<_>>(), margin))
    };
    let ((deep, margin), (flat, _)) = (visible(maps, pixel)?, visible(&shallow, &slanted)?);
    let differs =
        deep.symmetric_difference(&flat).find(|texel| margin(**texel).abs() > 2.0 * RAY_TIE);
    ensure(differs.is_none(), || format!("{differs:?} is visible in one of the two"))?;
    agree([maps.clone(), shallow], [pixel, &slanted], &Filter::Horizon(*horizon), tolerance)
}
