//! Quality bars: each filter against supersampled truth on a small procedural floor. The goals are
//! those on a large floor at 640 x 360; here stands what this small one reaches.

mod common;

use basrelief::footprint::Footprints;
use basrelief::geometry::project;
use basrelief::invariants::visible_sets;
use basrelief::metrics::compare;
use basrelief::raster::{AttributePlanes, QuadPair};
use basrelief::relief::HeightField;
use basrelief::texture::{Surface, SurfaceMaps, srgb_from_linear};
use basrelief::{
    Camera, Derivatives, Ewa, Filter, Frame, Horizon, Lighting, Rays, Renderer, Scene, Settings,
    Visibility, Visible,
};
use common::{cobbles, floor_scene};
use glam::{Vec2, Vec3};
use std::sync::OnceLock;

fn settings(filter: Filter) -> Settings {
    Settings { width: 160, height: 90, filter, msaa: 1, ..Settings::default() }
}

/// All texels of the full texture.
fn ewa() -> Ewa {
    Ewa { texel_budget: 0, ..Ewa::default() }
}

/// The paper's method on the full texture.
fn paper() -> Visible {
    Visible { texel_budget: 0, ..Visible::default() }
}

/// The horizon without tables.
fn sweeps() -> Filter {
    Filter::Horizon(Horizon { far_field: false, ..Horizon::default() })
}

fn truth(samples: u32) -> Filter {
    Filter::Truth(Rays { samples })
}

fn parallax(samples: u32) -> Filter {
    Filter::Parallax(Rays { samples })
}

/// Seen so low, and with relief so deep, that much of every footprint is hidden.
fn floor() -> Scene {
    floor_scene(
        Surface::new(SurfaceMaps { relief_depth: 0.1, ..cobbles(128, 4) }).expect("valid maps"),
        0.5,
    )
}

fn draw(settings: Settings) -> Frame {
    Renderer::new(floor(), settings).expect("a valid scene").render()
}

/// Decibels of a filter against 256 rays a pixel.
fn psnr(settings: Settings) -> f64 {
    static TRUTH: OnceLock<Frame> = OnceLock::new();
    let truth = TRUTH.get_or_init(|| draw(self::settings(truth(256))));
    let psnr = compare(&(&draw(settings.clone())).into(), &truth.into())
        .expect("frames of one size")
        .psnr_db;
    println!("{:?}: {psnr:.2} dB", settings.filter);
    psnr
}

fn visible(visibility: Visibility) -> f64 {
    psnr(settings(Filter::Visible(Visible { visibility, ..paper() })))
}

#[test]
fn visible_texels_beat_all_texels() {
    let ewa = psnr(settings(Filter::Ewa(ewa())));
    let exact = visible(Visibility::Exact);
    // The goal on the large floor is 6 dB more than all texels (6.4 there), and 30 dB (33.6 there).
    assert!(exact > ewa + 4.9 && exact > 36.0, "{exact} dB, {ewa} with all texels");
}

#[test]
fn jumps_of_the_relief_are_no_slopes() {
    let exact = visible(Visibility::Exact);
    let by_the_letter = psnr(settings(Filter::Visible(Visible { max_stretch: 0.0, ..paper() })));
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
        .map(|visibility| draw(settings(Filter::Visible(Visible { visibility, ..paper() }))));
    assert!(exact == resolved);
}

#[test]
fn horizon_beats_the_visible_texels() {
    let (exact, horizon) = (visible(Visibility::Exact), psnr(settings(sweeps())));
    // The goal on the large floor at 16 lines is 44 dB (51.5 there).
    assert!(horizon > exact + 8.0 && horizon > 46.0, "{horizon} dB, {exact} by the paper's method");
}

#[test]
fn quality_does_not_depend_on_the_size() {
    let maps = SurfaceMaps { relief_depth: 0.06, ..cobbles(512, 8) };
    let scene = floor_scene(Surface::new(maps).expect("valid maps"), 0.5);
    for (width, height) in [(80, 45), (160, 90), (240, 135)] {
        let draw = |filter| {
            let settings = Settings { width, height, filter, msaa: 1, ..Settings::default() };
            Renderer::new(scene.clone(), settings).expect("a valid scene").render()
        };
        let [horizon, truth] = [Filter::default(), truth(128)].map(draw);
        let psnr = compare(&(&horizon).into(), &(&truth).into()).expect("one size").psnr_db;
        println!("{width} x {height}: {psnr:.2} dB");
        assert!(psnr > 47.0, "{width} x {height}: {psnr} dB");
    }
}

#[test]
fn many_rays_come_close_to_truth_and_few_do_not() {
    let [few, many] = [1, 16].map(|samples| psnr(settings(parallax(samples))));
    assert!(many > few + 6.0 && many > 30.0, "{few} and {many} dB");
    let flat = Filter::Ewa(Ewa { derivatives: Derivatives::Flat, ..ewa() });
    let flat = psnr(Settings { parallax: false, ..settings(flat) });
    assert!(flat < 28.0, "without parallax {flat} dB");
}

#[test]
fn sets_of_texels_are_the_papers_on_every_footprint_of_a_frame() {
    // Base level nearby; beyond the horizon, where a quad's footprints have no end, a coarse one.
    let visible = Visible { texel_budget: 1024, ..paper() };
    let (filter, rule) = (Filter::Visible(visible), Filter::Visible(visible).traits().rule);
    let settings = Settings { width: 48, height: 27, ..settings(filter) };
    let scene = floor();
    let surface = scene.materials[0].surface.as_deref().expect("a relief floor");
    let field = HeightField::new(surface);
    let geometry = project(&scene, &settings);
    let planes: Vec<_> = geometry
        .triangles()
        .map(|t| AttributePlanes::new(&geometry, t, &scene, &settings))
        .collect();
    let mut num = 0;
    for quad in 0..24 * 13 {
        let origin = [[quad % 24 * 2, quad / 24 * 2]; 2];
        for planes in &planes {
            let pair = QuadPair::new(0, origin, [1; 8], [planes; 2]);
            let pixels = Footprints::of_quads(&pair.uv, &pair.view(), Some(&field), &rule, u8::MAX);
            for lane in 0..4 {
                visible_sets(surface, &pixels.lane(lane), &visible).expect("the paper's sets");
                num += 1;
            }
        }
    }
    assert!(num > 1000, "{num} footprints");
}

/// How much the error (image less truth, sRGB-encoded) of a filter changes from frame to frame of a
/// slow walk: for each pair of frames the three channels of all pixels.
fn error_changes(scene: Scene, settings: &Settings, truths: &[Frame]) -> Vec<Vec<f32>> {
    let mut renderer = Renderer::new(scene, settings.clone()).expect("a valid scene");
    let errors: Vec<Vec<f32>> = walk(&mut renderer, truths.len())
        .zip(truths)
        .map(|(frame, truth)| {
            let channels = |frame: &Frame| {
                frame.pixels.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect::<Vec<_>>()
            };
            let encoded = |c: f32| srgb_from_linear(c.clamp(0.0, 1.0));
            channels(&frame)
                .into_iter()
                .zip(channels(truth))
                .map(|(a, b)| encoded(a) - encoded(b))
                .collect()
        })
        .collect();
    let changes =
        errors.windows(2).map(|pair| pair[0].iter().zip(&pair[1]).map(|(a, b)| a - b).collect());
    changes.collect()
}

fn mean_square<'a>(values: impl IntoIterator<Item = &'a f32>) -> f64 {
    let (sum, num) = values
        .into_iter()
        .fold((0.0, 0), |(sum, num), value| (sum + f64::from(*value).powi(2), num + 1));
    sum / f64::from(num.max(1))
}

/// Frames of a walk towards the horizon, a hundredth of a texture repeat each.
fn walk(renderer: &mut Renderer, num: usize) -> impl Iterator<Item = Frame> {
    let camera = renderer.scene().camera;
    (0..num).map(move |i| {
        let step = Vec3::new(camera.target.x - camera.eye.x, 0.0, camera.target.z - camera.eye.z)
            .normalize();
        let moved = step * (0.01 * i as f32);
        renderer
            .set_camera(Camera { eye: camera.eye + moved, target: camera.target + moved, ..camera })
            .expect("a camera");
        renderer.render()
    })
}

#[test]
fn horizon_is_steady_in_motion() {
    let small = |filter| Settings { width: 96, height: 54, ..settings(filter) };
    let mut renderer = Renderer::new(floor(), small(truth(256))).expect("a valid scene");
    let truths: Vec<_> = walk(&mut renderer, 8).collect();
    let unrest =
        |filter| mean_square(error_changes(floor(), &small(filter), &truths).iter().flatten());
    let (horizon, parallax) = (unrest(Filter::default()), unrest(parallax(4)));
    // A twentieth, over 60 frames too.
    println!(
        "mean square of the error's change: horizon {horizon:e}, parallax with 4 rays {parallax:e}"
    );
    assert!(horizon < 0.1 * parallax, "{horizon:e} against {parallax:e}");
}

/// Where the floor goes from one mip level to the next, the mean error of a row does not jump by a
/// step of 8-bit colour.
#[test]
fn changes_of_level_are_not_seen() {
    let size = |filter| Settings { width: 320, height: 180, ..settings(filter) };
    let row_means = |filter| {
        let frame = draw(size(filter));
        let srgb = |pixel: &[f32; 4]| {
            pixel[..3].iter().map(|c| f64::from(srgb_from_linear(*c))).sum::<f64>() / 3.0
        };
        let rows = frame.pixels.chunks(frame.width as usize);
        rows.map(|row| row.iter().map(srgb).sum::<f64>() / row.len() as f64).collect::<Vec<_>>()
    };
    let (truth, horizon) = (row_means(truth(64)), row_means(sweeps()));
    let errors: Vec<_> = horizon.iter().zip(&truth).map(|(a, b)| a - b).collect();
    let step = errors.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    println!("greatest step of a row's mean error: {step:.5}");
    assert!(step < 1.0 / 255.0, "{step}");
}

/// Where a walk brings blocks of pixels from one mip level or table to the next, their error does
/// not jump: it changes from frame to frame as that of sweeps on the base level throughout does,
/// which is mostly the noise of the truth, and by less than a step of 8-bit colour.
#[test]
fn changes_of_level_are_not_seen_in_motion() {
    const BLOCK: usize = 8;
    let [width, height] = [160, 96];
    let maps = SurfaceMaps { relief_depth: 0.06, ..cobbles(512, 8) };
    let scene = floor_scene(Surface::new(maps).expect("valid maps"), 0.5);
    let size = |filter| Settings { width, height, ..settings(filter) };
    let mut renderer = Renderer::new(scene.clone(), size(truth(128))).expect("a valid scene");
    let truths: Vec<_> = walk(&mut renderer, 6).collect();
    let [width, height] = [width, height].map(|side| side as usize / BLOCK);
    let greatest = |filter| {
        let mut greatest = 0.0_f64;
        for changes in error_changes(scene.clone(), &size(filter), &truths) {
            for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
                let rows = (0..BLOCK).map(|row| 3 * BLOCK * ((y * BLOCK + row) * width + x));
                let block = rows.flat_map(|start| &changes[start..start + 3 * BLOCK]);
                greatest = greatest.max(mean_square(block).sqrt());
            }
        }
        greatest * 255.0
    };
    let base = Horizon { lines: 64, far_field: false, ..Horizon::default() };
    let (horizon, base) = (greatest(Filter::default()), greatest(Filter::Horizon(base)));
    println!(
        "greatest change of a block's error: {horizon:.2} steps of 8-bit colour, {base:.2} on the base level"
    );
    assert!(horizon < 1.0 && horizon < 1.1 * base, "{horizon}, {base} on the base level");
}

/// An arch throws its shadow over the street. Its edge was of the depth under the pixels' centres, and
/// the bent texture of the arch's front was seen along means of tangents: 40.2 dB. The goal is 46.
#[test]
fn the_built_in_scene_is_near_the_truth() {
    let draw = |filter| {
        let scene = basrelief::scene::builtin();
        let settings = Settings { lighting: Lighting::Lit, ..settings(filter) };
        Renderer::new(scene, settings).expect("a valid scene").render()
    };
    let [found, truth] = [Filter::default(), truth(64)].map(draw).map(|frame| (&frame).into());
    let found = compare(&found, &truth).expect("equal sizes").psnr_db;
    println!("{found:.2} dB");
    assert!(found > 40.5, "{found} dB");
}

/// Thin footprints at the skyline once fell between the texels of a table, and were black.
#[test]
fn no_pixel_of_the_far_field_is_black() {
    let settings = Settings { width: 640, height: 48, msaa: 1, ..Settings::default() };
    let scene = basrelief::scene::builtin();
    let mut renderer = Renderer::new(scene, settings).expect("a valid scene");
    let camera = renderer.scene().camera;
    renderer
        .set_camera(Camera { fov_degrees: camera.fov_degrees * 0.1, ..camera })
        .expect("a camera");
    let frame = renderer.render();
    assert!(frame.pixels.iter().all(|[r, g, b, _]| r + g + b > 0.01));
}

/// Smooth tangents that are turned from the polygon's lay ellipses aslant on the lines of a sweep: bins
/// that went by their height alone left nothing of them, and pixels were of any colour.
#[test]
fn ellipses_that_stand_aslant_keep_their_colour() {
    let mut scene = floor_scene(Surface::new(cobbles(64, 4)).expect("valid maps"), 0.25);
    scene.camera.eye.y = 1.0;
    for turn in [0.4, -0.6] {
        let turned = Vec2::new(1.0, turn).normalize();
        for tangents in &mut scene.meshes[0].tangents {
            *tangents = tangents.map(|tangent| {
                let across = Vec2::new(tangent.x, tangent.z).length() * turned;
                if tangent.x.abs() > tangent.z.abs() {
                    Vec3::new(across.x, 0.0, across.y)
                } else {
                    Vec3::new(across.y, 0.0, -across.x)
                }
            });
        }
        let draw = |filter: Filter| {
            Renderer::new(scene.clone(), settings(filter)).expect("a valid scene").render()
        };
        let found = common::decibels(&draw(sweeps()), &draw(truth(64)), 1000.0);
        println!("{found:.2} dB");
        assert!(found > 49.0, "{found} dB with tangents turned by {turn}");
    }
}
