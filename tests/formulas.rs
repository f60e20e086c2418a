//! Formulas (1), (2) and (3) as the paper prints them and as they are meant, on random cameras and
//! meshes.

mod common;

use basrelief::footprint::{Ellipse, Footprint, differences};
use basrelief::geometry::project;
use basrelief::raster::{AttributePlanes, QuadPair};
use basrelief::reference::{Conic, derivatives};
use basrelief::relief::{HeightField, displacement, march};
use basrelief::simd::PixelLanes;
use basrelief::texture::Wrap;
use basrelief::{
    Camera, Derivatives, FootprintRule, Formulas, Material, Mesh, RECONSTRUCTION, Scene, Settings,
};
use common::{Random, rough_surface};
use glam::{Vec2, Vec3};

const ALL: [FootprintRule; 4] = [
    rule(Derivatives::Flat, Formulas::Meant),
    rule(Derivatives::Flat, Formulas::Printed),
    rule(Derivatives::Relief, Formulas::Meant),
    rule(Derivatives::Relief, Formulas::Printed),
];

/// The formulas alone: a jump of the relief is a slope.
const fn rule(derivatives: Derivatives, formulas: Formulas) -> FootprintRule {
    FootprintRule { derivatives, formulas, max_stretch: 0.0, is_traced: true }
}

/// A triangle somewhere before a camera somewhere, with any texture coordinates.
fn random_scene(random: &mut Random) -> Scene {
    let mut point = |size: f32| Vec3::from([0; 3].map(|_| random.within(-size, size)));
    let positions = vec![point(2.0), point(2.0), point(2.0)];
    let eye = point(1.0) + Vec3::new(0.0, 0.0, 6.0);
    let target = point(1.0);
    let tex_coords =
        (0..3).map(|_| Vec2::new(random.within(-4.0, 4.0), random.within(-4.0, 4.0))).collect();
    Scene {
        meshes: vec![Mesh::new(positions, tex_coords, vec![], vec![[0, 1, 2]])],
        materials: vec![Material::default()],
        camera: Camera {
            eye,
            target,
            up: Vec3::Y,
            fov_degrees: random.within(20.0, 100.0),
            near: 0.01,
            ..Camera::default()
        },
        ..Scene::default()
    }
}

/// The texture coordinate and offset of one pixel, evaluated on its own: in the first lane, the
/// others elsewhere.
fn alone(planes: &AttributePlanes, field: &HeightField, [x, y]: [i32; 2]) -> ([f32; 2], [f32; 2]) {
    let lanes = |c: i32| PixelLanes::new([0.5, 9.5, 3.5, -7.5, 0.5, 40.5, 2.5, 1.5]) + c as f32;
    let (uv, view) = planes.at(lanes(x), lanes(y));
    let reach = displacement(&view, 0.1);
    let depth = march(field, &uv, &reach);
    let first = |lanes: [PixelLanes; 2]| lanes.map(|lanes| lanes.to_array()[0]);
    (first(uv), first([reach[0] * depth, reach[1] * depth]))
}

#[test]
fn quad_derivatives_are_differences_of_coordinates_to_the_bit() {
    let mut random = Random(11);
    let field = HeightField::new(&rough_surface(16, 16, Wrap::Repeat, 5));
    let settings = Settings { width: 64, height: 48, ..Settings::default() };
    let mut num_triangles = 0;
    for _ in 0..400 {
        let scene = random_scene(&mut random);
        let geometry = project(&scene, &settings);
        for triangle in geometry.triangles() {
            num_triangles += 1;
            let planes = AttributePlanes::new(&geometry, triangle, &scene, &settings);
            let mut quad = || [0, 1].map(|i| 2 * (random.bits() % [32, 24][i]) as i32);
            let origin = [quad(), quad()];
            let pair = QuadPair::new(0, origin, [1; 8], [&planes; 2]);
            let reach = displacement(&pair.view(), 0.1);
            let depth = march(&field, &pair.uv, &reach);
            for rule in ALL {
                let found = differences(&pair.uv, &[reach[0] * depth, reach[1] * depth], &rule);
                check_quads(found, &rule, |place| alone(&planes, &field, place), origin);
            }
        }
    }
    assert!(num_triangles > 100, "only {num_triangles} triangles in view");
}

fn check_quads(
    [found_dx, found_dy]: [[PixelLanes; 2]; 2],
    rule: &FootprintRule,
    at: impl Fn([i32; 2]) -> ([f32; 2], [f32; 2]),
    origin: [[i32; 2]; 2],
) {
    for lane in 0..8 {
        let [x, y] = origin[lane / 4];
        let (dx, dy) = (lane as i32 & 1, lane as i32 >> 1 & 1);
        // The x-difference in the pixel's row of the quad, the y-difference in its column.
        let along_row = [[x, y + dy], [x + 1, y + dy], [x, y + dy]].map(&at);
        let along_column = [[x + dx, y], [x + dx, y], [x + dx, y + 1]].map(&at);
        let formula = |places: [([f32; 2], [f32; 2]); 3]| {
            derivatives(places.map(|p| p.0), places.map(|p| p.1), rule)
        };
        let ([dudx, dvdx, _, _], [_, _, dudy, dvdy]) = (formula(along_row), formula(along_column));
        let expected = [dudx, dvdx, dudy, dvdy].map(|d| if d.is_finite() { d } else { 0.0 });
        let lanes = [found_dx[0], found_dx[1], found_dy[0], found_dy[1]]
            .map(|lanes| lanes.to_array()[lane]);
        assert_eq!(
            lanes.map(f32::to_bits),
            expected.map(f32::to_bits),
            "{rule:?} {lanes:?} {expected:?}"
        );
    }
}

#[test]
fn printed_formulas_are_the_papers_letters() {
    // u, v and offsets so unlike that every exchanged letter shows.
    let (uv, offsets) =
        ([[1.0, 20.0], [300.0, 4_000.0], [5e4, 6e5]], [[0.5, 0.25], [0.125, 3.0], [7.0, 11.0]]);
    let [[u, v], [u1, v1], [u2, v2]]: [[f32; 2]; 3] = uv;
    let [[m, r], [n, o], [p, s]]: [[f32; 2]; 3] = offsets;
    let [flat, flat_printed, relief, relief_printed] =
        ALL.map(|rule| derivatives(uv, offsets, &rule));
    assert_eq!(flat, [u1 - u, v1 - v, u2 - u, v2 - v]);
    assert_eq!(flat_printed, [u1 - u, v1 - u, u2 - u, v2 - u]);
    assert_eq!(
        relief,
        [(u1 + n) - (u + m), (v1 + o) - (v + r), (u2 + p) - (u + m), (v2 + s) - (v + r)]
    );
    assert_eq!(relief_printed, [u1 + n - u + m, v1 + o - u + m, u2 + p - v + r, v2 + s - v + r]);
    let lanes = |i: usize, c: usize, of: [[f32; 2]; 3]| {
        PixelLanes::new([0, 1, 2, 0, 0, 1, 2, 0].map(|pixel| of[pixel][c] * (i + 1) as f32))
    };
    for rule in ALL {
        let [dx, dy] = differences(
            &[lanes(0, 0, uv), lanes(0, 1, uv)],
            &[lanes(0, 0, offsets), lanes(0, 1, offsets)],
            &rule,
        );
        let first = [dx[0], dx[1], dy[0], dy[1]].map(|lanes| lanes.to_array()[0]);
        assert_eq!(first, derivatives(uv, offsets, &rule), "{rule:?}");
    }
}

/// Derivatives in texels of very different lengths and angles.
fn random_footprint(random: &mut Random) -> Footprint {
    let mut vector = || {
        let length = 10.0_f32.powf(random.within(-3.0, 1.0)) / 64.0;
        let angle = random.within(0.0, std::f32::consts::TAU);
        [length * angle.cos(), length * angle.sin()]
    };
    Footprint { dx: vector(), dy: vector(), ..Footprint::default() }
}

#[test]
fn ellipse_coefficients_are_those_in_f64() {
    let mut random = Random(3);
    for formulas in [Formulas::Meant, Formulas::Printed] {
        for _ in 0..20_000 {
            let footprint = random_footprint(&mut random);
            let found = Ellipse::new(&footprint, [64.0, 96.0], formulas);
            let [ux, uy] = [footprint.dx[0], footprint.dy[0]].map(|d| f64::from(d) * 64.0);
            let [vx, vy] = [footprint.dx[1], footprint.dy[1]].map(|d| f64::from(d) * 96.0);
            let Conic { a, b, c, f } = Conic::new([ux, vx, uy, vy], formulas);
            // Products of rounded products: a few units in the last place of the largest term.
            let unit = f64::from(f32::EPSILON) * 4.0;
            let near = |x: f32, y: f64, size: f64| (f64::from(x) - y).abs() <= unit * size;
            assert!(near(found.a, a, a) && near(found.c, c, c), "{found:?}");
            assert!(near(found.b, b, 2.0 * ((ux * vx).abs() + (uy * vy).abs())), "{found:?}");
            let terms = (ux * vy).abs() + (uy * vx).abs();
            assert!(near(found.f, f, terms * terms), "{found:?} {f}");
        }
    }
}

#[test]
fn widened_ellipse_is_that_in_f64() {
    let mut random = Random(4);
    let mut worst = [0.0_f64; 2];
    for _ in 0..20_000 {
        let footprint = random_footprint(&mut random);
        let max_anisotropy = random.within(1.0, 64.0);
        let found = Ellipse::new(&footprint, [64.0; 2], Formulas::Meant)
            .widened(max_anisotropy, Formulas::Meant);
        let scaled = |d: [f32; 2]| d.map(|d| f64::from(d) * 64.0);
        let ([ux, vx], [uy, vy]) = (scaled(footprint.dx), scaled(footprint.dy));
        let expected = Conic::new([ux, vx, uy, vy], Formulas::Meant).widened(
            f64::from(RECONSTRUCTION),
            f64::from(max_anisotropy),
            1.0 / 256.0,
        );
        let size = expected.a + expected.c;
        let pairs = [(found.a, expected.a), (found.b, expected.b), (found.c, expected.c)];
        worst[0] =
            pairs.iter().map(|(x, y)| (f64::from(*x) - y).abs() / size).fold(worst[0], f64::max);
        worst[1] = worst[1].max((f64::from(found.f) / expected.f - 1.0).abs());
    }
    // F is the square of a difference: where the ellipse is thin, the kernel keeps it away from
    // zero.
    assert!(worst[0] < 1e-6 && worst[1] < 1e-4, "{worst:?}");
}
