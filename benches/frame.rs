//! Whole frames of the built-in scene, small, by each filter, on all processors.

use basrelief::{
    Derivatives, Ewa, Filter, Frame, Horizon, Lighting, Rays, Renderer, Settings, Trilinear,
    Visibility, Visible, scene,
};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

const WIDTH: u32 = 320;
const HEIGHT: u32 = 180;

fn frames(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("frame");
    group.sample_size(10).throughput(Throughput::Elements(u64::from(WIDTH * HEIGHT)));
    let base = Settings { width: WIDTH, height: HEIGHT, msaa: 1, ..Settings::default() };
    let with = |filter| Settings { filter, ..base.clone() };
    let flat = Ewa { derivatives: Derivatives::Flat, ..Ewa::default() };
    let two_ended = Visible { visibility: Visibility::TwoEnded, ..Visible::default() };
    let horizon = Horizon::default();
    let cases = [
        ("trilinear", with(Filter::Trilinear(Trilinear::default()))),
        ("ewa_flat", with(Filter::Ewa(flat))),
        ("ewa_relief", with(Filter::Ewa(Ewa::default()))),
        ("visible_exact", with(Filter::Visible(Visible::default()))),
        ("visible_two_ended", with(Filter::Visible(two_ended))),
        ("horizon", with(Filter::Horizon(horizon))),
        ("horizon_msaa4", Settings { msaa: 4, ..with(Filter::Horizon(horizon)) }),
        ("horizon_4_lines", with(Filter::Horizon(Horizon { lines: 4, ..horizon }))),
        ("horizon_without_tables", with(Filter::Horizon(Horizon { far_field: false, ..horizon }))),
        ("horizon_lit", Settings { lighting: Lighting::Lit, ..with(Filter::Horizon(horizon)) }),
        ("parallax_1", with(Filter::Parallax(Rays { samples: 1 }))),
        ("parallax_4", with(Filter::Parallax(Rays { samples: 4 }))),
        ("truth_16", with(Filter::Truth(Rays { samples: 16 }))),
    ];
    for (name, settings) in cases {
        let mut renderer =
            Renderer::new(scene::builtin(), settings).expect("the settings are valid");
        let mut frame: Frame = Frame::default();
        group.bench_function(name, |b| b.iter(|| renderer.render_into(&mut frame)));
    }
    group.finish();
}

criterion_group!(benches, frames);
criterion_main!(benches);
