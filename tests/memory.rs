//! How much memory a frame and a surface take, at their peak.

mod common;

use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps, Wrap};
use basrelief::{
    Camera, DrawnPixel, Filter, Frame, Horizon, Material, Mesh, Rays, Renderer, Scene, Settings,
    Trilinear,
};
use common::{Random, flat_surface, floor_scene};
use glam::Vec3;
use peak_alloc::PeakAlloc;

#[global_allocator]
static HEAP: PeakAlloc = PeakAlloc;

/// What does not grow with the scene: buffers of one tile, and of threads.
const CONSTANT: usize = 4 << 20;

/// Bytes a texel that a surface and its height field take, and that building it takes with its
/// images.
const KEPT: f64 = 24.0;
const BUILT: f64 = 24.0;

/// Bytes a texel that heights in cells take, which are made for rays in steps alone.
const CELLS: f64 = 11.0;

/// Bytes that `run` has on the heap at its peak, beyond what was there before, and its result.
fn peak<T>(run: impl FnOnce() -> T) -> (usize, T) {
    HEAP.reset_peak_usage();
    let before = HEAP.current_usage();
    let result = run();
    (HEAP.peak_usage() - before, result)
}

/// A pixel in linear light: 16 bytes of the frame itself.
type Linear = [f32; 4];

/// A grid of `2 * side^2` triangles that fills the frame, all of them seen.
fn grid(side: u32) -> Scene {
    let num = side + 1;
    let position = |i: u32| {
        Vec3::new((i % num) as f32 / side as f32 - 0.5, 0.5 - (i / num) as f32 / side as f32, 0.0)
    };
    let cells = (0..side * num).filter(|i| i % num != side);
    let triangles =
        cells.flat_map(|i| [[i, i + num, i + 1], [i + 1, i + num, i + num + 1]]).collect();
    let mesh = Mesh::new((0..num * num).map(position).collect(), vec![], vec![], triangles);
    let camera = Camera {
        eye: Vec3::new(0.0, 0.0, 0.5),
        target: Vec3::ZERO,
        fov_degrees: 90.0,
        ..Camera::default()
    };
    Scene { meshes: vec![mesh], materials: vec![Material::default()], camera, ..Scene::default() }
}

/// The first frame of a renderer, which fills its buffers, on two threads.
fn frame<P: DrawnPixel>(scene: Scene, settings: Settings) -> usize {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("threads");
    let mut renderer = Renderer::new(scene, settings).expect("a valid scene");
    let mut frame = Frame::<P>::default();
    pool.install(|| peak(|| renderer.render_into(&mut frame)).0)
}

/// A surface without normals, as the program makes them where there is no light.
fn surface(size: u32, relief_depth: f32) -> Surface {
    let mut random = Random(1);
    let albedo = ColorImage::from_fn(size, size, |_, _| [0; 3].map(|_| random.within(0.0, 1.0)));
    let heights = (relief_depth > 0.0)
        .then(|| HeightImage::from_fn(size, size, |_, _| random.within(0.0, 1.0)));
    let maps = SurfaceMaps {
        albedo: Some(albedo),
        height: heights,
        relief_depth,
        keep_normals: false,
        ..SurfaceMaps::default()
    };
    Surface::new(maps).expect("valid maps")
}

/// One test, since the heap is counted for the whole process.
#[test]
fn memory_is_bounded() {
    let filter = Filter::Trilinear(Trilinear::default());
    let settings = Settings { width: 1024, height: 1024, filter, ..Settings::default() };
    let num_triangles = 2 * 400 * 400;
    let few = frame::<Linear>(grid(1), settings.clone());
    let many = frame::<Linear>(grid(400), settings.clone());
    let per_triangle = (many - few) as f64 / f64::from(num_triangles);
    println!("{per_triangle:.1} bytes a triangle beyond the mesh");
    assert!(per_triangle <= 64.0, "{per_triangle} bytes a triangle");

    let floor = || floor_scene(flat_surface(16, 16, Wrap::Repeat, 1), 1.0);
    let settings = Settings { width: 2048, height: 2048, ..settings };
    // The goal is 12 throughout; a pixel in linear light is 16 by itself.
    for (msaa, is_linear, most) in
        [(1, false, 12.0), (1, true, 16.1), (4, false, 12.0), (4, true, 12.0)]
    {
        let settings = Settings { msaa, ..settings.clone() };
        let bytes = if is_linear {
            frame::<Linear>(floor(), settings)
        } else {
            frame::<[u8; 4]>(floor(), settings)
        };
        let per_sample = bytes.saturating_sub(CONSTANT) as f64 / f64::from(msaa * 2048 * 2048);
        println!("{per_sample:.1} bytes a pixel and sample, of {msaa}, linear: {is_linear}");
        assert!(per_sample <= most, "{per_sample} bytes a pixel and sample");
    }

    let horizon = Filter::Horizon(Horizon { far_field: false, ..Horizon::default() });
    let parallax = Filter::Parallax(Rays { samples: 1 });
    for (name, relief_depth, filter, kept_at_most) in [
        ("flat", 0.0, horizon, KEPT),
        ("relief", 0.1, horizon, KEPT),
        ("relief in steps", 0.1, parallax, KEPT + CELLS),
    ] {
        let (most, surface) = peak(|| surface(1024, relief_depth));
        let kept = surface.num_bytes();
        let before = HEAP.current_usage();
        let scene = floor_scene(surface, 1.0);
        let renderer = Renderer::new(scene, Settings { filter, ..Settings::default() })
            .expect("a valid scene");
        let tables = HEAP.current_usage() - before;
        drop(renderer);
        let [most, kept, tables] =
            [most, kept, tables].map(|bytes| bytes as f64 / f64::from(1024 * 1024));
        println!(
            "{name}: {kept:.1} bytes a texel, and {tables:.1} of tables; {most:.1} while it is built"
        );
        assert!(kept + tables <= kept_at_most, "{name}: {} bytes a texel", kept + tables);
        assert!(most <= BUILT, "{name}: {most} bytes a texel while it is built");
    }
}
