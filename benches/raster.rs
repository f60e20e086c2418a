//! Geometry and raster: set-up, binning, and whole frames of a flat colour, for many small triangles and for one huge one.

use basrelief::geometry::{Geometry, project};
use basrelief::raster::{Bins, QuadBlock, Rasterizer, TileGrid, hit_counts};
use basrelief::simd::PixelLanes;
use basrelief::{Camera, Frame, Material, Mesh, Scene, Settings};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::{Vec2, Vec3};
use std::hint::black_box;

/// A hilly square of `2 * side^2` triangles, seen from above its border.
fn terrain(side: u32) -> Scene {
    let num = side + 1;
    let corner = |i: u32| Vec2::new((i % num) as f32, (i / num) as f32) / side as f32;
    let position = |at: Vec2| {
        let height = (at.x * 37.0).sin() * (at.y * 29.0).cos() * 0.4 + (at.x * 211.0).sin() * 0.05;
        Vec3::new(at.x * 20.0 - 10.0, height, at.y * 20.0 - 10.0)
    };
    let cells = (0..side * num).filter(|i| i % num != side);
    let triangles = cells.flat_map(|i| [[i, i + num, i + 1], [i + 1, i + num, i + num + 1]]).collect();
    let positions = (0..num * num).map(|i| position(corner(i))).collect();
    let tex_coords = (0..num * num).map(|i| corner(i) * 20.0).collect();
    let camera = Camera { eye: Vec3::new(0.0, 5.5, 11.0), target: Vec3::new(0.0, -0.6, 0.5), ..Camera::default() };
    scene(Mesh::new(positions, tex_coords, vec![], triangles), camera)
}

/// Two triangles to the horizon.
fn floor() -> Scene {
    let at = [(-32.0, 32.0), (32.0, 32.0), (32.0, -32.0), (-32.0, -32.0)];
    let positions = at.map(|(x, z)| Vec3::new(x, 0.0, z)).to_vec();
    let tex_coords = at.map(|(x, z)| Vec2::new(x, -z)).to_vec();
    let camera = Camera { eye: Vec3::new(0.0, 1.6, 6.0), target: Vec3::new(0.0, 0.6, 0.0), ..Camera::default() };
    scene(Mesh::new(positions, tex_coords, vec![], vec![[0, 1, 2], [0, 2, 3]]), camera)
}

fn scene(mesh: Mesh, camera: Camera) -> Scene {
    Scene { meshes: vec![mesh], materials: vec![Material::default()], camera, ..Scene::default() }
}

fn scenes() -> [(&'static str, Scene); 3] {
    [("100k_triangles", terrain(223)), ("1m_triangles", terrain(707)), ("floor", floor())]
}

fn flat(block: &QuadBlock, colors: &mut Vec<[PixelLanes; 3]>) {
    colors.extend(block.pairs().map(|pair| [pair.uv[0], pair.uv[1], pair.view[2]]));
}

fn geometry(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("geometry");
    let settings = Settings::default();
    for (name, scene) in scenes() {
        group.throughput(Throughput::Elements(scene.meshes[0].triangles.len() as u64));
        let mut geometry = Geometry::default();
        group.bench_function(format!("setup/{name}"), |b| b.iter(|| geometry.project(black_box(&scene), &settings)));
    }
    group.finish();
}

fn raster(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("raster");
    group.sample_size(20);
    let settings = Settings::default();
    for (name, scene) in scenes() {
        let geometry = project(&scene, &settings);
        let mut bins = Bins::default();
        group.bench_function(format!("binning/{name}"), |b| {
            b.iter(|| bins.fill(black_box(&geometry), &TileGrid::new(&settings)));
        });
        group.bench_function(format!("coverage/{name}"), |b| b.iter(|| hit_counts(black_box(&geometry), &settings)));
        let mut rasterizer = Rasterizer::default();
        let mut frame = Frame { width: 0, height: 0, pixels: vec![] };
        for msaa in [1, 4, 8] {
            let settings = Settings { msaa, ..settings.clone() };
            let geometry = project(&scene, &settings);
            group.bench_function(format!("draw_msaa{msaa}/{name}"), |b| {
                b.iter(|| rasterizer.draw(black_box(&geometry), &scene, &settings, &flat, &mut frame));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, geometry, raster);
criterion_main!(benches);
