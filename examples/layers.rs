//! Says what a picture shows, by its layers: how many pixels each object has, and how far it is.
//!
//! `cargo run --release --example layers -- [FILE.obj]`

use basrelief::load::{LoadOptions, load};
use basrelief::{Filter, Layer, Renderer, Settings, scene};
use std::path::Path;

fn main() -> basrelief::Result<()> {
    let scene = match std::env::args_os().nth(1) {
        Some(file) => load(Path::new(&file), &LoadOptions::default())?.scene,
        None => scene::builtin(),
    };
    // A filter without tables: layers need none.
    let settings =
        Settings { width: 256, height: 256, filter: Filter::Nearest, ..Settings::default() };
    let mut renderer = Renderer::new(scene, settings)?;
    let layers = renderer.render_layers(&[Layer::Depth, Layer::Object]);
    let (depths, objects) = (layers.floats(Layer::Depth), layers.ids(Layer::Object));
    for (i, mesh) in renderer.scene().meshes.iter().enumerate() {
        let of_mesh = depths.iter().zip(objects).filter(|(_, object)| **object == i as u32);
        let (num, nearest) = of_mesh
            .fold((0, f32::INFINITY), |(num, nearest), (depth, _)| (num + 1, nearest.min(*depth)));
        println!("{}: {num} pixels, {nearest} away and more", mesh.name);
    }
    Ok(())
}
