//! What moves in lit frames is the picture, not its errors: the change of a frame's error from one
//! frame to the next is what flickers.

mod common;

use basrelief::texture::{Surface, SurfaceMaps, srgb_from_linear};
use basrelief::{Filter, Frame, Light, Lighting, Rays, Scene, Settings, Sky, render};
use common::{cobbles, floor_scene};
use glam::Vec3;

/// The floor under a sun so many degrees beside the others, seen from so far ahead.
fn floor(ahead: f32, degrees: f32) -> Scene {
    let maps = SurfaceMaps { relief_depth: 0.08, ..cobbles(128, 4) };
    let mut scene = floor_scene(Surface::new(maps).expect("valid maps"), 0.5);
    scene.camera.eye.z -= ahead;
    scene.camera.target.z -= ahead;
    let (sin, cos) = (30.0 + degrees).to_radians().sin_cos();
    let to_light = Vec3::new(0.7 * cos, sin, -0.714 * cos);
    scene.lights = vec![Light::sun(to_light, Vec3::splat(0.9))];
    Scene { sky: Sky::Color(Vec3::splat(0.2)), ..scene }
}

fn draw(scene: &Scene, filter: Filter) -> Frame {
    let settings = Settings {
        width: 80,
        height: 45,
        msaa: 1,
        filter,
        lighting: Lighting::Lit,
        ..Settings::default()
    };
    render(scene.clone(), settings).expect("a valid scene")
}

/// The mean square of how the errors of a filter change between two scenes, as frames are encoded.
fn flicker(scenes: &[Scene; 2], truths: &[Frame; 2], filter: Filter) -> f64 {
    let frames = scenes.each_ref().map(|scene| draw(scene, filter));
    let error = |i: usize, pixel: usize, c: usize| {
        let [frame, truth] = [&frames[i], &truths[i]].map(|frame| frame.pixels[pixel][c]);
        f64::from(srgb_from_linear(frame) - srgb_from_linear(truth))
    };
    let pixels = 0..frames[0].pixels.len();
    let squares = pixels
        .clone()
        .flat_map(|pixel| [0, 1, 2].map(|c| (error(1, pixel, c) - error(0, pixel, c)).powi(2)));
    squares.sum::<f64>() / (3 * pixels.len()) as f64
}

/// The flicker of the default filter, and that of four rays a pixel.
fn flickers(scenes: &[Scene; 2]) -> [f64; 2] {
    let truths = scenes.each_ref().map(|scene| draw(scene, Filter::Truth(Rays { samples: 256 })));
    let filters = [Filter::default(), Filter::Parallax(Rays { samples: 4 })];
    filters.map(|filter| flicker(scenes, &truths, filter))
}

#[test]
fn errors_stay_where_the_camera_moves() {
    let [found, rays] = flickers(&[floor(0.0, 0.0), floor(0.03, 0.0)]);
    assert!(found <= 0.1 * rays, "{found:e}, by four rays a pixel {rays:e}");
}

#[test]
fn errors_stay_where_the_sun_moves() {
    // Light is baked for all filters, so that rays flicker as little: a hundredth of the square of
    // a byte's step is 1.5e-7.
    let flickers = flickers(&[floor(0.0, 0.0), floor(0.0, 0.1)]);
    assert!(flickers.iter().all(|flicker| *flicker <= 1.5e-7), "{flickers:?}");
}
