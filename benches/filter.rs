//! Filters: one pixel by each, near (about a texel), grazing (a long thin ellipse) and far (many
//! texels), and the tables.

use basrelief::filter::visible::{self, TexelSet};
use basrelief::filter::{Batch, Filtered, Footprint, Footprints, Prepared, Scratch, ewa, points};
use basrelief::footprint::levels;
use basrelief::texture::Surface;
use basrelief::{Ewa, Filter, Horizon, Rays, Visibility, Visible, scene};
use criterion::{BatchSize, Bencher, Criterion, criterion_group, criterion_main};
use std::hint::black_box;

/// Vectors of pixels that the horizon may sweep at once.
const NUM_VECTORS: usize = 32;

/// A pixel in texture space, in texels of the base level: across and along the view, and down to
/// the deepest relief.
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

/// Where tables alone give the colour.
const BEYOND: View = View { name: "beyond", across: 48.0, along: 960.0, walk: 1230.0 };

/// The view's pixel at a place of the texture; turned, as most views are.
fn pixel(view: &View, base: [f32; 2]) -> Footprint {
    let (cos, sin) = (0.8 / 1024.0, 0.6 / 1024.0);
    let turned = |x: f32, y: f32| [x * cos - y * sin, x * sin + y * cos];
    Footprint::new(base, turned(view.across, 0.0), turned(0.0, -view.along), turned(0.0, view.walk))
}

/// The sixteen by sixteen pixels from one on, all with its derivatives and displacement.
fn block(first: &Footprint) -> [Footprints; NUM_VECTORS] {
    let Footprint { base, dx, dy, .. } = *first;
    std::array::from_fn(|i| {
        let (column, row) = ((i % 2 * 8) as f32, (i / 2) as f32);
        let place = |c: usize, x: f32| base[c] + dx[c] * (column + x) + dy[c] * row;
        let pixels: [Footprint; 8] = std::array::from_fn(|x| {
            let base = [place(0, x as f32), place(1, x as f32)];
            Footprint { base, hit: base, ..*first }
        });
        Footprints::pack(&pixels)
    })
}

/// Runs `mean` on the view's pixel, each time elsewhere in the texture.
fn everywhere<T>(bencher: &mut Bencher, view: &View, mut mean: impl FnMut(&Footprint) -> T) {
    let mut place = [0.0_f32, 0.0];
    bencher.iter(|| {
        place = [(place[0] + 0.618_034).fract(), (place[1] + 0.754_877).fract()];
        mean(&black_box(pixel(view, place)))
    });
}

/// Pixels as frames filter them.
struct Filtering<'a> {
    prepared: &'a Prepared,
    filter: Filter,
    scratch: Scratch,
    found: [Filtered; NUM_VECTORS],
}

impl<'a> Filtering<'a> {
    fn new(prepared: &'a Prepared, filter: Filter) -> Self {
        let found = [Filtered::default(); NUM_VECTORS];
        Self { prepared, filter, scratch: Scratch::default(), found }
    }

    fn run(&mut self, pixels: &[Footprints], is_alone: bool) -> Filtered {
        let batch = Batch { pixels, is_alone, ..Batch::default() };
        let found = &mut self.found[..pixels.len()];
        self.filter.colors(self.prepared, &batch, &mut self.scratch, found);
        found[0]
    }

    fn one(&mut self, pixel: &Footprint, is_alone: bool) -> Filtered {
        self.run(&[Footprints::splat(pixel)], is_alone)
    }
}

fn street() -> Prepared {
    Prepared::new(scene::builtin().materials[0].surface.clone().expect("the street has relief"))
}

fn means(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("filter");
    let prepared = street();
    let street: &Surface = prepared.surface();
    let near = prepared.without_far_field();
    let horizon = Horizon { far_field: false, ..Horizon::default() };
    let mut set = TexelSet::default();
    for view in &VIEWS {
        let name = |filter: &str| format!("{filter}/{}", view.name);
        let base = street.base();
        group.bench_function(name("nearest"), |b| {
            everywhere(b, view, |p| points::nearest(base, p.hit));
        });
        group.bench_function(name("bilinear"), |b| {
            everywhere(b, view, |p| points::bilinear(base, p.hit));
        });
        group.bench_function(name("trilinear"), |b| {
            everywhere(b, view, |p| {
                let sizes = levels::longest_sides(base, &Footprints::splat(p));
                points::trilinear(street, p.hit, sizes.as_array()[0])
            });
        });
        group.bench_function(name("parallax"), |b| {
            let mut filtering = Filtering::new(&near, Filter::Parallax(Rays { samples: 1 }));
            everywhere(b, view, |p| filtering.one(p, false));
        });
        group.bench_function(name("ewa"), |b| {
            everywhere(b, view, |p| ewa::mean(street, p, &Ewa::default(), true));
        });
        for (how, visibility) in [("exact", Visibility::Exact), ("two_ended", Visibility::TwoEnded)]
        {
            let visible = Visible { visibility, ..Visible::default() };
            group.bench_function(name(&format!("visible_{how}")), |b| {
                everywhere(b, view, |p| visible::mean(street, p, &visible, &mut set));
            });
        }
        group.bench_function(name("horizon"), |b| {
            let mut filtering = Filtering::new(&near, Filter::Horizon(horizon));
            everywhere(b, view, |p| filtering.one(p, true));
        });
        group.bench_function(name("horizon_256_pixels"), |b| {
            let mut filtering = Filtering::new(&near, Filter::Horizon(horizon));
            everywhere(b, view, |p| filtering.run(&block(p), false));
        });
    }
    let filter = Filter::default();
    assert_eq!(
        filter.level(&prepared, &pixel(&BEYOND, [0.0; 2])).far_share,
        1.0,
        "the tables give all"
    );
    group.bench_function(format!("far_field/{}", BEYOND.name), |b| {
        let mut filtering = Filtering::new(&prepared, filter);
        everywhere(b, &BEYOND, |p| filtering.one(p, false));
    });
    group.finish();
}

fn tables(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("filter");
    let street = scene::builtin().materials[0].surface.clone().expect("the street has relief");
    group.sample_size(10);
    // With what levels lose in occlusion, which tables ask for.
    group.bench_function("far_field_build/1024", |b| {
        let prepared = || Prepared::new(street.clone());
        b.iter_batched(
            prepared,
            |prepared| prepared.make_ready(&Filter::default(), false),
            BatchSize::PerIteration,
        );
    });
    group.finish();
}

criterion_group!(benches, means, tables);
criterion_main!(benches);
