//! Where a place on a pixel's ray is.

use super::layer::Layer;
use crate::geometry::Projection;

/// Writes the layers that say where a place on the ray of a pixel is, by its distance along the
/// view.
#[inline(always)]
pub(super) fn write_place(
    layer: Layer,
    pixel: [i32; 2],
    w: f32,
    projection: &Projection,
    values: &mut [f32],
) {
    let place = || projection.place(pixel.map(|c| f64::from(c) + 0.5), f64::from(w));
    match layer {
        Layer::Depth | Layer::PolygonDepth => values[0] = w,
        Layer::CameraPosition => values[..3].copy_from_slice(&place().as_vec3().to_array()),
        _ => values[..3].copy_from_slice(&projection.world(place()).to_array()),
    }
}
