//! How near pictures of reliefs on curved meshes come to the same reliefs as real geometry: the
//! overlap of what is covered, the colour, the depth. Writes both, and pictures with outlines and
//! without.
//!
//! `cargo run --release --example outlines [WIDTH HEIGHT [SEGMENTS PIECES [SAMPLES]]]`

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/common/displaced.rs"]
mod displaced;

use basrelief::{
    Camera, Error, Filter, Layer, Light, Lighting, Rays, Renderer, Scene, Settings, Sky, render,
};
use common::cobbles;
use displaced::{ball_in_stones, decibels, depths_within, overlap, scene, show, sphere, torus};
use glam::Vec3;

fn main() -> Result<(), Error> {
    let numbers: Vec<u32> = std::env::args().skip(1).filter_map(|arg| arg.parse().ok()).collect();
    let or = |i: usize, default: u32| numbers.get(i).copied().unwrap_or(default);
    let [segments, pieces, samples] = [or(2, 48), or(3, 16), or(4, 64)];
    let settings = Settings { width: or(0, 640), height: or(1, 360), ..Settings::default() };
    let torus = scene(torus([2 * segments, segments]), cobbles(128, 4), 3.4);
    let sphere = scene(sphere([2 * segments, segments]), cobbles(128, 4), 2.6);
    for (name, scene) in [("torus", &torus), ("sphere", &sphere)] {
        measure(name, scene, &settings, [pieces, samples])?;
    }
    let near = Camera { eye: Vec3::new(0.0, 1.3, 1.9), ..torus.camera };
    with_and_without("torus", Scene { camera: near, ..torus }, &settings)?;
    with_and_without("ball", ball_in_stones(cobbles(256, 2)), &settings)
}

/// Compares a scene with displaced triangles.
fn measure(
    name: &str,
    scene: &Scene,
    settings: &Settings,
    [pieces, samples]: [u32; 2],
) -> Result<(), Error> {
    let geometry = displaced::displaced(scene, pieces);
    println!("{name}: {} triangles", geometry.meshes[0].triangles.len());
    let shown = show(&geometry, settings);
    shown.colors.save(format!("{name}_geometry.png"))?;
    let [u, v] = scene.meshes[0].tangents[scene.meshes[0].tangents.len() / 2];
    let depth = u.cross(v).length().sqrt() * 0.06;
    for (word, filter) in
        [("horizon", Filter::default()), ("truth", Filter::Truth(Rays { samples }))]
    {
        let mut renderer = Renderer::new(scene.clone(), Settings { filter, ..settings.clone() })?;
        let frame = renderer.render();
        let layers = renderer.render_layers(&[Layer::Depth]);
        println!(
            "{word}: overlap {:.4}, {:.2} dB, depth within 1 % of {depth:.4} {:.4}",
            overlap(&frame, &shown.coverage),
            decibels(&frame, &shown.colors),
            depths_within(layers.floats(Layer::Depth), &shown.depth, depth * 0.01),
        );
        frame.save(format!("{name}_{word}.png"))?;
    }
    Ok(())
}

/// Draws a scene in the sun, with outlines and by its polygons.
fn with_and_without(name: &str, scene: Scene, settings: &Settings) -> Result<(), Error> {
    let sun = Light::sun(Vec3::new(-0.6, 0.9, 0.5), Vec3::splat(0.9));
    let scene = Scene {
        lights: vec![sun],
        sky: Sky::Color(Vec3::new(0.25, 0.28, 0.33)),
        background: [0.3, 0.42, 0.6, 1.0],
        ..scene
    };
    for (word, silhouette) in [("with", true), ("without", false)] {
        let settings =
            Settings { silhouette, lighting: Lighting::Lit, msaa: 8, ..settings.clone() };
        render(scene.clone(), settings)?.save(format!("{name}_{word}.png"))?;
    }
    Ok(())
}
