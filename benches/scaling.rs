//! How the time of a frame grows: with threads, pixels, triangles, texels and objects. Prints
//! ratios of the fastest frames.
//!
//! `cargo bench --bench scaling`, on an idle machine; `-- NAME` runs what begins so.

mod scenes;

use basrelief::{Filter, Frame, Horizon, Renderer, Scene, Settings, Trilinear};
use rayon::ThreadPoolBuilder;
use scenes::{floor, objects, stones, terrain, textured};
use std::time::Instant;

/// Frames of which the fastest counts: what else the machine does only makes frames slower.
fn num_frames() -> usize {
    if is_bench() { 15 } else { 1 }
}

/// Whether this is `cargo bench`; `cargo test` only looks whether it runs.
fn is_bench() -> bool {
    std::env::args().any(|argument| argument == "--bench")
}

fn trilinear() -> Filter {
    Filter::Trilinear(Trilinear::default())
}

/// The horizon without tables: they are made for small maps only, and would spare a small map its
/// sweeps.
fn sweeps() -> Filter {
    Filter::Horizon(Horizon { far_field: false, ..Horizon::default() })
}

fn settings(filter: Filter) -> Settings {
    Settings { filter, msaa: 1, ..Settings::default() }
}

/// Milliseconds of the fastest frame.
fn time(scene: Scene, settings: Settings, num_threads: usize) -> f64 {
    let pool = ThreadPoolBuilder::new().num_threads(num_threads).build().expect("threads");
    let mut renderer = Renderer::new(scene, settings).expect("a valid scene");
    let mut pixels: Frame = Frame::default();
    let frame = || {
        let start = Instant::now();
        pool.install(|| renderer.render_into(&mut pixels));
        start.elapsed().as_secs_f64() * 1e3
    };
    std::iter::repeat_with(frame).take(num_frames()).fold(f64::INFINITY, f64::min)
}

fn report(name: &str, wanted: &str, [less, more]: [f64; 2]) {
    println!(
        "{name:<40} {less:>9.2} ms {more:>9.2} ms   ratio {:.2}   wanted {wanted}",
        more / less
    );
}

/// Two threads beside one.
fn threads() {
    let wanted = "at most 0.53";
    let hills = textured(terrain(707), stones(1024, 1, 0.0), 4.0);
    let road = textured(floor(), stones(1024, 1, 0.05), 1.0);
    for (name, scene, filter) in
        [("threads/1m_triangles", hills, trilinear()), ("threads/floor", road, Filter::default())]
    {
        report(name, wanted, [1, 2].map(|num| time(scene.clone(), settings(filter), num)));
    }
}

/// Four times the pixels.
fn pixels() {
    let road = textured(floor(), stones(1024, 1, 0.05), 1.0);
    for (name, filter) in [("pixels/trilinear", trilinear()), ("pixels/horizon", Filter::default())]
    {
        let times = [(960, 540), (1920, 1080)].map(|(width, height)| {
            time(road.clone(), Settings { width, height, ..settings(filter) }, 1)
        });
        report(name, "at most 4.2", times);
    }
}

/// Ten times the triangles.
fn triangles() {
    let times = [224, 707].map(|side| {
        time(textured(terrain(side), stones(1024, 1, 0.0), 4.0), settings(trilinear()), 1)
    });
    report("triangles/trilinear", "at most 10", times);
}

/// Sixty-four times the texels, with footprints of as many texels.
fn texels() {
    let scene =
        |size: u32, depth: f32| textured(floor(), stones(size, 1, depth), 1024.0 / size as f32);
    for (name, filter, depth) in
        [("texels/trilinear", trilinear(), 0.0), ("texels/horizon", sweeps(), 0.05)]
    {
        let settings = settings(filter);
        report(
            name,
            "at most 1.3",
            [1024, 8192]
                .map(|size| time(scene(size, depth * 1024.0 / size as f32), settings.clone(), 1)),
        );
    }
}

/// 2025 objects with a material each and 64 surfaces beside one object with one.
fn many_objects() {
    let surfaces: Vec<_> = (0..64).map(|seed| stones(256, seed, 0.05)).collect();
    for (name, filter) in [("objects/trilinear", trilinear()), ("objects/horizon", sweeps())] {
        let settings = settings(filter);
        let one = time(objects(224, 1, &surfaces[..1]), settings.clone(), 1);
        report(name, "-", [one, time(objects(224, 45, &surfaces), settings, 1)]);
    }
}

fn main() {
    let wanted =
        std::env::args().skip(1).find(|argument| !argument.starts_with('-')).unwrap_or_default();
    let all: [(&str, fn()); 5] = [
        ("threads", threads),
        ("pixels", pixels),
        ("triangles", triangles),
        ("texels", texels),
        ("objects", many_objects),
    ];
    // Maps of 8192 x 8192 texels take too long without optimisation.
    let is_wanted = |name: &str| name.starts_with(&wanted) && (is_bench() || name != "texels");
    all.iter().filter(|(name, _)| is_wanted(name)).for_each(|(_, run)| run());
}
