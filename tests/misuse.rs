//! What callers of the library can do wrong: refused with a reason, never a panic.

use basrelief::texture::{ColorImage, HeightImage, NormalImage, Surface, SurfaceMaps, Wrap};
use basrelief::{
    Camera, Derivatives, Error, Ewa, Filter, Formulas, Frame, Horizon, Light, Lighting, Material,
    Mesh, Rays, Region, Renderer, Scene, Settings, Sky, Tone, Trilinear, Visibility, Visible,
    metrics,
};
use glam::{Vec2, Vec3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::sync::Arc;

/// What users move to and share between threads.
const _: () = {
    const fn is_send_and_sync<T: Send + Sync + Unpin + 'static>() {}
    is_send_and_sync::<Scene>();
    is_send_and_sync::<Settings>();
    is_send_and_sync::<Renderer>();
    is_send_and_sync::<Frame>();
    is_send_and_sync::<Surface>();
    is_send_and_sync::<Error>();
    is_send_and_sync::<metrics::Picture>();
    is_send_and_sync::<metrics::Difference>();
    is_send_and_sync::<basrelief::load::LoadOptions>();
    is_send_and_sync::<basrelief::load::Loaded>();
    is_send_and_sync::<basrelief::invariants::Footprint>();
    is_send_and_sync::<basrelief::filter::Prepared>();
};

fn cases(num: u32) -> ProptestConfig {
    ProptestConfig {
        cases: num,
        rng_seed: RngSeed::Fixed(2017),
        failure_persistence: None,
        ..Default::default()
    }
}

/// Mostly a tame number, at times any.
fn number() -> impl Strategy<Value = f32> {
    let strange = vec![
        0.0,
        -0.0,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN,
        1e-45,
        1e18,
        1e30,
    ];
    prop_oneof![12 => -2.0_f32..2.0, 1 => prop::sample::select(strange), 1 => any::<f32>()]
}

fn vector() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(number()).prop_map(Vec3::from)
}

fn pick<T: Clone + std::fmt::Debug + 'static>(values: &[T]) -> impl Strategy<Value = T> + use<T> {
    prop::sample::select(values.to_vec())
}

/// A filter with options that may be out of their ranges.
fn filter() -> impl Strategy<Value = Filter> {
    let count = || prop_oneof![12 => 1_u32..12, 1 => Just(0), 1 => 65537..=u32::MAX];
    let limit = || prop_oneof![5 => 1.0_f32..80.0, 1 => number()];
    let near_one = || prop_oneof![5 => 0.9_f32..1.1, 1 => number()];
    let modes = (
        pick(&Filter::ALL),
        pick(&[Visibility::Exact, Visibility::TwoEnded, Visibility::Resolved]),
        pick(&[Derivatives::Flat, Derivatives::Relief]),
        pick(&[Formulas::Meant, Formulas::Printed]),
        any::<[bool; 2]>(),
    );
    let counts = (count(), count(), count(), prop_oneof![0_u32..300, any::<u32>()]);
    let limits = [limit().boxed(), limit().boxed(), near_one().boxed(), near_one().boxed()];
    (modes, counts, limits).prop_map(
        |(
            (filter, visibility, derivatives, formulas, [far_field, every_texel]),
            (samples, lines, far_field_mib, texel_budget),
            [max_anisotropy, max_stretch, cut, texel_kernel],
        )| match filter {
            Filter::Nearest | Filter::Bilinear => filter,
            Filter::Trilinear(_) => Filter::Trilinear(Trilinear { derivatives, formulas }),
            Filter::Ewa(_) => Filter::Ewa(Ewa {
                derivatives,
                formulas,
                lines,
                texel_budget,
                max_anisotropy,
                every_texel,
                cut,
                texel_kernel,
            }),
            Filter::Visible(_) => Filter::Visible(Visible {
                visibility,
                derivatives,
                formulas,
                texel_budget,
                max_anisotropy,
                max_stretch,
            }),
            Filter::Horizon(_) => {
                Filter::Horizon(Horizon { lines, far_field, far_field_mib, max_anisotropy })
            }
            Filter::Parallax(_) => Filter::Parallax(Rays { samples }),
            Filter::Truth(_) => Filter::Truth(Rays { samples }),
        },
    )
}

fn settings() -> impl Strategy<Value = Settings> {
    // Huge frames are valid; what is drawn here is small or not valid at all.
    let side = || prop_oneof![15 => 1_u32..20, 1 => Just(0), 1 => 32769..=u32::MAX];
    let region = prop_oneof![3 => Just(None), 1 => [side(), side(), side(), side()].prop_map(Some)];
    let grids = (
        pick(&[1, 1, 4, 8, 0, 2, u32::MAX]),
        pick(&[8, 16, 32, 64, 256, 32, 8, 0, 7, 512, u32::MAX]),
    );
    let exposure = prop_oneof![8 => -4.0..4.0_f32, 1 => number()];
    let light = (pick(&[Lighting::Unlit, Lighting::Lit]), exposure);
    let modes = (filter(), light, any::<[bool; 4]>());
    (side(), side(), region, modes, grids).prop_map(
        |(
            width,
            height,
            region,
            (filter, (lighting, exposure), [parallax, silhouette, cull_back_faces, has_tone]),
            (msaa, tile_size),
        )| Settings {
            width,
            height,
            region: region.map(|[x, y, width, height]| Region { x, y, width, height }),
            filter,
            parallax,
            silhouette,
            lighting,
            exposure,
            tone: if has_tone { Tone::Neutral } else { Tone::None },
            cull_back_faces,
            msaa,
            tile_size,
        },
    )
}

/// Maps whose numbers need not fit together.
fn maps() -> impl Strategy<Value = SurfaceMaps> {
    let size = || prop_oneof![12 => (1_u32..9, 1_u32..9, Just(0_usize)), 1 => (0_u32..3, any::<u32>(), 0..3_usize)];
    let wrap = pick(&[Wrap::Repeat, Wrap::Mirror, Wrap::Clamp]);
    let scalars = (
        prop_oneof![4 => 0.0_f32..1.0, 1 => number()],
        prop_oneof![4 => Just(1.0_f32), 1 => number()],
    );
    (size(), size(), size(), wrap, scalars, any::<[bool; 4]>(), any::<u16>()).prop_map(
        |(a, b, c, wrap, (relief_depth, scale), [has_a, has_b, has_c, keep_normals], seed)| {
            let num = |(w, h, missing): (u32, u32, usize)| {
                (w as usize).saturating_mul(h as usize).min(99) + missing
            };
            let value = |i: usize| (i as u16).wrapping_mul(seed);
            let albedo = || ColorImage {
                width: a.0,
                height: a.1,
                texels: (0..num(a)).map(|i| [value(i); 3]).collect(),
                scale,
            };
            let height = || HeightImage {
                width: b.0,
                height: b.1,
                texels: (0..num(b)).map(value).collect(),
            };
            let normal = || NormalImage {
                width: c.0,
                height: c.1,
                texels: (0..num(c)).map(|i| [value(i) as i16; 3]).collect(),
            };
            SurfaceMaps {
                albedo: has_a.then(albedo),
                height: has_b.then(height),
                normal: has_c.then(normal),
                wrap,
                relief_depth,
                keep_normals,
                least_size: [1; 2],
            }
        },
    )
}

fn mesh() -> impl Strategy<Value = Mesh> {
    let index = || prop_oneof![30 => 0_u32..6, 1 => any::<u32>()];
    let corners =
        (prop::collection::vec(vector(), 6), prop::collection::vec((number(), number()), 0..8));
    let triangles = prop::collection::vec(prop::array::uniform3(index()), 0..6);
    (corners, triangles, any::<[u8; 2]>(), vector()).prop_map(
        |((positions, uv), triangles, [change, material], v)| {
            let mut tex_coords: Vec<_> = uv.into_iter().map(Vec2::from).collect();
            if change % 4 > 0 {
                tex_coords.resize(6, v.truncate());
            }
            let mut mesh = Mesh::new(positions, tex_coords, vec![], triangles);
            mesh.material = usize::from(material % 8 / 7);
            match change {
                200 => mesh.normals.clear(),
                201 => mesh.normals[0] = v,
                202 => mesh.tangents.clear(),
                203 if !mesh.tangents.is_empty() => mesh.tangents[0][1] = v,
                204 => drop(mesh.positions.pop()),
                _ => {}
            }
            mesh
        },
    )
}

fn scene() -> impl Strategy<Value = Scene> {
    let size = prop_oneof![8 => 0.0..5.0_f32, 1 => number()];
    let light = (any::<bool>(), vector(), vector(), size).prop_map(
        |(is_point, place, intensity, angular_size)| match is_point {
            true => Light::Point { position: place, intensity: intensity.abs() },
            false => Light::Sun { to_light: place, intensity: intensity.abs(), angular_size },
        },
    );
    let sky = (any::<bool>(), vector(), vector(), vector()).prop_map(
        |(is_gradient, top, horizon, ground)| match is_gradient {
            true => Sky::Gradient { top: top.abs(), horizon: horizon.abs(), ground: ground.abs() },
            false => Sky::Color(top.abs()),
        },
    );
    let share = || prop_oneof![8 => 0.0..=1.0_f32, 1 => number()];
    let material = (maps(), vector(), vector(), share(), share(), share()).prop_map(
        |(maps, base_color, emissive, metallic, specular, roughness)| Material {
            surface: Surface::new(maps).ok().map(Arc::new),
            base_color: base_color.abs(),
            emissive: emissive.abs(),
            metallic,
            specular,
            roughness,
            ..Material::default()
        },
    );
    let positive = |most: f32| prop_oneof![8 => 1e-3..most, 1 => number()];
    let camera = (
        vector(),
        vector(),
        prop_oneof![4 => Just(Vec3::Y), 1 => vector()],
        positive(170.0),
        positive(1.0),
    )
        .prop_map(|(eye, target, up, fov_degrees, near)| Camera {
            eye,
            target,
            up,
            fov_degrees,
            near,
            ..Camera::default()
        });
    let background = prop_oneof![5 => Just([0.5; 4]), 1 => prop::array::uniform4(number())];
    (
        prop::collection::vec(mesh(), 0..3),
        material,
        camera,
        prop::collection::vec(light, 0..3),
        (sky, background),
    )
        .prop_map(|(meshes, material, camera, lights, (sky, background))| Scene {
            meshes,
            materials: vec![material],
            camera,
            lights,
            sky,
            background,
        })
}

proptest! {
    #![proptest_config(cases(10_000))]

    #[test]
    fn any_scene_and_settings_are_drawn_or_refused(scene in scene(), settings in settings()) {
        match Renderer::new(scene, settings.clone()) {
            Ok(mut renderer) => {
                let frame = renderer.render();
                let drawn = settings.region.map_or((settings.width, settings.height), |r| (r.width, r.height));
                prop_assert_eq!((frame.width, frame.height), drawn);
                let bad = frame.pixels.iter().find(|pixel| !pixel.iter().all(|c| c.is_finite() && *c >= 0.0));
                prop_assert!(bad.is_none(), "{bad:?}");
            }
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }

    #[test]
    fn any_settings_and_camera_are_taken_or_refused_between_frames(before in settings(), after in settings(), eye in vector(), target in vector()) {
        let Ok(mut renderer) = Renderer::new(Scene::default(), before.clone()) else { return Ok(()) };
        let is_valid = after.validate().is_ok();
        prop_assert_eq!(renderer.set_settings(after.clone()).is_ok(), is_valid);
        prop_assert_eq!(renderer.settings(), if is_valid { &after } else { &before });
        let camera = Camera { eye, target, ..Camera::default() };
        prop_assert_eq!(renderer.set_camera(camera).is_ok(), camera.validate().is_ok());
        renderer.render();
    }

    #[test]
    fn any_frames_are_compared_or_refused(sizes in prop::array::uniform4(0_u32..6), lengths in prop::array::uniform2(0_usize..30), value in number()) {
        let frame = |i: usize| Frame { width: sizes[2 * i], height: sizes[2 * i + 1], pixels: vec![[value, 0.5, -value, 1.0]; lengths[i]] };
        let (a, b) = (frame(0), frame(1));
        let _ = metrics::compare(&(&a).into(), &(&b).into());
        let _ = metrics::heat_map(&(&a).into(), &(&b).into(), value);
        let is_whole = a.pixels.len() as u32 == a.width * a.height && !a.pixels.is_empty();
        prop_assert_eq!(a.encode(basrelief::frame::Format::Png).is_ok(), is_whole);
    }
}

#[test]
fn frames_too_large_are_refused_before_memory_is_taken() {
    let settings = Settings { width: 32768, height: 32768, ..Settings::default() };
    let text = Renderer::new(Scene::default(), settings).expect_err("refused").to_string();
    assert_eq!(text, "width: 32768 x 32768 is more than 268435456 pixels");
}

#[test]
fn many_renders_run_in_one_process_at_once() {
    let draw = |filter| {
        let settings = Settings { width: 40, height: 30, filter, ..Settings::default() };
        let heights = HeightImage::from_fn(16, 16, |x, y| ((x * 5 + y * 3) % 7) as f32 / 6.0);
        let maps = SurfaceMaps { height: Some(heights), ..SurfaceMaps::default() };
        let surface = Arc::new(Surface::new(maps).expect("valid maps"));
        let corners = [(-4.0, 4.0), (4.0, 4.0), (4.0, -4.0), (-4.0, -4.0)];
        let positions = corners.map(|(x, z)| Vec3::new(x, -1.0, z)).to_vec();
        let tex_coords = corners.map(|(x, z)| Vec2::new(x, -z)).to_vec();
        let mesh = Mesh::new(positions, tex_coords, vec![], vec![[0, 1, 2], [0, 2, 3]]);
        let materials = vec![Material { surface: Some(surface), ..Material::default() }];
        basrelief::render(Scene { meshes: vec![mesh], materials, ..Scene::default() }, settings)
            .expect("a frame")
    };
    let few_rays = |filter| match filter {
        Filter::Parallax(_) => Filter::Parallax(Rays { samples: 2 }),
        Filter::Truth(_) => Filter::Truth(Rays { samples: 2 }),
        other => other,
    };
    let filters = Filter::ALL.map(few_rays);
    let alone = filters.map(draw);
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..16).map(|i| scope.spawn(move || draw(filters[i % 8]))).collect();
        for (i, thread) in threads.into_iter().enumerate() {
            assert!(thread.join().expect("no panic") == alone[i % 8], "{:?}", filters[i % 8]);
        }
    });
}
