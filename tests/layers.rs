//! Layers are what lies at the pixels' centres: against a plain loop over all triangles in f64,
//! against frames, and the same however the work is cut.

mod common;

use basrelief::invariants::layers_agree;
use basrelief::reference::{Ray, first_hit};
use basrelief::texture::{Surface, Wrap};
use basrelief::{
    Camera, Filter, Layer, Layers, Lighting, Material, Mesh, Region, Renderer, Scene, Settings,
};
use common::{Random, floor_scene, rough_surface};
use glam::{DVec2, DVec3, Vec3};

const SIZE: [u32; 2] = [72, 50];

fn settings() -> Settings {
    // What stands in a relief is held against real geometry in tests/outlines.rs.
    let silhouette = false;
    let [width, height] = SIZE;
    Settings { width, height, silhouette, filter: Filter::Nearest, ..Settings::default() }
}

fn render(scene: &Scene, settings: Settings, layers: &[Layer]) -> Layers {
    Renderer::new(scene.clone(), settings).expect("a valid scene").render_layers(layers)
}

/// A floor with relief under loose triangles without, some of them behind the eye.
fn scene() -> Scene {
    let mut scene = floor_scene(rough_surface(32, 16, Wrap::Repeat, 3), 0.5);
    let mut random = Random(7);
    let mut vector = || Vec3::from([0; 3].map(|_| random.within(-1.0, 1.0)));
    let positions: Vec<Vec3> = (0..20)
        .flat_map(|_| {
            let middle = Vec3::new(0.0, 1.5, 0.0) + vector() * Vec3::new(4.0, 1.4, 7.0);
            [middle + vector(), middle + vector(), middle + vector()]
        })
        .collect();
    let triangles = (0..20).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mut loose = Mesh::new(positions, vec![], vec![], triangles);
    loose.material = 1;
    scene.meshes.push(loose);
    scene.materials.push(Material { base_color: Vec3::new(0.2, 0.5, 0.7), ..Default::default() });
    scene
}

/// What a ray meets first: mesh, triangle, and its place in the triangle.
struct Met {
    mesh: usize,
    triangle: usize,
    w: f64,
    shares: [f64; 3],
}

/// The nearest triangle on the ray through a place of the screen, by a plain loop in f64.
fn meet(scene: &Scene, place: [f64; 2]) -> (DVec3, Option<Met>) {
    let Camera { eye, near, fov_degrees, .. } = scene.camera;
    let [right, up, forward] = scene.camera.axes().map(|axis| axis.as_dvec3());
    let focal = f64::from(SIZE[1]) * 0.5 / (f64::from(fov_degrees).to_radians() * 0.5).tan();
    let [x, y] = [0, 1].map(|i| (place[i] - f64::from(SIZE[i]) * 0.5) / focal);
    let ray = right * x - up * y + forward;
    let mut met: Option<Met> = None;
    for (m, mesh) in scene.meshes.iter().enumerate() {
        for (t, corners) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|i| (mesh.positions[i as usize] - eye).as_dvec3());
            let normal = (b - a).cross(c - a);
            let w = a.dot(normal) / ray.dot(normal);
            let p = ray * w;
            let shares = [(b, c), (c, a), (a, b)]
                .map(|(q, r)| (q - p).cross(r - p).dot(normal))
                .map(|share| share / normal.length_squared());
            let is_hit = shares.iter().all(|share| *share >= 0.0) && w >= f64::from(near);
            if is_hit && met.as_ref().is_none_or(|met| w < met.w) {
                met = Some(Met { mesh: m, triangle: t, w, shares });
            }
        }
    }
    (ray, met)
}

/// The same, where all within a 50th of a pixel agree: corners are snapped to 1/256.
fn meet_clearly(scene: &Scene, pixel: [u32; 2]) -> Option<(DVec3, Option<Met>)> {
    let center = pixel.map(|c| f64::from(c) + 0.5);
    let (ray, met) = meet(scene, center);
    let name = |met: &Option<Met>| met.as_ref().map(|met| (met.mesh, met.triangle));
    let is_clear = [[-0.02, 0.0], [0.02, 0.0], [0.0, -0.02], [0.0, 0.02]]
        .iter()
        .all(|d| name(&meet(scene, [center[0] + d[0], center[1] + d[1]]).1) == name(&met));
    is_clear.then_some((ray, met))
}

fn close(found: &[f32], expected: &[f64], bound: f64) -> bool {
    found.iter().zip(expected).all(|(f, e)| (f64::from(*f) - e).abs() <= bound)
}

/// Texture coordinates, and how far the ray goes on behind the polygon to its relief as a share of
/// its way, by formulas in f64.
fn hit(scene: &Scene, met: &Met, ray: DVec3) -> (DVec2, f64) {
    let mesh = &scene.meshes[met.mesh];
    if mesh.tex_coords.is_empty() {
        return (DVec2::ZERO, 0.0);
    }
    let corners = mesh.triangles[met.triangle].map(|i| i as usize);
    let uv: DVec2 = (0..3).map(|i| mesh.tex_coords[corners[i]].as_dvec2() * met.shares[i]).sum();
    // The floor is flat: any corner's frame is that of all.
    let [u, v] = mesh.tangents[corners[0]].map(|t| t.as_dvec3());
    let repeat = u.cross(v).length().sqrt();
    let way = ray * met.w;
    let gamma = -way.dot(mesh.normals[corners[0]].as_dvec3()) / repeat;
    let along = DVec2::new(way.dot(u) / u.length_squared(), way.dot(v) / v.length_squared());
    let surface: &Surface = scene.materials[mesh.material].surface.as_ref().expect("a surface");
    let depth = f64::from(surface.relief_depth());
    let moved = along * (depth / gamma);
    let relief = Ray::new(surface, uv.as_vec2().to_array(), moved.as_vec2().to_array());
    let t = first_hit(surface.base(), &relief, 64.0);
    (uv + moved * t, t * depth / gamma)
}

#[test]
fn layers_are_what_a_plain_loop_finds() {
    let scene = scene();
    let found = render(&scene, settings(), &Layer::ALL);
    let (mut num, mut num_hits, mut num_grazing) = (0, 0, 0);
    for at in 0..SIZE[0] * SIZE[1] {
        let Some((ray, met)) = meet_clearly(&scene, [at % SIZE[0], at / SIZE[0]]) else { continue };
        num += 1;
        let of = |layer: Layer| {
            let n = layer.num_channels();
            &found.floats(layer)[at as usize * n..][..n]
        };
        let name = |layer| found.ids(layer)[at as usize];
        let Some(met) = met else {
            assert_eq!((name(Layer::Object), of(Layer::Depth)), (u32::MAX, &[f32::INFINITY][..]));
            continue;
        };
        let what = format!("pixel {at} of mesh {} at {}", met.mesh, met.w);
        assert_eq!(name(Layer::Object), met.mesh as u32, "{what}");
        assert_eq!(name(Layer::Triangle), met.triangle as u32, "{what}");
        assert_eq!(name(Layer::Material), met.mesh as u32, "{what}");
        // f32 holds the plane of 1 / w to some 2^-22 of its terms, which are at most a dozen times
        // what is left of them here.
        let bound = 4e-6 * met.w * (1.0 + met.w);
        assert!(
            close(of(Layer::PolygonDepth), &[met.w], bound),
            "{what}: {found:?}",
            found = of(Layer::PolygonDepth)
        );
        let eye = scene.camera.eye.as_dvec3();
        let place = |w: f64| (eye + ray * w).to_array();
        assert!(close(of(Layer::PolygonPosition), &place(met.w), 2.0 * bound), "{what}");
        let (uv, farther) = hit(&scene, &met, ray);
        if farther == 0.0 {
            assert_eq!(of(Layer::Depth), of(Layer::PolygonDepth), "{what}");
            continue;
        }
        // A ray that grazes relief may hit it a little before or behind.
        num_hits += 1;
        let w = met.w * (1.0 + farther);
        let is_hit = close(of(Layer::Depth), &[w], 3.0 * bound + 1e-4)
            && close(of(Layer::Position), &place(w), 6.0 * bound + 1e-4)
            && close(of(Layer::Uv), &uv.to_array(), 3.0 * bound + 1e-4);
        num_grazing += u32::from(!is_hit);
    }
    assert!(num > SIZE[0] * SIZE[1] * 3 / 4, "{num} pixels are clear");
    assert!(num_hits > 800 && num_grazing * 200 <= num_hits, "{num_grazing} of {num_hits}");
}

#[test]
fn tiles_threads_and_regions_change_nothing() {
    let scene = scene();
    let settings = || Settings { silhouette: true, ..settings() };
    let whole = render(&scene, settings(), &Layer::ALL);
    for (tile_size, threads) in [(8, 1), (16, 3), (64, 2), (256, 1)] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let other =
            pool.install(|| render(&scene, Settings { tile_size, ..settings() }, &Layer::ALL));
        assert!(other == whole, "tiles of {tile_size}, {threads} threads");
    }
    let region = Region { x: 13, y: 21, width: 41, height: 19 };
    let part = render(&scene, Settings { region: Some(region), ..settings() }, &Layer::ALL);
    assert_eq!([part.width, part.height], [41, 19]);
    for layer in Layer::ALL {
        let n = layer.num_channels();
        for y in 0..19 {
            let (a, b) = (y * 41, (y + 21) * SIZE[0] as usize + 13);
            if layer.is_id() {
                assert_eq!(part.ids(layer)[a..a + 41], whole.ids(layer)[b..b + 41], "{layer:?}");
            } else {
                let [a, b] = [(&part, a), (&whole, b)]
                    .map(|(of, at)| &of.floats(layer)[n * at..n * (at + 41)]);
                assert_eq!(a, b, "{layer:?}");
            }
        }
    }
}

#[test]
fn what_else_is_asked_for_changes_nothing() {
    let scene = scene();
    let all = render(&scene, settings(), &Layer::ALL);
    for layer in Layer::ALL {
        let alone = render(&scene, settings(), &[layer, layer]);
        assert_eq!(alone.all.len(), 1);
        assert_eq!(alone.floats(layer), all.floats(layer), "{layer:?}");
        assert_eq!(alone.ids(layer), all.ids(layer), "{layer:?}");
    }
    let flat = render(&scene, Settings { parallax: false, ..settings() }, &Layer::ALL);
    assert_eq!(flat.floats(Layer::Depth), all.floats(Layer::PolygonDepth));
    assert_eq!(flat.floats(Layer::Uv), all.floats(Layer::PolygonUv));
}

#[test]
fn albedo_is_what_the_nearest_texel_draws() {
    let scene = scene();
    let mut renderer =
        Renderer::new(scene, Settings { msaa: 1, ..settings() }).expect("a valid scene");
    let frame = renderer.render();
    let layers = renderer.render_layers(&[Layer::Albedo]);
    let albedo = layers.floats(Layer::Albedo).chunks(3);
    let num_others =
        frame.pixels.iter().zip(albedo).filter(|(pixel, albedo)| pixel[..3] != **albedo).count();
    // Frames bring texture coordinates near the origin: a hit on a texel's edge may change sides.
    assert!(num_others <= 3, "{num_others} pixels differ");
    // Layers leave the renderer as it was.
    assert_eq!(renderer.render(), frame);
}

#[test]
fn layers_agree_with_each_other() {
    for lighting in [Lighting::Unlit, Lighting::Lit] {
        layers_agree(scene(), Settings { lighting, ..settings() }).expect("layers that agree");
    }
    layers_agree(basrelief::scene::builtin(), settings()).expect("layers that agree");
    // A floor through the eye, and one that ends in the near plane.
    let mut low = floor_scene(rough_surface(8, 8, Wrap::Mirror, 1), 3.0);
    low.camera = Camera { eye: Vec3::new(0.0, 1e-6, 3.0), target: Vec3::ZERO, ..low.camera };
    layers_agree(low.clone(), settings()).expect("layers that agree");
    low.camera =
        Camera { near: 5.0, ..floor_scene(rough_surface(8, 8, Wrap::Clamp, 1), 3.0).camera };
    layers_agree(low, settings()).expect("layers that agree");
}

#[test]
fn normals_of_slopes_lean_and_face_the_eye() {
    // Seen from below, where the mesh's own normal looks away.
    let mut scene = floor_scene(rough_surface(16, 16, Wrap::Repeat, 5), 0.5);
    scene.camera.eye.y = -1.6;
    let layers = render(&scene, settings(), &[Layer::PolygonNormal, Layer::CameraNormal]);
    let seen = layers.floats(Layer::PolygonNormal).chunks(3).filter(|n| **n != [0.0; 3]);
    assert!(seen.clone().count() > 500);
    seen.for_each(|n| assert_eq!(n, [0.0, -1.0, 0.0]));
    let [_, up, forward] = scene.camera.axes();
    let expected = [0.0, -Vec3::NEG_Y.dot(up), Vec3::NEG_Y.dot(forward)];
    let flat = Settings { parallax: false, ..settings() };
    scene.materials[0].surface = None;
    let layers = render(&scene, flat, &[Layer::CameraNormal]);
    let normals = layers.floats(Layer::CameraNormal).chunks(3).filter(|n| **n != [0.0; 3]);
    normals.for_each(|n| {
        assert!(Vec3::from_slice(n).abs_diff_eq(Vec3::from(expected), 1e-6), "{n:?}");
    });
}
