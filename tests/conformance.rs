//! Cases of public conformance suites, by their parameters: the fill rules of OpenGL ES 3, the
//! anisotropy and explicit levels of Vulkan, the anisotropy of WebGPU, the odd aspect ratios of
//! `OpenImageIO`, the magnified lines of pbrt.

mod common;

use basrelief::filter::points;
use basrelief::footprint::{Footprint, Footprints, levels};
use basrelief::geometry::project;
use basrelief::invariants::filtered;
use basrelief::raster::hit_counts;
use basrelief::texture::{ColorImage, FULL, Surface, SurfaceMaps, Wrap};
use basrelief::{Camera, Ewa, Filter, Formulas, Horizon, Material, Mesh, Scene, Settings, render};
use common::{Random, flat_surface, limited_filters, with_budget, with_limit};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// A camera for which the clip coordinates (x, y, w) are the world's (x, y, -w) in a square frame.
fn clip_camera() -> Camera {
    Camera {
        eye: Vec3::ZERO,
        target: -Vec3::Z,
        up: Vec3::Y,
        fov_degrees: 90.0,
        near: 1e-3,
        ..Camera::default()
    }
}

fn square(side: u32) -> Settings {
    Settings { width: side, height: side, msaa: 1, ..Settings::default() }
}

// ---- dEQP-GLES3.functional.rasterization.fill_rules

/// A quad of `half` its side, turned, around a centre in device coordinates, each corner with its
/// own w.
fn quad(center: Vec2, half: f32, degrees: f32, w: [f32; 4]) -> Vec<Vec3> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let corner = |x: f32, y: f32, w: f32| {
        let [x, y] = [half * (x * cos - y * sin) + center.x, half * (x * sin + y * cos) + center.y];
        Vec3::new(x * w, y * w, -w)
    };
    vec![
        corner(-1.0, -1.0, w[0]),
        corner(1.0, -1.0, w[1]),
        corner(1.0, 1.0, w[2]),
        corner(-1.0, 1.0, w[3]),
    ]
}

const DIAGONAL: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
const OTHER_DIAGONAL: [[u32; 3]; 2] = [[1, 2, 3], [3, 0, 1]];

/// How often each pixel is drawn: the suite draws gray 127 additively and looks for more.
fn drawn(quads: &[(Vec<Vec3>, [[u32; 3]; 2])], settings: &Settings) -> Vec<u8> {
    let mesh = |(corners, triangles): &(Vec<Vec3>, [[u32; 3]; 2])| {
        Mesh::new(corners.clone(), vec![], vec![], triangles.to_vec())
    };
    let meshes = quads.iter().map(mesh).collect();
    let scene = Scene {
        meshes,
        materials: vec![Material::default()],
        camera: clip_camera(),
        ..Scene::default()
    };
    scene.validate().expect("a valid scene");
    hit_counts(&project(&scene, settings), settings)
}

/// 4 x 4 turned quads on 256 x 256 pixels, twice: plain, with the other diagonal, and with w of 0.1
/// to 4.
#[test]
fn fill_rules_of_a_grid_of_quads() {
    let mut random = Random(0xabcd);
    for (name, triangles, is_projected) in [
        ("basic", DIAGONAL, false),
        ("reversed", OTHER_DIAGONAL, false),
        ("projected", DIAGONAL, true),
    ] {
        for iteration in 0..2 {
            let quads: Vec<_> = (0..16)
                .map(|i| {
                    let center =
                        Vec2::new((i % 4) as f32 + 0.5, (i / 4) as f32 + 0.5) / 4.0 * 2.0 - 1.0;
                    let w = if is_projected {
                        [0; 4].map(|_| random.within(0.1, 4.0))
                    } else {
                        [1.0; 4]
                    };
                    let degrees = (iteration * 16 + i) as f32 / 32.0 * 360.0;
                    (quad(center, 0.15, degrees, w), triangles)
                })
                .collect();
            let counts = drawn(&quads, &square(256));
            assert!(counts.iter().all(|&count| count <= 1), "{name}: a pixel is drawn twice");
            let num: usize = counts.iter().map(|&count| usize::from(count)).sum();
            // A quad has a side of 0.3 / 2 x 256 = 38.4 pixels; the edges may take or leave a pixel
            // along them.
            let area = 16.0 * 38.4 * 38.4;
            assert!(
                (num as f32 - area).abs() < 16.0 * 38.4 * 0.5,
                "{name}: {num} pixels of {area}"
            );
        }
    }
}

/// One quad larger than a target of 64 x 64 pixels at 15 rotations: covers all of it, or a part,
/// once.
#[test]
fn fill_rules_of_clipped_quads() {
    for half in [2.0, 1.0] {
        for triangles in [DIAGONAL, OTHER_DIAGONAL] {
            for i in 0..15 {
                let degrees = i as f32 / 15.0 * 90.0;
                let counts =
                    drawn(&[(quad(Vec2::ZERO, half, degrees, [1.0; 4]), triangles)], &square(64));
                assert!(
                    counts.iter().all(|&count| count <= 1),
                    "{degrees} degrees: a pixel is drawn twice"
                );
                let num_holes = counts.iter().filter(|&&count| count == 0).count();
                assert!(half < 2.0 || num_holes == 0, "{degrees} degrees: {num_holes} holes");
            }
        }
    }
}

// ---- dEQP-VK.texture.filtering_anisotropy

/// Limits of 2, 4, 8 and 16, with mip levels and without, for each filter that has a limit: 128 x
/// 128 pixels of a 128 x 128 grid, w from 3.5 on the left to 1 on the right.
#[test]
fn anisotropic_frames_are_close_to_isotropic_ones_and_differ() {
    let cell = |c: u32| c / 16;
    let grid = ColorImage::from_fn(128, 128, |x, y| {
        [if (cell(x) + cell(y)) % 2 == 0 { 0.0 } else { 1.0 }; 3]
    });
    let maps = SurfaceMaps { albedo: Some(grid), wrap: Wrap::Clamp, ..Default::default() };
    let surface = Arc::new(Surface::new(maps).expect("valid maps"));
    for filter in limited_filters() {
        for texel_budget in [0, 64] {
            let draw = |max_anisotropy: f32| {
                let corners =
                    [[-3.5, -1.0, 3.5], [3.5, -1.0, 1.0], [3.5, 1.0, 1.0], [-3.5, 1.0, 3.5]];
                let positions = corners.map(|[x, y, w]| Vec3::new(x, y, -w)).to_vec();
                let tex_coords =
                    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from).to_vec();
                let scene = Scene {
                    meshes: vec![Mesh::new(positions, tex_coords, vec![], DIAGONAL.to_vec())],
                    materials: vec![Material {
                        surface: Some(surface.clone()),
                        ..Material::default()
                    }],
                    camera: clip_camera(),
                    ..Scene::default()
                };
                let filter = with_limit(with_budget(filter, texel_budget), max_anisotropy);
                render(scene, Settings { filter, ..square(128) }).expect("a frame").pixels
            };
            let isotropic = draw(1.0);
            for limit in [2.0, 4.0, 8.0, 16.0] {
                let errors =
                    draw(limit).into_iter().zip(&isotropic).map(|(a, b)| (a[0] - b[0]).abs());
                let (sum, most) =
                    errors.fold((0.0, 0.0_f32), |(sum, most), e| (sum + e, most.max(e)));
                let mean = sum / (128.0 * 128.0);
                // The suite's own comparison forgives shifts by a pixel, so its bound of 0.05 is
                // not one of the mean.
                let what = format!(
                    "{filter:?}, budget {texel_budget}, limit {limit}: mean {mean}, most {most}"
                );
                println!("{what}");
                assert!(mean < 0.05 && most > 0.02, "{what}");
            }
        }
    }
}

// ---- gpuweb/cts: sampling, anisotropy

/// A higher limit takes a finer level where the footprint is long, and the same where it is not.
#[test]
fn higher_limits_take_finer_levels() {
    let surface = flat_surface(256, 256, Wrap::Repeat, 1);
    let level = |aspect: f32, max_anisotropy: f32| {
        let across = 2.0 / 256.0;
        let pixel = Footprint::new([0.4, 0.3], [across, 0.0], [0.0, across * aspect], [0.0; 2]);
        let formulas = Formulas::Meant;
        let rule = levels::EllipseRule { formulas, texel_budget: 64, max_anisotropy };
        levels::within_budget(&surface, &pixel, &rule).0
    };
    for aspect in [4.0, 8.0, 16.0] {
        let levels = [1.0, 2.0, 4.0, 8.0, 16.0, 1024.0].map(|limit| level(aspect, limit));
        assert!(
            levels.is_sorted_by(|a, b| a >= b) && levels[0] > levels[4],
            "{aspect}: {levels:?}"
        );
        assert_eq!(levels[4], levels[5], "{aspect}: a limit past the ratio changes the level");
    }
    assert_eq!(level(1.0, 1.0), level(1.0, 16.0));
}

/// The footprint is long in the right direction: stripes along it stay, stripes across it become
/// their mean.
#[test]
fn footprints_are_long_where_the_derivative_is() {
    let stripes = |along_u: bool| {
        let color = |x: u32, y: u32| {
            [if (if along_u { y } else { x }) / 8 % 2 == 0 { 0.0 } else { 1.0 }; 3]
        };
        let maps =
            SurfaceMaps { albedo: Some(ColorImage::from_fn(64, 64, color)), ..Default::default() };
        Surface::new(maps).expect("valid maps")
    };
    for filter in limited_filters() {
        // Half a texel by 32 texels, in the middle of a stripe.
        let (short, long) = (0.5 / 64.0, 32.0 / 64.0);
        let along_u = Footprint::new([0.5, 4.0 / 64.0], [long, 0.0], [0.0, short], [0.0; 2]);
        let along_v = Footprint::new([4.0 / 64.0, 0.5], [short, 0.0], [0.0, long], [0.0; 2]);
        let color = |surface: &Surface, pixel: &Footprint| filtered(surface, pixel, &filter)[0];
        for (kept, blurred) in [
            (color(&stripes(true), &along_u), color(&stripes(false), &along_u)),
            (color(&stripes(false), &along_v), color(&stripes(true), &along_v)),
        ] {
            assert!(
                kept < 0.1 && (blurred - 0.5).abs() < 0.1,
                "{filter:?}: {kept} along, {blurred} across"
            );
        }
    }
}

// ---- dEQP-VK.texture.explicit_lod

/// The bilinear colour in f64 at a place in repeats.
fn bilinear(surface: &Surface, level: usize, place: [f32; 2]) -> [f64; 3] {
    let level = &surface.levels()[level];
    let texels = level.texels_per_repeat();
    let [u, v] = [0, 1].map(|i| f64::from(place[i]) * f64::from(texels[i]) - 0.5);
    // A pixel without extent reads one texel when it stands on its centre.
    let texel = |x: f64, y: f64| {
        let center = [0, 1].map(|i| ([x, y][i] as f32 + 0.5) / texels[i]);
        points::bilinear(level, center).color.map(f64::from)
    };
    let ([x, y], [fx, fy]) = ([u.floor(), v.floor()], [u - u.floor(), v - v.floor()]);
    let row = |y: f64| {
        let (a, b) = (texel(x, y), texel(x + 1.0, y));
        [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * fx)
    };
    let (a, b) = (row(y), row(y + 1.0));
    [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * fy)
}

/// A 16 x 16 texture, clamped, at levels -1 to 2 in halves, and at pairs of derivatives of 0 to 2
/// texels.
#[test]
fn explicit_levels_and_derivatives() {
    let surface = flat_surface(16, 16, Wrap::Clamp, 7);
    let check = |place: [f32; 2], size: f32, what: &str| {
        // Between two levels the blend is linear in the size, which is within 0.09 of linear in its
        // logarithm.
        let level = size.max(1.0).log2().floor();
        let blend = f64::from(size.max(1.0) / level.exp2() - 1.0);
        let (fine, coarse) = (
            bilinear(&surface, level as usize, place),
            bilinear(&surface, level as usize + 1, place),
        );
        let found = points::trilinear(&surface, place, size).color;
        for i in 0..3 {
            let expected = fine[i] + (coarse[i] - fine[i]) * blend;
            let error = (f64::from(found[i]) - expected).abs() / f64::from(FULL);
            assert!(error < 1e-5, "{what} at {place:?}: {} for {expected}", found[i]);
        }
    };
    for i in 0..256 {
        let place = [(i % 16) as f32 / 15.3 - 0.02, (i / 16) as f32 / 14.7 - 0.03];
        for lod in [-1.0_f32, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0] {
            check(place, lod.exp2(), &format!("level {lod}"));
        }
        for [dx, dy] in [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0], [2.0, 2.0_f32]] {
            let pixel = Footprint::new(place, [dx / 16.0, 0.0], [0.0, dy / 16.0], [0.0; 2]);
            let size =
                levels::longest_sides(surface.base(), &Footprints::splat(&pixel)).as_array()[0];
            assert_eq!(size, dx.max(dy));
            check(place, size, &format!("derivatives {dx}, {dy}"));
        }
    }
}

// ---- OpenImageIO testsuite: texture-skinny, texture-fat

/// A texture stretched 4 times along one axis, texel by texel, looks like the plain one where
/// footprints span many texels.
#[test]
fn skinny_and_fat_textures_look_like_square_ones() {
    let color = |x: u32, y: u32| {
        [((x * 7 + y * 3) % 16) as f32 / 15.0, (x % 4) as f32 / 3.0, (y % 4) as f32 / 3.0]
    };
    let surface = |scale: [u32; 2]| {
        let image = ColorImage::from_fn(16 * scale[0], 16 * scale[1], |x, y| {
            color(x / scale[0], y / scale[1])
        });
        Surface::new(SurfaceMaps { albedo: Some(image), ..Default::default() }).expect("valid maps")
    };
    let (plain, skinny, fat) = (surface([1, 1]), surface([4, 1]), surface([1, 4]));
    let mut random = Random(4);
    let ewa = Filter::Ewa(Ewa { texel_budget: 0, ..Ewa::default() });
    let horizon = Filter::Horizon(Horizon { lines: 64, ..Horizon::default() });
    for (filter, most) in [(ewa, 0.06), (horizon, 0.06)] {
        let mut worst = 0.0_f32;
        for _ in 0..200 {
            let center = [0; 2].map(|_| random.within(0.0, 1.0));
            let [dx, dy] = [random.within(0.3, 0.6), random.within(0.3, 0.6)];
            let pixel = Footprint::new(center, [dx, 0.0], [0.0, dy], [0.0; 2]);
            let [a, b, c] =
                [&plain, &skinny, &fat].map(|surface| filtered(surface, &pixel, &filter));
            let errors = [b, c]
                .iter()
                .flat_map(|other| (0..3).map(|i| (a[i] - other[i]).abs()))
                .collect::<Vec<_>>();
            worst = errors.into_iter().fold(worst, f32::max);
        }
        println!("{filter:?}: {worst}");
        assert!(worst < most, "{filter:?}: {worst} apart");
    }
}
