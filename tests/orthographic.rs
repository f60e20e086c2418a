//! Cameras whose rays are all parallel: what they see is what a pinhole sees from far away through a
//! small opening, and what straight lines say.

mod common;

#[path = "common/displaced.rs"]
mod displaced;

use basrelief::geometry::project;
use basrelief::invariants::{layers_agree, outlines_hold};
use basrelief::raster::AttributePlanes;
use basrelief::simd::PixelLanes;
use basrelief::texture::{Surface, SurfaceMaps, Wrap};
use basrelief::{
    Camera, Filter, Frame, Layer, Layers, Light, Lighting, Material, Mesh, Rays, Renderer, Scene,
    Settings, Sky,
};
use common::{cobbles, decibels, floor_scene, rough_surface};
use displaced::{ball_in_stones, displaced, overlap, torus};
use glam::Vec3;

const SIZE: [u32; 2] = [96, 64];

fn settings(filter: Filter) -> Settings {
    Settings { width: SIZE[0], height: SIZE[1], filter, ..Settings::default() }
}

fn draw(scene: &Scene, settings: &Settings) -> Frame {
    Renderer::new(scene.clone(), settings.clone()).expect("a valid scene").render()
}

fn layers(scene: &Scene, asked: &[Layer]) -> Layers {
    let mut renderer = Renderer::new(scene.clone(), settings(Filter::Nearest)).expect("valid");
    renderer.render_layers(asked)
}

/// The scene through parallel rays.
fn orthographic(scene: Scene, height: f32) -> Scene {
    let camera = Camera { orthographic: Some(height), ..scene.camera };
    Scene { camera, ..scene }
}

/// How far away a pinhole is that sees what an orthographic camera does, in heights of the picture.
const AFAR: f32 = 500.0;

/// What an orthographic camera sees, by a pinhole far away; depths are `moved` more.
fn from_afar(scene: &Scene) -> (Scene, f32) {
    let camera = scene.camera;
    let height = camera.orthographic.expect("an orthographic camera");
    let [.., forward] = camera.axes();
    let moved = AFAR * height - camera.eye.distance(camera.target);
    let camera = Camera {
        eye: camera.eye - forward * moved,
        orthographic: None,
        fov_degrees: (0.5 / AFAR).atan().to_degrees() * 2.0,
        near: camera.near + moved,
        ..camera
    };
    (Scene { camera, ..scene.clone() }, moved)
}

/// A relief floor with a wall of another relief and a plain triangle, under a sun, a point and a sky.
fn lit_scene() -> Scene {
    let mut scene = ball_in_stones(cobbles(64, 2));
    scene.lights = vec![
        Light::sun(Vec3::new(0.5, 1.0, 0.3), Vec3::splat(0.8)),
        Light::Point { position: Vec3::new(-1.0, 1.0, 1.0), intensity: Vec3::new(1.5, 1.0, 0.5) },
    ];
    scene.sky = Sky::Color(Vec3::splat(0.1));
    scene.materials[0].roughness = 0.5;
    scene
}

fn stones_on_torus() -> Scene {
    displaced::scene(torus([48, 24]), cobbles(48, 2), 3.4)
}

/// The centre of pixel `(x, y)` is at `(x + 0.5, y + 0.5)`: a quad of half a pixel around it is seen
/// there alone, wherever it is along the view.
#[test]
fn a_quad_around_a_pixels_centre_is_that_pixel() {
    let height = 8.0;
    let unit = height / SIZE[1] as f32;
    let camera = Camera {
        eye: Vec3::new(5.0, 6.0, 7.0),
        target: Vec3::new(9.0, 6.0, 7.0),
        up: Vec3::Z,
        orthographic: Some(height),
        ..Camera::default()
    };
    for [x, y] in [[0, 0], [1, 0], [3, 2], [95, 63], [40, 17]] {
        for depth in [0.02, 2.0, 1e4] {
            let place = |[dx, dy]: [f32; 2]| {
                let [x, y] = [x as f32 + 0.5 + dx - 48.0, y as f32 + 0.5 + dy - 32.0];
                camera.eye + Vec3::new(depth, -x * unit, -y * unit)
            };
            let corners = [[-0.25, -0.25], [-0.25, 0.25], [0.25, 0.25], [0.25, -0.25]];
            let positions = corners.map(place).to_vec();
            let scene = Scene {
                meshes: vec![Mesh::new(positions, vec![], vec![], vec![[0, 1, 2], [0, 2, 3]])],
                materials: vec![Material::default()],
                camera,
                ..Scene::default()
            };
            let found = layers(&scene, &[Layer::Object, Layer::Position, Layer::Depth]);
            let objects = found.ids(Layer::Object);
            let seen: Vec<usize> = (0..objects.len()).filter(|&i| objects[i] == 0).collect();
            let pixel = (y * SIZE[0] + x) as usize;
            assert_eq!(seen, [pixel], "{x}, {y}");
            let at = Vec3::from_slice(&found.floats(Layer::Position)[3 * pixel..]);
            let expected = place([0.0; 2]);
            assert!(at.abs_diff_eq(expected, 1e-5 + depth * 1e-6), "{at} is not {expected}");
            let distance = found.floats(Layer::Depth)[pixel];
            assert!((distance - depth).abs() <= depth * 1e-5, "{distance}, not {depth}");
        }
    }
}

/// Depth, place and texture coordinates of a flat floor are those of straight lines; so are the
/// derivatives, which are the same everywhere.
#[test]
fn a_floor_is_where_straight_lines_meet_it() {
    let scene = orthographic(floor_scene(rough_surface(24, 16, Wrap::Repeat, 7), 0.5), 3.0);
    let flat = Settings { parallax: false, ..settings(Filter::Nearest) };
    let mut renderer = Renderer::new(scene.clone(), flat.clone()).expect("valid");
    let found = renderer.render_layers(&Layer::ALL);
    let [right, up, forward] = scene.camera.axes();
    let unit = 3.0 / SIZE[1] as f32;
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            let [across, above] =
                [x as f32 + 0.5 - 48.0, 32.0 - (y as f32 + 0.5)].map(|c| c * unit);
            let from = scene.camera.eye + right * across + up * above;
            let depth = -from.y / forward.y;
            let place = from + forward * depth;
            let at = (y * SIZE[0] + x) as usize;
            let found = |layer: Layer, i: usize| found.floats(layer)[layer.num_channels() * at + i];
            assert!((found(Layer::Depth, 0) - depth).abs() < 2e-5 * depth, "{x}, {y}");
            for (i, expected) in place.to_array().into_iter().enumerate() {
                assert!((found(Layer::Position, i) - expected).abs() < 1e-4, "{x}, {y}");
            }
            for (i, expected) in [place.x * 0.5, -place.z * 0.5].into_iter().enumerate() {
                assert!((found(Layer::Uv, i) - expected).abs() < 1e-4, "{x}, {y}");
            }
        }
    }
    let geometry = project(&scene, &flat);
    let triangle = geometry.triangles().next().expect("a triangle");
    let planes = AttributePlanes::new(&geometry, triangle, &scene, &flat);
    assert_eq!(planes.inverse_w, [0.0, 0.0, 1.0]);
    let at = |x: f32, y: f32| {
        let (uv, view) = planes.at(PixelLanes::splat(x), PixelLanes::splat(y));
        (uv.map(|c| c.as_array()[0]), view.map(|c| c.as_array()[0]))
    };
    let ((start, view), (end, other)) = (at(0.5, 0.5), at(90.5, 60.5));
    // A pixel to the right is a pixel along x, and a pixel down so much along the floor.
    let down = unit / -forward.y;
    let expected = [90.0 * unit * 0.5, -60.0 * down * 0.5];
    assert!((0..2).all(|i| (end[i] - start[i] - expected[i]).abs() < 1e-4), "{start:?} {end:?}");
    assert!((0..3).all(|i| (view[i] - other[i]).abs() < 1e-6), "rays are parallel");
}

/// Every filter, with and without light: what a pinhole draws from far away.
#[test]
fn frames_are_those_of_a_pinhole_far_away() {
    let scene = orthographic(lit_scene(), 2.0);
    let (afar, _) = from_afar(&scene);
    for filter in Filter::ALL {
        let filter = if let Filter::Truth(_) = filter {
            Filter::Truth(Rays { samples: 16 })
        } else {
            filter
        };
        for lighting in [Lighting::Unlit, Lighting::Lit] {
            let settings = Settings { lighting, ..settings(filter) };
            let [near, far] = [&scene, &afar].map(|scene| draw(scene, &settings));
            let found = decibels(&near, &far, 10_000.0);
            println!("{filter:?} {lighting:?}: {found:.1} dB");
            // One texel or another, and rays to lights, are a matter of rounding.
            let least = match (filter, lighting) {
                (Filter::Nearest, _) | (Filter::Truth(_), Lighting::Lit) => 40.0,
                _ => 50.0,
            };
            assert!(found > least, "{filter:?} {lighting:?}: {found} dB");
        }
    }
}

/// Outlines of curved reliefs, and the depth of what is seen there.
#[test]
fn outlines_are_those_of_a_pinhole_far_away() {
    let scene = orthographic(stones_on_torus(), 3.4);
    let (afar, moved) = from_afar(&scene);
    let both = [&scene, &afar].map(|scene| draw(scene, &settings(Filter::default())));
    let (found, covered) = (decibels(&both[0], &both[1], 2000.0), overlap(&both[0], &both[1]));
    println!("{found:.1} dB, overlap {covered:.4}");
    assert!(found > 40.0 && covered > 0.995, "{found} dB, overlap {covered}");
    let [near, far] = [&scene, &afar].map(|scene| {
        let found = layers(scene, &[Layer::Depth, Layer::Object]);
        found.floats(Layer::Depth).to_vec()
    });
    let both: Vec<_> =
        near.iter().zip(&far).filter(|(a, b)| a.is_finite() && b.is_finite()).collect();
    let num_near = both.iter().filter(|(a, b)| (**a - (**b - moved)).abs() < 4e-3).count();
    assert!(both.len() > 1500 && num_near as f64 > 0.98 * both.len() as f64, "{num_near}");
}

/// And the same as real geometry has.
#[test]
fn outlines_are_those_of_displaced_triangles() {
    let scene = orthographic(stones_on_torus(), 3.4);
    let shown = displaced::show(&displaced(&scene, 16), &settings(Filter::Nearest));
    let frame = draw(&scene, &settings(Filter::Truth(Rays { samples: 64 })));
    let covered = overlap(&frame, &shown.coverage);
    let found = displaced::decibels(&frame, &shown.colors);
    println!("overlap {covered:.4}, {found:.1} dB");
    assert!(covered > 0.997 && found > 45.0, "overlap {covered}, {found} dB");
}

/// How far away the eye is says nothing: what it sees stays where it is.
#[test]
fn the_eyes_distance_changes_nothing() {
    for scene in [orthographic(lit_scene(), 2.0), orthographic(stones_on_torus(), 3.4)] {
        let [.., forward] = scene.camera.axes();
        let eye = scene.camera.eye - forward * 8.0;
        let moved = Scene { camera: Camera { eye, ..scene.camera }, ..scene.clone() };
        let settings = Settings { lighting: Lighting::Lit, ..settings(Filter::default()) };
        let [here, there] = [&scene, &moved].map(|scene| draw(scene, &settings));
        let found = decibels(&here, &there, 1500.0);
        assert!(found > 55.0, "{found} dB");
    }
}

#[test]
fn nothing_is_seen_before_the_near_plane() {
    let scene = orthographic(floor_scene(rough_surface(8, 8, Wrap::Repeat, 1), 0.5), 3.0);
    let near = 7.0;
    let scene = Scene { camera: Camera { near, ..scene.camera }, ..scene };
    let depth = layers(&scene, &[Layer::PolygonDepth]).floats(Layer::PolygonDepth).to_vec();
    let seen: Vec<_> = depth.into_iter().filter(|depth| depth.is_finite()).collect();
    let least = seen.iter().fold(f32::MAX, |least, depth| least.min(*depth));
    assert!(seen.len() > 500 && seen.len() < 5500, "{} pixels", seen.len());
    assert!((least - near).abs() < 0.3 && least > near - 0.01, "{least}");
}

#[test]
fn layers_and_outlines_agree() {
    let surface = |relief_depth: f32| {
        let maps = SurfaceMaps { relief_depth, ..cobbles(48, 2) };
        Surface::new(maps).expect("valid maps")
    };
    let floor = floor_scene(surface(0.2), 0.5);
    for scene in [orthographic(floor, 3.0), orthographic(stones_on_torus(), 3.4)] {
        layers_agree(scene.clone(), settings(Filter::Nearest)).expect("agree");
        let settings = Settings { width: 48, height: 32, ..settings(Filter::Nearest) };
        outlines_hold(scene, settings).expect("hold");
    }
}

#[test]
fn heights_that_are_none_are_refused() {
    let camera = Camera::default();
    for height in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e10] {
        assert!(Camera { orthographic: Some(height), ..camera }.validate().is_err(), "{height}");
    }
    let both =
        Camera { orthographic: Some(1.0), intrinsics: Some(camera.on_frame(9, 9)), ..camera };
    assert!(both.validate().is_err());
}
