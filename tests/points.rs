//! Points that shine: the relief's shadow and that of meshes, against the truth.

mod common;

use basrelief::texture::{HeightImage, Surface, SurfaceMaps};
use basrelief::{
    Filter, Frame, Light, Lighting, Material, Mesh, Rays, Scene, Settings, Sky, render,
};
use common::{cobbles, decibels, floor_scene};
use glam::Vec3;

const TRUTH: Filter = Filter::Truth(Rays { samples: 32 });

fn draw(scene: &Scene, filter: Filter) -> Frame {
    let settings = Settings {
        width: 72,
        height: 48,
        msaa: 1,
        filter,
        lighting: Lighting::Lit,
        ..Settings::default()
    };
    render(scene.clone(), settings).expect("a valid scene")
}

/// A floor under a point alone.
fn floor(maps: SurfaceMaps, position: Vec3) -> Scene {
    let mut scene = floor_scene(Surface::new(maps).expect("valid maps"), 0.5);
    let intensity = Vec3::splat(position.y * position.y * 4.0 + 2.0);
    scene.lights = vec![Light::Point { position, intensity }];
    scene.sky = Sky::Color(Vec3::splat(0.02));
    scene.background = [0.0; 4];
    scene
}

#[test]
fn relief_hides_points_as_in_the_truth() {
    for (height, least) in [(0.3, 33.0), (1.0, 35.0), (5.0, 35.0)] {
        let scene = floor(cobbles(128, 4), Vec3::new(0.3, height, 2.5));
        let found = decibels(&draw(&scene, Filter::default()), &draw(&scene, TRUTH), 1500.0);
        assert!(found > least, "{found} dB at a height of {height}");
    }
}

#[test]
fn relief_hides_points_from_what_it_reflects() {
    for (metallic, least) in [(0.0, 38.0), (1.0, 34.0)] {
        let mut scene = floor(cobbles(128, 4), Vec3::new(0.3, 1.0, 2.5));
        scene.materials[0] =
            Material { metallic, roughness: 0.5, specular: 1.0, ..scene.materials[0].clone() };
        let found = decibels(&draw(&scene, Filter::default()), &draw(&scene, TRUTH), 1500.0);
        assert!(found > least, "{found} dB, {metallic} of metal");
    }
}

#[test]
fn meshes_hide_points_from_flat_pieces() {
    let flat = SurfaceMaps { height: None, ..cobbles(128, 4) };
    // All of the error is at the edges, which go from white to black within a pixel.
    for (maps, least) in [(cobbles(128, 4), 23.0), (flat, 25.0)] {
        let mut scene = floor(maps, Vec3::new(0.3, 2.0, 1.5));
        let corners = [[-1.0, 2.5], [1.0, 2.5], [1.0, 1.0], [-1.0, 1.0]];
        let board = corners.map(|[x, z]| Vec3::new(x, 1.0, z)).to_vec();
        let mut mesh = Mesh::new(board, vec![], vec![], vec![[0, 1, 2], [0, 2, 3]]);
        mesh.material = 1;
        let open = draw(&scene, Filter::default());
        scene.meshes.push(mesh);
        scene.materials.push(Material { base_color: Vec3::ZERO, ..Material::default() });
        let drawn = draw(&scene, Filter::default());
        let found = decibels(&drawn, &draw(&scene, TRUTH), 1500.0);
        assert!(found > least, "{found} dB");
        assert!(decibels(&drawn, &open, 1500.0) < 15.0, "there is a shadow");
    }
}

#[test]
fn without_relief_it_is_lambert_in_closed_form() {
    let white = SurfaceMaps::default();
    let mut scene = floor(white, Vec3::new(0.0, 1.0, 2.0));
    scene.sky = Sky::default();
    let [drawn, truth] = [Filter::default(), TRUTH].map(|filter| draw(&scene, filter));
    assert!(decibels(&drawn, &truth, 1500.0) > 50.0, "{} dB", decibels(&drawn, &truth, 1500.0));
}

#[test]
fn suns_keep_their_shadows_beside_points() {
    let mut scene = floor(cobbles(128, 4), Vec3::new(0.3, 1.0, 2.5));
    scene.lights.insert(0, Light::sun(Vec3::new(-0.45, 0.577, -0.9), Vec3::ONE));
    let found = decibels(&draw(&scene, Filter::default()), &draw(&scene, TRUTH), 1500.0);
    assert!(found > 35.0, "{found} dB");
}

/// What lies wholly within a relief hides points from what is deeper.
#[test]
fn what_lies_in_a_relief_hides_points_from_it() {
    let pit = HeightImage::from_fn(16, 16, |_, _| 0.0);
    let maps = SurfaceMaps { height: Some(pit), relief_depth: 0.1, ..cobbles(16, 1) };
    let mut scene = floor(maps, Vec3::new(0.0, 2.0, 1.0));
    let open = draw(&scene, Filter::default());
    let corners = [[-0.5, 1.5], [0.5, 1.5], [0.5, 0.5], [-0.5, 0.5]];
    let board = corners.map(|[x, z]| Vec3::new(x, -0.05, z)).to_vec();
    let mut mesh = Mesh::new(board, vec![], vec![], vec![[0, 1, 2], [0, 2, 3]]);
    mesh.material = 1;
    scene.meshes.push(mesh);
    scene.materials.push(Material { base_color: Vec3::ZERO, ..Material::default() });
    let truth = draw(&scene, TRUTH);
    let found = decibels(&draw(&scene, Filter::default()), &truth, 1000.0);
    let lit = decibels(&open, &truth, 1000.0);
    println!("{found} dB, {lit} without the board");
    assert!(found > 25.0 && lit < 22.0, "{found} dB, {lit} without the board");
}
