//! Textures of a material's metal, roughness, occlusion and emission.

mod common;

use basrelief::texture::{ColorImage, GrayImage, Surface, Texture, Wrap};
use basrelief::{
    Camera, Filter, Frame, Light, Lighting, Material, Rays, Scene, Settings, Sky, Tone, Trilinear,
    render,
};
use common::{cobbles, decibels, floor_scene};
use glam::Vec3;
use std::sync::Arc;

const TRUTH: Filter = Filter::Truth(Rays { samples: 48 });

fn draw(scene: &Scene, filter: Filter) -> Frame {
    let settings = Settings {
        width: 72,
        height: 48,
        msaa: 1,
        filter,
        lighting: Lighting::Lit,
        tone: Tone::Neutral,
        ..Settings::default()
    };
    render(scene.clone(), settings).expect("a valid scene")
}

/// A floor of stones under a sun and a sky.
fn floor() -> Scene {
    let surface = Surface::new(cobbles(64, 4)).expect("valid maps");
    let mut scene = floor_scene(surface, 0.5);
    scene.lights = vec![Light::sun(Vec3::new(-0.45, 0.577, -0.9), Vec3::ONE)];
    scene.sky = Sky::Color(Vec3::splat(0.3));
    scene.background = [0.0; 4];
    scene
}

/// A texture of stripes, a quarter of the surface's size, of two values.
fn stripes(values: [f32; 2]) -> Option<Arc<Texture>> {
    let image = GrayImage::from_fn(16, 4, |x, _| values[(x / 2 % 2) as usize]);
    Some(Arc::new(Texture::gray(image, Wrap::Repeat).expect("a valid image")))
}

#[test]
fn even_textures_are_plain_numbers() {
    let mut plain = floor();
    let dull = Vec3::new(0.1, 0.2, 0.05);
    let material = &mut plain.materials[0];
    (material.metallic, material.specular, material.roughness) = (0.5, 1.0, 0.75);
    material.emissive = dull;
    let mut mapped = plain.clone();
    let material = &mut mapped.materials[0];
    (material.metallic, material.roughness) = (1.0, 1.0);
    (material.maps.metallic, material.maps.roughness) = (stripes([0.5; 2]), stripes([0.75; 2]));
    let image = ColorImage::from_fn(3, 5, |_, _| [0.5; 3]);
    material.maps.emissive =
        Some(Arc::new(Texture::color(image, Wrap::Clamp).expect("a valid image")));
    material.emissive = dull * 2.0;
    let mut with_point = [plain.clone(), mapped.clone()];
    for scene in &mut with_point {
        let position = Vec3::new(1.0, 2.0, 2.0);
        scene.lights.push(Light::Point { position, intensity: Vec3::ONE });
    }
    let trilinear = Filter::Trilinear(Trilinear::default());
    for filter in [TRUTH, Filter::default(), trilinear] {
        for [plain, mapped] in [[&plain, &mapped], [&with_point[0], &with_point[1]]] {
            let found = decibels(&draw(plain, filter), &draw(mapped, filter), 1500.0);
            // Colours are packed in fifteen bits, with (1 - metal) or without; what the horizon's
            // highlights know of a texture of roughness, in the lengths of packed normals, which are
            // shorter between texels that lie differently.
            let least = if matches!(filter, Filter::Horizon(_)) { 48.0 } else { 75.0 };
            assert!(found > least, "{filter:?}: {found} dB");
        }
    }
}

#[test]
fn frames_are_near_the_truth() {
    for (least, metallic, roughness, occlusion) in [
        (35.0, stripes([0.0, 1.0]), None, None),
        (28.0, None, stripes([0.5, 1.0]), None),
        (22.0, stripes([0.0, 1.0]), stripes([1.0, 0.6]), stripes([1.0, 0.3])),
    ] {
        let mut scene = floor();
        let material = &mut scene.materials[0];
        (material.metallic, material.specular) = (f32::from(u8::from(metallic.is_some())), 1.0);
        material.maps.metallic = metallic;
        material.maps.roughness = roughness;
        material.maps.occlusion = occlusion;
        let found = decibels(&draw(&scene, Filter::default()), &draw(&scene, TRUTH), 1500.0);
        assert!(found > least, "{found} dB");
    }
}

#[test]
fn emission_is_filtered_as_colours_are() {
    let mut scene = floor();
    scene.lights.clear();
    scene.sky = Sky::default();
    scene.materials[0].emissive = Vec3::ONE;
    let colors = ColorImage::from_fn(64, 64, |x, y| [((x / 8 + y / 8) % 2) as f32; 3]);
    let unlit = {
        let maps =
            basrelief::texture::SurfaceMaps { albedo: Some(colors.clone()), ..cobbles(64, 4) };
        let surface = Arc::new(Surface::new(maps).expect("valid maps"));
        let material = Material { surface: Some(surface), ..Material::default() };
        let scene = Scene { materials: vec![material], ..scene.clone() };
        let settings =
            Settings { width: 72, height: 48, msaa: 1, tone: Tone::Neutral, ..Settings::default() };
        render(scene, settings).expect("a valid scene")
    };
    let texture = Texture::color(colors, Wrap::Repeat).expect("a valid image");
    scene.materials[0].maps.emissive = Some(Arc::new(texture));
    let lit = draw(&scene, Filter::default());
    assert!(decibels(&lit, &unlit, 1500.0) > 40.0, "{}", decibels(&lit, &unlit, 1500.0));
    let found = decibels(&lit, &draw(&scene, TRUTH), 1500.0);
    assert!(found > 32.0, "{found} dB");
}

#[test]
fn textures_need_a_surface() {
    let mut scene = Scene { camera: Camera::default(), ..floor() };
    scene.materials[0].maps.metallic = stripes([0.0, 1.0]);
    assert_eq!(scene.validate().ok(), Some(()));
    scene.materials[0].surface = None;
    assert!(scene.validate().is_err());
}
