//! What must hold of layers.

use super::check::{Checked, ensure};
use crate::layers::{Layer, Layers};
use crate::render::Renderer;
use crate::scene::Scene;
use crate::settings::Settings;
use glam::Vec3;

/// The layers of a frame, if the scene and settings are not refused, say one thing: names are those
/// of triangles of the scene, no hit is before its polygon, places in camera axes are as far as the
/// depth says, normals are of length one, numbers are finite where something is seen and those of
/// the background where nothing is.
///
/// # Errors
/// Says what broke.
pub fn layers_agree(scene: Scene, settings: Settings) -> Checked {
    let Ok(mut renderer) = Renderer::new(scene, settings) else { return Ok(()) };
    let layers = renderer.render_layers(&Layer::ALL);
    (0..layers.width as usize * layers.height as usize).try_for_each(|at| {
        pixel_agrees(renderer.scene(), &layers, at).map_err(|what| {
            let [x, y] = [at % layers.width as usize, at / layers.width as usize];
            format!("pixel {x},{y}: {what}")
        })
    })
}

fn pixel_agrees(scene: &Scene, layers: &Layers, at: usize) -> Checked {
    let of = |layer: Layer| {
        let num = layer.num_channels();
        &layers.floats(layer)[num * at..num * (at + 1)]
    };
    let [object, material, triangle] =
        [Layer::Object, Layer::Material, Layer::Triangle].map(|layer| layers.ids(layer)[at]);
    if object == u32::MAX {
        ensure(material == u32::MAX && triangle == u32::MAX, || "a name of nothing".into())?;
        return Layer::ALL.into_iter().filter(|layer| !layer.is_id()).try_for_each(|layer| {
            let is_background = of(layer).iter().all(|value| *value == layer.background());
            ensure(is_background, || format!("{layer:?} of nothing: {:?}", of(layer)))
        });
    }
    let is_named = scene.meshes.get(object as usize).is_some_and(|mesh| {
        (triangle as usize) < mesh.triangles.len() && material as usize == mesh.material
    });
    ensure(is_named, || format!("object {object}, material {material}, triangle {triangle}"))?;
    let [[polygon], [depth]] = [of(Layer::PolygonDepth), of(Layer::Depth)] else {
        return Err("depths are single numbers".into());
    };
    ensure(0.0 < *polygon && polygon <= depth && depth.is_finite(), || {
        format!("polygon at {polygon}, hit at {depth}")
    })?;
    ensure(of(Layer::CameraPosition)[2] == *depth, || {
        format!("depth {depth}, place {:?}", of(Layer::CameraPosition))
    })?;
    for layer in [Layer::Normal, Layer::CameraNormal, Layer::PolygonNormal] {
        let length = Vec3::from_slice(of(layer)).length();
        ensure((length - 1.0).abs() < 1e-5, || format!("{layer:?} {:?}", of(layer)))?;
    }
    [Layer::Uv, Layer::PolygonUv, Layer::Albedo].into_iter().try_for_each(|layer| {
        let is_good = of(layer).iter().all(|value| value.is_finite());
        ensure(is_good, || format!("{layer:?} {:?}", of(layer)))
    })
}
