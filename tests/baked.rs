//! What holds of lit frames whose light is baked: flat meshes under suns and a sky.

mod common;

use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps, srgb_from_linear};
use basrelief::{
    Environment, Filter, Frame, Light, Lighting, Material, Mesh, Rays, Region, Scene, Settings,
    Sky, render,
};
use common::{cobbles, floor_scene};
use glam::Vec3;

fn lit(filter: Filter) -> Settings {
    Settings {
        width: 64,
        height: 48,
        msaa: 1,
        filter,
        lighting: Lighting::Lit,
        ..Settings::default()
    }
}

fn floor(maps: SurfaceMaps, lights: &[Light], sky: Vec3) -> Scene {
    let scene = floor_scene(Surface::new(maps).expect("valid maps"), 0.5);
    Scene { lights: lights.to_vec(), sky: Sky::Color(sky), ..scene }
}

fn white() -> SurfaceMaps {
    SurfaceMaps { albedo: Some(ColorImage::from_fn(64, 64, |_, _| [1.0; 3])), ..cobbles(64, 4) }
}

fn draw(scene: &Scene, filter: Filter) -> Frame {
    render(scene.clone(), lit(filter)).expect("a valid scene")
}

/// Filters that draw lit surfaces as they draw others; the truth lights its samples.
fn baked_filters() -> impl Iterator<Item = Filter> {
    Filter::ALL.into_iter().filter(|filter| !matches!(filter, Filter::Truth(_)))
}

/// The colours of the pixels that show the floor.
fn seen(frame: &Frame) -> impl Iterator<Item = [f32; 3]> {
    frame.pixels.iter().filter(|pixel| pixel[3] == 1.0).map(|[r, g, b, _]| [*r, *g, *b])
}

/// How near two frames are where they show a surface, as they are encoded.
fn decibels(a: &Frame, b: &Frame) -> f32 {
    let squares = seen(a).zip(seen(b)).flat_map(|(a, b)| {
        [0, 1, 2].map(|c| (srgb_from_linear(a[c]) - srgb_from_linear(b[c])).powi(2))
    });
    let (sum, num) = squares.fold((0.0, 0.0), |(sum, num), square| (sum + square, num + 1.0));
    -10.0 * (sum / num as f32).log10()
}

fn sun(to_light: Vec3, intensity: Vec3) -> Light {
    Light::sun(to_light, intensity)
}

/// The light of a part of a large frame of bricks in a sun, over that of the truth.
fn share_of_light(to_sun: Vec3, region: Region) -> f32 {
    // Even tops, slopes of a tenth of their length, joints.
    let side = |i: u32, n: u32| {
        let to_joint = (i % n).min(n - 1 - i % n) as f32 / n as f32;
        ((to_joint - 0.03) * 10.0).clamp(0.0, 1.0)
    };
    let heights = HeightImage::from_fn(1024, 1024, |x, y| side(x, 128).min(side(y, 64)));
    let maps = SurfaceMaps { height: Some(heights), relief_depth: 0.06, ..SurfaceMaps::default() };
    let scene = floor(maps, &[sun(to_sun, Vec3::ONE)], Vec3::ZERO);
    let [drawn, truth] = [Filter::default(), Filter::Truth(Rays { samples: 64 })].map(|filter| {
        let settings = Settings { width: 1280, height: 720, region: Some(region), ..lit(filter) };
        let frame = render(scene.clone(), settings).expect("a valid scene");
        seen(&frame).map(|[r, g, b]| r + g + b).sum::<f32>()
    });
    drawn / truth
}

/// Just below the skyline of a large frame sweeps are longer than a thousand rows, and tables do not count
/// yet. Swept on level 1, which mixes what faces the sun with what faces the eye, it was too bright there.
#[test]
fn long_sweeps_are_as_bright_as_the_truth() {
    let region = Region { x: 600, y: 306, width: 48, height: 12 };
    let share = share_of_light(Vec3::new(-0.45, 0.577, -0.9), region);
    assert!((0.97..1.03).contains(&share), "{share}");
}

#[test]
fn without_relief_it_is_lambert_in_closed_form() {
    let to_light = Vec3::new(1.0, 2.0, 0.5);
    let (intensity, sky) = (Vec3::new(0.9, 0.6, 0.3), Vec3::new(0.05, 0.1, 0.2));
    let maps = SurfaceMaps { height: None, ..white() };
    let scene = floor(maps, &[sun(to_light, intensity)], sky);
    let expected = intensity * to_light.normalize().y + sky;
    for filter in baked_filters() {
        let frame = draw(&scene, filter);
        assert!(seen(&frame).count() > 1000);
        for color in seen(&frame) {
            let error = (Vec3::from(color) - expected).abs().max_element();
            assert!(error < 1e-3, "{filter:?}: {color:?}, by the formula {expected}");
        }
    }
}

#[test]
fn in_a_white_furnace_nothing_shines() {
    // Nothing is brighter than what shines on it. Deep places see less of the sky, but some.
    let scene = floor(white(), &[], Vec3::ONE);
    for filter in baked_filters() {
        let colors: Vec<_> = seen(&draw(&scene, filter)).flatten().collect();
        let [least, most] =
            [f32::min, f32::max].map(|of| colors.iter().copied().reduce(of).expect("a floor"));
        assert!(most < 1.005 && least > 0.05, "{filter:?}: {least} to {most}");
        let mean = colors.iter().sum::<f32>() / colors.len() as f32;
        assert!((0.6..0.99).contains(&mean), "{filter:?}: {mean}");
    }
}

#[test]
fn two_lights_add() {
    let lights = [
        sun(Vec3::new(1.0, 0.8, 0.5), Vec3::new(0.9, 0.7, 0.5)),
        sun(Vec3::new(-0.4, 0.3, 1.0), Vec3::new(0.1, 0.3, 0.6)),
    ];
    let maps = || cobbles(64, 4);
    for filter in baked_filters() {
        let [a, b, both] = [&lights[..1], &lights[1..], &lights]
            .map(|lights| draw(&floor(maps(), lights, Vec3::ZERO), filter));
        for ((a, b), both) in seen(&a).zip(seen(&b)).zip(seen(&both)) {
            for c in 0..3 {
                assert!((a[c] + b[c] - both[c]).abs() < 2e-3, "{filter:?}: {a:?} {b:?} {both:?}");
            }
        }
    }
}

#[test]
fn a_floor_seen_from_below_is_lit_from_below() {
    let up = sun(Vec3::new(0.3, 1.0, 0.2), Vec3::ONE);
    let mut scene = floor(white(), &[up], Vec3::ZERO);
    scene.camera.eye.y = -1.6;
    scene.camera.target.y = -0.6;
    let filter = Filter::default();
    assert!(
        seen(&draw(&scene, filter)).flatten().all(|c| c < 1e-3),
        "the sun is on the other side"
    );
    scene.lights = vec![sun(Vec3::new(0.3, -1.0, 0.2), Vec3::ONE)];
    let colors: Vec<_> = seen(&draw(&scene, filter)).flatten().collect();
    assert!(colors.iter().sum::<f32>() > 0.5 * colors.len() as f32);
}

#[test]
fn baked_light_is_the_truths() {
    let lights = [sun(Vec3::new(1.0, 0.6, 0.5), Vec3::splat(0.9))];
    for (lights, sky) in [(&lights[..], Vec3::ZERO), (&[], Vec3::splat(0.8))] {
        let scene = floor(cobbles(128, 4), lights, sky);
        let [baked, truth] = [Filter::default(), Filter::Truth(Rays { samples: 64 })]
            .map(|filter| draw(&scene, filter));
        let decibels = decibels(&baked, &truth);
        assert!(decibels > 40.0, "{decibels} dB under {} suns", lights.len());
    }
}

/// Tops and sides of stones shine apart, near by and at the skyline, in each other's shadow.
#[test]
fn highlights_are_the_truths() {
    let sun = sun(Vec3::new(-0.3, 0.5, -1.0), Vec3::splat(0.4));
    for (metallic, roughness, least) in [(1.0, 0.6, 36.5), (0.0, 0.45, 35.3)] {
        let mut scene = floor(cobbles(256, 6), std::slice::from_ref(&sun), Vec3::ZERO);
        let material = &mut scene.materials[0];
        (material.metallic, material.specular, material.roughness) = (metallic, 1.0, roughness);
        let [frame, truth] = [Filter::default(), Filter::Truth(Rays { samples: 256 })]
            .map(|filter| draw(&scene, filter));
        let found = decibels(&frame, &truth);
        let far = |frame: &Frame| seen(frame).take(6 * 64).flatten().sum::<f32>();
        let share = far(&frame) / far(&truth);
        println!("metal {metallic}: {found} dB, {share} of the truth's light at the skyline");
        assert!(found > least && (0.95..1.05).contains(&share), "{found} dB, {share}");
    }
}

/// What stones reflect does not get to their colour below, and at the skyline they reflect much of it: each as
/// its own side is turned, not as all of them are in the mean.
#[test]
fn the_diffuse_layer_is_as_bright_as_the_truths() {
    let sun = sun(Vec3::new(0.2, 0.6, 1.0), Vec3::ONE);
    let mut scene = floor(cobbles(256, 6), &[sun], Vec3::ZERO);
    (scene.materials[0].specular, scene.materials[0].roughness) = (1.0, 0.3);
    let [frame, truth] = [Filter::default(), Filter::Truth(Rays { samples: 256 })]
        .map(|filter| draw(&scene, filter));
    let far = |frame: &Frame| seen(frame).take(6 * 64).flatten().sum::<f32>();
    let share = far(&frame) / far(&truth);
    assert!((0.98..1.02).contains(&share), "{share} of the truth's light at the skyline");
    assert!(decibels(&frame, &truth) > 38.0, "{} dB", decibels(&frame, &truth));
}

/// Metal shows what each stone's side reflects, and nothing where that is another stone.
#[test]
fn skies_are_reflected_as_the_truth_says() {
    let (top, horizon) = (Vec3::new(0.3, 0.5, 0.9), Vec3::new(0.8, 0.8, 0.75));
    let gradient = Sky::Gradient { top, horizon, ground: Vec3::splat(0.1) };
    // Red on one side, blue on top.
    let texels = (0..32 * 16).map(|i| {
        let (x, y) = ((i % 32) as f32 / 16.0 - 1.0, (i / 32) as f32 / 16.0);
        Vec3::new(0.1 + 0.8 * x.abs(), 0.5, 0.9 - 0.8 * y)
    });
    let picture = Environment::new(32, 16, texels.collect::<Vec<_>>(), 0.0).unwrap();
    let skies = [Sky::Color(Vec3::splat(0.6)), gradient, Sky::Environment(picture)];
    for (sky, least) in skies.into_iter().zip([35.7, 36.5, 34.3]) {
        let mut scene = floor(cobbles(256, 6), &[], Vec3::ZERO);
        let material = &mut scene.materials[0];
        (material.metallic, material.roughness) = (1.0, 0.6);
        scene.sky = sky;
        let [frame, truth] = [Filter::default(), Filter::Truth(Rays { samples: 256 })]
            .map(|filter| draw(&scene, filter));
        let found = decibels(&frame, &truth);
        println!("{found} dB");
        assert!(found > least, "{found} dB under {:?}", scene.sky);
    }
}

/// Adds a plate over the floor, edge on to the eye, so that it hides little of the picture.
fn add_plate(scene: &mut Scene) {
    let corners = [[-1.5, 3.5], [1.5, 3.5], [1.5, 1.5], [-1.5, 1.5]];
    let plate = corners.map(|[x, z]| Vec3::new(x, 1.6, z)).to_vec();
    let faces = vec![[0, 1, 2], [0, 2, 3]];
    scene.materials.push(Material::default());
    scene.meshes.push(Mesh { material: 1, ..Mesh::new(plate, vec![], vec![], faces) });
}

#[test]
fn meshes_throw_the_truths_shadows_on_flat_pieces() {
    let lights = [
        sun(Vec3::new(0.3, 1.0, -0.4), Vec3::splat(0.6)),
        Light::Sun { to_light: Vec3::new(-0.5, 0.8, 0.0), intensity: Vec3::X, angular_size: 6.0 },
    ];
    let mut scene = floor(cobbles(128, 4), &lights, Vec3::ZERO);
    let lit = draw(&scene, Filter::default());
    add_plate(&mut scene);
    let shaded = draw(&scene, Filter::default());
    let truth = draw(&scene, Filter::Truth(Rays { samples: 64 }));
    assert!(decibels(&lit, &truth) < 25.0, "the plate shades a part of the picture");
    let found = decibels(&shaded, &truth);
    assert!(found > 33.0, "{found} dB");
}

#[test]
fn meshes_hide_the_truths_part_of_the_sky_from_flat_pieces() {
    let mut scene = floor(cobbles(128, 4), &[], Vec3::splat(0.8));
    let open = draw(&scene, Filter::default());
    add_plate(&mut scene);
    let shaded = draw(&scene, Filter::default());
    let truth = draw(&scene, Filter::Truth(Rays { samples: 64 }));
    let [without, found] = [&open, &shaded].map(|frame| decibels(frame, &truth));
    assert!(without < 28.0, "the plate hides a part of the sky: {without} dB without it");
    assert!(found > 36.0, "{found} dB");
}

/// A wall that rises from one texel to the next, many pixels high, and a sun before it that is low enough
/// for what stands opposite to shade its foot: the edge of that shadow runs along the wall.
#[test]
fn shadows_end_on_walls_of_one_texel() {
    let height = |x: u32, y: u32| match (x, y) {
        (_, 0..4) => 1.0,
        (0..8, 9..12) => 0.75,
        _ => 0.0,
    };
    let maps = SurfaceMaps {
        albedo: Some(ColorImage::from_fn(16, 16, |_, _| [0.8; 3])),
        height: Some(HeightImage::from_fn(16, 16, height)),
        relief_depth: 0.25,
        ..SurfaceMaps::default()
    };
    let scene = floor(maps, &[sun(Vec3::new(0.1, 0.7, 1.0), Vec3::ONE)], Vec3::splat(0.1));
    let truth = draw(&scene, Filter::Truth(Rays { samples: 256 }));
    let near = decibels(&draw(&scene, Filter::default()), &truth);
    assert!(near > 40.0, "{near} dB");
}

/// The same of many walls at the skyline, which tables show. By the light of texels alone they were a quarter too
/// dark, or a tenth too bright.
#[test]
fn shadows_end_on_walls_far_away() {
    for (period, top, relief_depth, height_of_sun) in
        [(16, 4, 0.06, 0.7), (8, 3, 0.04, 0.7), (16, 4, 0.06, 1.5)]
    {
        let maps = SurfaceMaps {
            albedo: Some(ColorImage::from_fn(512, 512, |_, _| [0.8; 3])),
            height: Some(HeightImage::from_fn(512, 512, |_, y| f32::from(y % period < top))),
            relief_depth,
            ..SurfaceMaps::default()
        };
        let sun = sun(Vec3::new(0.1, height_of_sun, 1.0), Vec3::ONE);
        let scene = floor(maps, &[sun], Vec3::splat(0.1));
        let [frame, truth] = [Filter::default(), Filter::Truth(Rays { samples: 256 })]
            .map(|filter| draw(&scene, filter));
        let far = |frame: &Frame| seen(frame).take(4 * 64).flatten().sum::<f32>();
        let share = far(&frame) / far(&truth);
        assert!((0.95..1.03).contains(&share), "{share} of the truth's light");
    }
}
