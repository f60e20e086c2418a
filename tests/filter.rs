//! Properties of the filters over random textures, footprints and views, and the kernels against
//! the scalar reference.

mod common;

use basrelief::filter::visible::{Occlusion, TexelSet, average, remove_hidden};
use basrelief::filter::{
    Batch, Filtered, Footprint, Footprints, Prepared, Scratch, ewa, points, trilinear,
};
use basrelief::footprint::Ellipse;
use basrelief::invariants::{self, Checked};
use basrelief::reference::{self, Conic, Lines, RAY_TIE, mean, ray_margin, supersampled, texels};
use basrelief::simd::PixelLanes;
use basrelief::texture::{ColorImage, FULL, HeightImage, Surface, SurfaceMaps, Wrap};
use basrelief::{Ewa, Filter, Formulas, Horizon, Rays, Visibility, Visible};
use common::{Random, cobbles, limited_filters, with_budget, with_limit};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::sync::Arc;

/// The same cases on every run: what rounding decides must not fail one build in a thousand.
fn cases(num: u32) -> ProptestConfig {
    ProptestConfig {
        cases: num,
        rng_seed: RngSeed::Fixed(2017),
        failure_persistence: None,
        ..Default::default()
    }
}

fn broke(checked: Checked) -> Result<(), TestCaseError> {
    checked.map_err(TestCaseError::fail)
}

/// Random texels and heights, rough or in steps, of any small size.
fn maps(width: u32, height: u32, wrap: Wrap, seed: u64) -> SurfaceMaps {
    let mut random = Random(seed);
    let roughness = [0.05, 0.5, 1.0][(seed % 3) as usize];
    let albedo = ColorImage::from_fn(width, height, |_, _| [0; 3].map(|_| random.within(0.0, 1.0)));
    let heights = HeightImage::from_fn(width, height, |_, _| {
        let h = random.within(1.0 - roughness, 1.0);
        if seed.is_multiple_of(2) { h } else { (h * 4.0).round() / 4.0 }
    });
    SurfaceMaps {
        albedo: Some(albedo),
        height: Some(heights),
        wrap,
        relief_depth: 0.1,
        ..Default::default()
    }
}

fn surface(maps: SurfaceMaps) -> Surface {
    Surface::new(maps).expect("valid maps")
}

/// Maps by what they are made from, which is what a failure prints.
#[derive(Clone, Debug)]
struct Made(u32, u32, Wrap, u64);

impl Made {
    fn maps(&self) -> SurfaceMaps {
        maps(self.0, self.1, self.2, self.3)
    }

    fn surface(&self) -> Surface {
        surface(self.maps())
    }
}

fn any_maps() -> impl Strategy<Value = Made> {
    let wrap = prop::sample::select(vec![Wrap::Repeat, Wrap::Mirror, Wrap::Clamp]);
    (1_u32..13, 1_u32..13, wrap, any::<u64>()).prop_map(|(w, h, wrap, seed)| Made(w, h, wrap, seed))
}

/// Repeating square maps of a power of two, which shift and turn exactly, with depths that can be
/// halved.
fn even_maps(seed: u64) -> SurfaceMaps {
    let mut maps = maps(16, 16, Wrap::Repeat, seed);
    maps.height.as_mut().expect("heights").texels.iter_mut().for_each(|h| *h = *h & !3 | 2);
    maps
}

/// Any number that a footprint may hold.
fn any_number() -> impl Strategy<Value = f32> {
    let strange = vec![
        0.0,
        -0.0,
        1.0,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        1e30,
        -1e30,
        1e-30,
        f32::MIN_POSITIVE,
    ];
    prop_oneof![3 => -1.0_f32..1.0, 1 => -1e-4_f32..1e-4, 1 => prop::sample::select(strange), 1 => any::<f32>()]
}

fn any_pixel() -> impl Strategy<Value = Footprint> {
    let pair = || prop::array::uniform2(any_number());
    (pair(), pair(), pair(), pair())
        .prop_map(|(base, dx, dy, view)| Footprint::new(base, dx, dy, view).bounded())
}

/// A pixel with derivatives up to `reach` and a displacement up to `walk` repeats, at a 1024th of a
/// repeat.
fn pixel(reach: f32, walk: f32) -> impl Strategy<Value = Footprint> {
    let pair = |most: f32| prop::array::uniform2(-most..most);
    (pair(1.0), pair(reach), pair(reach), pair(walk)).prop_map(|(base, dx, dy, view)| {
        Footprint::new(base.map(|c| (c * 1024.0).round() / 1024.0), dx, dy, view).bounded()
    })
}

/// Any filter, near by.
fn any_filter() -> impl Strategy<Value = Filter> {
    prop::sample::select(Filter::ALL.to_vec()).prop_map(|filter| with_lines(filter, 16))
}

/// The filters that can be kept on the base level, there.
fn any_on_base_level() -> impl Strategy<Value = Filter> {
    let mut filters = Filter::ALL.to_vec();
    filters.retain(|filter| !matches!(filter, Filter::Trilinear(_) | Filter::Parallax(_)));
    prop::sample::select(filters).prop_map(base_level)
}

/// The filters to which the edges between texels do not matter, at base level where they can be
/// kept there.
fn any_smooth() -> impl Strategy<Value = Filter> {
    let mut filters = Filter::ALL.to_vec();
    filters.retain(|filter| *filter != Filter::Nearest);
    prop::sample::select(filters).prop_map(base_level)
}

/// The filter with other lines, where it has any.
fn with_lines(filter: Filter, lines: u32) -> Filter {
    match filter {
        Filter::Horizon(_) => Filter::Horizon(horizon(lines)),
        other => other,
    }
}

/// The horizon near by.
fn horizon(lines: u32) -> Horizon {
    Horizon { lines, far_field: false, ..Horizon::default() }
}

/// Base level wherever a footprint is within the caps.
fn base_level(filter: Filter) -> Filter {
    with_lines(with_budget(filter, 0), 64)
}

proptest! {
    #![proptest_config(cases(10_000))]

    #[test]
    fn ellipses_are_finite_and_bounded(pixel in any_pixel(), texels in prop::array::uniform2(1_u32..32768), limit in 1.0_f32..64.0) {
        broke(invariants::ellipse_is_bounded(&pixel, texels.map(|n| n as f32), limit))?;
    }

    #[test]
    fn colours_lie_within_the_texels(made in any_maps(), pixel in any_pixel(), filter in any_filter()) {
        broke(invariants::within_texels(&made.surface(), &pixel, &filter))?;
    }

    #[test]
    fn constant_textures_give_their_constant(seed in any::<u64>(), color in any::<[u16; 3]>(), pixel in any_pixel(), filter in any_filter()) {
        let mut maps = maps(8, 8, Wrap::Repeat, seed);
        maps.albedo = Some(ColorImage { width: 1, height: 1, texels: vec![color], scale: 1.0 });
        broke(invariants::within_texels(&surface(maps), &pixel, &filter))?;
    }

    #[test]
    fn sets_of_texels_are_the_papers(made in any_maps(), pixel in pixel(0.5, 2.0)) {
        broke(invariants::visible_sets(&made.surface(), &pixel, &Visible::default()))?;
    }

    #[test]
    fn sets_of_texels_are_the_papers_for_any_numbers(made in any_maps(), pixel in any_pixel()) {
        broke(invariants::visible_sets(&made.surface(), &pixel, &Visible::default()))?;
    }

    #[test]
    fn marches_find_the_first_hit(made in any_maps(), pixel in pixel(0.1, 2.0)) {
        broke(invariants::march_finds_first_hit(&made.surface(), &pixel))?;
    }

    #[test]
    fn records_are_what_rays_leave_visible(made in any_maps(), pixel in pixel(0.3, 1.0)) {
        broke(invariants::records_are_visible(&made.surface(), &pixel, Horizon::default().max_anisotropy))?;
    }

    #[test]
    fn anisotropy_limits_above_the_footprints_change_nothing(made in any_maps(), pixel in pixel(0.5, 1.0), filter in any_filter()) {
        let limited = |limit| with_limit(filter, limit);
        broke(invariants::anisotropy_limit_only_limits(&made.surface(), &pixel, 16.0, limited))?;
    }

    #[test]
    fn shifting_by_texels_changes_nothing(seed in any::<u64>(), pixel in pixel(0.5, 0.6), by in prop::array::uniform2(0_u32..16), filter in any_on_base_level()) {
        broke(invariants::shifted(&even_maps(seed), &pixel, &filter, by, tolerance(&filter)))?;
    }

    #[test]
    fn turning_changes_nothing(seed in any::<u64>(), pixel in pixel(0.5, 0.6), filter in any_smooth()) {
        broke(invariants::turned(&even_maps(seed), &pixel, &filter, tolerance(&filter)))?;
    }

    #[test]
    fn mirroring_changes_nothing(seed in any::<u64>(), pixel in pixel(0.5, 0.6), filter in any_smooth()) {
        broke(invariants::mirrored(&even_maps(seed), &pixel, &filter, tolerance(&filter)))?;
    }

    #[test]
    fn the_same_ellipse_gives_the_same_colour(made in any_maps(), pixel in any_pixel(), filter in any_filter()) {
        broke(invariants::same_for_same_ellipse(&made.surface(), &pixel, &filter))?;
    }

    #[test]
    fn colours_are_linear_in_the_texture(made in any_maps(), pixel in any_pixel(), filter in any_filter()) {
        let other = maps(made.0, made.1, made.2, !made.3).albedo.expect("an albedo");
        broke(invariants::linear_in_texture(&made.maps(), &other, &pixel, &filter))?;
    }

    #[test]
    fn flat_relief_hides_no_texel(made in any_maps(), height in any::<u16>(), pixel in any_pixel()) {
        broke(invariants::flat_relief_hides_nothing(&made.maps(), height, &pixel, &Visible::default()))?;
    }

    #[test]
    fn no_pixel_takes_more_texels_than_its_budget(made in any_maps(), pixel in any_pixel(), texel_budget in 0_u32..400) {
        let visible = Visible { texel_budget, ..Visible::default() };
        let ewa = Ewa { texel_budget, ..Ewa::default() };
        broke(invariants::work_is_bounded(&made.surface(), &pixel, &visible, &ewa))?;
    }

    #[test]
    fn scaling_height_and_view_changes_nothing(seed in any::<u64>(), pixel in pixel(0.5, 0.6)) {
        let horizon = horizon(64);
        let tolerance = tolerance(&Filter::Horizon(horizon));
        broke(invariants::same_when_scaled(&even_maps(seed), &pixel, &horizon, tolerance))?;
    }
}

/// Sums in another order; for the sweep also places between texels that round differently.
fn tolerance(filter: &Filter) -> f32 {
    if matches!(filter, Filter::Horizon(_)) { 1e-3 } else { 2e-5 }
}

proptest! {
    #![proptest_config(cases(10_000))]

    #[test]
    fn horizon_weights_are_a_partition(seed in any::<u64>(), wrap in prop::sample::select(vec![Wrap::Repeat, Wrap::Mirror, Wrap::Clamp]), pixel in any_pixel()) {
        broke(invariants::horizon_weights(&maps(3, 2, wrap, seed), &pixel, &horizon(16)))?;
    }
}

proptest! {
    #![proptest_config(cases(300))]

    /// So many and so long rays that bounds on the horizon decide most of them.
    #[test]
    fn large_sets_of_texels_are_the_papers(seed in any::<u64>(), wrap in prop::sample::select(vec![Wrap::Repeat, Wrap::Mirror, Wrap::Clamp]), pixel in pixel(0.7, 3.0)) {
        let visible = Visible { texel_budget: 0, ..Visible::default() };
        broke(invariants::visible_sets(&surface(maps(32, 24, wrap, seed)), &pixel, &visible))?;
    }
}

/// Found by fuzzing: a ray along the very edge of the height field's cells hit up to a texel late.
#[test]
fn marches_along_the_edges_of_cells_find_the_first_hit() {
    let heights = HeightImage::from_fn(11, 4, |x, y| 0.5 + 0.01 * (x % 3 + y) as f32);
    let surface = surface(SurfaceMaps { height: Some(heights), ..Default::default() });
    for (place, view) in [
        ([-13.625, -13.625], [-13.625, 0.0]),
        ([-13.5 / 11.0, 0.3], [0.0, 3.7]),
        ([-13.5 / 11.0, 0.3], [-1e-5, 3.7]),
    ] {
        let pixel = Footprint::new(place, [0.1, 0.0], [0.0, 0.1], view);
        invariants::march_finds_first_hit(&surface, &pixel).expect("the first hit");
    }
}

/// Found by fuzzing: under a high limit of anisotropy the half axes of a thin ellipse came from a
/// difference that cancels.
#[test]
fn a_sweep_takes_a_bounded_number_of_rows() {
    let surface = surface(maps(1, 1, Wrap::Repeat, 1));
    let prepared = Prepared::new(surface).without_far_field();
    let filter = Filter::Horizon(Horizon { max_anisotropy: 1e6, ..horizon(16) });
    for view in [0.0, 0.002, 3.0, 64.0] {
        let pixel = Footprint::new([0.9, 0.0], [0.0, 0.002], [-15.75, -15.75], [view; 2]);
        let batch =
            Batch { pixels: &[Footprints::splat(&pixel)], is_alone: true, ..Batch::default() };
        let mut found = [Filtered::default()];
        let num_rows =
            filter.colors(&prepared, &batch, &mut Scratch::default(), &mut found).num_tested;
        assert!((1..8 * 200).contains(&num_rows), "{num_rows} rows");
    }
}

/// A stored colour as a share of the brightest.
fn unit(stored: f32) -> f32 {
    stored / FULL as f32
}

/// The kernels' view of a pixel at the base level, and the reference's.
struct Case {
    surface: Surface,
    ellipse: Ellipse,
    center: [f32; 2],
    displacement: [f32; 2],
}

impl Case {
    fn new(maps: SurfaceMaps, pixel: &Footprint) -> Self {
        let surface = surface(maps);
        let texels = surface.base().texels_per_repeat();
        let ellipse = Ellipse::new(pixel, texels, Formulas::Meant).widened(64.0, Formulas::Meant);
        let scaled = |p: [f32; 2]| [p[0] * texels[0], p[1] * texels[1]];
        Self {
            center: scaled(pixel.base),
            displacement: scaled(pixel.displacement),
            surface,
            ellipse,
        }
    }

    fn conic(&self) -> Conic {
        Conic::from(&self.ellipse)
    }

    fn center(&self) -> [f64; 2] {
        self.center.map(f64::from)
    }
}

proptest! {
    #![proptest_config(cases(10_000))]

    #[test]
    fn ellipse_texels_are_the_references(pixel in pixel(0.3, 1.0)) {
        let case = Case::new(maps(16, 16, Wrap::Repeat, 1), &pixel);
        let mut set = TexelSet::default();
        set.fill_ellipse(&case.ellipse, case.center);
        // A texel's r^2 is a difference of terms as large as the squared anisotropy.
        let [short, long] = case.ellipse.squared_axes();
        let tie = f64::from(1e-5 * (1.0 + long / short));
        let expected = texels(&case.conic(), case.center(), tie);
        for (texel, r2) in &expected {
            prop_assert!(set.contains(texel[0], texel[1]) == (*r2 <= 1.0) || (r2 - 1.0).abs() < tie, "{texel:?} {r2}");
        }
        prop_assert!(set.iter().all(|texel| expected.iter().any(|(other, _)| *other == texel)));
    }

    #[test]
    fn visible_texels_are_the_references(made in any_maps(), pixel in pixel(0.3, 2.0)) {
        let case = Case::new(made.maps(), &pixel);
        let level = case.surface.base();
        let mut set = TexelSet::default();
        set.fill_ellipse(&case.ellipse, case.center);
        let all: Vec<_> = set.iter().collect();
        remove_hidden(&mut set, &Occlusion::new(level, case.displacement), Visibility::Exact);
        for texel in all {
            let margin = ray_margin(level, texel, case.displacement.map(f64::from));
            let is_visible = set.contains(texel[0], texel[1]);
            prop_assert!(is_visible == (margin <= 0.0) || margin.abs() < RAY_TIE, "{texel:?} {margin}");
        }
    }

    #[test]
    fn ewa_mean_is_the_references(made in any_maps(), pixel in pixel(0.3, 2.0)) {
        let case = Case::new(made.maps(), &pixel);
        let level = case.surface.base();
        let mut set = TexelSet::default();
        set.fill_ellipse(&case.ellipse, case.center);
        remove_hidden(&mut set, &Occlusion::new(level, case.displacement), Visibility::Exact);
        let found = average(level, &set, &case.ellipse, case.center).map(|mean| mean.color.map(unit));
        let expected = mean(level, &set.iter().collect::<Vec<_>>(), &case.conic(), case.center());
        prop_assert_eq!(found.is_some(), expected.is_some());
        if let (Some(found), Some(expected)) = (found, expected) {
            // As above, r^2 cancels, and a weight is as wrong as it is.
            let [short, long] = case.ellipse.squared_axes();
            let bound = f64::from(2e-5 + 1e-6 * long / short);
            let error = (0..3).map(|i| (f64::from(found[i]) - expected[i]).abs()).fold(0.0, f64::max);
            prop_assert!(error < bound, "{found:?} {expected:?} {error} {bound}");
        }
    }

    #[test]
    fn whole_ellipse_in_one_pass_is_the_references(made in any_maps(), pixel in pixel(0.3, 2.0)) {
        let case = Case::new(made.maps(), &pixel);
        let (conic, center) = (case.conic(), case.center());
        let [short, long] = case.ellipse.squared_axes();
        let tie = f64::from(1e-5 * (1.0 + long / short));
        let texels = texels(&conic, center, tie);
        // A texel on the edge may belong to one of the two.
        if texels.iter().all(|(_, r2)| (r2 - 1.0).abs() > tie) {
            let inside: Vec<_> = texels.iter().filter(|(_, r2)| *r2 <= 1.0).map(|(texel, _)| *texel).collect();
            let found = ewa::mean(&case.surface, &pixel, &Ewa { texel_budget: 0, ..Ewa::default() }, true).0.color.map(unit);
            if let Some(expected) = mean(case.surface.base(), &inside, &conic, center) {
                let error = (0..3).map(|i| (f64::from(found[i]) - expected[i]).abs()).fold(0.0, f64::max);
                // The fitted Gaussian is off by 2e-5, at most 2e-4 of the least weight.
                let bound = 3e-4 + f64::from(1e-6 * long / short);
                prop_assert!(error < bound, "{found:?} {expected:?} {error} {bound}");
            }
        }
    }

    #[test]
    fn trilinear_lanes_are_the_scalar_look_ups(
        made in (any_maps(), prop::sample::select(vec![1_u32, 1, 1, 5])).prop_map(|(Made(w, h, wrap, seed), scale)| Made(w * scale, h * scale, wrap, seed)),
        center in prop::array::uniform2(any_number()),
        steps in prop::array::uniform16(-0.2_f32..0.2),
        sizes in prop::array::uniform8(0.0_f32..40.0),
        is_near in any::<bool>(),
    ) {
        let surface = made.surface();
        let center = center.map(|c| if c.abs() <= 1e6 { c } else { 0.0 });
        let reach = if is_near { 0.1 } else { 100.0 };
        let place = |lane: usize| [center[0] + steps[2 * lane] * reach, center[1] + steps[2 * lane + 1] * reach];
        let lanes = |axis: usize| PixelLanes::new(std::array::from_fn(|lane| place(lane)[axis]));
        let size = |lane: usize| if is_near { 1.0 + sizes[0] + 0.02 * sizes[lane] } else { sizes[lane] };
        let mut found = vec![];
        let group = [lanes(0), lanes(1), PixelLanes::new(std::array::from_fn(size))];
        trilinear::look_up(&surface, &[group; 2], |_, color| found.push(color));
        for lane in 0..8 {
            let expected = points::trilinear(&surface, place(lane), size(lane)).color;
            prop_assert_eq!(found[1].map(|lanes| lanes.as_array()[lane]), expected, "{} {:?}", lane, place(lane));
        }
    }

}

proptest! {
    // The reference goes line by line: a case takes milliseconds.
    #![proptest_config(cases(4_000))]

    #[test]
    fn horizon_mean_is_the_references(made in any_maps(), pixel in pixel(0.5, 1.0)) {
        let surface = made.surface();
        let found = invariants::filtered(&surface, &pixel, &Filter::Horizon(horizon(64)));
        let expected = reference_lines(&surface, &pixel).mean();
        let error = (0..3).map(|i| (f64::from(found[i]) - expected[i]).abs()).fold(0.0, f64::max);
        prop_assert!(error < HORIZON_ERROR, "{found:?} {expected:?} {error}");
    }
}

/// Parallax occlusion in lanes against one ray at a time, for maps of every kind.
#[test]
fn parallax_is_the_references() {
    let mut random = Random(5);
    let (mut num, mut num_apart) = (0, 0);
    for seed in 0..300 {
        let wrap = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp][seed as usize % 3];
        // A power of two now and then: its cells are found by another rule.
        let mut side = || if seed % 2 == 0 { 16 } else { random.within(1.0, 40.0) as u32 };
        let surface = Arc::new(surface(maps(side(), side(), wrap, seed)));
        let mut pair = |most: f32| [0; 2].map(|_| random.within(-most, most));
        // Some groups of eight are on one level, others on many.
        let reach = if seed % 5 == 0 { 0.001 } else { 0.3 };
        let pixels: Vec<_> = (0..8)
            .map(|_| Footprint::new(pair(3.0), pair(reach), pair(reach), pair(0.5)))
            .collect();
        let filter = Filter::Parallax(Rays { samples: 4 });
        let found = Prepared::new(surface.clone()).colors(&filter, &pixels);
        for (pixel, found) in pixels.iter().zip(found) {
            let expected = reference::parallax(&surface, pixel, 4);
            let error = (0..3).map(|c| (f64::from(found[c]) - expected[c]).abs());
            num += 1;
            num_apart += i32::from(error.fold(0.0, f64::max) > 1e-3);
        }
    }
    // A ray that just touches the relief at a step may be taken to hit it or to pass.
    println!("{num_apart} of {num} pixels are apart");
    assert!(num_apart * 1000 < num, "{num_apart} of {num} pixels are apart");
}

/// How far the sweep may be from the reference on the same lines, of the range: the fitted integral
/// is off by 2e-4, f32 on steep relief by as much.
const HORIZON_ERROR: f64 = 2e-3;

/// The lines that the sweep takes where the settings say 64: 0.62 times as many, and then so many
/// that they fill three groups of sixteen.
fn reference_lines<'a>(surface: &'a Surface, pixel: &Footprint) -> Lines<'a> {
    let texels = surface.base().texels_per_repeat();
    let ellipse = Ellipse::new(pixel, texels, Formulas::Meant).bounded(64.0);
    let scaled = |p: [f32; 2]| [p[0] * texels[0], p[1] * texels[1]].map(f64::from);
    let (center, displacement) = (scaled(pixel.base), scaled(pixel.displacement));
    let lines = Lines {
        level: surface.base(),
        conic: Conic::from(&ellipse),
        center,
        displacement,
        spacing: 1.0,
        steps_per_row: 1,
    };
    let width = 2.0 * lines.half_width();
    Lines { spacing: width / 48.0, ..lines }.with_half_rows()
}

/// A floor's footprint: `aspect` times as long along the view as across.
fn floor_pixel(center: [f32; 2], across: f32, aspect: f32, angle: f32, walk: f32) -> Footprint {
    let (c, s) = (angle.cos(), angle.sin());
    Footprint::new(
        center,
        [-s * across, c * across],
        [c * across * aspect, s * across * aspect],
        [c * walk, s * walk],
    )
}

#[test]
fn averages_of_long_ellipses_are_close_to_many_rays() {
    let surface = surface(SurfaceMaps { height: None, ..cobbles(64, 4) });
    let mut random = Random(9);
    let mut squares = [0.0_f64; 2];
    for _ in 0..300 {
        let center = [0; 2].map(|_| random.within(0.0, 1.0));
        let angle = random.within(0.0, std::f32::consts::TAU);
        let pixel =
            floor_pixel(center, random.within(0.01, 0.1), random.within(1.0, 12.0), angle, 0.0);
        let truth = supersampled(&surface, &pixel, 24);
        for (every_texel, sum) in [true, false].into_iter().zip(&mut squares) {
            let color = invariants::filtered(
                &surface,
                &pixel,
                &Filter::Ewa(Ewa { every_texel, ..Ewa::default() }),
            );
            *sum += (0..3).map(|i| (f64::from(color[i]) - truth[i]).powi(2)).sum::<f64>() / 3.0;
        }
    }
    let [every, near_the_axis] = squares.map(|sum| (sum / 300.0).sqrt());
    println!("root mean square error: every texel {every}, near the longer axis {near_the_axis}");
    assert!(every < 0.002 && near_the_axis < 0.004, "every {every}, near the axis {near_the_axis}");
}

/// Places where an f32 tells no texels apart, on more texels than its digits.
#[test]
fn averages_far_from_the_texture_are_finite() {
    let surface = surface(maps(4096, 2, Wrap::Repeat, 3));
    for place in [1e6, -1e6, 999_999.94, 16_777.216] {
        for view in [[1.0, 0.0], [16.0, 16.0], [0.0, 1e-7]] {
            let pixel = Footprint::new([place, -place], view, [view[1], 0.003], [0.0; 2]);
            let color = invariants::filtered(&surface, &pixel, &Filter::Ewa(Ewa::default()));
            assert!(color.iter().all(|c| (0.0..=1.001).contains(c)), "{place} {view:?} {color:?}");
        }
    }
}

#[test]
fn horizon_is_close_to_many_rays_and_visible_less_so() {
    let surface = surface(cobbles(64, 4));
    let mut random = Random(9);
    let mut squares = [0.0_f64; 2];
    for _ in 0..150 {
        let center = [0; 2].map(|_| random.within(0.0, 1.0));
        let angle = random.within(0.0, std::f32::consts::TAU);
        let across = random.within(0.01, 0.1);
        let pixel =
            floor_pixel(center, across, random.within(1.0, 4.0), angle, random.within(0.0, 0.4));
        let truth = supersampled(&surface, &pixel, 24);
        let visible = Visible { texel_budget: 0, ..Visible::default() };
        for (filter, sum) in
            [Filter::Horizon(horizon(64)), Filter::Visible(visible)].iter().zip(&mut squares)
        {
            let color = invariants::filtered(&surface, &pixel, filter);
            *sum += (0..3).map(|i| (f64::from(color[i]) - truth[i]).powi(2)).sum::<f64>() / 3.0;
        }
    }
    let [horizon, visible] = squares.map(|sum| (sum / 150.0).sqrt());
    println!("root mean square error: horizon {horizon}, visible {visible}");
    assert!(horizon < 0.004 && visible > 2.0 * horizon, "horizon {horizon}, visible {visible}");
}

#[test]
fn flat_horizon_is_the_gaussian_over_bilinear_texels() {
    let mut random = Random(10);
    let (mut worst, mut worst_lines) = (0.0_f64, 0.0_f64);
    let flat = SurfaceMaps { height: None, ..maps(32, 32, Wrap::Repeat, 8) };
    let surface = surface(flat);
    for _ in 0..100 {
        let center = [0; 2].map(|_| random.within(0.0, 1.0));
        let (across, aspect) = (random.within(0.005, 0.2), random.within(1.0, 3.0));
        let pixel = floor_pixel(center, across, aspect, random.within(0.0, 6.3), 0.0);
        let found = invariants::filtered(&surface, &pixel, &Filter::Horizon(horizon(64)));
        let error = |expected: [f64; 3]| {
            (0..3).map(|i| (f64::from(found[i]) - expected[i]).abs()).fold(0.0, f64::max)
        };
        worst_lines = worst_lines.max(error(reference_lines(&surface, &pixel).mean()));
        worst = worst.max(error(supersampled(&surface, &pixel, 64)));
    }
    println!("flat: {worst_lines} from the reference's lines, {worst} from the integral");
    // The goal is 1e-5 on the lines; interpolation in 15 bits alone is worth 3e-5. Lines a texel
    // apart blur between two texels more or less, as they fall: on white noise that shows.
    assert!(worst_lines < 3e-5 && worst < 0.06, "{worst_lines} {worst}");
}

/// As Vulkan's conformance tests of anisotropy have it: a grid on a slanted plane, isotropic and
/// anisotropic close, not equal.
#[test]
fn anisotropic_is_close_to_isotropic_and_sharper() {
    let grid = ColorImage::from_fn(128, 128, |x, y| {
        [if (x / 16 + y / 16) % 2 == 0 { 0.0 } else { 1.0 }; 3]
    });
    let surface = surface(SurfaceMaps { albedo: Some(grid), ..Default::default() });
    let (mut sum, mut most) = (0.0, 0.0_f32);
    for limit in [2.0, 4.0, 8.0, 16.0] {
        for i in 0..64 {
            // w from 3.5 to 1 across 128 pixels.
            let w = 1.0 + 2.5 * i as f32 / 63.0;
            let pixel = floor_pixel([i as f32 / 64.0, 0.3], w / 128.0, w, 0.0, 0.0);
            let of = |max_anisotropy: f32| {
                invariants::filtered(
                    &surface,
                    &pixel,
                    &Filter::Ewa(Ewa { max_anisotropy, ..Ewa::default() }),
                )[0]
            };
            let error = (of(limit) - of(1.0)).abs();
            (sum, most) = (sum + error, most.max(error));
        }
    }
    assert!(sum / 256.0 < 0.05 && most > 0.02, "mean {}, most {most}", sum / 256.0);
}

/// As WebGPU's conformance tests of anisotropy have it: a checkerboard on a slanted plane, limits
/// of 16 and of 1024.
#[test]
fn limits_of_16_and_1024_are_equal_where_the_footprint_is_below() {
    let checker = ColorImage::from_fn(32, 32, |x, y| [if (x + y) % 2 == 0 { 0.0 } else { 1.0 }; 3]);
    let surface = surface(SurfaceMaps { albedo: Some(checker), ..Default::default() });
    for filter in limited_filters().map(|filter| with_lines(filter, 16)) {
        let mut num_widened = 0;
        for i in 0..200 {
            let pixel = floor_pixel(
                [0.1 * i as f32, 0.37 * i as f32],
                0.02,
                1.0 + 0.07 * i as f32,
                1.0,
                0.0,
            );
            let of = |limit| invariants::filtered(&surface, &pixel, &with_limit(filter, limit));
            assert_eq!(of(16.0), of(1024.0), "{filter:?} {i}");
            num_widened += usize::from(of(1.0) != of(16.0));
        }
        assert!(num_widened > 100, "{filter:?}: a limit of 1 changes {num_widened} of 200");
    }
}

/// A magnified line pattern: no holes between texels, no steps, no ringing.
#[test]
fn magnified_footprints_are_smooth() {
    let lines = ColorImage::from_fn(16, 16, |x, _| [if x % 4 == 0 { 1.0 } else { 0.0 }; 3]);
    let surface = surface(SurfaceMaps { albedo: Some(lines), ..Default::default() });
    for filter in limited_filters().map(|filter| with_lines(filter, 16)) {
        let step = 1.0 / 512.0;
        let at = |i: usize| {
            let pixel = Footprint::new([i as f32 * step, 0.31], [step, 0.0], [0.0, step], [0.0; 2]);
            invariants::filtered(&surface, &pixel, &filter)[0]
        };
        let row: Vec<f32> = (0..512).map(at).collect();
        // 32 pixels a texel: bilinear interpolation changes by 1/32 a pixel. The ellipse of texel
        // centres has an edge, where a texel of weight exp(-2) comes in.
        let most = if matches!(filter, Filter::Horizon(_)) { 0.04 } else { 0.2 };
        let steepest = row.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
        assert!(steepest < most, "{filter:?} changes by {steepest} from pixel to pixel");
        assert!(row.iter().all(|c| (0.0..1.00001).contains(c)), "{filter:?}");
        let texel_middle = row[16];
        assert!(texel_middle > 0.6 && row[16 + 64] < 0.1, "{filter:?} {texel_middle} {}", row[80]);
    }
}
