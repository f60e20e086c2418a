//! The same bytes for any number of threads, any tile size and any SIMD level.
//!
//! `golden/frames.txt` holds a hash a case, of the frame's f32 bits and its 8-bit bytes. After a
//! wanted change run with `BASRELIEF_ACCEPT=1` to write it anew, and look at what changed.

mod common;

use basrelief::texture::{Surface, SurfaceMaps, Wrap};
use basrelief::{
    Derivatives, Ewa, Filter, Formulas, Frame, Horizon, Light, Lighting, Material, Mesh, Rays,
    Region, Renderer, Scene, Settings, Sky, Trilinear, Visibility, Visible,
};
use common::{cobbles, floor_scene};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// A relief floor of `size` texels, a mirrored relief wall that cuts it, and a plain triangle,
/// under two lights.
fn scene(wrap: Wrap, size: u32) -> Scene {
    let maps = |size, stones| SurfaceMaps { wrap, ..cobbles(size, stones) };
    let mut scene = floor_scene(Surface::new(maps(size, 4)).expect("valid maps"), 0.5);
    let wall = Surface::new(SurfaceMaps { relief_depth: 0.1, ..maps(48, 3) }).expect("valid maps");
    scene.materials[0].specular = 1.0;
    scene.materials[0].roughness = 0.5;
    scene.materials.push(Material {
        surface: Some(Arc::new(wall)),
        base_color: Vec3::new(1.0, 0.7, 0.5),
        metallic: 0.5,
        emissive: Vec3::new(0.0, 0.0, 0.1),
        ..Material::default()
    });
    scene.materials.push(Material { base_color: Vec3::new(0.2, 0.3, 0.8), ..Material::default() });
    let corners = [[-2.0, -0.5, 1.5], [1.5, -0.5, -1.0], [1.5, 2.0, -1.0], [-2.0, 2.0, 1.5]]
        .map(Vec3::from)
        .to_vec();
    let tex_coords = [[1.5, 0.0], [0.0, 0.0], [0.0, 1.2], [1.5, 1.2]].map(Vec2::from).to_vec();
    let mut wall = Mesh::new(corners, tex_coords, vec![], vec![[0, 1, 2], [0, 2, 3]]);
    wall.material = 1;
    let corners = [[0.5, 0.2, 3.0], [2.5, 0.2, 2.0], [1.5, 2.2, 2.0]].map(Vec3::from).to_vec();
    let mut plain = Mesh::new(corners, vec![], vec![], vec![[0, 1, 2]]);
    plain.material = 2;
    scene.meshes.extend([wall, plain]);
    scene.sky = Sky::Color(Vec3::splat(0.1));
    scene.background = [0.3, 0.5, 0.7, 0.5];
    scene.lights = vec![
        Light::sun(Vec3::new(0.5, 1.0, 0.3), Vec3::splat(0.8)),
        Light::Point { position: Vec3::new(-1.0, 1.0, 3.0), intensity: Vec3::new(1.5, 1.0, 0.5) },
    ];
    scene
}

fn small(filter: Filter) -> Settings {
    Settings { width: 45, height: 37, filter, msaa: 1, ..Settings::default() }
}

/// What small frames are drawn with: less work than by default.
fn with_small_options(filter: Filter) -> (&'static str, Filter) {
    match filter {
        Filter::Nearest => ("Nearest", filter),
        Filter::Bilinear => ("Bilinear", filter),
        Filter::Trilinear(_) => ("Trilinear", filter),
        Filter::Ewa(ewa) => ("Ewa", Filter::Ewa(Ewa { texel_budget: 64, ..ewa })),
        Filter::Visible(visible) => {
            ("Visible", Filter::Visible(Visible { texel_budget: 64, ..visible }))
        }
        Filter::Horizon(_) => ("Horizon", filter),
        Filter::Parallax(_) => ("Parallax", Filter::Parallax(Rays { samples: 4 })),
        Filter::Truth(_) => ("Truth", Filter::Truth(Rays { samples: 4 })),
    }
}

/// A name, what lies beyond the textures' edges, texels a side of the floor's, and settings.
type Case = (String, Wrap, u32, Settings);

/// What the paper's method can be told.
fn visible_cases(visible: Visible) -> [(&'static str, Visible); 6] {
    let (flat, printed) = (Derivatives::Flat, Formulas::Printed);
    [
        ("two-ended", Visible { visibility: Visibility::TwoEnded, ..visible }),
        ("resolved", Visible { visibility: Visibility::Resolved, ..visible }),
        ("flat derivatives", Visible { derivatives: flat, ..visible }),
        ("printed", Visible { formulas: printed, ..visible }),
        ("printed, flat derivatives", Visible { derivatives: flat, formulas: printed, ..visible }),
        ("base level", Visible { texel_budget: 0, ..visible }),
    ]
}

/// Frames whose light is baked.
fn baked_cases() -> Vec<Case> {
    let lit = Settings { lighting: Lighting::Lit, ..small(Filter::default()) };
    let mut cases = Vec::new();
    for (wrap, size) in [(Wrap::Repeat, 200), (Wrap::Mirror, 130), (Wrap::Clamp, 64)] {
        cases.push((format!("{BAKED}, {wrap:?}"), wrap, size, lit.clone()));
    }
    cases.push((format!("{BAKED}, flat"), Wrap::Repeat, 64, Settings { parallax: false, ..lit }));
    cases
}

/// Every filter and every option, one frame each.
fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (name, filter) in Filter::ALL.map(with_small_options) {
        for (lighting, msaa) in [(Lighting::Unlit, 1), (Lighting::Lit, 4)] {
            let name = format!("{name} {lighting:?} msaa {msaa}");
            cases.push((name, Wrap::Repeat, 64, Settings { lighting, msaa, ..small(filter) }));
        }
    }
    let mut add = |name: &str, wrap, settings| cases.push((name.into(), wrap, 64, settings));
    let ewa = Ewa { texel_budget: 64, ..Ewa::default() };
    let visible = Visible { texel_budget: 64, ..Visible::default() };
    let horizon = Horizon::default();
    let trilinear = Filter::Trilinear(Trilinear::default());
    let ray = Filter::Parallax(Rays { samples: 1 });
    for (name, filter, narrow) in [
        ("Trilinear", trilinear, trilinear),
        ("One ray", ray, ray),
        ("Ewa", Filter::Ewa(ewa), Filter::Ewa(Ewa { max_anisotropy: 4.0, ..ewa })),
        (
            "Visible",
            Filter::Visible(visible),
            Filter::Visible(Visible { max_anisotropy: 4.0, ..visible }),
        ),
        (
            "Horizon",
            Filter::Horizon(horizon),
            Filter::Horizon(Horizon { max_anisotropy: 4.0, ..horizon }),
        ),
    ] {
        add(&format!("{name} mirror"), Wrap::Mirror, small(filter));
        add(&format!("{name} clamp"), Wrap::Clamp, small(filter));
        add(&format!("{name} flat"), Wrap::Repeat, Settings { parallax: false, ..small(filter) });
        add(&format!("{name} anisotropy 4"), Wrap::Repeat, small(narrow));
    }
    for (lighting, cut) in [(Lighting::Unlit, 1.0), (Lighting::Lit, 1.5)] {
        let filter = Filter::Ewa(Ewa { every_texel: true, cut, ..ewa });
        let settings = Settings { lighting, ..small(filter) };
        add(&format!("Ewa {lighting:?}, every texel, cut {cut}"), Wrap::Repeat, settings);
    }
    for (name, visible) in visible_cases(visible) {
        add(name, Wrap::Repeat, small(Filter::Visible(visible)));
    }
    let visible = small(Filter::Visible(visible));
    add("culled, msaa 8", Wrap::Repeat, Settings { cull_back_faces: true, msaa: 8, ..visible });
    add("4 lines", Wrap::Repeat, small(Filter::Horizon(Horizon { lines: 4, ..horizon })));
    let near = Horizon { lines: 64, far_field: false, ..horizon };
    add("64 lines, near field", Wrap::Repeat, small(Filter::Horizon(near)));
    let default = Settings { width: 45, height: 37, ..Default::default() };
    add("default", Wrap::Repeat, default.clone());
    add("default, lit", Wrap::Repeat, Settings { lighting: Lighting::Lit, ..default });
    // Only maps of more than 128 x 128 texels have tables of what is seen from afar.
    let far = small(Filter::Horizon(Horizon { far_field_mib: 1, ..horizon }));
    cases.push(("far field".into(), Wrap::Repeat, 200, far));
    cases.push(("far field, mirror".into(), Wrap::Mirror, 130, small(Filter::Horizon(horizon))));
    cases.extend(baked_cases());
    cases.extend([Filter::Horizon(horizon), Filter::Ewa(ewa)].map(parallel_case));
    // Texels a side that are no power of two wrap by a division.
    for (name, filter) in [("Trilinear", trilinear), ("Ewa", Filter::Ewa(ewa)), ("One ray", ray)] {
        cases.push((format!("{name}, 50 texels"), Wrap::Repeat, 50, small(filter)));
    }
    cases
}

/// How cases begin that are lit by the sun and the sky alone, so that light is baked.
const BAKED: &str = "baked";

/// How cases begin that are seen by parallel rays.
const PARALLEL: &str = "orthographic";

fn parallel_case(filter: Filter) -> Case {
    let name = if matches!(filter, Filter::Ewa(_)) { "Ewa" } else { "Horizon" };
    let settings = Settings { lighting: Lighting::Lit, ..small(filter) };
    (format!("{PARALLEL}, {name}"), Wrap::Repeat, 64, settings)
}

/// What a case shows.
fn scene_of(&(ref name, wrap, size, _): &Case) -> Scene {
    let mut scene = scene(wrap, size);
    if name.starts_with(BAKED) {
        scene.lights.retain(|light| matches!(light, Light::Sun { .. }));
    }
    scene.camera.orthographic = name.starts_with(PARALLEL).then_some(4.0);
    scene
}

fn draw(case: &Case) -> Frame {
    Renderer::new(scene_of(case), case.3.clone()).expect("a valid scene").render()
}

/// 64-bit FNV-1a of the frame's bits and of its 8-bit bytes.
fn hash(frame: &Frame) -> u64 {
    let floats = frame.pixels.iter().flatten().flat_map(|c| c.to_bits().to_le_bytes());
    let bytes = frame.to_rgba8().into_iter().flatten();
    floats.chain(bytes).fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
    })
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
    let changed: Vec<_> =
        found.lines().filter(|line| !expected.lines().any(|other| other == *line)).collect();
    assert!(
        found == expected,
        "BASRELIEF_ACCEPT=1 accepts on {}: {changed:#?}",
        basrelief::SIMD_LEVEL
    );
}

#[test]
fn frames_do_not_depend_on_threads_and_tiles() {
    let pools = [1, 2, 7]
        .map(|num| rayon::ThreadPoolBuilder::new().num_threads(num).build().expect("a pool"));
    for case in cases() {
        let (name, .., settings) = &case;
        let mut renderer = Renderer::new(scene_of(&case), settings.clone()).expect("a valid scene");
        let expected = hash(&pools[0].install(|| renderer.render()));
        for (pool, tile_size) in pools.iter().cycle().zip([8, 16, 32, 64, 128, 256]) {
            renderer
                .set_settings(Settings { tile_size, ..settings.clone() })
                .expect("valid settings");
            let found = hash(&pool.install(|| renderer.render()));
            assert_eq!(
                found,
                expected,
                "{name}: tiles of {tile_size}, {} threads",
                pool.current_num_threads()
            );
        }
    }
}

#[test]
fn frames_of_any_size_do_not_depend_on_threads_and_tiles() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(7).build().expect("a pool");
    for (width, height) in [(1, 1), (2, 1), (1, 7), (8, 8), (9, 17), (31, 33), (65, 3)] {
        for (name, filter) in Filter::ALL.map(with_small_options) {
            let settings = Settings { width, height, ..small(filter) };
            let case = |tile_size| {
                (String::new(), Wrap::Repeat, 64, Settings { tile_size, ..settings.clone() })
            };
            let expected = draw(&case(32));
            let other = pool.install(|| draw(&case(8)));
            assert!(expected == other, "{name} at {width} x {height}");
        }
    }
}

#[test]
fn regions_have_the_bytes_of_their_part_of_the_frame() {
    let regions = [
        [0, 0, 45, 37],
        [0, 0, 1, 1],
        [44, 36, 1, 1],
        [7, 3, 11, 9],
        [8, 8, 8, 8],
        [13, 30, 32, 7],
        [1, 0, 3, 37],
    ];
    for case in cases() {
        let (name, .., settings) = &case;
        let mut renderer = Renderer::new(scene_of(&case), settings.clone()).expect("a valid scene");
        let whole = renderer.render();
        for (i, [x, y, width, height]) in regions.into_iter().enumerate() {
            let region = Some(Region { x, y, width, height });
            let tile_size = [8, 16, 32][i % 3];
            renderer
                .set_settings(Settings { region, tile_size, ..settings.clone() })
                .expect("valid settings");
            let mut expected = whole.clone();
            expected.crop(Region { x, y, width, height });
            assert!(renderer.render() == expected, "{name}: {region:?}");
        }
    }
}

#[test]
fn regions_outside_the_frame_are_refused() {
    for [x, y, width, height] in [
        [0, 0, 46, 1],
        [45, 0, 1, 1],
        [0, 30, 1, 8],
        [3, 3, 0, 1],
        [1, 1, 1, 0],
        [u32::MAX, 0, 2, 1],
    ] {
        let region = Some(Region { x, y, width, height });
        let error = Settings { region, ..small(Filter::Nearest) }
            .validate()
            .expect_err("refused")
            .to_string();
        assert!(error.starts_with("region: "), "{error}");
    }
}
