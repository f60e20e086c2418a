//! Small scenes of any triangles, camera and settings: refused with a reason, or drawn with finite colours.
#![no_main]

use basrelief::invariants::frame_is_finite;
use basrelief::{Camera, Filter, Light, Lighting, Material, Mesh, Scene, Settings};
use basrelief_fuzz::{Input, Number, hold};
use glam::{Vec2, Vec3};
use std::sync::Arc;

type Corner = ([Number; 3], [Number; 2]);

libfuzzer_sys::fuzz_target!(|input: (Input, Vec<Corner>, [[Number; 3]; 2], u8)| {
    let (texture, mut corners, [eye, light], options) = input;
    corners.truncate(48);
    let vector = |v: [Number; 3]| Vec3::from(v.map(Number::get));
    let positions = corners.iter().map(|corner| vector(corner.0)).collect();
    let tex_coords = corners.iter().map(|corner| Vec2::from(corner.1.map(Number::get))).collect();
    let triangles = (0..corners.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let scene = Scene {
        meshes: vec![Mesh::new(positions, tex_coords, vec![], triangles)],
        materials: vec![Material { surface: Some(Arc::new(texture.surface())), ..Material::default() }],
        camera: Camera { eye: vector(eye), ..Camera::default() },
        lights: vec![Light::Point { position: vector(light), intensity: Vec3::ONE }],
        ..Scene::default()
    };
    let settings = texture.settings();
    let filter = [settings.filter, Filter::Parallax, Filter::Truth, Filter::Horizon][usize::from(options >> 4 & 3)];
    let lighting = if options & 1 == 0 { Lighting::Unlit } else { Lighting::Lit };
    let msaa = [1, 4, 8, 4][usize::from(options >> 1 & 3)];
    hold(frame_is_finite(scene, Settings { width: 24, height: 16, samples: 2, filter, lighting, msaa, ..settings }));
});
