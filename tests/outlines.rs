//! Relief with an outline and a depth, against the same relief as real geometry.

mod common;
#[path = "common/displaced.rs"]
mod displaced;

use basrelief::invariants::outlines_hold;
use basrelief::relief::{HeightField, MOST_STEPS, ReliefPlace, march};
use basrelief::shell::{Met, Shell, ViewRay, Width};
use basrelief::simd::PixelLanes;
use basrelief::texture::{HeightImage, Surface, SurfaceMaps, Wrap};
use basrelief::{
    Eye, Filter, Frame, Layer, Light, Lighting, Mesh, Rays, Renderer, Scene, Settings, Sky,
};
use common::{Random, cobbles, floor_scene, rough_surface};
use displaced::{
    ball_in_stones, decibels, depths_within, displaced, overlap, scene, show, sphere, torus,
};
use glam::{DVec3, Vec2, Vec3};

/// As small as a picture may be and a stone still have some pixels.
fn settings(filter: Filter) -> Settings {
    Settings { width: 96, height: 64, filter, ..Settings::default() }
}

/// Few stones, so that they are large in small pictures.
fn stones() -> SurfaceMaps {
    cobbles(48, 2)
}

fn draw(scene: &Scene, settings: Settings) -> Frame {
    Renderer::new(scene.clone(), settings).expect("a valid scene").render()
}

fn depths(scene: &Scene) -> Vec<f32> {
    let mut renderer = Renderer::new(scene.clone(), settings(Filter::Nearest)).expect("valid");
    renderer.render_layers(&[Layer::Depth]).floats(Layer::Depth).to_vec()
}

#[test]
fn curved_reliefs_look_as_displaced_triangles_do() {
    // Overlap at least, and decibels of the horizon and of the truth. The goals at 640x360 are 0.993
    // and 40 dB for the horizon.
    for (name, mesh, distance, [least_overlap, horizon, truth]) in [
        ("torus", torus([48, 24]), 3.4, [0.998, 46.0, 54.0]),
        ("sphere", sphere([48, 24]), 2.6, [0.998, 48.5, 57.0]),
    ] {
        let scene = scene(mesh, stones(), distance);
        let shown = show(&displaced(&scene, 16), &settings(Filter::Nearest));
        for (filter, least) in
            [(Filter::default(), horizon), (Filter::Truth(Rays { samples: 64 }), truth)]
        {
            let frame = draw(&scene, settings(filter));
            let found = [overlap(&frame, &shown.coverage), decibels(&frame, &shown.colors)];
            println!("{name}: overlap {:.4}, {:.2} dB", found[0], found[1]);
            assert!(found[0] > least_overlap && found[1] > least, "{name}, {filter:?}: {found:?}");
        }
        let [u, v] = scene.meshes[0].tangents[600];
        let most = u.cross(v).length().sqrt() * 0.06 * 0.01;
        let near = depths_within(&depths(&scene), &shown.depth, most);
        println!("{name}: depth {near:.4}");
        assert!(near > 0.99, "{name}: depths of {near}");
        let polygons = draw(&scene, Settings { silhouette: false, ..settings(Filter::Nearest) });
        assert!(overlap(&polygons, &shown.coverage) < 0.985, "{name} has an outline to speak of");
    }
}

/// The first and the last point of a circle, each computed by itself, are one but for rounding.
#[test]
fn rays_cross_a_seam_that_is_rounded_twice() {
    let hollow = SurfaceMaps {
        height: Some(HeightImage::from_fn(4, 4, |_, _| 0.05)),
        albedo: cobbles(48, 2).albedo,
        relief_depth: 0.06,
        ..SurfaceMaps::default()
    };
    let whole = scene(torus([48, 24]), hollow, 3.4);
    let mut rounded = whole.clone();
    for last in 0..=24 {
        rounded.meshes[0].positions[last * 49 + 48] += Vec3::new(1e-7, -1e-7, 2e-7);
    }
    for last in 0..=48 {
        rounded.meshes[0].positions[24 * 49 + last] += Vec3::new(-1e-7, 2e-7, 1e-7);
    }
    let [whole, rounded] =
        [whole, rounded].map(|scene| draw(&scene, settings(Filter::Truth(Rays { samples: 4 }))));
    let found = [overlap(&rounded, &whole), decibels(&rounded, &whole)];
    assert!(found[0] > 0.999 && found[1] > 60.0, "overlap and decibels {found:?}");
}

/// Smooth normals turn away from the eye where the polygons of a ball of few do not: what is seen of
/// them is their front all the same.
#[test]
fn outlines_of_smooth_meshes_are_lit_from_the_side_that_is_seen() {
    let maps = SurfaceMaps { relief_depth: 0.0, ..SurfaceMaps::default() };
    let mut scene = scene(sphere([8, 16]), maps, 2.6);
    // Corners stand 43 and 88 degrees to the right of the eye, and the sun 95.
    let around = |degrees: f32| Vec3::new(degrees.cos(), 0.0, -degrees.sin());
    scene.camera.eye = around(47_f32.to_radians()) * 2.6;
    let (to_light, intensity) = (around(142_f32.to_radians()), Vec3::ONE);
    scene.lights = vec![Light::Sun { to_light, intensity, angular_size: 0.0 }];
    scene.sky = Sky::Color(Vec3::ZERO);
    assert!(scene.camera.axes()[0].dot(to_light) > 0.9, "the sun is to the right");
    for filter in [Filter::Nearest, Filter::Truth(Rays { samples: 16 })] {
        let frame = draw(&scene, Settings { lighting: Lighting::Lit, ..settings(filter) });
        let row = &frame.pixels[32 * 96..33 * 96];
        let last = row.iter().rposition(|pixel| pixel[3] > 0.5).expect("a ball");
        let [inner, outer] = [last - 6, last].map(|x| row[x][0] / row[x][3]);
        assert!(outer > inner, "{outer} at the outline, {inner} within");
    }
}

/// So do the layers: what of the ball is seen of its front faces outwards, though it leans away.
#[test]
fn layers_of_normals_face_the_side_that_is_seen() {
    let maps = SurfaceMaps { relief_depth: 0.0, ..SurfaceMaps::default() };
    let mut scene = scene(sphere([8, 16]), maps, 2.6);
    let mut count = |eye: Vec3, side: f32| {
        scene.camera.eye = eye;
        let mut renderer =
            Renderer::new(scene.clone(), settings(Filter::Nearest)).expect("a valid scene");
        let all = [Layer::PolygonNormal, Layer::Normal, Layer::PolygonPosition, Layer::Object];
        let layers = renderer.render_layers(&all);
        let vectors = |layer: Layer| layers.floats(layer).chunks(3).map(Vec3::from_slice);
        let (mut num, mut num_away) = (0, 0);
        let normals = vectors(Layer::PolygonNormal).zip(vectors(Layer::Normal));
        for ((place, normals), object) in
            vectors(Layer::PolygonPosition).zip(normals).zip(layers.ids(Layer::Object))
        {
            if *object == u32::MAX {
                continue;
            }
            num += 1;
            num_away += u32::from(normals.0.dot(place - eye) > 0.0);
            assert!(normals.0.dot(place.normalize()) * side > 0.9, "{normals:?} at {place}");
            assert!(normals.1.abs_diff_eq(normals.0, 1e-6), "{normals:?} without a map");
        }
        [num, num_away]
    };
    let [num, num_away] = count(Vec3::new(1.8, 0.0, -1.9), 1.0);
    assert!(num > 1000 && num_away > 10, "{num_away} of {num} pixels lean away");
    // From within, its back.
    let [num, _] = count(Vec3::new(0.1, 0.0, 0.1), -1.0);
    assert!(num > 5000, "{num} pixels from within");
}

/// As those of models do: their charts lie anywhere in the texture.
#[test]
fn textures_may_go_on_elsewhere_across_an_edge() {
    let whole = torus([24, 12]);
    // Each third of a quarter of the way around is a chart.
    let chart = |triangle: usize| Vec2::new(0.37, 0.21) * (triangle / 2 % 24 / 2) as f32;
    let corners: Vec<_> = whole.triangles.iter().flatten().map(|i| *i as usize).collect();
    let places = corners.iter().enumerate();
    let mesh = Mesh::new(
        corners.iter().map(|i| whole.positions[*i]).collect(),
        places.map(|(corner, i)| whole.tex_coords[*i] + chart(corner / 3)).collect(),
        corners.iter().map(|i| whole.normals[*i]).collect(),
        (0..corners.len() as u32 / 3).map(|i| [0, 1, 2].map(|corner| 3 * i + corner)).collect(),
    );
    let scene = scene(mesh, stones(), 3.4);
    let truth = draw(&scene, settings(Filter::Truth(Rays { samples: 128 })));
    let found = common::decibels(&draw(&scene, settings(Filter::default())), &truth, 1000.0);
    println!("{found:.2} dB");
    assert!(found > 45.5, "{found} dB");
}

/// Where the ball's lower half ends: pixels of it beside others.
fn lower_edge(names: &[u32], [width, height]: [usize; 2]) -> Vec<[usize; 2]> {
    let is_ball = |x: usize, y: usize| names[y * width + x] == 1;
    let places = (height / 2..height - 1).flat_map(|y| (1..width - 1).map(move |x| [x, y]));
    places
        .filter(|&[x, y]| {
            let all = is_ball(x - 1, y) && is_ball(x + 1, y) && is_ball(x, y + 1);
            is_ball(x, y) && !all
        })
        .collect()
}

/// The part of an edge from which another is no farther than one pixel.
fn within_a_pixel(edge: &[[usize; 2]], other: &[[usize; 2]]) -> f64 {
    let is_near = |[x, y]: [usize; 2]| {
        other.iter().any(|at| at[0].abs_diff(x) <= 1 && at[1].abs_diff(y) <= 1)
    };
    edge.iter().filter(|at| is_near(**at)).count() as f64 / edge.len() as f64
}

#[test]
fn a_ball_sinks_between_the_stones() {
    let scene = ball_in_stones(cobbles(64, 2));
    // The floor is large, so only its middle is cut finely enough: one more floor of that.
    let mut fine = scene.clone();
    fine.meshes[0] = {
        let grid = displaced::grid([20, 20], |x, y| {
            let at = Vec3::new(x - 0.5, 0.0, 0.5 - y) * 6.0;
            (at, Vec3::Y, Vec2::new(at.x, -at.z) * 0.5)
        });
        Mesh { material: 0, ..grid }
    };
    let edge = |scene: &Scene, silhouette: bool| {
        let settings = Settings { width: 160, height: 100, silhouette, ..Settings::default() };
        let mut renderer = Renderer::new(scene.clone(), settings).expect("a valid scene");
        let layers = renderer.render_layers(&[Layer::Object]);
        lower_edge(layers.ids(Layer::Object), [160, 100])
    };
    let [geometry, cut, polygons] =
        [edge(&displaced(&fine, 20), true), edge(&scene, true), edge(&scene, false)];
    let near = within_a_pixel(&cut, &geometry).min(within_a_pixel(&geometry, &cut));
    let by_polygons = within_a_pixel(&geometry, &polygons);
    println!("{} pixels: {near:.3}, by polygons {by_polygons:.3}", geometry.len());
    assert!(near >= 0.95, "{near} of the line where they meet");
    assert!(by_polygons < 0.9, "{by_polygons} of the line by polygons: no ball to speak of");
}

#[test]
fn a_flat_mesh_alone_is_drawn_as_without_outlines() {
    let scene = floor_scene(rough_surface(32, 16, Wrap::Repeat, 3), 0.5);
    for filter in Filter::ALL {
        let filter =
            if let Filter::Truth(_) = filter { Filter::Truth(Rays { samples: 8 }) } else { filter };
        let [with, without] = [true, false].map(|silhouette| {
            let settings = Settings { width: 48, height: 32, ..settings(filter) };
            draw(&scene, Settings { silhouette, ..settings })
        });
        assert!(with.pixels == without.pixels, "{filter:?}");
    }
}

#[test]
fn tiles_and_threads_show_nowhere() {
    let mut scene = scene(torus([24, 12]), stones(), 3.4);
    // Another ring through the first: rays pass the one and meet the other.
    let mut other = torus([24, 12]);
    for position in &mut other.positions {
        *position = Vec3::new(position.x + 1.0, -position.z, position.y);
    }
    for normal in &mut other.normals {
        *normal = Vec3::new(normal.x, -normal.z, normal.y);
    }
    scene.meshes.push(Mesh::new(other.positions, other.tex_coords, other.normals, other.triangles));
    let filters = [(Filter::default(), 1), (Filter::Nearest, 4), (Filter::Nearest, 8)];
    for (filter, msaa) in filters {
        for cull_back_faces in [false, true] {
            let settings = Settings { msaa, cull_back_faces, ..settings(filter) };
            outlines_hold(scene.clone(), settings).unwrap_or_else(|what| panic!("{what}"));
        }
    }
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| draw(&scene, settings(Filter::default())))
    };
    assert!(of(1) == of(5));
}

#[test]
fn straight_pieces_hit_what_the_march_hits() {
    let mut random = Random(5);
    for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
        for size in [[16, 16], [20, 12], [1, 7]] {
            let field = HeightField::new(&rough_surface(size[0], size[1], wrap, 7));
            for _ in 0..300 {
                let mut pair = |most: f32| [(); 2].map(|()| random.within(-most, most));
                let (base, along) = (pair(3.0), pair(1.0));
                let lanes = |pair: [f32; 2]| pair.map(PixelLanes::splat);
                let expected = march(&field, &lanes(base), &lanes(along)).as_array()[0];
                let at = |depth: f64| ReliefPlace {
                    uv: [0, 1].map(|i| f64::from(base[i]) + f64::from(along[i]) * depth),
                    depth,
                };
                // In two pieces, as prisms cut rays.
                let mut steps_left = MOST_STEPS;
                let mut hit = |from, to| field.first_hit(&at(from), &at(to), &mut steps_left);
                let first = hit(0.0, 0.3).map(|part| part * 0.3);
                let second = || hit(0.3, 1.0).map(|part| 0.3 + part * 0.7);
                let found = first.or_else(second).unwrap_or(1.0);
                assert!(
                    (found - f64::from(expected)).abs() < 2e-4,
                    "{wrap:?} {size:?}: {found}, not {expected} from {base:?} along {along:?}"
                );
            }
        }
    }
}

#[test]
fn rays_rise_from_a_ball_without_relief_to_meet() {
    // Heights are 0 all over: what is not deep enough comes out again.
    let mesh = sphere([64, 32]);
    let maps = SurfaceMaps { relief_depth: 0.1, ..cobbles(16, 2) };
    let field = HeightField::new(&Surface::new(maps).expect("valid maps"));
    let shell = Shell::new(&mesh, 0.1);
    assert!(shell.is_curved());
    let eye = DVec3::new(0.0, 0.0, 4.0);
    let seen_from = Eye { place: eye.as_vec3(), share: 1.0 };
    let (mut num_hits, mut num_passed) = (0, 0);
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        let middle = triangle.iter().fold(Vec3::ZERO, |sum, v| sum + mesh.positions[*v as usize]);
        let middle = (middle / 3.0).as_dvec3();
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
        let front = (b - a).cross(c - a).as_dvec3();
        if front.dot(eye - middle) <= 0.0 {
            continue;
        }
        let ray = ViewRay { from: eye, direction: middle - eye };
        match shell.follow(&mesh, &field, i as u32, &ray) {
            Met::Relief(hit) => {
                num_hits += 1;
                assert!(hit.distance >= 1.0 - 1e-6 && (0.0..=1.0).contains(&hit.place.depth));
                let place = eye + ray.direction * hit.distance;
                // From the middle, relief is no higher than the ball and no deeper than it may be.
                assert!((0.85..1.001).contains(&place.length()), "{hit:?} at {place}");
            }
            Met::Nothing(distance) => {
                num_passed += 1;
                assert!(distance >= 1.0 - 1e-6, "out of it before its polygon");
                assert!(shell.passable(&mesh, i as u32, seen_from).is_some(), "triangle {i}");
            }
            Met::Polygon => panic!("it has relief"),
        }
    }
    assert!(num_hits > 500 && num_passed > 10, "{num_hits} hits, {num_passed} passed");
}

/// Texture coordinates that run far make every piece of a ray long: all together are bounded, not
/// each.
#[test]
fn a_ray_takes_a_bounded_number_of_steps_over_all_its_triangles() {
    const REPEATS: f32 = 200_000.0;
    let ball = sphere([64, 32]);
    let tex_coords = ball.tex_coords.iter().map(|place| *place * REPEATS).collect();
    let mesh = Mesh::new(ball.positions, tex_coords, ball.normals, ball.triangles);
    let low = HeightImage::from_fn(4, 4, |_, _| 0.0);
    let maps = SurfaceMaps { height: Some(low), ..SurfaceMaps::default() };
    let field = HeightField::new(&Surface::new(maps).expect("valid maps"));
    // As deep in the world as a tenth with the ball's own coordinates.
    let shell = Shell::new(&mesh, 0.1 * REPEATS);
    let eye = DVec3::new(0.0, 0.0, 4.0);
    let mut num_bounded = 0;
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize].as_dvec3());
        let middle = (a + b + c) / 3.0;
        // Seen from the front, and not at a pole.
        if (b - a).cross(c - a).dot(eye - middle) <= 0.0 || middle.y.abs() > 0.5 {
            continue;
        }
        let ray = ViewRay { from: eye, direction: middle - eye };
        let follow = |most: u32| {
            let mut steps_left = most;
            let met = shell.follow_within(&mesh, &field, i as u32, (&ray, &mut steps_left));
            (met, most - steps_left)
        };
        let ((_, num_of_all), (met, num_steps)) = (follow(u32::MAX), follow(MOST_STEPS));
        assert_eq!(num_steps, num_of_all.min(MOST_STEPS), "triangle {i}: {met:?}");
        if num_steps < num_of_all {
            let Met::Relief(hit) = met else { panic!("triangle {i} ends with {met:?}") };
            num_bounded += usize::from(hit.triangle != i as u32);
            // Without a number it is that.
            let same = shell.follow(&mesh, &field, i as u32, &ray);
            assert!(matches!(same, Met::Relief(same) if same.place == hit.place), "triangle {i}");
        }
    }
    assert!(num_bounded > 10, "{num_bounded} rays end in other triangles");
}

/// Where a probe says that all rays around it hit, they do.
#[test]
fn rays_beside_a_probe_hit_what_it_hits() {
    let mesh = torus([96, 48]);
    let maps = SurfaceMaps { relief_depth: 0.06, ..cobbles(128, 4) };
    let (field, shell) =
        (HeightField::new(&Surface::new(maps).expect("valid maps")), Shell::new(&mesh, 0.06));
    let from = DVec3::new(0.0, 2.2, 2.6);
    let width = Width { per_distance: 0.004, ..Width::default() };
    let mut num_sure = 0;
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize].as_dvec3());
        let (middle, front) = ((a + b + c) / 3.0, (b - a).cross(c - a).normalize());
        let cosine = front.dot((from - middle).normalize());
        if !(0.0..0.5).contains(&cosine) {
            continue;
        }
        let forward = -from.normalize();
        // So long that all go 1 along the view.
        let ray = |to: DVec3| {
            let way = to - from;
            ViewRay { from, direction: way / way.dot(forward) }
        };
        let probed = ray(middle);
        let Met::Relief(_) = shell.probe(&mesh, &field, i as u32, (&probed, width)) else {
            continue;
        };
        num_sure += 1;
        let (x, y) = forward.any_orthonormal_pair();
        for turn in 0..12 {
            let around = displaced::direction(turn as f32 / 12.0).as_dvec2() * 0.004;
            let direction = probed.direction + x * around.x + y * around.y;
            let beside = ViewRay { from, direction };
            // Others enter the relief by another triangle, if at all.
            let sides =
                [(a, b), (b, c), (c, a)].map(|(a, b)| (a - from).cross(b - from).dot(direction));
            if sides.iter().any(|side| side.signum() != sides[0].signum()) {
                continue;
            }
            let met = shell.follow(&mesh, &field, i as u32, &beside);
            assert!(matches!(met, Met::Relief(_)), "triangle {i}, turn {turn}: {met:?}");
        }
    }
    assert!(num_sure > 100, "{num_sure} probes");
}
