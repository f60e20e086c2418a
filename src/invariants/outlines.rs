//! What must hold of outlines and of meshes that meet in a relief.

use super::check::{Checked, ensure};
use crate::layers::{Layer, Layers};
use crate::render::Renderer;
use crate::scene::Scene;
use crate::settings::Settings;

/// A frame, if the scene and settings are not refused, covers no sample where no polygon is, and
/// neither a frame nor its layers depend on how they are cut into tiles.
///
/// # Errors
/// Says what broke.
pub fn outlines_hold(scene: Scene, settings: Settings) -> Checked {
    let of =
        |silhouette: bool, tile_size: u32| Settings { silhouette, tile_size, ..settings.clone() };
    let Ok(mut renderer) = Renderer::new(scene, of(true, 16)) else { return Ok(()) };
    let mut draw = |settings: Settings| {
        renderer.set_settings(settings).map_err(|error| error.to_string())?;
        Ok::<_, String>((renderer.render(), renderer.render_layers(&[Layer::Depth, Layer::Object])))
    };
    let [(frame, layers), (same_frame, same_layers), (polygons, polygon_layers)] =
        [draw(of(true, 16))?, draw(of(true, 64))?, draw(of(false, 32))?];
    let bits = |layers: &Layers| -> Vec<u32> {
        layers.floats(Layer::Depth).iter().map(|depth| depth.to_bits()).collect()
    };
    ensure(bits(&layers) == bits(&same_layers), || "layers depend on tiles".into())?;
    for (at, pixel) in frame.pixels.iter().enumerate() {
        let place = || [at % frame.width as usize, at / frame.width as usize];
        ensure(pixel.map(f32::to_bits) == same_frame.pixels[at].map(f32::to_bits), || {
            format!("pixel {:?} depends on tiles", place())
        })?;
        ensure(pixel[3] <= polygons.pixels[at][3], || {
            format!("pixel {:?} is covered where no polygon is", place())
        })?;
        let [on, off] = [&layers, &polygon_layers].map(|layers| layers.ids(Layer::Object)[at]);
        ensure(on == u32::MAX || off != u32::MAX, || {
            format!("a layer at {:?} sees what no polygon is before", place())
        })?;
    }
    Ok(())
}
