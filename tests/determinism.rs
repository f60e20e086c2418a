//! The same bytes for any number of threads, any tile size and any SIMD level.
//!
//! `golden/frames.txt` holds a hash a case, of the frame's f32 bits and its 8-bit bytes. After a wanted change run with
//! `BASRELIEF_ACCEPT=1` to write it anew, and look at what changed.

mod common;

use basrelief::texture::{Surface, SurfaceMaps, Wrap};
use basrelief::{
    Derivatives, Filter, Formulas, Frame, Light, Lighting, Material, Mesh, Region, Renderer, Scene, Settings,
    Visibility,
};
use common::{cobbles, floor_scene};
use glam::{Vec2, Vec3};
use std::sync::Arc;

const FILTERS: [Filter; 8] = [
    Filter::Nearest,
    Filter::Bilinear,
    Filter::Trilinear,
    Filter::Ewa,
    Filter::Visible,
    Filter::Horizon,
    Filter::Parallax,
    Filter::Truth,
];

/// A relief floor of `size` texels, a mirrored relief wall that cuts it, and a plain triangle, under two lights.
fn scene(wrap: Wrap, size: u32) -> Scene {
    let maps = |size, stones| SurfaceMaps { wrap, ..cobbles(size, stones) };
    let mut scene = floor_scene(Surface::new(maps(size, 4)).expect("valid maps"), 0.5);
    let wall = Surface::new(SurfaceMaps { relief_depth: 0.1, ..maps(48, 3) }).expect("valid maps");
    scene.materials[0].specular = Vec3::splat(0.4);
    scene.materials.push(Material {
        surface: Some(Arc::new(wall)),
        diffuse: Vec3::new(1.0, 0.7, 0.5),
        ..Material::default()
    });
    scene.materials.push(Material { diffuse: Vec3::new(0.2, 0.3, 0.8), ..Material::default() });
    let corners = [[-2.0, -0.5, 1.5], [1.5, -0.5, -1.0], [1.5, 2.0, -1.0], [-2.0, 2.0, 1.5]].map(Vec3::from).to_vec();
    let tex_coords = [[1.5, 0.0], [0.0, 0.0], [0.0, 1.2], [1.5, 1.2]].map(Vec2::from).to_vec();
    let mut wall = Mesh::new(corners, tex_coords, vec![], vec![[0, 1, 2], [0, 2, 3]]);
    wall.material = 1;
    let corners = [[0.5, 0.2, 3.0], [2.5, 0.2, 2.0], [1.5, 2.2, 2.0]].map(Vec3::from).to_vec();
    let mut plain = Mesh::new(corners, vec![], vec![], vec![[0, 1, 2]]);
    plain.material = 2;
    scene.meshes.extend([wall, plain]);
    scene.ambient = Vec3::splat(0.1);
    scene.background = [0.3, 0.5, 0.7, 0.5];
    scene.lights = vec![
        Light::Directional { to_light: Vec3::new(0.5, 1.0, 0.3), intensity: Vec3::splat(0.8) },
        Light::Point { position: Vec3::new(-1.0, 1.0, 3.0), intensity: Vec3::new(1.5, 1.0, 0.5) },
    ];
    scene
}

fn small(filter: Filter) -> Settings {
    Settings { width: 45, height: 37, filter, samples: 4, texel_budget: 64, msaa: 1, ..Settings::default() }
}

/// A name, what lies beyond the textures' edges, texels a side of the floor's, and settings.
type Case = (String, Wrap, u32, Settings);

/// Every filter and every option, one frame each.
fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for filter in FILTERS {
        for (lighting, msaa) in [(Lighting::Unlit, 1), (Lighting::Lit, 4)] {
            let name = format!("{filter:?} {lighting:?} msaa {msaa}");
            cases.push((name, Wrap::Repeat, 64, Settings { lighting, msaa, ..small(filter) }));
        }
    }
    let mut add = |name: &str, wrap, settings| cases.push((name.into(), wrap, 64, settings));
    for filter in [Filter::Trilinear, Filter::Ewa, Filter::Visible, Filter::Horizon] {
        add(&format!("{filter:?} mirror"), Wrap::Mirror, small(filter));
        add(&format!("{filter:?} clamp"), Wrap::Clamp, small(filter));
        add(&format!("{filter:?} flat"), Wrap::Repeat, Settings { parallax: false, ..small(filter) });
        add(&format!("{filter:?} anisotropy 4"), Wrap::Repeat, Settings { max_anisotropy: 4.0, ..small(filter) });
    }
    for (lighting, cut) in [(Lighting::Unlit, 1.0), (Lighting::Lit, 1.5)] {
        let settings = Settings { every_texel: true, lighting, cut, ..small(Filter::Ewa) };
        add(&format!("Ewa {lighting:?}, every texel, cut {cut}"), Wrap::Repeat, settings);
    }
    let visible = small(Filter::Visible);
    add("two-ended", Wrap::Repeat, Settings { visibility: Visibility::TwoEnded, ..visible.clone() });
    add("resolved", Wrap::Repeat, Settings { visibility: Visibility::Resolved, ..visible.clone() });
    add("flat derivatives", Wrap::Repeat, Settings { derivatives: Derivatives::Flat, ..visible.clone() });
    add("printed", Wrap::Repeat, Settings { formulas: Formulas::Printed, ..visible.clone() });
    let printed = Settings { derivatives: Derivatives::Flat, formulas: Formulas::Printed, ..visible.clone() };
    add("printed, flat derivatives", Wrap::Repeat, printed);
    add("base level", Wrap::Repeat, Settings { texel_budget: 0, ..visible.clone() });
    add("culled, msaa 8", Wrap::Repeat, Settings { cull_back_faces: true, msaa: 8, ..visible });
    let horizon = small(Filter::Horizon);
    add("4 lines", Wrap::Repeat, Settings { lines: 4, ..horizon.clone() });
    add("64 lines, near field", Wrap::Repeat, Settings { lines: 64, far_field: false, ..horizon.clone() });
    let default = Settings { width: 45, height: 37, ..Settings::default() };
    add("default", Wrap::Repeat, default.clone());
    add("default, lit", Wrap::Repeat, Settings { lighting: Lighting::Lit, ..default });
    // Only maps of more than 128 x 128 texels have tables of what is seen from afar.
    cases.push(("far field".into(), Wrap::Repeat, 200, Settings { far_field_mib: 1, ..horizon.clone() }));
    cases.push(("far field, mirror".into(), Wrap::Mirror, 130, horizon));
    // Texels a side that are no power of two wrap by a division.
    for filter in [Filter::Trilinear, Filter::Ewa] {
        cases.push((format!("{filter:?}, 50 texels"), Wrap::Repeat, 50, small(filter)));
    }
    cases
}

fn draw(&(_, wrap, size, ref settings): &Case) -> Frame {
    Renderer::new(scene(wrap, size), settings.clone()).expect("a valid scene").render()
}

/// 64-bit FNV-1a of the frame's bits and of its 8-bit bytes.
fn hash(frame: &Frame) -> u64 {
    let floats = frame.pixels.iter().flatten().flat_map(|c| c.to_bits().to_le_bytes());
    let bytes = frame.to_rgba8().into_iter().flatten();
    floats.chain(bytes).fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

#[test]
fn frames_have_the_golden_bytes() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/frames.txt");
    let lines = cases().into_iter().map(|case| format!("{:016x} {}\n", hash(&draw(&case)), case.0));
    let found: String = lines.collect();
    if std::env::var_os("BASRELIEF_ACCEPT").is_some() {
        std::fs::write(path, &found).expect("the golden file can be written");
    }
    let expected = std::fs::read_to_string(path).unwrap_or_default();
    let changed: Vec<_> = found.lines().filter(|line| !expected.lines().any(|other| other == *line)).collect();
    assert!(found == expected, "BASRELIEF_ACCEPT=1 accepts on {}: {changed:#?}", basrelief::SIMD_LEVEL);
}

#[test]
fn frames_do_not_depend_on_threads_and_tiles() {
    let pools = [1, 2, 7].map(|num| rayon::ThreadPoolBuilder::new().num_threads(num).build().expect("a pool"));
    for (name, wrap, size, settings) in cases() {
        let mut renderer = Renderer::new(scene(wrap, size), settings.clone()).expect("a valid scene");
        let expected = hash(&pools[0].install(|| renderer.render()));
        for (pool, tile_size) in pools.iter().cycle().zip([8, 16, 32, 64, 128, 256]) {
            renderer.set_settings(Settings { tile_size, ..settings.clone() }).expect("valid settings");
            let found = hash(&pool.install(|| renderer.render()));
            assert_eq!(found, expected, "{name}: tiles of {tile_size}, {} threads", pool.current_num_threads());
        }
    }
}

#[test]
fn frames_of_any_size_do_not_depend_on_threads_and_tiles() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(7).build().expect("a pool");
    for (width, height) in [(1, 1), (2, 1), (1, 7), (8, 8), (9, 17), (31, 33), (65, 3)] {
        for filter in FILTERS {
            let settings = Settings { width, height, ..small(filter) };
            let case = |tile_size| (String::new(), Wrap::Repeat, 64, Settings { tile_size, ..settings.clone() });
            let expected = draw(&case(32));
            let other = pool.install(|| draw(&case(8)));
            assert!(expected == other, "{filter:?} at {width} x {height}");
        }
    }
}

#[test]
fn regions_have_the_bytes_of_their_part_of_the_frame() {
    let regions =
        [[0, 0, 45, 37], [0, 0, 1, 1], [44, 36, 1, 1], [7, 3, 11, 9], [8, 8, 8, 8], [13, 30, 32, 7], [1, 0, 3, 37]];
    for (name, wrap, size, settings) in cases() {
        let mut renderer = Renderer::new(scene(wrap, size), settings.clone()).expect("a valid scene");
        let whole = renderer.render();
        for (i, [x, y, width, height]) in regions.into_iter().enumerate() {
            let region = Some(Region { x, y, width, height });
            let tile_size = [8, 16, 32][i % 3];
            renderer.set_settings(Settings { region, tile_size, ..settings.clone() }).expect("valid settings");
            let mut expected = whole.clone();
            expected.crop(Region { x, y, width, height });
            assert!(renderer.render() == expected, "{name}: {region:?}");
        }
    }
}

#[test]
fn regions_outside_the_frame_are_refused() {
    for [x, y, width, height] in
        [[0, 0, 46, 1], [45, 0, 1, 1], [0, 30, 1, 8], [3, 3, 0, 1], [1, 1, 1, 0], [u32::MAX, 0, 2, 1]]
    {
        let region = Some(Region { x, y, width, height });
        let error = Settings { region, ..small(Filter::Nearest) }.validate().expect_err("refused").to_string();
        assert!(error.starts_with("region: "), "{error}");
    }
}
