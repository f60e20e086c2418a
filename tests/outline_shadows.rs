//! The shadows of outlines, against those of the same relief as real geometry.

mod common;
#[path = "common/displaced.rs"]
mod displaced;

use basrelief::light::exact::{LightRay, Occluders};
use basrelief::relief::HeightField;
use basrelief::shell::{Outlined, Shell};
use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps};
use basrelief::{
    Camera, Filter, Frame, Light, Lighting, Material, Mesh, Rays, Renderer, Scene, Settings, Sky,
};
use common::cobbles;
use displaced::{displaced, sphere, torus};
use glam::{DVec3, Vec2, Vec3};
use std::sync::Arc;

const TRUTH: Filter = Filter::Truth(Rays { samples: 16 });

/// A mesh of stones over a floor that shows its shadow alone: the camera is between both.
fn over_a_floor(mesh: Mesh, light: Light, has_texture: bool) -> Scene {
    let mut scene = displaced::scene(mesh, cobbles(24, 2), 1.0);
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
    drawn_finer(scene, filter, (1, silhouette))
}

fn drawn_finer(scene: &Scene, filter: Filter, (finer, silhouette): (u32, bool)) -> Frame {
    let settings = Settings {
        width: 96 * finer,
        height: 64 * finer,
        filter,
        silhouette,
        lighting: Lighting::Lit,
        ..Settings::default()
    };
    Renderer::new(scene.clone(), settings).expect("a valid scene").render()
}

/// What a filter must draw where there is no relief: the truth, or the mean over each pixel, which rays
/// from all over it find.
fn expected(scene: &Scene, filter: Filter) -> Frame {
    if filter == TRUTH {
        return draw(scene, TRUTH, false);
    }
    let fine = drawn_finer(scene, Filter::Truth(Rays { samples: 2 }), (4, false));
    let mean = |i: u32| {
        let [x, y] = [i % 96 * 4, i / 96 * 4];
        let places = (0..16).map(|j| (y + j / 4) * fine.width + x + j % 4);
        let sum: f32 = places.map(|i| fine.pixels[i as usize][1]).sum();
        [sum / 16.0; 4]
    };
    Frame { width: 96, height: 64, pixels: (0..96 * 64).map(mean).collect() }
}

/// The same relief as triangles, none of which is left out that the light meets first.
fn as_triangles(scene: &Scene) -> Scene {
    let mut seen = scene.clone();
    seen.camera.eye = match scene.lights[0] {
        Light::Sun { to_light, .. } => to_light * 1e3,
        Light::Point { position, .. } => position,
    };
    Scene { camera: scene.camera, ..displaced(&seen, 8) }
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
    // Overlap at least, of the picture and of the truth. Reached: 0.9946 and 0.9989, 0.9921 and 0.9988,
    // 0.9966 and 0.9986; with the shadows of polygons 0.968 to 0.974.
    let point = Light::Point { position: Vec3::new(1.5, 2.5, 0.5), intensity: Vec3::splat(9.0) };
    for (name, scene, [least_horizon, least_truth]) in [
        ("torus in the sun", over_a_floor(torus([24, 12]), sun(0.0), true), [0.993, 0.998]),
        ("sphere in the sun", over_a_floor(sphere([24, 12]), sun(0.5), false), [0.991, 0.998]),
        ("sphere under a point", over_a_floor(sphere([24, 12]), point, false), [0.995, 0.998]),
    ] {
        let triangles = as_triangles(&scene);
        let mut bare = scene.clone();
        bare.meshes[0].triangles.clear();
        for (filter, least) in [(Filter::default(), least_horizon), (TRUTH, least_truth)] {
            let [lit, expected] = [&bare, &triangles].map(|scene| expected(scene, filter));
            let [found, of_polygons] =
                [true, false].map(|silhouette| draw(&scene, filter, silhouette));
            let [found, of_polygons] =
                [found, of_polygons].map(|frame| overlap(&lit, [&frame, &expected]));
            println!("{name}: {found:.4}, of polygons {of_polygons:.4}");
            assert!(found > least, "{name}, {filter:?}: {found}");
            assert!(of_polygons < 0.976, "{name} has an outline to speak of: {of_polygons}");
        }
    }
}

/// A sphere within its polygons, as wherever the relief is as deep.
#[test]
fn light_passes_between_the_polygons_and_the_relief() {
    let hollow = SurfaceMaps {
        height: Some(HeightImage::from_fn(4, 4, |_, _| 0.05)),
        relief_depth: 0.06,
        ..SurfaceMaps::default()
    };
    let scene = displaced::scene(sphere([96, 48]), hollow, 2.6);
    let mesh = &scene.meshes[0];
    let field = HeightField::new(scene.materials[0].surface.as_ref().expect("stones"));
    let shell = Shell::new(mesh, field.relief_depth);
    let outlined = Outlined::new(&scene.meshes, vec![Some((&shell, &field))]);
    let occluders = Occluders::new(&scene);
    let hides = |from: DVec3, direction: DVec3, outlined: Option<&Outlined>| {
        let direction = direction.normalize();
        let distance = f64::INFINITY;
        let ray = LightRay { from, direction, distance, reach: 1e-6, is_turned: false };
        occluders.hide(&ray, outlined)
    };
    // The world length of a repeat at the equator, an eighth of the way around.
    let radius = 1.0 - 0.95 * 0.06 * std::f64::consts::PI / 4.0;
    for i in 0..200 {
        let aside = 0.9 + f64::from(i) * 0.0005;
        for way in [DVec3::X, DVec3::NEG_X] {
            let from = DVec3::new(0.0, 0.013, aside) - way * 3.0;
            assert!(hides(from, way, None), "{aside} by polygons");
            let is_hidden = hides(from, way, outlined.as_ref());
            assert!(is_hidden == (aside < radius) || (aside - radius).abs() < 2e-3, "{aside}");
        }
    }
    // From between both it gets out, in whatever direction, and not into the relief.
    let from = DVec3::new(0.0, 0.013, 0.5 * (radius + 1.0));
    for (way, is_hidden) in [
        (DVec3::X, false),
        (DVec3::new(1.0, 0.0, 0.1), false),
        (DVec3::Z, false),
        (DVec3::new(1.0, 0.0, -0.4), true),
        (DVec3::NEG_Z, true),
    ] {
        assert!(hides(from, way, None), "{way} by polygons");
        assert_eq!(hides(from, way, outlined.as_ref()), is_hidden, "{way}");
    }
}
