//! Whole frames of the built-in scene, small, by each filter, on all processors.

use basrelief::{Derivatives, Filter, Frame, Lighting, Renderer, Settings, Visibility, scene};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

const WIDTH: u32 = 320;
const HEIGHT: u32 = 180;

fn frames(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("frame");
    group.sample_size(10).throughput(Throughput::Elements(u64::from(WIDTH * HEIGHT)));
    let base = Settings { width: WIDTH, height: HEIGHT, msaa: 1, ..Settings::default() };
    let with = |filter| Settings { filter, ..base.clone() };
    let cases = [
        ("trilinear", with(Filter::Trilinear)),
        ("ewa_flat", Settings { derivatives: Derivatives::Flat, ..with(Filter::Ewa) }),
        ("ewa_relief", with(Filter::Ewa)),
        ("visible_exact", with(Filter::Visible)),
        ("visible_two_ended", Settings { visibility: Visibility::TwoEnded, ..with(Filter::Visible) }),
        ("horizon", with(Filter::Horizon)),
        ("horizon_msaa4", Settings { msaa: 4, ..with(Filter::Horizon) }),
        ("horizon_4_lines", Settings { lines: 4, ..with(Filter::Horizon) }),
        ("horizon_without_tables", Settings { far_field: false, ..with(Filter::Horizon) }),
        ("horizon_lit", Settings { lighting: Lighting::Lit, ..with(Filter::Horizon) }),
        ("parallax_1", Settings { samples: 1, ..with(Filter::Parallax) }),
        ("parallax_4", Settings { samples: 4, ..with(Filter::Parallax) }),
        ("truth_16", Settings { samples: 16, ..with(Filter::Truth) }),
    ];
    for (name, settings) in cases {
        let mut renderer = Renderer::new(scene::builtin(), settings).expect("the settings are valid");
        let mut frame: Frame = Frame::default();
        group.bench_function(name, |b| b.iter(|| renderer.render_into(&mut frame, &|| 0.0)));
    }
    group.finish();
}

criterion_group!(benches, frames);
criterion_main!(benches);
