//! The default filter on its own, for a renderer that has its own derivatives.

use super::{Footprint, ewa, horizon};
use crate::relief::displacement;
use crate::settings::Settings;
use crate::simd::PixelLanes;
use crate::texture::{FULL_F32, Surface};

/// The linear RGB that the eye sees of `surface` in a pixel, by [`Filter::Horizon`](crate::Filter::Horizon) without its
/// tables for distant surfaces.
///
/// `footprint` is where the pixel lies on the flat polygon. `view` is the direction from the eye in the frame of the
/// texture: how far it goes along u, along v and down, all in repeats; any length above 0. Of the settings `lines` and
/// `max_anisotropy` count.
///
/// ```
/// use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps};
/// use basrelief::{Footprint, Settings, seen_color};
///
/// // White ridges across u, with black joints as deep as a tenth of a repeat.
/// let is_ridge = |x: u32| x % 16 < 8;
/// let surface = Surface::new(SurfaceMaps {
///     albedo: Some(ColorImage::from_fn(64, 64, |x, _| if is_ridge(x) { [1.0; 3] } else { [0.0; 3] })),
///     height: Some(HeightImage::from_fn(64, 64, |x, _| if is_ridge(x) { 1.0 } else { 0.0 })),
///     relief_depth: 0.1,
///     ..SurfaceMaps::default()
/// })?;
/// // One's own derivatives: a pixel covers half a repeat along u and a tenth along v.
/// let footprint = Footprint { center: [0.3, 0.7], dx: [0.5, 0.0], dy: [0.0, 0.1] };
/// let settings = Settings::default();
/// let [from_above, _, _] = seen_color(&surface, &footprint, [0.0, 0.0, 1.0], &settings);
/// let [grazing, _, _] = seen_color(&surface, &footprint, [0.9, 0.0, 0.3], &settings);
/// // From above half of what is seen is black; at a grazing angle the ridges hide the joints.
/// assert!((0.4..0.6).contains(&from_above) && grazing > 0.8);
/// # Ok::<(), basrelief::Error>(())
/// ```
#[must_use]
pub fn seen_color(surface: &Surface, footprint: &Footprint, view: [f32; 3], settings: &Settings) -> [f32; 3] {
    let reach = displacement(&view.map(PixelLanes::splat), surface.relief_depth).map(|lanes| lanes.as_array()[0]);
    let (filtered, _) = horizon::visible_mean(surface, footprint, reach, settings, None);
    filtered.color.map(|c| c * (surface.color_scale / FULL_F32))
}

/// The linear RGB of `surface` in a pixel by the elliptical weighted average, formula (1), relief left out of account.
/// Of the settings `texel_budget`, `max_anisotropy`, `cut` and `texel_kernel` count.
///
/// ```
/// use basrelief::texture::{ColorImage, Surface, SurfaceMaps};
/// use basrelief::{Footprint, Settings, ewa_color};
///
/// let stripes = ColorImage::from_fn(64, 64, |x, _| if x % 16 < 8 { [1.0; 3] } else { [0.0; 3] });
/// let surface = Surface::new(SurfaceMaps { albedo: Some(stripes), ..SurfaceMaps::default() })?;
/// let footprint = Footprint { center: [0.5, 0.5], dx: [2.0, 0.0], dy: [0.0, 0.1] };
/// let [red, _, _] = ewa_color(&surface, &footprint, &Settings::default());
/// assert!((0.45..0.55).contains(&red));
/// # Ok::<(), basrelief::Error>(())
/// ```
#[must_use]
pub fn ewa_color(surface: &Surface, footprint: &Footprint, settings: &Settings) -> [f32; 3] {
    ewa::mean(surface, footprint, settings, false).0.color.map(|c| c * (surface.color_scale / FULL_F32))
}
