//! Light: the sweep of one direction over the street's texture, and colours baked from it.

use basrelief::light::{BakedLight, Part, TextureFrame};
use basrelief::relief::LitParts;
use basrelief::scene::{self, Light, Sky};
use criterion::{Criterion, criterion_group, criterion_main};
use glam::Vec3;
use std::hint::black_box;

fn light(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("light");
    let street = scene::builtin().materials[0].surface.clone().expect("the street has relief");
    group.sample_size(10);
    for (name, displacement) in [("along_v", [0.01, -0.1]), ("along_u", [0.1, -0.01])] {
        group.bench_function(format!("lit_parts/1024_{name}"), |b| {
            b.iter(|| LitParts::new(black_box(street.base()), displacement, street.relief_depth()));
        });
    }
    let frame = TextureFrame { tangents: [Vec3::X, Vec3::NEG_Z], normal: Vec3::Y };
    let to_light = Vec3::new(-0.62, 0.55, 0.56);
    let hard = Light::Sun { to_light, intensity: Vec3::ONE, angular_size: 0.0 };
    let dark = Sky::default();
    for (name, lights, sky) in [
        ("direction", &[hard][..], &dark),
        ("sun", &[Light::sun(to_light, Vec3::ONE)], &dark),
        ("sky", &[], &Sky::Color(Vec3::ONE)),
    ] {
        group.bench_function(format!("bake/1024_{name}"), |b| {
            b.iter(|| {
                BakedLight::new(black_box(&street), &frame, (lights, sky), None).surface(Part::All)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, light);
criterion_main!(benches);
