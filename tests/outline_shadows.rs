//! The shadows of outlines, against those of the same relief as real geometry.

mod common;
#[path = "common/displaced.rs"]
mod displaced;

use basrelief::texture::{ColorImage, Surface, SurfaceMaps};
use basrelief::{
    Camera, Filter, Frame, Light, Lighting, Material, Mesh, Rays, Renderer, Scene, Settings, Sky,
};
use common::cobbles;
use displaced::{displaced, sphere, torus};
use glam::{Vec2, Vec3};
use std::sync::Arc;

const TRUTH: Filter = Filter::Truth(Rays { samples: 64 });

/// A mesh of stones over a floor that shows its shadow alone: the camera is between both.
fn over_a_floor(mesh: Mesh, light: Light, has_texture: bool) -> Scene {
    let mut scene = displaced::scene(mesh, cobbles(48, 2), 1.0);
    let corners = [[-9.0, 9.0], [9.0, 9.0], [9.0, -9.0], [-9.0, -9.0]].map(Vec2::from);
    let positions = corners.map(|c| Vec3::new(c.x, -1.5, c.y)).to_vec();
    let tex_coords = if has_texture { corners.to_vec() } else { vec![] };
    let floor = Mesh::new(positions, tex_coords, vec![], vec![[0, 1, 2], [0, 2, 3]]);
    scene.meshes.push(Mesh { material: 1, ..floor });
    let white = ColorImage::from_fn(2, 2, |_, _| [1.0; 3]);
    let white = Surface::new(SurfaceMaps { albedo: Some(white), ..SurfaceMaps::default() });
    let surface = has_texture.then(|| Arc::new(white.expect("valid maps")));
    scene.materials.push(Material { surface, ..Material::default() });
    scene.camera = Camera {
        eye: Vec3::new(-0.9, -1.2, 0.0),
        target: Vec3::new(-0.9, -1.5, 0.0),
        up: Vec3::Z,
        orthographic: Some(3.4),
        ..Camera::default()
    };
    (scene.lights, scene.sky) = (vec![light], Sky::Color(Vec3::ZERO));
    scene
}

fn sun(angular_size: f32) -> Light {
    Light::Sun { to_light: Vec3::new(0.6, 1.0, 0.2), intensity: Vec3::splat(0.8), angular_size }
}

fn draw(scene: &Scene, filter: Filter, silhouette: bool) -> Frame {
    let settings = Settings {
        width: 96,
        height: 64,
        filter,
        silhouette,
        lighting: Lighting::Lit,
        ..Settings::default()
    };
    Renderer::new(scene.clone(), settings).expect("a valid scene").render()
}

/// The shadow of the same relief as triangles, which is that of polygons.
fn shadow_of_triangles(scene: &Scene) -> Frame {
    // All of them throw it: seen from the light none faces far away but those that others hide.
    let mut seen = scene.clone();
    seen.camera.eye = match scene.lights[0] {
        Light::Sun { to_light, .. } => to_light * 1e3,
        Light::Point { position, .. } => position,
    };
    let mut geometry = displaced(&seen, 8);
    geometry.camera = scene.camera;
    draw(&geometry, TRUTH, false)
}

/// How much two shadows overlap: their common part over all that either darkens, where a frame without
/// any is given.
fn overlap(lit: &Frame, shadows: [&Frame; 2]) -> f64 {
    let dark = |frame: &Frame, i: usize| f64::from(1.0 - frame.pixels[i][1] / lit.pixels[i][1]);
    let pairs = || (0..lit.pixels.len()).map(|i| shadows.map(|shadow| dark(shadow, i)));
    let common: f64 = pairs().map(|[a, b]| a.min(b)).sum();
    common / pairs().map(|[a, b]| a.max(b)).sum::<f64>()
}

#[test]
fn curved_reliefs_throw_the_shadows_of_displaced_triangles() {
    for (name, mesh) in [("torus", torus([48, 24])), ("sphere", sphere([48, 24]))] {
        for (light, has_texture) in [(sun(0.0), true), (sun(3.0), false)] {
            let scene = over_a_floor(mesh.clone(), light, has_texture);
            let expected = shadow_of_triangles(&scene);
            let mut bare = scene.clone();
            bare.meshes[0].triangles.clear();
            let lit = draw(&bare, TRUTH, false);
            for filter in [Filter::default(), TRUTH] {
                let [with, without] = [true, false]
                    .map(|silhouette| overlap(&lit, [&draw(&scene, filter, silhouette), &expected]));
                println!("{name}, {filter:?}, {has_texture}: {with:.4}, of polygons {without:.4}");
            }
        }
    }
}
