//! Cut-outs: what is seen through holes, and how much of a surface stays with distance.

use basrelief::load::{LoadOptions, MaterialOptions, load};
use basrelief::texture::{GrayImage, HeightImage, Surface, SurfaceMaps, Texture, Wrap};
use basrelief::{
    Camera, CutOut, Layer, Light, Lighting, Material, Mesh, Renderer, Scene, Settings, Sky, render,
};
use glam::{Vec2, Vec3};
use std::fs;
use std::sync::Arc;

/// A square of side 2 around `middle`, with the axes of its sides.
fn square(material: usize, middle: Vec3, [u, v]: [Vec3; 2], repeats: f32) -> Mesh {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let positions = corners.map(|[x, y]| middle + u * x + v * y).to_vec();
    let tex_coords = corners.map(|c| (Vec2::from(c) + 1.0) * 0.5 * repeats).to_vec();
    let mesh = Mesh::new(positions, tex_coords, vec![], vec![[0, 1, 2], [0, 2, 3]]);
    Mesh { material, ..mesh }
}

/// A material with holes where a function of column and row of 40 is below a half.
fn cut(color: Vec3, opacity: impl Fn(u32, u32) -> f32) -> Material {
    let surface = Surface::new(SurfaceMaps::default()).expect("a surface").into();
    let image = GrayImage::from_fn(40, 40, opacity);
    let opacity = Texture::opacity(image, Wrap::Repeat, 0.5).expect("a texture").into();
    let cut_out = Some(CutOut { opacity });
    Material { base_color: color, surface: Some(surface), cut_out, ..Material::default() }
}

fn front(eye: f32) -> Camera {
    Camera { eye: Vec3::Z * eye, target: Vec3::ZERO, fov_degrees: 50.0, ..Camera::default() }
}

fn settings() -> Settings {
    Settings { width: 64, height: 64, msaa: 4, ..Settings::default() }
}

#[test]
fn holes_show_what_lies_behind_and_layers_say_so() {
    let left = cut(Vec3::X, |x, _| if x < 20 { 1.0 } else { 0.0 });
    let plain = Material { base_color: Vec3::Y, ..Material::default() };
    let meshes = vec![
        square(0, Vec3::Z * 0.5, [Vec3::X, Vec3::Y], 1.0),
        square(1, Vec3::ZERO, [Vec3::X, Vec3::Y], 1.0),
    ];
    let scene =
        Scene { meshes, materials: vec![left, plain], camera: front(2.0), ..Scene::default() };
    let mut renderer = Renderer::new(scene, settings()).expect("a scene");
    let frame = renderer.render();
    assert_eq!(frame.pixels[32 * 64 + 20], [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(frame.pixels[32 * 64 + 44], [0.0, 1.0, 0.0, 1.0]);
    let layers = renderer.render_layers(&[Layer::Object, Layer::Depth]);
    let ids = layers.ids(Layer::Object);
    let depth = layers.floats(Layer::Depth);
    assert_eq!([ids[32 * 64 + 20], ids[32 * 64 + 44]], [0, 1]);
    assert!((depth[32 * 64 + 20] - 1.5).abs() < 1e-4 && (depth[32 * 64 + 44] - 2.0).abs() < 1e-4);
}

#[test]
fn foliage_stays_as_dense_as_it_is_however_far() {
    // Thin blades: a fifth of the texture.
    let blades = |x: u32, y: u32| match x % 5 {
        0 => 0.6 + 0.4 * (y % 3) as f32 / 2.0,
        _ => 0.1,
    };
    let share = |eye: f32, repeats: f32| {
        let axes = [Vec3::X, Vec3::Y].map(|axis| axis * eye);
        let meshes = vec![square(0, Vec3::ZERO, axes, repeats)];
        let materials = vec![cut(Vec3::ONE, blades)];
        let scene = Scene { meshes, materials, camera: front(eye), ..Scene::default() };
        let frame = render(scene, settings()).expect("a frame");
        frame.pixels.iter().map(|pixel| pixel[3]).sum::<f32>() / frame.pixels.len() as f32
    };
    // From six pixels a texel to forty texels a pixel.
    for repeats in [0.25, 1.0, 3.0, 10.0, 60.0] {
        let found = share(2.0, repeats);
        assert!((0.17..0.23).contains(&found), "{repeats} repeats: {found}");
    }
}

#[test]
fn light_falls_through_holes() {
    let floor = Material { base_color: Vec3::ONE, ..Material::default() };
    let brightness = |card: Option<Material>| {
        let mut meshes = vec![square(0, Vec3::ZERO, [Vec3::X, Vec3::Y], 1.0)];
        let mut materials = vec![floor.clone()];
        if let Some(card) = card {
            // Out of the camera's sight, in the sun's way.
            meshes.push(square(1, Vec3::new(3.0, 0.0, 3.0), [Vec3::X, Vec3::Y], 1.0));
            materials.push(card);
        }
        let lights = vec![Light::Sun {
            to_light: Vec3::new(1.0, 0.0, 1.0),
            intensity: Vec3::ONE,
            angular_size: 0.0,
        }];
        let (camera, sky) = (front(2.0), Sky::Color(Vec3::ZERO));
        // The floor itself has a texture: plain surfaces are in no shadow.
        materials[0].surface = Some(Surface::new(SurfaceMaps::default()).expect("valid").into());
        let scene = Scene { meshes, materials, lights, camera, sky, ..Scene::default() };
        let settings = Settings { lighting: Lighting::Lit, ..settings() };
        let frame = render(scene, settings).expect("a frame");
        frame.pixels.iter().map(|pixel| pixel[0]).sum::<f32>() / frame.pixels.len() as f32
    };
    let open = brightness(None);
    let closed = brightness(Some(cut(Vec3::ONE, |_, _| 1.0)));
    let half = brightness(Some(cut(Vec3::ONE, |x, _| if x < 20 { 1.0 } else { 0.0 })));
    assert!(closed < 0.05 * open, "{closed} of {open}");
    assert!((half / open - 0.5).abs() < 0.06, "{half} of {open}");
}

#[test]
fn mtl_files_name_opacity() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        fs::write(folder.path().join(name), text).expect("written");
    };
    let quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl m\nf 1/1 2/2 3/3\n";
    write("s.obj", &format!("mtllib s.mtl\n{quad}"));
    let image =
        image::RgbaImage::from_fn(8, 8, |x, _| image::Rgba([9, 9, 9, if x < 4 { 255 } else { 0 }]));
    image.save(folder.path().join("a.png")).expect("saved");
    let gray = image::GrayImage::from_fn(8, 8, |x, _| image::Luma([if x < 4 { 255 } else { 0 }]));
    gray.save(folder.path().join("g.png")).expect("saved");
    let load = || load(&folder.path().join("s.obj"), &LoadOptions::default()).expect("loaded");
    let opaque = |alpha: u8| image::RgbaImage::from_pixel(8, 8, image::Rgba([9, 9, 9, alpha]));
    opaque(200).save(folder.path().join("full.png")).expect("saved");
    opaque(0).save(folder.path().join("none.png")).expect("saved");
    for (lines, has_holes) in [
        ("map_d a.png", true),
        ("map_d g.png", true),
        ("map_Kd a.png", true),
        ("map_Kd a.png\nmap_d full.png", false),
        ("map_Kd g.png", false),
        ("map_Kd full.png", false),
        // Opacity that is not meant.
        ("map_Kd none.png", false),
        ("d 0.3", false),
    ] {
        write("s.mtl", &format!("newmtl m\n{lines}\n"));
        let loaded = load();
        let cut_out = &loaded.scene.materials[0].cut_out;
        assert_eq!(cut_out.is_some(), has_holes, "{lines}");
        if let Some(cut_out) = cut_out {
            let at = |u: f32| cut_out.opacity.at([u, 0.5])[0];
            assert_eq!([at(0.25), at(0.75)], [1.0, 0.0], "{lines}");
        }
        assert_eq!(loaded.warnings.len(), usize::from(lines == "d 0.3"), "{:?}", loaded.warnings);
    }
    write("s.mtl", "newmtl m\nmap_Kd a.png\n");
    let solid = MaterialOptions { cut_out: Some(false), ..MaterialOptions::default() };
    let all = LoadOptions { all: solid.clone(), ..LoadOptions::default() };
    let materials = [("m".into(), solid)].into();
    let one = LoadOptions { materials, ..LoadOptions::default() };
    for options in [all, one] {
        let loaded = basrelief::load::load(&folder.path().join("s.obj"), &options).expect("loaded");
        assert!(loaded.scene.materials[0].cut_out.is_none());
    }
}

/// A relief that is deepest all over is a flat square below, holes and all.
#[test]
fn holes_of_a_relief_are_where_rays_hit_it() {
    let height = HeightImage::from_fn(8, 8, |_, _| 0.0);
    let maps = SurfaceMaps { height: Some(height), relief_depth: 0.2, ..Default::default() };
    let relief = Surface::new(maps).expect("a surface").into();
    let stripes = |x: u32, _: u32| if (x / 10).is_multiple_of(2) { 1.0 } else { 0.0 };
    let camera = Camera { eye: Vec3::new(1.6, 0.0, 1.5), ..front(1.0) };
    let drawn = |material: Material, middle: Vec3, silhouette: bool| {
        let meshes = vec![square(0, middle, [Vec3::X, Vec3::Y], 1.0)];
        let scene = Scene { meshes, materials: vec![material], camera, ..Scene::default() };
        let settings = Settings { silhouette, ..settings() };
        let mut renderer = Renderer::new(scene, settings).expect("a scene");
        renderer.render_layers(&[Layer::Object]).ids(Layer::Object).to_vec()
    };
    let solid = |silhouette: bool| {
        let material = Material { surface: Some(Arc::clone(&relief)), ..cut(Vec3::ONE, stripes) };
        drawn(material, Vec3::ZERO, silhouette)
    };
    // The square has a repeat of two units, so the relief is 0.4 deep.
    let below = drawn(cut(Vec3::ONE, stripes), Vec3::Z * -0.4, true);
    let middle = |ids: &[u32]| -> Vec<bool> {
        (20..44).flat_map(|y| (24..40).map(move |x| 64 * y + x)).map(|i| ids[i] == 0).collect()
    };
    let differ =
        |ids: &[u32]| middle(ids).iter().zip(middle(&below)).filter(|(a, b)| **a != *b).count();
    let [at_hits, at_polygons] = [solid(true), solid(false)].map(|ids| differ(&ids));
    assert!(middle(&below).iter().any(|is| *is) && middle(&below).iter().any(|is| !*is));
    assert!(at_hits <= 4 && at_polygons > 60, "{at_hits} and {at_polygons} pixels differ");
}
