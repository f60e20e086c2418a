//! Relief: marches of eight rays to their first hits, steep, slanted and grazing, and the pyramid
//! that they descend.

use basrelief::relief::{HeightField, march};
use basrelief::scene;
use basrelief::simd::PixelLanes;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;

/// Displacements in repeats down to the deepest relief: slopes of about 0.3, 3 and 30 at a relief
/// depth of 0.06.
const VIEWS: [(&str, [f32; 2]); 3] =
    [("steep", [0.005, 0.017]), ("slanted", [0.06, 0.17]), ("grazing", [0.6, 1.7])];

fn relief(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("relief");
    let street = scene::builtin().materials[0].surface.clone().expect("the street has relief");
    group.sample_size(20);
    group.bench_function("height_field/1024", |b| b.iter(|| HeightField::new(black_box(&street))));
    let field = HeightField::new(&street);
    group.sample_size(100).throughput(Throughput::Elements(8));
    for (name, displacement) in VIEWS {
        // Two quads of pixels a texel and a half apart, each time elsewhere in the texture.
        let lanes = |step: [f32; 8]| PixelLanes::new(step) * (1.5 / 1024.0);
        let (x, y) =
            (lanes([0., 1., 0., 1., 2., 3., 2., 3.]), lanes([0., 0., 1., 1., 0., 0., 1., 1.]));
        let displacement = displacement.map(PixelLanes::splat);
        let mut place = [0.0_f32, 0.0];
        group.bench_function(format!("march/{name}"), |b| {
            b.iter(|| {
                place = [(place[0] + 0.618_034).fract(), (place[1] + 0.754_877).fract()];
                march(black_box(&field), &[x + place[0], y + place[1]], black_box(&displacement))
            });
        });
    }
    group.finish();
}

criterion_group!(benches, relief);
criterion_main!(benches);
