//! Quality bars: each filter against supersampled truth on a small procedural floor. The goals are those on a large floor at
//! 640 x 360; here stands what this small one reaches.

mod common;

use basrelief::filter::differences_for;
use basrelief::geometry::project;
use basrelief::invariants::{Pixel, visible_sets};
use basrelief::metrics::compare;
use basrelief::raster::{AttributePlanes, QuadPair};
use basrelief::relief::{HeightField, displacement, march};
use basrelief::texture::{Surface, SurfaceMaps, srgb_from_linear};
use basrelief::{Camera, Derivatives, Filter, Frame, Renderer, Scene, Settings, Visibility};
use common::{cobbles, floor_scene};
use std::sync::OnceLock;

fn settings(filter: Filter) -> Settings {
    Settings {
        width: 160,
        height: 90,
        filter,
        texel_budget: 0,
        samples: 256,
        far_field: false,
        msaa: 1,
        ..Settings::default()
    }
}

/// Seen so low, and with relief so deep, that much of every footprint is hidden.
fn floor() -> Scene {
    floor_scene(Surface::new(SurfaceMaps { relief_depth: 0.1, ..cobbles(128, 4) }).expect("valid maps"), 0.5)
}

fn draw(settings: Settings) -> Frame {
    Renderer::new(floor(), settings).expect("a valid scene").render()
}

/// Decibels of a filter against 256 rays a pixel.
fn psnr(settings: Settings) -> f64 {
    static TRUTH: OnceLock<Frame> = OnceLock::new();
    let truth = TRUTH.get_or_init(|| draw(self::settings(Filter::Truth)));
    let psnr = compare(&(&draw(settings.clone())).into(), &truth.into()).expect("frames of one size").psnr_db;
    println!("{:?} {:?} {:?}: {psnr:.2} dB", settings.filter, settings.visibility, settings.derivatives);
    psnr
}

fn visible(visibility: Visibility) -> f64 {
    psnr(Settings { visibility, ..settings(Filter::Visible) })
}

#[test]
fn visible_texels_beat_all_texels() {
    let ewa = psnr(settings(Filter::Ewa));
    let exact = visible(Visibility::Exact);
    // The goal on the large floor is 6 dB more than all texels (6.4 there), and 30 dB (33.6 there).
    assert!(exact > ewa + 4.9 && exact > 36.0, "{exact} dB, {ewa} with all texels");
}

#[test]
fn jumps_of_the_relief_are_no_slopes() {
    let exact = visible(Visibility::Exact);
    let by_the_letter = psnr(Settings { max_stretch: 0.0, ..settings(Filter::Visible) });
    // 1.3 dB on the large floor.
    assert!(exact > by_the_letter + 0.1, "{exact} dB, {by_the_letter} by formula (3) alone");
}

#[test]
fn two_ended_rows_come_close_to_rays_from_every_texel() {
    let (exact, two_ended) = (visible(Visibility::Exact), visible(Visibility::TwoEnded));
    assert!((exact - two_ended).abs() < 1.5, "{two_ended} dB, {exact} by rays");
}

#[test]
fn resolved_draws_what_exact_draws() {
    let [exact, resolved] = [Visibility::Exact, Visibility::Resolved]
        .map(|visibility| draw(Settings { visibility, ..settings(Filter::Visible) }));
    assert!(exact == resolved);
}

#[test]
fn horizon_beats_the_visible_texels() {
    let (exact, horizon) = (visible(Visibility::Exact), psnr(settings(Filter::Horizon)));
    // The goal on the large floor at 16 lines is 44 dB (51.5 there).
    assert!(horizon > exact + 8.0 && horizon > 46.0, "{horizon} dB, {exact} by the paper's method");
}

#[test]
fn many_rays_come_close_to_truth_and_few_do_not() {
    let [few, many] = [1, 16].map(|samples| psnr(Settings { samples, ..settings(Filter::Parallax) }));
    assert!(many > few + 6.0 && many > 30.0, "{few} and {many} dB");
    let flat = psnr(Settings { parallax: false, derivatives: Derivatives::Flat, ..settings(Filter::Ewa) });
    assert!(flat < 28.0, "without parallax {flat} dB");
}

#[test]
fn sets_of_texels_are_the_papers_on_every_footprint_of_a_frame() {
    // Base level nearby; beyond the horizon, where a quad's footprints have no end, a coarse one.
    let settings = Settings { width: 48, height: 27, texel_budget: 1024, ..settings(Filter::Visible) };
    let scene = floor();
    let surface = scene.materials[0].surface.as_deref().expect("a relief floor");
    let field = HeightField::new(surface);
    let geometry = project(&scene, &settings);
    let planes: Vec<_> = geometry.triangles().map(|t| AttributePlanes::new(&geometry, t, &scene, &settings)).collect();
    let mut num = 0;
    for quad in 0..24 * 13 {
        let origin = [[quad % 24 * 2, quad / 24 * 2]; 2];
        for planes in &planes {
            let pair = QuadPair::new(0, origin, [1; 8], [planes; 2]);
            let reach = displacement(&pair.view(), surface.relief_depth);
            let depth = march(&field, &pair.uv, &reach);
            let offset = reach.map(|lanes| lanes * depth);
            let place = [pair.uv[0] + offset[0], pair.uv[1] + offset[1]];
            let differences = differences_for(&pair.uv, &offset, &settings);
            for lane in 0..4 {
                let displacement = reach.map(|lanes| lanes.to_array()[lane]);
                let pixel = Pixel { footprint: differences.footprint(&place, lane), displacement };
                visible_sets(surface, &pixel, &settings).expect("the paper's sets");
                num += 1;
            }
        }
    }
    assert!(num > 1000, "{num} footprints");
}

/// Mean square of how much the error (image less truth) of a filter changes from frame to frame of a slow walk.
fn unrest(settings: &Settings, truths: &[Frame]) -> f64 {
    let mut renderer = Renderer::new(floor(), settings.clone()).expect("a valid scene");
    let errors: Vec<Vec<f32>> = walk(&mut renderer, truths.len())
        .zip(truths)
        .map(|(frame, truth)| {
            let channels =
                |frame: &Frame| frame.pixels.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect::<Vec<_>>();
            let encoded = |c: f32| srgb_from_linear(c.clamp(0.0, 1.0));
            channels(&frame).into_iter().zip(channels(truth)).map(|(a, b)| encoded(a) - encoded(b)).collect()
        })
        .collect();
    let squares =
        errors.windows(2).flat_map(|pair| pair[0].iter().zip(&pair[1]).map(|(a, b)| f64::from(a - b).powi(2)));
    squares.sum::<f64>() / ((errors.len() - 1) * errors[0].len()) as f64
}

/// Frames of a walk towards the horizon, a hundredth of a texture repeat each.
fn walk(renderer: &mut Renderer, num: usize) -> impl Iterator<Item = Frame> {
    let camera = renderer.scene().camera;
    (0..num).map(move |i| {
        let step = glam::Vec3::new(camera.target.x - camera.eye.x, 0.0, camera.target.z - camera.eye.z).normalize();
        let moved = step * (0.01 * i as f32);
        renderer
            .set_camera(Camera { eye: camera.eye + moved, target: camera.target + moved, ..camera })
            .expect("a camera");
        renderer.render()
    })
}

#[test]
fn horizon_is_steady_in_motion() {
    let small = |filter| Settings { width: 96, height: 54, samples: 256, far_field: true, ..settings(filter) };
    let mut renderer = Renderer::new(floor(), small(Filter::Truth)).expect("a valid scene");
    let truths: Vec<_> = walk(&mut renderer, 8).collect();
    let horizon = unrest(&small(Filter::Horizon), &truths);
    let parallax = unrest(&Settings { samples: 4, ..small(Filter::Parallax) }, &truths);
    // A twentieth, over 60 frames too.
    println!("mean square of the error's change: horizon {horizon:e}, parallax with 4 rays {parallax:e}");
    assert!(horizon < 0.1 * parallax, "{horizon:e} against {parallax:e}");
}

/// Where the floor goes from one mip level to the next, the mean error of a row does not jump by a step of 8-bit colour.
#[test]
fn changes_of_level_are_not_seen() {
    let size = |filter| Settings { width: 320, height: 180, samples: 64, ..settings(filter) };
    let row_means = |filter| {
        let frame = draw(size(filter));
        let srgb = |pixel: &[f32; 4]| pixel[..3].iter().map(|c| f64::from(srgb_from_linear(*c))).sum::<f64>() / 3.0;
        let rows = frame.pixels.chunks(frame.width as usize);
        rows.map(|row| row.iter().map(srgb).sum::<f64>() / row.len() as f64).collect::<Vec<_>>()
    };
    let (truth, horizon) = (row_means(Filter::Truth), row_means(Filter::Horizon));
    let errors: Vec<_> = horizon.iter().zip(&truth).map(|(a, b)| a - b).collect();
    let step = errors.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    println!("greatest step of a row's mean error: {step:.5}");
    assert!(step < 1.0 / 255.0, "{step}");
}

/// Thin footprints at the skyline once fell between the texels of a table, and were black.
#[test]
fn no_pixel_of_the_far_field_is_black() {
    let settings = Settings { width: 640, height: 48, msaa: 1, ..Settings::default() };
    let scene = basrelief::scene::builtin();
    let mut renderer = Renderer::new(scene, settings).expect("a valid scene");
    let camera = renderer.scene().camera;
    renderer.set_camera(Camera { fov_degrees: camera.fov_degrees * 0.1, ..camera }).expect("a camera");
    let frame = renderer.render();
    assert!(frame.pixels.iter().all(|[r, g, b, _]| r + g + b > 0.01));
}
