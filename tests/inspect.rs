//! What the inspector says of a pixel: the paper's figures by their sets, the cut by its sums, the
//! views of whole frames.

mod common;
#[path = "common/displaced.rs"]
mod displaced;

use basrelief::footprint::Ellipse;
use basrelief::inspect::{self, Cut, Figure, Inspection, View, measure};
use basrelief::relief::HeightField;
use basrelief::texture::{Surface, Wrap};
use basrelief::{
    Derivatives, Filter, FootprintRule, Formulas, Layer, Light, Lighting, Renderer, Scene,
    Settings, Visible, reference, scene,
};
use glam::Vec3;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

fn figure(number: usize) -> (Figure, Inspection) {
    let figure = Figure::ALL[number - 1];
    (
        figure,
        inspect::pixel(&figure.scene(), &figure.settings(), figure.pixel())
            .expect("the pixel sees the street"),
    )
}

fn street() -> Arc<Surface> {
    scene::builtin().materials[0].surface.clone().expect("the street has a surface")
}

fn set(texels: &[[i32; 2]]) -> BTreeSet<[i32; 2]> {
    texels.iter().copied().collect()
}

/// The texels of the reference's ellipse, apart from those within rounding of its edge: inside, and
/// inside or near.
fn reference_texels(seen: &Inspection, projected: &inspect::Projected) -> [BTreeSet<[i32; 2]>; 2] {
    let hit = [0, 1].map(|i| f64::from(seen.ray.hit[i] * seen.sets.texels_per_repeat[i]));
    let near = reference::texels(&reference::Conic::from(&projected.widened), hit, 1e-3);
    let inside = near.iter().filter(|(_, r2)| *r2 < 1.0 - 1e-3).map(|(texel, _)| *texel).collect();
    [inside, near.into_iter().map(|(texel, _)| texel).collect()]
}

#[test]
fn figure_1_the_ray_meets_no_relief_before_the_hit() {
    let (_, seen) = figure(1);
    let field = HeightField::new(&street());
    let texels = seen.sets.texels_per_repeat.map(f64::from);
    // How far the ray is above the relief at a part of the relief depth.
    let gap = |depth: f64| {
        let [u, v] = [0, 1]
            .map(|i| f64::from(seen.ray.base[i]) + f64::from(seen.ray.displacement[i]) * depth);
        1.0 - depth - field.height_at(u * texels[0], v * texels[1])
    };
    let hit = f64::from(seen.ray.hit_depth);
    assert!(hit > 0.1 && hit < 0.9, "the figure shows a hit within the relief: {hit}");
    assert!(
        (0..2000).all(|i| gap(hit * f64::from(i) / 2000.0) > -1e-3),
        "the ray is above the relief before the hit"
    );
    assert!(gap(hit).abs() < 2e-3, "and on it at the hit: {}", gap(hit));
    for i in 0..2 {
        let moved = seen.ray.base[i] + seen.ray.displacement[i] * seen.ray.hit_depth;
        assert_eq!(moved, seen.ray.hit[i], "the coordinates are displaced by the depth of the hit");
    }
}

#[test]
fn figure_2_the_texels_are_those_of_formula_2() {
    let (_, seen) = figure(2);
    assert_eq!(seen.ray.hit, seen.ray.base, "without parallax nothing is displaced");
    let [inside, near] = reference_texels(&seen, &seen.readings[0].flat);
    let all = set(&seen.sets.all);
    assert!(all.is_superset(&inside) && all.is_subset(&near));
    assert!(seen.sets.hidden.is_empty() && seen.sets.visible == seen.sets.all);
    let [short, long] = seen.readings[0].flat.half_axes;
    assert!(long > 3.0 * short, "the projection is a long ellipse: {long} and {short}");
}

#[test]
fn figure_3_the_relief_changes_shape_and_area() {
    let ((_, flat), (_, seen)) = (figure(2), figure(3));
    let [inside, near] = reference_texels(&seen, &seen.readings[0].relief);
    let all = set(&seen.sets.all);
    assert!(all.is_superset(&inside) && all.is_subset(&near));
    assert_ne!(all, set(&flat.sets.all));
    let ratio = seen.readings[0].relief.area / flat.readings[0].flat.area;
    assert!(!(0.67..1.5).contains(&ratio), "the area changes visibly: {ratio}");
    assert_eq!(
        flat.readings[0].flat.dx, seen.readings[0].flat.dx,
        "formula (2) knows nothing of the relief"
    );
}

/// Every texel of T by a ray of the reference, which decides all but ties.
fn check_visibility(seen: &Inspection) {
    let surface = street();
    let level = &surface.levels()[seen.sets.level];
    let displacement = seen.sets.displacement.map(f64::from);
    for (texels, is_hidden) in [(&seen.sets.visible, false), (&seen.sets.hidden, true)] {
        for &texel in texels {
            let margin = reference::ray_margin(level, texel, displacement);
            let is_tie = margin.abs() <= reference::RAY_TIE;
            assert!(is_tie || (margin > 0.0) == is_hidden, "{texel:?}: {margin}");
        }
    }
}

#[test]
fn figure_4_a_part_of_the_ellipse_is_hidden() {
    let (_, seen) = figure(4);
    check_visibility(&seen);
    let (visible, hidden) = (set(&seen.sets.visible), set(&seen.sets.hidden));
    assert!(visible.is_disjoint(&hidden) && !visible.is_empty());
    assert_eq!(&visible | &hidden, set(&seen.sets.all), "T is T_vis and T_invis");
    assert!(hidden.len() * 4 > seen.sets.all.len(), "much of it is hidden: {}", hidden.len());
}

#[test]
fn figure_5_each_texel_that_must_not_count_has_a_visible_one_before_it() {
    let (_, seen) = figure(5);
    check_visibility(&seen);
    let covered: BTreeSet<_> = seen.sets.covered_by.iter().map(|pair| pair[0]).collect();
    assert!(!covered.is_empty());
    assert_eq!(covered, set(&seen.sets.hidden));
    let [dx, dy] = seen.cut.direction;
    let surface = street();
    for [texel, coverer] in &seen.sets.covered_by {
        let way = [0, 1].map(|i| f64::from(coverer[i] - texel[i]));
        let towards_eye = -(way[0] * dx + way[1] * dy);
        let aside = (way[0] * dy - way[1] * dx).abs();
        assert!(towards_eye > 0.0, "{texel:?} is covered from behind, by {coverer:?}");
        // A chain of coverers may step aside by a texel at each link.
        assert!(aside <= towards_eye, "{texel:?} is covered from aside, by {coverer:?}");
        let margin =
            reference::ray_margin(surface.base(), *coverer, seen.sets.displacement.map(f64::from));
        assert!(margin <= reference::RAY_TIE, "what is seen in its place is visible: {coverer:?}");
    }
}

#[test]
fn figure_6_texels_count_twice_where_a_hidden_one_leads_to_them() {
    let (_, seen) = figure(6);
    let visible = set(&seen.sets.visible);
    let mut expected: BTreeMap<[i32; 2], u32> = BTreeMap::new();
    for [_, coverer] in seen.sets.covered_by.iter().filter(|pair| visible.contains(&pair[1])) {
        *expected.entry(*coverer).or_insert(1) += 1;
    }
    let counted: BTreeMap<_, _> = seen.sets.counted_twice.iter().copied().collect();
    assert_eq!(counted, expected);
    assert!(counted.len() >= 3, "the figure shows some: {}", counted.len());
}

#[test]
fn readings_are_the_references_formulas() {
    for number in [2, 3, 5] {
        let (_, seen) = figure(number);
        for reading in &seen.readings {
            for (projected, derivatives) in
                [(&reading.flat, Derivatives::Flat), (&reading.relief, Derivatives::Relief)]
            {
                let [left, right] = reading.row;
                let [upper, lower] = reading.column;
                let of = |here: inspect::Corner, other: inspect::Corner| {
                    let uv = [here.uv, other.uv, other.uv];
                    let offsets = [here.offset, other.offset, other.offset];
                    let rule = FootprintRule {
                        derivatives,
                        formulas: reading.formulas,
                        ..FootprintRule::FLAT
                    };
                    reference::derivatives(uv, offsets, &rule)
                };
                let ([ux, vx, ..], [.., uy, vy]) = (of(left, right), of(upper, lower));
                assert_eq!((projected.dx, projected.dy), ([ux, vx], [uy, vy]), "{reading:?}");
                let texels = seen.sets.texels_per_repeat;
                let scaled =
                    [ux * texels[0], vx * texels[1], uy * texels[0], vy * texels[1]].map(f64::from);
                let expected = reference::Conic::new(scaled, reading.formulas);
                let Ellipse { a, b, c, f } = projected.conic;
                for (ours, theirs) in
                    [(a, expected.a), (b, expected.b), (c, expected.c), (f, expected.f)]
                {
                    let scale = expected.a.abs().max(expected.c.abs()).max(expected.f.abs());
                    assert!((f64::from(ours) - theirs).abs() <= 1e-5 * scale, "{ours} {theirs}");
                }
            }
        }
        assert_ne!(
            seen.readings[0].relief.conic, seen.readings[1].relief.conic,
            "the slips in print change the ellipse"
        );
        assert_eq!(seen.readings.map(|r| r.formulas), [Formulas::Meant, Formulas::Printed]);
    }
}

/// Pixels of the street at several distances.
fn pixels() -> impl Iterator<Item = Inspection> {
    let scene = scene::builtin();
    let settings = Settings { width: 320, height: 180, ..Settings::default() };
    let places = [[20, 175], [61, 160], [103, 150], [200, 170], [301, 179], [40, 130], [280, 140]];
    places
        .into_iter()
        .map(move |pixel| inspect::pixel(&scene, &settings, pixel).expect("the street"))
}

#[test]
fn visible_lengths_add_up_to_the_ellipse() {
    for seen in pixels() {
        let Cut { ellipse: [entry, exit], points, .. } = &seen.cut;
        let sum: f64 = points.iter().map(|point| point.visible).sum();
        assert!((sum - (exit - entry)).abs() < 1e-9, "{:?}: {sum} of {}", seen.pixel, exit - entry);
        assert!(points.windows(2).all(|p| p[1].horizon >= p[0].horizon && p[1].along > p[0].along));
        assert!(
            points.iter().all(|p| p.visible >= 0.0
                && (0.0..=1.0).contains(&p.depth)
                && p.projected <= p.along)
        );
        let [num_seen, num] = seen.cut.num_seen();
        assert!(num_seen >= 1 && num_seen <= num);
    }
}

#[test]
fn the_horizon_passes_the_ray_where_the_ray_hits() {
    for seen in pixels().filter(|seen| seen.sets.level == 0) {
        // The first row that is seen at or behind the ray's place on the polygon.
        let first = seen
            .cut
            .points
            .iter()
            .find(|point| point.projected >= 0.0)
            .expect("the walk ends behind the hit");
        let [along, _] = seen.cut.hit;
        let row = seen.cut.points[1].along - seen.cut.points[0].along;
        assert!(
            along <= first.along + 0.1 * row && along >= first.along - 1.5 * row,
            "{along} and {}",
            first.along
        );
    }
}

#[test]
fn flat_relief_hides_nothing() {
    let scene = common::floor_scene(common::flat_surface(64, 64, Wrap::Repeat, 3), 1.0);
    let settings = Settings { width: 64, height: 36, ..Settings::default() };
    let seen = inspect::pixel(&scene, &settings, [30, 30]).unwrap();
    assert!(
        seen.sets.hidden.is_empty()
            && seen.sets.counted_twice.is_empty()
            && seen.sets.skipped.is_empty()
    );
    assert_eq!((seen.ray.hit, seen.ray.hit_depth, seen.relief_depth), (seen.ray.base, 0.0, 0.0));
    assert!(seen.cut.points.iter().all(|point| point.depth == 0.0));
}

#[test]
fn what_cannot_be_inspected_is_named() {
    let scene = scene::builtin();
    let settings = Settings { width: 64, height: 36, ..Settings::default() };
    for (pixel, reason) in
        [([5, 2], "sees no surface"), ([64, 0], "outside the frame of 64x36"), ([0, 36], "outside")]
    {
        let text = inspect::pixel(&scene, &settings, pixel).unwrap_err().to_string();
        assert!(
            text.contains(&format!("pixel {},{}", pixel[0], pixel[1])) && text.contains(reason),
            "{text}"
        );
    }
    let plain = Scene { materials: vec![basrelief::Material::default(); 2], ..scene };
    let text = inspect::pixel(&plain, &settings, [20, 34]).unwrap_err().to_string();
    assert!(text.contains("without texture coordinates"), "{text}");
}

#[test]
fn views_say_of_a_pixel_what_the_inspector_says() {
    let scene = scene::builtin();
    let filter = Filter::Visible(Visible { max_stretch: 0.0, ..Visible::default() });
    let settings = Settings { width: 80, height: 45, filter, ..Settings::default() };
    let of = |view| measure(&scene, &settings, view).unwrap();
    let (visible, footprint, mip, uv) =
        (of(View::Visible), of(View::Footprint), of(View::Mip), of(View::Uv));
    let mut num = 0;
    for (i, value) in visible.pixels.iter().enumerate().step_by(37) {
        let pixel = [i as u32 % 80, i as u32 / 80];
        let Ok(seen) = inspect::pixel(&scene, &settings, pixel) else {
            assert_eq!(*value, None, "{pixel:?}");
            continue;
        };
        num += 1;
        let sets = &seen.sets;
        assert_eq!(
            value.unwrap()[..2],
            [sets.visible.len() as f32 / sets.all.len() as f32, sets.all.len() as f32]
        );
        assert_eq!(mip.pixels[i].unwrap()[0], sets.level as f32);
        assert_eq!(uv.pixels[i].unwrap()[..2], seen.ray.hit);
        let area = footprint.pixels[i].unwrap()[0];
        assert!(sets.level > 0 || (area / seen.readings[0].relief.area - 1.0).abs() < 1e-5);
    }
    assert!(num > 20, "the scene covers much of the frame: {num}");
}

#[test]
fn views_of_geometry_are_right_on_a_floor() {
    let scene = common::floor_scene(common::flat_surface(64, 64, Wrap::Repeat, 3), 1.0);
    let settings = Settings { width: 64, height: 36, msaa: 4, ..Settings::default() };
    let of = |view| measure(&scene, &settings, view).unwrap().pixels;
    let (normal, depth, uv, coverage) =
        (of(View::Normal), of(View::Depth), of(View::Uv), of(View::Coverage));
    let camera = scene.camera;
    let [right, up, forward] = camera.axes();
    let focal = camera.on_frame(64, 36).fx;
    let mut num = 0;
    for i in (0..64 * 36).filter(|&i| depth[i].is_some()) {
        let [x, y] = [(i % 64) as f32 + 0.5 - 32.0, (i / 64) as f32 + 0.5 - 18.0];
        let way = forward + (right * x - up * y) / focal;
        let place = camera.eye + way * depth[i].unwrap()[0];
        assert!(place.y.abs() < 1e-2, "the floor lies at height 0: {place}");
        let [u, v, _] = uv[i].unwrap();
        assert!((u - place.x).abs() < 2e-2 && (v + place.z).abs() < 2e-2, "{u} {v} {place}");
        assert_eq!(normal[i], Some([0.0, 1.0, 0.0]));
        assert!(coverage[i].is_some());
        num += 1;
    }
    assert!(num > 800);
    assert!(
        coverage.iter().flatten().any(|c| c[0] == 2.0),
        "the diagonal's pixels see both triangles"
    );
    assert!(
        coverage.iter().flatten().any(|c| c[1] < 1.0),
        "the skyline's pixels are covered in part"
    );
}

#[test]
fn relief_moves_the_depth_behind_the_polygon() {
    let scene = common::floor_scene(common::rough_surface(64, 64, Wrap::Repeat, 5), 1.0);
    let of = |parallax| {
        let settings = Settings { width: 64, height: 36, parallax, ..Settings::default() };
        measure(&scene, &settings, View::Depth).unwrap().pixels
    };
    let (flat, relief) = (of(false), of(true));
    let pairs: Vec<_> =
        flat.iter().flatten().zip(relief.iter().flatten()).map(|(f, r)| (f[0], r[0])).collect();
    assert!(
        pairs.iter().all(|(flat, relief)| relief >= flat)
            && pairs.iter().any(|(flat, relief)| *relief > flat * 1.01)
    );
    // The relief is a tenth of a unit deep, and the eye 1.6 above the floor: the way grows by a
    // sixteenth at the most.
    assert!(pairs.iter().all(|(flat, relief)| *relief <= flat * (1.0 + 0.1 / 1.6 + 1e-3)));
}

/// Past outlines, too, views and the inspector see what frames and layers see.
#[test]
fn views_and_pixels_look_past_outlines() {
    let torus = displaced::torus([48, 24]);
    let scene = displaced::scene(torus, common::cobbles(48, 2), 3.4);
    for silhouette in [true, false] {
        let settings = Settings {
            width: 96,
            height: 64,
            silhouette,
            filter: Filter::Nearest,
            ..Settings::default()
        };
        let of = |view| measure(&scene, &settings, view).unwrap().pixels;
        let (depth, uv, normal) = (of(View::Depth), of(View::Uv), of(View::Normal));
        let mut renderer = Renderer::new(scene.clone(), settings.clone()).expect("a valid scene");
        let layers = renderer.render_layers(&Layer::ALL);
        let mut num = 0;
        for i in 0..96 * 64 {
            let triangle = layers.ids(Layer::Triangle)[i];
            assert_eq!(depth[i].is_some(), triangle != u32::MAX, "pixel {i}");
            let Some([distance, ..]) = depth[i] else { continue };
            let expected = layers.floats(Layer::Depth)[i];
            assert!((distance - expected).abs() < 2e-4, "pixel {i}: {distance}, not {expected}");
            let same = |found: Option<[f32; 3]>, layer: Layer| {
                let num = layer.num_channels();
                let expected = &layers.floats(layer)[num * i..num * (i + 1)];
                found.unwrap().iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-3)
            };
            // Bent rays of what is not followed find places near those of straight ones.
            assert!(!silhouette || same(uv[i], Layer::Uv), "pixel {i}");
            assert!(!silhouette || same(normal[i], Layer::Normal), "pixel {i}");
            if i % 53 == 0 {
                num += 1;
                let pixel = [i as u32 % 96, i as u32 / 96];
                let seen = inspect::pixel(&scene, &settings, pixel).expect("a surface");
                assert_eq!(seen.triangle, triangle as usize, "pixel {i}");
                assert_eq!(seen.ray.hit, uv[i].unwrap()[..2], "pixel {i}");
            }
        }
        assert!(num > 20, "{num} pixels");
    }
}

#[test]
fn the_horizon_sees_all_of_what_is_flat() {
    let scene = common::floor_scene(common::flat_surface(64, 64, Wrap::Repeat, 3), 1.0);
    let settings = Settings { width: 64, height: 36, ..Settings::default() };
    for view in [View::Horizon, View::Visible] {
        let pixels = measure(&scene, &settings, view).unwrap().pixels;
        assert!(pixels.iter().flatten().all(|value| value[0] > 0.999), "{view:?}");
    }
}

#[test]
fn inspected_pixels_say_what_light_reaches_them() {
    let mut scene = scene::builtin();
    scene.lights = vec![
        Light::Point { position: Vec3::new(0.0, 0.4, 0.0), intensity: Vec3::splat(1e-3) },
        Light::sun(Vec3::new(-0.45, 0.577, -0.9), Vec3::ONE),
    ];
    let lit = Settings { width: 64, height: 36, lighting: Lighting::Lit, ..Settings::default() };
    let [shadow, light, open] = [View::Shadow, View::Light, View::Occlusion]
        .map(|view| measure(&scene, &lit, view).expect("a valid scene"));
    let (mut num_dark, mut num_cuts) = (0, 0);
    for y in 0..36 {
        for x in 0..64 {
            let i = y * 64 + x;
            let [Some([part, ..]), Some(shown), Some([open, ..])] =
                [shadow.pixels[i], light.pixels[i], open.pixels[i]]
            else {
                continue;
            };
            assert!((0.0..=1.0).contains(&part) && (0.0..=1.0).contains(&open), "{part} {open}");
            num_dark += usize::from(part < 0.5);
            if (x + 3 * y) % 41 > 0 {
                continue;
            }
            // The same by inspection of the pixel.
            let Ok(seen) = inspect::pixel(&scene, &lit, [x as u32, y as u32]) else { continue };
            let seen = seen.light.expect("light");
            let found = (seen.reaching.shown(), seen.reaching.part(), seen.reaching.open);
            let is_near = (found.0 - Vec3::from(shown)).abs().max_element() < 0.02;
            assert!(is_near && (found.1 - part).abs() < 0.02 && (found.2 - open).abs() < 0.02);
            let Some(cut) = seen.cut else { continue };
            let sent = |i: usize| seen.reaching.lights[i].sent.element_sum();
            assert_eq!(seen.main, Some(usize::from(sent(1) > sent(0))), "the one that sends most");
            assert!(cut.points.windows(2).all(|pair| pair[0].horizon <= pair[1].horizon));
            num_cuts += 1;
        }
    }
    assert!(num_dark > 50 && num_cuts > 10, "{num_dark} pixels in shadow, {num_cuts} cuts");
    let unlit = Settings { lighting: Lighting::Unlit, ..lit };
    assert!(inspect::pixel(&scene, &unlit, [32, 30]).expect("a surface").light.is_none());
}
