//! Filters: one pixel by each, near (about a texel), grazing (a long thin ellipse) and far (many texels), and the tables.

use basrelief::filter::horizon::{self, MOST_PIXELS, Patches, Scratch};
use basrelief::filter::{self, FarField, Filtered, Footprint, PixelFootprints, TexelSet, isotropic, parallax};
use basrelief::simd::f32x8;
use basrelief::texture::Surface;
use basrelief::{Settings, Visibility, scene};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

/// A pixel in texture space, in texels of the base level: across and along the view, and down to the deepest relief.
struct View {
    name: &'static str,
    across: f32,
    along: f32,
    walk: f32,
}

/// The slope of a view on a floor is about the ratio of its axes; the relief is 61 texels deep.
const VIEWS: [View; 3] = [
    View { name: "near", across: 1.0, along: 2.0, walk: 110.0 },
    View { name: "grazing", across: 4.0, along: 60.0, walk: 920.0 },
    View { name: "far", across: 24.0, along: 480.0, walk: 1230.0 },
];

/// The view's pixel at a place of the texture, and its displacement, both in repeats; turned, as most views are.
fn pixel(view: &View, center: [f32; 2]) -> (Footprint, [f32; 2]) {
    let (cos, sin) = (0.8 / 1024.0, 0.6 / 1024.0);
    let turned = |x: f32, y: f32| [x * cos - y * sin, x * sin + y * cos];
    (Footprint { center, dx: turned(view.across, 0.0), dy: turned(0.0, -view.along) }, turned(0.0, view.walk))
}

/// The sixteen by sixteen pixels from one on, all with its derivatives and displacement.
fn block(first: &Footprint, displacement: [f32; 2]) -> [PixelFootprints; MOST_PIXELS / 8] {
    let Footprint { center, dx, dy } = *first;
    std::array::from_fn(|i| {
        let (column, row) = ((i % 2 * 8) as f32, (i / 2) as f32);
        let at = |c: usize, x: usize| center[c] + dx[c] * (column + x as f32) + dy[c] * row;
        let place = |c: usize| f32x8::new(std::array::from_fn(|x| at(c, x)));
        PixelFootprints { center: [place(0), place(1)], ..PixelFootprints::splat(first, displacement) }
    })
}

/// Runs `mean` on the view's pixel, each time elsewhere in the texture.
fn everywhere<T>(bencher: &mut criterion::Bencher, view: &View, mut mean: impl FnMut(&Footprint, [f32; 2]) -> T) {
    let mut place = [0.0_f32, 0.0];
    bencher.iter(|| {
        place = [(place[0] + 0.618_034).fract(), (place[1] + 0.754_877).fract()];
        let (footprint, displacement) = black_box(pixel(view, place));
        mean(&footprint, displacement)
    });
}

fn means(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("filter");
    let settings = Settings::default();
    let scene = scene::builtin();
    let street: &Surface = scene.materials[0].surface.as_deref().expect("the street has relief");
    let far = FarField::new(street, &settings).expect("the street repeats");
    let mut set = TexelSet::default();
    for view in &VIEWS {
        let name = |filter: &str| format!("{filter}/{}", view.name);
        group.bench_function(name("nearest"), |b| everywhere(b, view, |f, _| isotropic::nearest(street, f.center)));
        group
            .bench_function(name("bilinear"), |b| everywhere(b, view, |f, _| isotropic::bilinear(street, 0, f.center)));
        group.bench_function(name("trilinear"), |b| {
            everywhere(b, view, |f, _| isotropic::trilinear(street, f.center, isotropic::longest_side(street, f)));
        });
        group.bench_function(name("parallax"), |b| {
            everywhere(b, view, |f, d| parallax::trace(street, f.center, d, parallax::texel_size(street, f, 1)));
        });
        group.bench_function(name("ewa"), |b| {
            everywhere(b, view, |f, _| filter::ewa::mean(street, f, &settings, true));
        });
        for (how, visibility) in [("exact", Visibility::Exact), ("two_ended", Visibility::TwoEnded)] {
            let settings = Settings { visibility, ..settings.clone() };
            group.bench_function(name(&format!("visible_{how}")), |b| {
                everywhere(b, view, |f, d| filter::ellipse_mean(street, f, Some(d), &settings, &mut set));
            });
        }
        group.bench_function(name("horizon"), |b| {
            everywhere(b, view, |f, d| horizon::visible_mean(street, f, d, &settings, None));
        });
        let (mut scratch, mut found) = (Scratch::default(), [Filtered::default(); MOST_PIXELS]);
        let picks: [u8; MOST_PIXELS] = std::array::from_fn(|i| i as u8);
        group.bench_function(name("horizon_256_pixels"), |b| {
            everywhere(b, view, |f, d| {
                let (pixels, num_bins) = (&block(f, d), horizon::picture_bins(&settings, false));
                let patches = Patches { surface: street, far: Some(&far), pixels, settings: &settings, num_bins };
                patches.means(&picks, &[], &mut scratch, &mut found)
            });
        });
        group.bench_function(name("far_field"), |b| everywhere(b, view, |f, d| far.mean(street, f, d, &settings)));
    }
    group.finish();
}

fn tables(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("filter");
    let scene = scene::builtin();
    let street = scene.materials[0].surface.as_deref().expect("the street has relief");
    group.sample_size(10);
    group.bench_function("far_field_build/1024", |b| b.iter(|| FarField::new(black_box(street), &Settings::default())));
    group.finish();
}

criterion_group!(benches, means, tables);
criterion_main!(benches);
