//! Coverage: every sample of a mesh of shared edges belongs to exactly one triangle.
//!
//! Scenes are given in pixels: a corner `[x, y, w]` lands on the screen at (x, y), w in front of
//! the eye. Pictures show how many triangles hit each pixel: '.' none, '1' one, '2' two.

use basrelief::geometry::{Geometry, ScreenTriangle, project};
use basrelief::raster::{QuadPair, RasterStats, draw, hit_counts};
use basrelief::simd::PixelLanes;
use basrelief::{Camera, Frame, Material, Mesh, Scene, Settings};
use glam::{Vec2, Vec3};
use proptest::prelude::*;

type Corner = [f64; 3];

fn settings(width: u32, height: u32) -> Settings {
    Settings { width, height, msaa: 1, ..Settings::default() }
}

/// A field of view of 90 degrees: one pixel is `2 w / height` world units.
fn world([x, y, w]: Corner, settings: &Settings) -> Vec3 {
    let focal = f64::from(settings.height) * 0.5;
    let (cx, cy) = (f64::from(settings.width) * 0.5, f64::from(settings.height) * 0.5);
    Vec3::new(((x - cx) * w / focal) as f32, (-(y - cy) * w / focal) as f32, -w as f32)
}

fn scene_of(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Scene {
    let tex_coords = positions
        .iter()
        .map(|p| Vec2::new(p.x, p.y).clamp(Vec2::splat(-1e5), Vec2::splat(1e5)))
        .collect();
    Scene {
        meshes: vec![Mesh::new(positions, tex_coords, vec![], triangles)],
        materials: vec![Material::default()],
        camera: Camera {
            eye: Vec3::ZERO,
            target: -Vec3::Z,
            up: Vec3::Y,
            fov_degrees: 90.0,
            ..Camera::default()
        },
        ..Scene::default()
    }
}

fn scene(corners: &[Corner], triangles: &[[u32; 3]], settings: &Settings) -> Scene {
    scene_of(corners.iter().map(|&c| world(c, settings)).collect(), triangles.to_vec())
}

fn counts(corners: &[Corner], triangles: &[[u32; 3]], settings: &Settings) -> Vec<u8> {
    hit_counts(&project(&scene(corners, triangles, settings), settings), settings)
}

fn picture(counts: &[u8], width: u32) -> Vec<String> {
    let letter = |&count: &u8| {
        if count == 0 { '.' } else { char::from(b'0' + count.min(9)) }
    };
    counts.chunks(width as usize).map(|row| row.iter().map(letter).collect()).collect()
}

#[track_caller]
fn assert_picture(corners: &[Corner], triangles: &[[u32; 3]], expected: &[&str]) {
    let settings = settings(expected[0].len() as u32, expected.len() as u32);
    assert_eq!(picture(&counts(corners, triangles, &settings), settings.width), expected);
}

/// Counts are one on every pixel whose centre is safely inside, at most one elsewhere.
#[track_caller]
fn assert_once(counts: &[u8], width: u32, is_inside: impl Fn(f64, f64) -> bool, what: &str) {
    for (i, &count) in counts.iter().enumerate() {
        let (x, y) = ((i as u32 % width) as f64 + 0.5, (i as u32 / width) as f64 + 0.5);
        assert!(count <= 1, "{what}: pixel ({x}, {y}) is hit {count} times");
        assert!(count == 1 || !is_inside(x, y), "{what}: pixel ({x}, {y}) is a hole");
    }
}

#[test]
fn a_triangle_takes_the_centres_inside() {
    assert_picture(
        &[[1.0, 1.0, 1.0], [1.0, 7.0, 1.0], [7.0, 1.0, 1.0]],
        &[[0, 1, 2]],
        &[
            "........", ".11111..", ".1111...", ".111....", ".11.....", ".1......", "........",
            "........",
        ],
    );
}

#[test]
fn top_and_left_edges_through_centres_count() {
    assert_picture(
        &[[1.5, 1.5, 1.0], [1.5, 5.5, 1.0], [5.5, 5.5, 1.0], [5.5, 1.5, 1.0]],
        &[[0, 1, 2], [0, 2, 3]],
        &[
            "........", ".1111...", ".1111...", ".1111...", ".1111...", "........", "........",
            "........",
        ],
    );
}

#[test]
fn overlapping_triangles_both_count() {
    assert_picture(
        &[[0.0, 0.0, 1.0], [0.0, 4.0, 1.0], [4.0, 0.0, 1.0], [4.0, 4.0, 1.0]],
        &[[0, 1, 2], [0, 1, 3]],
        &[
            "111.....", "21......", "21......", "111.....", "........", "........", "........",
            "........",
        ],
    );
}

#[test]
fn what_misses_every_centre_is_dropped() {
    let settings = settings(8, 8);
    let corners = [[2.6, 2.6, 1.0], [2.6, 3.4, 1.0], [3.4, 2.6, 1.0]];
    assert_eq!(project(&scene(&corners, &[[0, 1, 2]], &settings), &settings).num_triangles(), 0);
    let corners = [[2.6, 2.6, 1.0], [2.6, 3.4, 1.0], [2.7, 3.0, 1.0], [3.6, 3.6, 1.0]];
    assert_eq!(
        project(&scene(&corners, &[[0, 1, 2], [0, 3, 1]], &settings), &settings).num_triangles(),
        1
    );
}

/// A fan of `num` triangles around a centre.
fn fan(center: [f64; 2], radius: f64, num: u32, degrees: f64) -> (Vec<Corner>, Vec<[u32; 3]>) {
    let mut corners = vec![[center[0], center[1], 1.0]];
    corners.extend((0..num).map(|i| {
        let angle = degrees.to_radians() + f64::from(i) / f64::from(num) * std::f64::consts::TAU;
        [center[0] + radius * angle.cos(), center[1] + radius * angle.sin(), 1.0]
    }));
    (corners, (0..num).map(|i| [0, 1 + i, 1 + (i + 1) % num]).collect())
}

#[test]
fn fans_at_every_rotation_hit_once() {
    let settings = settings(37, 29);
    for degree in 0..360 {
        let (corners, triangles) = fan([18.5, 14.5], 12.0, 7, f64::from(degree));
        let inner = 12.0 * (std::f64::consts::PI / 7.0).cos() - 0.01;
        let counts = counts(&corners, &triangles, &settings);
        assert_once(
            &counts,
            37,
            |x, y| (x - 18.5).hypot(y - 14.5) < inner,
            &format!("{degree} degrees"),
        );
    }
}

#[test]
fn grids_at_every_rotation_hit_once() {
    let settings = settings(33, 31);
    for degree in 0..360 {
        let (sin, cos) = f64::from(degree).to_radians().sin_cos();
        // Cells of 2.5 by 1.5 pixels, 13 by 17 of them.
        let corner = |i: u32| {
            let (x, y) = ((f64::from(i % 14) - 6.5) * 2.5, (f64::from(i / 14) - 8.5) * 1.5);
            [16.5 + x * cos - y * sin, 15.5 + x * sin + y * cos, 1.0]
        };
        let corners: Vec<_> = (0..14 * 18).map(corner).collect();
        let cells = (0..17 * 14).filter(|i| i % 14 != 13);
        let triangles: Vec<_> =
            cells.flat_map(|i| [[i, i + 14, i + 1], [i + 1, i + 14, i + 15]]).collect();
        let inside = |x: f64, y: f64| {
            let (x, y) = (x - 16.5, y - 15.5);
            (x * cos + y * sin).abs() < 16.24 && (y * cos - x * sin).abs() < 12.74
        };
        assert_once(
            &counts(&corners, &triangles, &settings),
            33,
            inside,
            &format!("{degree} degrees"),
        );
    }
}

#[test]
fn extreme_sizes_hit_once() {
    let settings = settings(24, 24);
    for exponent in -6..=6 {
        for degree in (0..360).step_by(15) {
            let radius = 10_f64.powi(exponent);
            let (corners, triangles) = fan([12.3, 11.8], radius, 5, f64::from(degree));
            let inner = radius * (std::f64::consts::PI / 5.0).cos() * 0.999 - 0.01;
            let what = format!("radius 1e{exponent}, {degree} degrees");
            let counts = counts(&corners, &triangles, &settings);
            assert_once(&counts, 24, |x, y| (x - 12.3).hypot(y - 11.8) < inner, &what);
        }
    }
}

#[test]
fn a_floor_whose_corners_lie_behind_the_eye_fills_below_the_horizon() {
    let settings = settings(64, 48);
    for diagonal in [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]] {
        for size in [10.0_f32, 1e3, 1e6, 1e9] {
            let corners = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
            let positions =
                corners.map(|(x, z)| Vec3::new(x * size * 2.0, -1.0, z * size)).to_vec();
            let geometry = project(&scene_of(positions, diagonal.to_vec()), &settings);
            let counts = hit_counts(&geometry, &settings);
            let far = 24.0 + 24.0 / f64::from(size) + 0.01;
            assert_once(&counts, 64, |_, y| y > far, &format!("size {size}"));
            assert!(
                counts[..64 * 24].iter().all(|&count| count == 0),
                "size {size} draws above the horizon"
            );
        }
    }
}

/// A small generator, so that the cases are the same everywhere (Steele and others 2014,
/// `SplitMix64`).
struct Random(u64);

impl Random {
    fn next(&mut self, min: f64, max: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        min + (max - min) * ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Two triangles on either diagonal and in mixed windings; the frame lies within some quads, across
/// borders of others, and beyond an extent of 65536 pixels corners are clipped.
#[test]
fn random_projected_quads_hit_once() {
    let settings = settings(40, 30);
    let mut random = Random(1);
    for case in 0..2000 {
        let center = [random.next(0.0, 40.0), random.next(0.0, 30.0)];
        let extent = 10_f64.powf(random.next(0.0, 5.5));
        let quarter = std::f64::consts::FRAC_PI_2;
        let corners: Vec<Corner> = (0..4)
            .map(|i| {
                let angle = (f64::from(i) + random.next(0.05, 0.95)) * quarter;
                let radius = extent * random.next(0.7, 1.0);
                let w = random.next(0.1, 4.0);
                [center[0] + radius * angle.cos(), center[1] + radius * angle.sin(), w]
            })
            .collect();
        for triangles in [[[0, 1, 2], [0, 2, 3]], [[1, 2, 3], [3, 0, 1]], [[0, 2, 1], [0, 2, 3]]] {
            let margin = 0.02 + extent * 1e-5;
            let inside =
                |x: f64, y: f64| is_convex(&corners) && is_within(&corners, [x, y], margin);
            if is_convex(&corners) {
                let counts = counts(&corners, &triangles, &settings);
                assert_once(
                    &counts,
                    40,
                    inside,
                    &format!("case {case}, extent {extent}, {triangles:?}"),
                );
            }
        }
    }
}

/// Quads in space with some corners behind the eye: their halves never overlap.
#[test]
fn random_quads_through_the_near_plane_hit_at_most_once() {
    let settings = settings(40, 30);
    let mut random = Random(2);
    for case in 0..2000 {
        let mut point = || {
            Vec3::new(
                random.next(-1.0, 1.0) as f32,
                random.next(-1.0, 1.0) as f32,
                random.next(-1.0, 1.0) as f32,
            )
        };
        let (middle, u, v) = (point(), point() * 3.0, point() * 3.0);
        let positions = vec![middle - u - v, middle + u - v, middle + u + v, middle - u + v];
        for triangles in [[[0, 1, 2], [0, 2, 3]], [[1, 2, 3], [3, 0, 1]], [[0, 2, 1], [0, 2, 3]]] {
            let geometry = project(&scene_of(positions.clone(), triangles.to_vec()), &settings);
            let counts = hit_counts(&geometry, &settings);
            // Rays through pixel centres meet the parallelogram, in f64, by a margin, beyond the
            // near plane.
            let inside =
                |x: f64, y: f64| meets([middle, u, v], [(x - 20.0) / 15.0, -(y - 15.0) / 15.0]);
            assert_once(&counts, 40, inside, &format!("case {case}, {triangles:?}"));
        }
    }
}

fn meets([middle, u, v]: [Vec3; 3], [x, y]: [f64; 2]) -> bool {
    let (middle, u, v) = (middle.as_dvec3(), u.as_dvec3(), v.as_dvec3());
    let ray = glam::DVec3::new(x, y, -1.0);
    let normal = u.cross(v);
    let t = middle.dot(normal) / ray.dot(normal);
    let at = ray * t - middle;
    let (a, b) = (
        at.cross(v).dot(normal) / normal.length_squared(),
        u.cross(at).dot(normal) / normal.length_squared(),
    );
    // Slivers seen edge on are all margin.
    let is_steep = ray.normalize().dot(normal.normalize()).abs() > 0.05;
    is_steep && t > 0.0102 && a.abs().max(b.abs()) < 0.99
}

fn is_convex(corners: &[Corner]) -> bool {
    (0..4).all(|i| {
        let [a, b, c] = [0, 1, 2].map(|k| corners[(i + k) % 4]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0
    })
}

fn is_within(corners: &[Corner], [x, y]: [f64; 2], margin: f64) -> bool {
    (0..4).all(|i| {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        dx * (y - a[1]) - dy * (x - a[0]) > margin * dx.hypot(dy)
    })
}

/// Random triangles over a 100 by 70 frame, at random depths.
fn soup(num: u32, settings: &Settings) -> Scene {
    let mut random = Random(3);
    let mut corners = vec![];
    for _ in 0..num {
        let (center, extent) = (
            [random.next(-5.0, 105.0), random.next(-5.0, 75.0)],
            10_f64.powf(random.next(-0.5, 2.5)),
        );
        let mut corner = || {
            let w = random.next(0.5, 3.0);
            [center[0] + random.next(-extent, extent), center[1] + random.next(-extent, extent), w]
        };
        corners.extend([corner(), corner(), corner()]);
    }
    let triangles: Vec<_> = (0..num).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mut scene = scene(&corners, &triangles, settings);
    // Two materials, so that quads are sorted.
    let mut second = scene.meshes[0].clone();
    let half = second.triangles.len() / 2;
    second.triangles.drain(..half);
    second.material = 1;
    scene.meshes[0].triangles.truncate(half);
    scene.meshes.push(second);
    scene.materials.push(Material::default());
    scene.background = [0.1, 0.2, 0.3, 0.5];
    scene
}

fn shade(pair: &QuadPair) -> [PixelLanes; 3] {
    let tint = PixelLanes::splat(pair.material as f32 + 0.5);
    [pair.uv[0], pair.uv[1] * tint, pair.view()[2]]
}

fn drawn(scene: &Scene, settings: &Settings) -> (Frame, RasterStats) {
    let mut frame = Frame { width: 0, height: 0, pixels: vec![] };
    let stats = draw(&project(scene, settings), scene, settings, &shade, &mut frame);
    (frame, stats)
}

fn bits(frame: &Frame) -> Vec<[u32; 4]> {
    frame.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

#[test]
fn tile_size_and_threads_do_not_show() {
    for msaa in [1, 4, 8] {
        let settings = Settings { msaa, ..settings(101, 71) };
        let scene = soup(600, &settings);
        let (frame, stats) = drawn(&scene, &settings);
        let hits = hit_counts(&project(&scene, &settings), &settings);
        for tile_size in [8, 16, 64, 128, 256] {
            let settings = Settings { tile_size, ..settings.clone() };
            let (other, other_stats) = drawn(&scene, &settings);
            assert!(bits(&frame) == bits(&other), "tile size {tile_size}, msaa {msaa}");
            assert_eq!(stats, other_stats);
            assert_eq!(hits, hit_counts(&project(&scene, &settings), &settings));
        }
        for num_threads in [1, 2, 7] {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(num_threads).build().expect("threads");
            let (other, other_stats) = pool.install(|| drawn(&scene, &settings));
            assert!(bits(&frame) == bits(&other), "{num_threads} threads, msaa {msaa}");
            assert_eq!(stats, other_stats);
        }
    }
}

/// What is hidden may be left out: how much that is depends on the order.
#[test]
fn order_of_triangles_does_not_show_where_depths_differ() {
    let settings = Settings { msaa: 1, ..settings(101, 71) };
    for num in [40, 700, 3000] {
        let scene = soup(num, &settings);
        let mut reversed = scene.clone();
        reversed.meshes.reverse();
        reversed.meshes.iter_mut().for_each(|mesh| mesh.triangles.reverse());
        assert!(
            bits(&drawn(&scene, &settings).0) == bits(&drawn(&reversed, &settings).0),
            "{num} triangles"
        );
    }
}

#[test]
fn order_does_not_depend_on_threads() {
    let settings = settings(200, 150);
    let scene = soup(20_000, &settings);
    let triangles =
        |geometry: &Geometry| geometry.triangles().copied().collect::<Vec<ScreenTriangle>>();
    let expected = triangles(&project(&scene, &settings));
    assert!(expected.is_sorted_by_key(|triangle| (triangle.mesh, triangle.triangle)));
    for num_threads in [1, 2, 7] {
        let pool =
            rayon::ThreadPoolBuilder::new().num_threads(num_threads).build().expect("threads");
        assert!(
            pool.install(|| triangles(&project(&scene, &settings))) == expected,
            "{num_threads} threads"
        );
    }
}

#[test]
fn samples_share_pixels_by_their_number() {
    // The left half of every pixel of column 2 is covered.
    let corners = [[0.0, 0.0, 1.0], [0.0, 8.0, 1.0], [2.5, 8.0, 1.0], [2.5, 0.0, 1.0]];
    for (msaa, expected) in [(4, "442....."), (8, "884.....")] {
        let settings = Settings { msaa, ..settings(8, 8) };
        let picture = picture(&counts(&corners, &[[0, 1, 2], [0, 2, 3]], &settings), 8);
        assert_eq!(picture, vec![expected; 8]);
        let mut scene = scene(&corners, &[[0, 1, 2], [0, 2, 3]], &settings);
        scene.background = [1.0, 0.0, 0.0, 1.0];
        let mut frame = Frame { width: 0, height: 0, pixels: vec![] };
        let white = |_: &QuadPair| [PixelLanes::ONE; 3];
        draw(&project(&scene, &settings), &scene, &settings, &white, &mut frame);
        assert_eq!(
            frame.pixels[..4],
            [[1.0; 4], [1.0; 4], [1.0, 0.5, 0.5, 1.0], [1.0, 0.0, 0.0, 1.0]]
        );
    }
}

#[test]
fn every_mesh_of_shared_edges_covers_every_sample_once() {
    for msaa in [4, 8] {
        let settings = Settings { msaa, ..settings(20, 20) };
        for degree in 0..90 {
            let (corners, triangles) = fan([10.1, 9.7], 40.0, 9, f64::from(degree));
            assert!(
                counts(&corners, &triangles, &settings)
                    .iter()
                    .all(|&count| u32::from(count) == msaa)
            );
        }
    }
}

#[test]
fn back_faces_are_culled_on_demand() {
    let settings = Settings { cull_back_faces: true, ..settings(8, 8) };
    let corners = [[0.0, 0.0, 1.0], [0.0, 8.0, 1.0], [8.0, 0.0, 1.0]];
    // Down, then right and up: counter-clockwise as displayed.
    assert!(counts(&corners, &[[0, 1, 2]], &settings)[0] == 1);
    assert!(counts(&corners, &[[0, 2, 1]], &settings).iter().all(|&count| count == 0));
    let both = Settings { cull_back_faces: false, ..settings };
    assert!(counts(&corners, &[[0, 2, 1]], &both)[0] == 1);
    // Clipped ones too.
    let corners =
        [Vec3::new(-50.0, -1.0, 5.0), Vec3::new(50.0, -1.0, 5.0), Vec3::new(0.0, -1.0, -50.0)];
    let num = |triangle, settings: &Settings| {
        project(&scene_of(corners.to_vec(), vec![triangle]), settings).num_triangles()
    };
    let culled = Settings { cull_back_faces: true, ..both.clone() };
    assert!(
        num([0, 1, 2], &culled) > 0 && num([0, 2, 1], &culled) == 0 && num([0, 2, 1], &both) > 0
    );
}

#[test]
fn the_nearer_wins_and_equal_depth_keeps_the_first() {
    let settings = settings(8, 8);
    let square = |w: f64| [[0.0, 0.0, w], [0.0, 20.0, w], [20.0, 0.0, w]];
    let color = |depths: &[f64]| {
        let corners: Vec<_> = depths.iter().flat_map(|&w| square(w)).collect();
        let triangles: Vec<_> =
            (0..depths.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mut scene = scene(&corners, &triangles, &settings);
        let mesh = scene.meshes.remove(0);
        for (i, triangle) in triangles.iter().enumerate() {
            scene.meshes.push(Mesh { material: i, triangles: vec![*triangle], ..mesh.clone() });
        }
        scene.materials = vec![Material::default(); depths.len()];
        let mut frame = Frame { width: 0, height: 0, pixels: vec![] };
        let material = |pair: &QuadPair| [PixelLanes::splat(pair.material as f32); 3];
        let stats = draw(&project(&scene, &settings), &scene, &settings, &material, &mut frame);
        assert_eq!(stats.pixels_shaded, 64);
        frame.pixels[0][0]
    };
    assert_eq!(color(&[1.0, 2.0, 3.0]), 0.0);
    assert_eq!(color(&[3.0, 1.0, 2.0]), 1.0);
    assert_eq!(color(&[2.0, 2.0, 2.0]), 0.0);
}

#[test]
fn attributes_are_perspective_correct() {
    let settings = settings(64, 48);
    let size = 1e4_f32;
    let corners = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
    let positions: Vec<_> = corners.map(|(x, z)| Vec3::new(x * size, -1.0, z * size)).to_vec();
    let tex_coords = positions.iter().map(|p| Vec2::new(p.x, -p.z)).collect();
    let mut scene = scene_of(vec![], vec![]);
    scene.meshes =
        vec![Mesh::new(positions, tex_coords, vec![Vec3::Y; 4], vec![[0, 1, 2], [0, 2, 3]])];
    let worst = std::sync::Mutex::new(0.0_f64);
    let check = |pair: &QuadPair| {
        let [x, y] = pair.centers().map(PixelLanes::to_array);
        for lane in (0..8).filter(|&lane| pair.coverage[lane] > 0) {
            let (x, y) = ((f64::from(x[lane]) - 32.0) / 24.0, (f64::from(y[lane]) - 24.0) / 24.0);
            // The floor's point under the pixel; its texture frame is (x, -z) and the normal up.
            let (expected, w) = ([x / y, 1.0 / y, 1.0], 1.0 / y);
            let found = [pair.uv[0], pair.uv[1]].map(|lanes| f64::from(lanes.to_array()[lane]));
            let view = pair.view().map(|lanes| f64::from(lanes.to_array()[lane]));
            let error = [
                found[0] - expected[0],
                found[1] - expected[1],
                view[0] - expected[0],
                view[1] - expected[1],
                view[2] - 1.0,
            ];
            let error = error.iter().fold(0.0_f64, |most, e| most.max(e.abs())) / w;
            let mut worst = worst.lock().expect("not poisoned");
            *worst = worst.max(error);
        }
        [PixelLanes::ZERO; 3]
    };
    let mut frame = Frame { width: 0, height: 0, pixels: vec![] };
    let stats = draw(&project(&scene, &settings), &scene, &settings, &check, &mut frame);
    assert_eq!(stats.pixels_shaded, 64 * 24);
    let worst = worst.into_inner().expect("not poisoned");
    assert!(worst < 1e-4, "relative error {worst}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn any_triangle_is_drawn_without_panic(values in prop::collection::vec(any::<f32>(), 9), msaa in prop::sample::select(vec![1, 4, 8])) {
        let bounded = |i: usize| if values[i].is_finite() { values[i].clamp(-1e18, 1e18) } else { 0.5 };
        let positions: Vec<_> = (0..3).map(|i| Vec3::new(bounded(3 * i), bounded(3 * i + 1), bounded(3 * i + 2))).collect();
        let settings = Settings { msaa, ..settings(19, 17) };
        let (frame, _) = drawn(&scene_of(positions, vec![[0, 1, 2]]), &settings);
        prop_assert!(frame.pixels.iter().all(|pixel| (0.0..=1.0).contains(&pixel[3])));
    }

    #[test]
    fn any_vertex_stays_out_of_fixed_point_unless_finite(x in any::<f32>(), bad in prop::sample::select(vec![f32::NAN, f32::INFINITY, f32::NEG_INFINITY])) {
        let settings = settings(19, 17);
        let positions = vec![Vec3::new(bad, x, -1.0), Vec3::new(1.0, 1.0, -1.0), Vec3::new(-1.0, 1.0, -1.0)];
        let mut scene = scene_of(vec![Vec3::ZERO; 3], vec![[0, 1, 2]]);
        scene.meshes[0].positions = positions;
        prop_assert_eq!(project(&scene, &settings).num_triangles(), 0);
    }

    #[test]
    fn any_closed_fan_hits_each_pixel_once(
        x in -10.0..30.0_f64, y in -10.0..30.0_f64, radius in 60.0..1e5_f64, num in 3..12_u32, degrees in 0.0..360.0_f64,
    ) {
        let settings = settings(20, 20);
        let (corners, triangles) = fan([x, y], radius * 2.0, num, degrees);
        let counts = counts(&corners, &triangles, &settings);
        prop_assert!(counts.iter().all(|&count| count == 1), "{:?}", picture(&counts, 20));
    }
}
