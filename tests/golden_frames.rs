//! Golden pictures: small PNGs in `golden/` that must be drawn again. Each shows a floor of stones
//! that hide the joints behind them, the eye 1.2 above it.
//!
//! Those named `reference_` are drawn by the oracle in `basrelief::reference` alone, pixel by
//! pixel in f64, and a filter must come as close to them as it says here. The others are frames
//! that were looked at and accepted; their bytes are the same on every machine. A tolerance of 1.5
//! steps of 255 is one of rounding: the PNG is rounded, and so is the picture.
//!
//! After a wanted change `BASRELIEF_ACCEPT=1` writes the PNGs anew. Look at them.

mod common;

use basrelief::filter::{Footprint, Prepared};
use basrelief::golden::{self, OnDifference, Thresholds};
use basrelief::reference::{self, Conic, Lines, Ray};
use basrelief::texture::{Surface, SurfaceMaps, Wrap};
use basrelief::{
    Camera, Ewa, Filter, Formulas, Frame, Horizon, Light, Lighting, Material, Mesh, RECONSTRUCTION,
    Rays, Scene, Settings, Sky, Visible, render,
};
use common::{cobbles, floor_scene};
use glam::Vec3;
use std::path::PathBuf;

/// Pixels a side.
const SIDE: u32 = 64;
/// Height of the eye over the floor, in world units.
const EYE: f64 = 1.2;
/// Texture repeats a world unit.
const REPEATS: f64 = 0.5;
/// Tangent of half the field of view.
const TAN_HALF_FOV: f64 = 0.6;
/// Where the eye looks, and what is up in the picture: both of length one, and square.
const FORWARD: [f64; 3] = [0.0, -0.6, -0.8];
const UP: [f64; 3] = [0.0, 0.8, -0.6];
/// Longest axis of an ellipse over its shortest, as filters have it by default.
const MAX_ANISOTROPY: f64 = 64.0;
/// Least half axis of an ellipse in texels.
const LEAST_AXIS: f64 = 1.0 / 256.0;

/// Depth of the relief in repeats.
const RELIEF_DEPTH: f64 = 0.1;

fn stones(wrap: Wrap) -> Surface {
    Surface::new(SurfaceMaps { relief_depth: RELIEF_DEPTH as f32, wrap, ..cobbles(64, 4) })
        .expect("valid maps")
}

fn camera() -> Camera {
    let eye = Vec3::new(0.0, EYE as f32, 0.0);
    Camera {
        eye,
        target: eye + Vec3::from(FORWARD.map(|c| c as f32)),
        fov_degrees: (2.0 * TAN_HALF_FOV.atan().to_degrees()) as f32,
        ..Camera::default()
    }
}

fn floor(wrap: Wrap) -> Scene {
    let mut scene = floor_scene(stones(wrap), REPEATS as f32);
    scene.camera = camera();
    scene
}

/// Draws a small frame.
fn draw(scene: Scene, filter: Filter) -> Frame {
    draw_with(scene, Settings { filter, ..Settings::default() })
}

fn draw_with(scene: Scene, settings: Settings) -> Frame {
    render(scene, Settings { width: SIDE, height: SIDE, ..settings }).expect("a valid scene")
}

fn golden_path(name: &str) -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden")).join(format!("{name}.png"))
}

fn is_accepted() -> bool {
    std::env::var_os("BASRELIEF_ACCEPT").is_some()
}

/// A frame must have the bytes of its golden picture.
fn check_frame(name: &str, frame: &Frame) {
    let on_difference = if is_accepted() { OnDifference::Accept } else { OnDifference::Fail };
    golden::check(golden_path(name), frame, Thresholds::default(), on_difference)
        .unwrap_or_else(|error| panic!("{error}; BASRELIEF_ACCEPT=1 accepts"));
}

/// A picture by the reference, and what a filter draws of it.
///
/// The reference is slow: it draws the whole picture when it is accepted, and else only the
/// diagonal, which must be that of the golden picture.
fn check_against_reference(
    name: &str,
    of_pixel: impl Fn(&Surface, &Footprint) -> [f64; 3],
    frame: &Frame,
    thresholds: Thresholds,
) {
    let (surface, path) = (stones(Wrap::Repeat), golden_path(name));
    let color = |pixel: [u32; 2]| {
        let [r, g, b] = of_pixel(&surface, &footprint(&surface, pixel))
            .map(|c| c as f32 * surface.color_scale());
        [r, g, b, 1.0]
    };
    if is_accepted() {
        let mut drawn = Frame::filled(SIDE, SIDE, [0.0; 4]);
        for (i, pixel) in drawn.pixels.iter_mut().enumerate() {
            *pixel = color([i as u32 % SIDE, i as u32 / SIDE]);
        }
        golden::check(&path, &drawn, Thresholds::default(), OnDifference::Accept)
            .expect("accepted");
    }
    let stored = basrelief::metrics::Picture::open(&path).expect("a golden picture");
    for i in 0..SIDE {
        let diagonal = Frame::filled(1, 1, color([i, i])).to_rgba8()[0];
        let golden = stored.pixels()[(i * SIDE + i) as usize].map(|c| (c * 255.0).round() as u8);
        assert_eq!(diagonal, golden, "{name}: the reference draws pixel {i}, {i} otherwise");
    }
    golden::check(&path, frame, thresholds, OnDifference::Fail)
        .unwrap_or_else(|error| panic!("{error}"));
}

/// Where the ray through the middle of a pixel meets the floor in texture repeats, and its
/// displacement.
fn ray(pixel: [u32; 2]) -> [[f64; 2]; 2] {
    let [x, y] =
        pixel.map(|c| (f64::from(c) + 0.5) / f64::from(SIDE) * 2.0 - 1.0).map(|c| c * TAN_HALF_FOV);
    // Right is along x; rows go down.
    let along = [FORWARD[0] + x, FORWARD[1] - UP[1] * y, FORWARD[2] - UP[2] * y];
    let down = -along[1];
    let slope = [along[0] / down, -along[2] / down];
    [slope.map(|s| s * EYE * REPEATS), slope.map(|s| s * RELIEF_DEPTH)]
}

/// A pixel of the floor by the paper's formula (2), and the hit of its view ray, all in f64.
fn footprint(surface: &Surface, [x, y]: [u32; 2]) -> Footprint {
    let [base, displacement] = ray([x, y]);
    // Differences within the pixel's quad: in its own row, and in its own column.
    let (left, top) = (x & !1, y & !1);
    let between = |from, to| {
        let ([[u, v], _], [[to_u, to_v], _]) = (ray(from), ray(to));
        [to_u - u, to_v - v].map(|c| c as f32)
    };
    let dx = between([left, y], [left + 1, y]);
    let dy = between([x, top], [x, top + 1]);
    let texels = surface.base().texels_per_repeat().map(f64::from);
    let in_texels = |p: [f64; 2]| [p[0] * texels[0], p[1] * texels[1]];
    let view = Ray { base: in_texels(base), displacement: in_texels(displacement) };
    let place = view.at(reference::first_hit(surface.base(), &view, 8.0));
    let hit = [place[0] / texels[0], place[1] / texels[1]];
    let [base, hit, displacement] = [base, hit, displacement].map(|p| p.map(|c| c as f32));
    Footprint { base, hit, dx, dy, displacement }
}

/// The picture by a filter alone, of footprints by the reference. One pixel a call: pixels given
/// together may share a sweep, whose lines are not those of each pixel's ellipse.
fn filter_alone(filter: Filter) -> Frame {
    let surface = stones(Wrap::Repeat);
    let prepared = Prepared::new(surface.clone()).without_far_field();
    let color = |i: u32| {
        let pixel = footprint(&surface, [i % SIDE, i / SIDE]);
        let [r, g, b] = prepared.colors(&filter, &[pixel])[0];
        [r, g, b, 1.0]
    };
    let pixels = (0..SIDE * SIDE).map(color).collect();
    Frame { width: SIDE, height: SIDE, pixels }
}

fn in_texels(surface: &Surface, [u, v]: [f32; 2]) -> [f64; 2] {
    let [across, down] = surface.base().texels_per_repeat();
    [f64::from(u) * f64::from(across), f64::from(v) * f64::from(down)]
}

/// Formula (1) in texels, with a kernel for the texels themselves.
fn ellipse(surface: &Surface, pixel: &Footprint, kernel: f64) -> Conic {
    let ([ux, vx], [uy, vy]) = (in_texels(surface, pixel.dx), in_texels(surface, pixel.dy));
    Conic::new([ux, vx, uy, vy], Formulas::Meant).widened(kernel, MAX_ANISOTROPY, LEAST_AXIS)
}

/// The mean of those texels of the ellipse around the hit that `counts`, or of the one at the hit.
fn mean_of(surface: &Surface, pixel: &Footprint, counts: impl Fn([i32; 2]) -> bool) -> [f64; 3] {
    let conic = ellipse(surface, pixel, f64::from(RECONSTRUCTION));
    let center = in_texels(surface, pixel.hit);
    let texels = reference::texels(&conic, center, 0.0).into_iter().map(|(texel, _)| texel);
    let counted: Vec<_> = texels.filter(|texel| counts(*texel)).collect();
    reference::mean(surface.base(), &counted, &conic, center).expect("something is seen")
}

/// One texel's colour.
fn texel(surface: &Surface, texel: [i32; 2]) -> [f64; 3] {
    let disc = Conic { a: 1.0, b: 0.0, c: 1.0, f: 1.0 };
    reference::mean(surface.base(), &[texel], &disc, texel.map(|c| f64::from(c) + 0.5))
        .expect("one texel")
}

#[test]
fn nearest_is_the_reference() {
    let of_pixel = |surface: &Surface, pixel: &Footprint| {
        texel(surface, in_texels(surface, pixel.hit).map(|c| c.floor() as i32))
    };
    let thresholds = Thresholds { tolerance: 1.5 / 255.0, share: 0.0 };
    check_against_reference(
        "reference_nearest",
        of_pixel,
        &filter_alone(Filter::Nearest),
        thresholds,
    );
}

#[test]
fn bilinear_is_the_reference() {
    let of_pixel = |surface: &Surface, pixel: &Footprint| {
        let place = in_texels(surface, pixel.hit).map(|c| c - 0.5);
        let [x, y] = place.map(|c| c.floor() as i32);
        let [s, t] = place.map(|c| c - c.floor());
        let parts = [
            ([0, 0], (1.0 - s) * (1.0 - t)),
            ([1, 0], s * (1.0 - t)),
            ([0, 1], (1.0 - s) * t),
            ([1, 1], s * t),
        ];
        parts.into_iter().fold([0.0; 3], |sum, ([right, down], part)| {
            let color = texel(surface, [x + right, y + down]);
            std::array::from_fn(|i| sum[i] + color[i] * part)
        })
    };
    let thresholds = Thresholds { tolerance: 1.5 / 255.0, share: 0.0 };
    check_against_reference(
        "reference_bilinear",
        of_pixel,
        &filter_alone(Filter::Bilinear),
        thresholds,
    );
}

#[test]
fn all_texels_of_an_ellipse_are_the_reference() {
    let of_pixel = |surface: &Surface, pixel: &Footprint| mean_of(surface, pixel, |_| true);
    let filter = Filter::Ewa(Ewa { texel_budget: 0, ..Ewa::default() });
    let thresholds = Thresholds { tolerance: 1.5 / 255.0, share: 0.0 };
    check_against_reference("reference_ewa", of_pixel, &filter_alone(filter), thresholds);
}

#[test]
fn visible_texels_are_the_reference() {
    let of_pixel = |surface: &Surface, pixel: &Footprint| {
        let displacement = in_texels(surface, pixel.displacement);
        mean_of(surface, pixel, |texel| {
            reference::ray_margin(surface.base(), texel, displacement) <= 0.0
        })
    };
    let filter = Filter::Visible(Visible { texel_budget: 0, ..Visible::default() });
    let thresholds = Thresholds { tolerance: 1.5 / 255.0, share: 0.0 };
    check_against_reference("reference_visible", of_pixel, &filter_alone(filter), thresholds);
}

#[test]
fn the_horizon_is_the_reference() {
    let of_pixel = |surface: &Surface, pixel: &Footprint| {
        let [center, displacement] =
            [pixel.base, pixel.displacement].map(|p| in_texels(surface, p));
        let conic = ellipse(surface, pixel, 0.0);
        let lines = Lines {
            level: surface.base(),
            conic,
            center,
            displacement,
            spacing: 1.0,
            steps_per_row: 1,
        };
        // As many lines as the filter takes when it is asked for 64 texels across.
        Lines { spacing: 2.0 * lines.half_width() / (0.65 * 64.0), ..lines }.with_half_rows().mean()
    };
    let filter = Filter::Horizon(Horizon { lines: 64, far_field: false, ..Horizon::default() });
    let thresholds = Thresholds { tolerance: 1.5 / 255.0, share: 0.0 };
    check_against_reference("reference_horizon", of_pixel, &filter_alone(filter), thresholds);
}

#[test]
fn rays_and_the_default_filter_are_close_to_the_reference() {
    let of_pixel =
        |surface: &Surface, pixel: &Footprint| reference::supersampled(surface, pixel, 12);
    let unlit = |filter| {
        draw_with(floor(Wrap::Repeat), Settings { filter, msaa: 1, ..Settings::default() })
    };
    // Both are whole frames: projection, coverage and footprints count too.
    let truth = unlit(Filter::Truth(Rays { samples: 256 }));
    // 256 rays a pixel have noise: two pixels are four steps of 255 off.
    let close = Thresholds { tolerance: 3.5 / 255.0, share: 0.001 };
    check_against_reference("reference_truth", of_pixel, &truth, close);
    let default = unlit(Filter::default());
    // Ten lines: eight pixels are five or six steps off.
    let near = Thresholds { tolerance: 4.5 / 255.0, share: 0.003 };
    check_against_reference("reference_truth", of_pixel, &default, near);
}

#[test]
fn frames_are_the_accepted_ones() {
    for filter in Filter::ALL {
        let (name, filter) = match filter {
            // The reference draws these.
            Filter::Nearest | Filter::Bilinear | Filter::Truth(_) => continue,
            Filter::Trilinear(_) => ("trilinear", filter),
            Filter::Ewa(ewa) => ("ewa", Filter::Ewa(Ewa { texel_budget: 64, ..ewa })),
            Filter::Visible(visible) => {
                ("visible", Filter::Visible(Visible { texel_budget: 64, ..visible }))
            }
            Filter::Horizon(horizon) => {
                ("horizon", Filter::Horizon(Horizon { lines: 4, ..horizon }))
            }
            Filter::Parallax(_) => ("parallax", Filter::Parallax(Rays { samples: 4 })),
        };
        check_frame(name, &draw(floor(Wrap::Repeat), filter));
    }
}

#[test]
fn lit_relief_is_the_accepted_one() {
    let mut scene = floor(Wrap::Repeat);
    scene.sky = Sky::Color(Vec3::splat(0.1));
    scene.materials[0].roughness = 0.5;
    // A low sun from the left, and a lamp over the middle.
    scene.lights = vec![
        Light::sun(Vec3::new(-1.0, 0.5, 0.0), Vec3::splat(0.9)),
        Light::Point { position: Vec3::new(0.0, 0.7, -1.8), intensity: Vec3::new(1.5, 1.0, 0.5) },
    ];
    check_frame(
        "horizon_lit",
        &draw_with(scene, Settings { lighting: Lighting::Lit, ..Settings::default() }),
    );
}

#[test]
fn clamped_and_mirrored_maps_are_the_accepted_ones() {
    for (name, wrap) in [("horizon_clamp", Wrap::Clamp), ("horizon_mirror", Wrap::Mirror)] {
        check_frame(name, &draw(floor(wrap), Filter::default()));
    }
}

#[test]
fn an_edge_of_a_mesh_is_the_accepted_one() {
    let mut scene = floor(Wrap::Repeat);
    // A plain leaf in the air: its edges are nearly upright, nearly level, and aslant.
    let corners =
        [[-0.6, 0.4, -1.6], [0.5, 0.35, -1.4], [-0.5, 0.9, -2.0]].map(Vec3::from).to_vec();
    let mut leaf = Mesh::new(corners, vec![], vec![], vec![[0, 1, 2]]);
    leaf.material = 1;
    scene.meshes.push(leaf);
    scene.materials.push(Material { base_color: Vec3::new(0.8, 0.3, 0.1), ..Material::default() });
    check_frame("edge_msaa_8", &draw_with(scene, Settings { msaa: 8, ..Settings::default() }));
}
