//! The truth's light: what hides it, and what must come of it where the answer is known.

mod common;

use basrelief::invariants::{lights_add, no_more_than_the_sky};
use basrelief::relief::{Climb, HeightField, march};
use basrelief::simd::PixelLanes;
use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps, Wrap};
use basrelief::{
    Camera, Filter, Frame, Light, Lighting, Material, Mesh, Rays, Renderer, Scene, Settings, Sky,
};
use common::{Random, cobbles, flat_surface, floor_scene, rough_surface};
use glam::{Vec2, Vec3};
use std::sync::Arc;

fn settings(samples: u32) -> Settings {
    let filter = Filter::Truth(Rays { samples });
    Settings {
        width: 48,
        height: 32,
        msaa: 1,
        filter,
        lighting: Lighting::Lit,
        ..Settings::default()
    }
}

fn draw(scene: &Scene, settings: &Settings) -> Frame {
    Renderer::new(scene.clone(), settings.clone()).expect("a valid scene").render()
}

/// A square of 2 x 2 around the origin, seen from straight above so that it fills a square picture;
/// +x is right and -z is up.
fn table(material: Material) -> Scene {
    let corners = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
    let positions = corners.map(|(x, z)| Vec3::new(x, 0.0, z)).to_vec();
    let tex_coords = corners.map(|(x, z)| Vec2::new(x + 1.0, 1.0 - z) * 0.5).to_vec();
    Scene {
        meshes: vec![Mesh::new(positions, tex_coords, vec![], vec![[0, 1, 2], [0, 2, 3]])],
        materials: vec![material],
        camera: Camera {
            eye: Vec3::new(0.0, 10.0, 0.0),
            target: Vec3::ZERO,
            up: Vec3::NEG_Z,
            // 2 atan(1 / 10), so that the square fills the picture.
            fov_degrees: 11.421_186,
            near: 0.1,
            ..Camera::default()
        },
        ..Scene::default()
    }
}

fn square(samples: u32) -> Settings {
    Settings { width: 32, height: 32, ..settings(samples) }
}

fn pixel(frame: &Frame, x: usize, y: usize) -> [f32; 3] {
    let [r, g, b, _] = frame.pixels[y * frame.width as usize + x];
    [r, g, b]
}

fn matt(surface: Option<Surface>) -> Material {
    Material { surface: surface.map(Arc::new), ..Material::default() }
}

#[test]
fn white_under_a_white_sky_is_white() {
    let mut scene = table(matt(None));
    scene.sky = Sky::Color(Vec3::new(0.25, 1.0, 4.0));
    for roughness in [0.0, 0.3, 1.0] {
        scene.materials[0].specular = 1.0;
        scene.materials[0].roughness = roughness;
        let frame = draw(&scene, &square(8));
        for (c, expected) in [0.25, 1.0, 4.0].into_iter().enumerate() {
            let found = pixel(&frame, 9, 20)[c];
            assert!((found / expected - 1.0).abs() < 1e-5, "{roughness}: {found} for {expected}");
        }
    }
}

#[test]
fn no_surface_sends_out_more_than_it_gets() {
    let surfaces = [
        Surface::new(cobbles(64, 4)).expect("valid maps"),
        rough_surface(16, 12, Wrap::Mirror, 3),
        rough_surface(16, 12, Wrap::Clamp, 4),
        flat_surface(8, 8, Wrap::Repeat, 5),
    ];
    for surface in surfaces {
        for (metallic, roughness) in [(0.0, 1.0), (0.0, 0.2), (0.5, 0.5), (1.0, 0.0)] {
            let mut scene = floor_scene(surface.clone(), 0.5);
            (scene.materials[0].metallic, scene.materials[0].roughness) = (metallic, roughness);
            scene.materials[0].specular = 1.0;
            no_more_than_the_sky(scene, &settings(4), 4).expect("no more than the sky");
        }
    }
}

#[test]
fn lights_are_added() {
    let mut scene = floor_scene(Surface::new(cobbles(64, 4)).expect("valid maps"), 0.5);
    scene.materials[0].specular = 1.0;
    scene.materials[0].roughness = 0.3;
    scene.materials[0].emissive = Vec3::new(0.1, 0.0, 0.0);
    scene.sky = Sky::Gradient { top: Vec3::Z, horizon: Vec3::ONE, ground: Vec3::X };
    scene.lights = vec![
        Light::sun(Vec3::new(0.3, 0.5, 0.2), Vec3::ONE),
        Light::Point { position: Vec3::new(0.0, 1.0, 2.0), intensity: Vec3::ONE },
        Light::Sun { to_light: Vec3::Y, intensity: Vec3::ONE, angular_size: 20.0 },
    ];
    lights_add(scene, &settings(4), 4).expect("a sum");
}

/// Lambert and GGX under a point of light, where nothing hides it: by the truth the share that the
/// diffuse layer keeps is a mean over samples, else it is looked up.
#[test]
fn without_relief_the_truth_is_the_closed_form() {
    for (metallic, roughness) in [(0.0, 1.0), (0.0, 0.5), (1.0, 0.4)] {
        let base_color = Vec3::new(0.8, 0.5, 0.3);
        let mut scene =
            table(Material { base_color, metallic, specular: 1.0, roughness, ..matt(None) });
        scene.lights = vec![
            Light::Sun {
                to_light: Vec3::new(0.1, 1.0, 0.1),
                intensity: Vec3::ONE,
                angular_size: 0.0,
            },
            Light::Point { position: Vec3::new(-0.5, 2.0, 0.3), intensity: Vec3::splat(2.0) },
        ];
        let truth = draw(&scene, &square(256));
        let other = draw(&scene, &Settings { filter: Filter::Nearest, ..square(1) });
        for place in [[4, 6], [16, 16], [28, 10]] {
            let [found, expected] = [&other, &truth].map(|frame| pixel(frame, place[0], place[1]));
            for c in 0..3 {
                let error = (found[c] / expected[c] - 1.0).abs();
                assert!(error < 0.005, "{metallic} {roughness} {place:?}: {found:?} {expected:?}");
            }
        }
    }
}

/// Directions keep their angles in the frame of a texture whose u and v are all but parallel: once
/// facets with such coordinates shone white where they should have been dark.
#[test]
fn oblique_texture_coordinates_change_no_light() {
    let brown = Some(ColorImage::from_fn(64, 64, |_, _| [0.2, 0.1, 0.05]));
    let brown = Surface::new(SurfaceMaps { albedo: brown, ..SurfaceMaps::default() });
    let metal = matt(Some(brown.expect("valid maps")));
    let metal = Material { specular: 1.0, metallic: 1.0, roughness: 0.5, ..metal };
    let mut scene = table(metal);
    scene.sky = Sky::Gradient { top: Vec3::Z, horizon: Vec3::ONE, ground: Vec3::X };
    scene.lights = vec![
        Light::sun(Vec3::new(1.0, 0.7, 0.4), Vec3::ONE),
        Light::Point { position: Vec3::new(-0.5, 2.0, 0.3), intensity: Vec3::ONE },
    ];
    let mut sheared = scene.clone();
    let Mesh { positions, tex_coords, triangles, .. } = scene.meshes[0].clone();
    let tex_coords = tex_coords.into_iter().map(|uv| Vec2::new(uv.x + 4.0 * uv.y, uv.y)).collect();
    sheared.meshes[0] = Mesh::new(positions, tex_coords, vec![], triangles);
    for filter in [Filter::default(), Filter::Nearest, Filter::Truth(Rays { samples: 4 })] {
        let settings = Settings { filter, ..square(1) };
        let [straight, sheared] = [&scene, &sheared].map(|scene| draw(scene, &settings));
        for (a, b) in straight.pixels.iter().flatten().zip(sheared.pixels.iter().flatten()) {
            assert!((a - b).abs() < 0.01 * a.max(0.1), "{a} {b} by {filter:?}");
        }
    }
}

/// A wall a quarter of the texture high and wide, lit from its left: its shadow is as long as it is
/// high times the light's slope.
#[test]
fn relief_casts_its_shadow() {
    let heights =
        HeightImage::from_fn(256, 4, |x, _| if (64..96).contains(&x) { 1.0 } else { 0.0 });
    let maps = SurfaceMaps {
        height: Some(heights),
        relief_depth: 0.125,
        keep_normals: false,
        ..SurfaceMaps::default()
    };
    let mut scene = table(matt(Some(Surface::new(maps).expect("valid maps"))));
    // The table is two units wide, one repeat: the ridge is 0.25 high, its shadow 0.5 long.
    let to_light = Vec3::new(-2.0, 1.0, 0.0);
    scene.lights = vec![Light::Sun { to_light, intensity: Vec3::ONE, angular_size: 0.0 }];
    let frame = draw(&scene, &square(64));
    let lit = |x: usize| pixel(&frame, x, 16)[0];
    // Columns of 1/32 of a repeat: the ridge ends at 12, its shadow at 12 + 8.
    let full = lit(2);
    assert!(full > 0.3 && (lit(10) / full - 1.0).abs() < 0.02, "ground and top are lit: {full}");
    (13..19).for_each(|x| assert!(lit(x) < 1e-6, "column {x}: {}", lit(x)));
    (22..30).for_each(|x| assert!((lit(x) / full - 1.0).abs() < 0.02, "column {x}: {}", lit(x)));
}

/// A level square hides the sun behind it.
#[test]
fn meshes_cast_shadows_with_the_suns_penumbra() {
    let mut scene = table(matt(None));
    let corners = [(-0.5, 0.5), (0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)];
    // Beside the camera's view: the sun comes in flat.
    let positions = corners.map(|(x, z)| Vec3::new(x - 3.0, 3.0, z)).to_vec();
    scene.meshes.push(Mesh::new(positions, vec![], vec![], vec![[0, 1, 2], [0, 2, 3]]));
    let light = |angular_size| Light::Sun {
        to_light: Vec3::new(-1.0, 1.0, 0.0),
        intensity: Vec3::ONE,
        angular_size,
    };
    scene.lights = vec![light(0.0)];
    let frame = draw(&scene, &square(64));
    let full = pixel(&frame, 2, 16)[0];
    for (x, is_lit) in [(2, true), (6, true), (10, false), (16, false), (22, false), (26, true)] {
        let found = pixel(&frame, x, 16)[0];
        assert!((found - if is_lit { full } else { 0.0 }).abs() < 0.01, "column {x}: {found}");
    }
    // A wide sun: at the edge half of its disc is hidden.
    scene.lights = vec![light(4.0)];
    let frame = draw(&scene, &square(64));
    let edge = (pixel(&frame, 7, 16)[0] + pixel(&frame, 8, 16)[0]) / 2.0;
    assert!((edge / full - 0.5).abs() < 0.05, "{edge} of {full}");
    assert!(pixel(&frame, 10, 16)[0] > 0.02 * full, "light from the sun's upper rim");
}

/// The bottom of a slit sees as much of the sky as its opening is wide: nothing comes back from its
/// walls.
#[test]
fn the_sky_is_hidden_by_relief() {
    let heights = HeightImage::from_fn(64, 4, |x, _| if (16..48).contains(&x) { 0.0 } else { 1.0 });
    let maps = SurfaceMaps {
        height: Some(heights),
        relief_depth: 0.5,
        keep_normals: false,
        wrap: Wrap::Repeat,
        ..SurfaceMaps::default()
    };
    let mut scene = table(matt(Some(Surface::new(maps).expect("valid maps"))));
    scene.sky = Sky::Color(Vec3::ONE);
    let frame = draw(&scene, &square(256));
    // Half a repeat wide and deep: the middle sees sin(atan(1/2)) = 0.447 of a sky weighed by the
    // cosine, a long slit's form factor. Walls of one texel are a 64th of the repeat wide.
    let found = pixel(&frame, 16, 16)[0];
    assert!((found - 0.447).abs() < 0.03, "{found}");
    assert!((pixel(&frame, 2, 16)[0] - 1.0).abs() < 1e-3, "the top sees all of it");
}

/// Four times the samples halve the noise at least, as samples by chance would.
#[test]
fn more_samples_are_nearer_to_the_truth() {
    let mut scene = floor_scene(Surface::new(cobbles(64, 4)).expect("valid maps"), 0.5);
    scene.sky = Sky::Color(Vec3::splat(0.4));
    scene.lights = vec![Light::sun(Vec3::new(0.3, 0.5, 0.2), Vec3::ONE)];
    let size = |samples| Settings { width: 24, height: 16, ..settings(samples) };
    let [few, more, many] = [16, 64, 1024].map(|samples| draw(&scene, &size(samples)));
    let error = |frame: &Frame| {
        let pairs = frame.pixels.iter().flatten().zip(many.pixels.iter().flatten());
        pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f32>().sqrt()
    };
    assert!(error(&more) * 2.0 < error(&few), "{} {}", error(&more), error(&few));
}

/// Light reaches a place of the relief exactly if it is the first that a ray from the light meets.
#[test]
fn climbing_rays_and_marching_rays_agree() {
    let mut random = Random(7);
    let (mut nums, mut num_different) = ([0; 2], 0);
    for wrap in [Wrap::Repeat, Wrap::Clamp] {
        let field = HeightField::new(&rough_surface(24, 16, wrap, 11));
        let depth = field.relief_depth;
        for _ in 0..4000 {
            let place = [0; 2].map(|_| random.within(0.1, 0.9));
            let slope = [0; 2].map(|_| random.within(-1.0, 1.0));
            let direction = [f64::from(slope[0]), f64::from(slope[1]), 0.5];
            let climb = Climb::new(&field, place, direction).expect("it goes up");
            // From the light it comes down the other way.
            let displacement = slope.map(|s| -s * 2.0 * depth);
            let down = climb.depth() as f32;
            let base = [0, 1].map(|i| place[i] - displacement[i] * down);
            let [base, displacement] = [base, displacement].map(|pair| pair.map(PixelLanes::splat));
            let found = march(&field, &base, &displacement).to_array()[0];
            let is_free = climb.is_free(&field, f64::INFINITY);
            // What hides a place may begin right there: the ray starts inwards.
            let is_first = (found - down).abs() < 1e-3 && (is_free || climb.is_free(&field, 5e-3));
            num_different += u32::from(is_first != is_free);
            nums[usize::from(is_free)] += 1;
        }
    }
    assert!(nums.iter().all(|num| *num > 400), "{nums:?}");
    // Rays that only touch the relief may hit it in an f32 or not: two of 8000 do.
    assert!(num_different < 5, "{num_different}");
}
