//! Geometry and raster: set-up, binning, and whole frames of a flat colour, for many small
//! triangles and for one huge one.

mod scenes;

use basrelief::geometry::{Geometry, project};
use basrelief::raster::{Bins, Drawn, QuadBlock, Rasterizer, TileGrid, hit_counts};
use basrelief::simd::PixelLanes;
use basrelief::{Frame, Scene, Settings};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use scenes::{floor, terrain};
use std::hint::black_box;

fn cases() -> [(&'static str, Scene); 3] {
    [("100k_triangles", terrain(223)), ("1m_triangles", terrain(707)), ("floor", floor())]
}

fn flat(block: &QuadBlock, colors: &mut Vec<[PixelLanes; 3]>) {
    colors.extend(block.pairs().map(|pair| [pair.uv[0], pair.uv[1], pair.view()[2]]));
}

fn setup(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("setup");
    let settings = Settings { msaa: 1, ..Settings::default() };
    for (name, scene) in cases() {
        group.throughput(Throughput::Elements(scene.meshes[0].triangles.len() as u64));
        let mut geometry = Geometry::default();
        group.bench_function(name, |b| b.iter(|| geometry.project(black_box(&scene), &settings)));
    }
    group.finish();
}

fn binning(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("binning");
    let settings = Settings { msaa: 1, ..Settings::default() };
    for (name, scene) in cases() {
        let geometry = project(&scene, &settings);
        let mut bins = Bins::default();
        group.bench_function(name, |b| {
            b.iter(|| bins.fill(black_box(&geometry), &TileGrid::new(&settings)));
        });
    }
    group.finish();
}

fn coverage(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("coverage");
    group.sample_size(20);
    for (name, scene) in cases() {
        for msaa in [1, 4, 8] {
            let settings = Settings { msaa, ..Settings::default() };
            let geometry = project(&scene, &settings);
            group.bench_function(format!("{name}_msaa{msaa}"), |b| {
                b.iter(|| hit_counts(black_box(&geometry), &settings));
            });
        }
    }
    group.finish();
}

/// Binning, coverage, depth, attributes, and a flat colour.
fn draw(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("draw");
    group.sample_size(20);
    for (name, scene) in cases() {
        for msaa in [1, 4, 8] {
            let settings = Settings { msaa, ..Settings::default() };
            let geometry = project(&scene, &settings);
            let mut rasterizer = Rasterizer::default();
            let mut frame = Frame::filled(settings.width, settings.height, [0.0; 4]);
            group.bench_function(format!("{name}_msaa{msaa}"), |b| {
                b.iter(|| {
                    rasterizer.draw(
                        black_box(&geometry),
                        Drawn { scene: &scene, settings: &settings, group: None, follow: None },
                        &flat,
                        &|| 0.0,
                        &mut frame.pixels,
                    )
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, setup, binning, coverage, draw);
criterion_main!(benches);
