//! Loading: what is read, how it is read, and what is refused with which words.

#[path = "common/files.rs"]
#[allow(unreachable_pub, reason = "shared between tests")]
mod files;

use basrelief::Error;
use basrelief::load::{
    HeightSense, LoadOptions, LoadStage, Loaded, MaterialOptions, NormalY, load, load_obj_bytes,
    load_reporting,
};
use basrelief::texture::{Surface, Wrap};
use files::Files;
use glam::{Vec2, Vec3};
use image::{GrayImage, ImageBuffer, Luma, Rgb, Rgb32FImage, RgbImage, Rgba, RgbaImage};
use std::fs;
use std::path::Path;
use std::sync::Mutex;

const QUAD: &str = "mtllib s.mtl\no floor\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
                    usemtl stone\nf 1/1 2/2 3/3 4/4\n";

/// With `s.obj`, `s.mtl` and images.
impl Files {
    fn new(obj: &str, mtl: &str) -> Self {
        let files = Self::empty(LoadOptions::default());
        files.write("s.obj", obj);
        files.write("s.mtl", mtl);
        files
    }

    /// The quad with one material of these lines.
    fn quad(material: &str) -> Self {
        Self::new(QUAD, &format!("newmtl stone\n{material}\n"))
    }

    fn load(&self) -> Loaded {
        self.try_load().unwrap_or_else(|error| panic!("{error}"))
    }

    fn try_load(&self) -> Result<Loaded, Error> {
        load(&self.path("s.obj"), &self.options)
    }

    /// The one line of the refusal, without the folder's path.
    fn refusal(&self) -> String {
        let text = self.try_load().expect_err("refused").to_string();
        assert!(!text.contains('\n'), "more than one line: {text}");
        text.replace(&format!("{}/", self.folder.path().display()), "")
    }

    fn surface(&self) -> Surface {
        self.load().scene.materials[0].surface.as_deref().expect("a surface").clone()
    }

    /// Heights of the first row (v = 0), 0 to 65535.
    fn heights(&self) -> Vec<i32> {
        let surface = self.surface();
        let base = surface.base();
        (0..base.size()[0] as i32)
            .map(|x| (base.height_at(x, 0) * 65535.0).round() as i32)
            .collect()
    }
}

fn gray(values: &[u8]) -> GrayImage {
    GrayImage::from_fn(values.len() as u32, 1, |x, _| Luma([values[x as usize]]))
}

fn one(r: u8, g: u8, b: u8) -> RgbImage {
    RgbImage::from_pixel(2, 2, Rgb([r, g, b]))
}

fn has(lines: &[String], part: &str) -> bool {
    lines.iter().any(|line| line.contains(part))
}

// ---- geometry

#[test]
fn polygons_become_fans_with_normals_and_tangents() {
    let loaded =
        Files::new("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5\n", "").load();
    let mesh = &loaded.scene.meshes[0];
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
    assert!(mesh.normals.iter().all(|n| n.abs_diff_eq(Vec3::Z, 1e-6)));
    assert!(mesh.tex_coords.is_empty() && mesh.tangents.is_empty());
    let with_coords = Files::quad("").load();
    assert!(with_coords.scene.meshes[0].tangents.iter().all(|t| *t == [Vec3::X, Vec3::Y]));
}

#[test]
fn made_normals_know_no_seams_and_edges_by_the_crease_angle() {
    // A roof of 90 degrees whose ridge, from (0, 1, 0) to (0, 1, 1), has its own texture
    // coordinates on either side.
    let faces = "usemtl a\nf 1/1 3/3 4/4 2/2\nusemtl b\nf 1/5 2/6 6/4 5/3\n";
    let obj = "mtllib s.mtl\nv 0 1 0\nv 0 1 1\nv -1 0 0\nv -1 0 1\nv 1 0 0\nv 1 0 1\n\
               vt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 5 0\nvt 6 0\n";
    let mut files = Files::new(&format!("{obj}{faces}"), "newmtl a\n\nnewmtl b\n");
    for (crease_angle, at_ridge) in [(60.0, [-1.0, 1.0]), (90.0, [0.0, 0.0])] {
        files.options.crease_angle = Some(crease_angle);
        let meshes = files.load().scene.meshes;
        for (mesh, x) in meshes.iter().zip(at_ridge) {
            let ridge = mesh.positions.iter().zip(&mesh.normals).filter(|(p, _)| p.y == 1.0);
            assert!(
                ridge.map(|(_, normal)| normal.x / normal.y).all(|slope| (slope - x).abs() < 1e-6),
                "{meshes:?}"
            );
        }
    }
    for crease_angle in [-1.0, 180.5, f32::NAN] {
        files.options.crease_angle = Some(crease_angle);
        assert!(
            files.try_load().unwrap_err().to_string().contains("crease_angle"),
            "{crease_angle}"
        );
    }
}

#[test]
fn negative_indices_count_from_the_end() {
    let mesh =
        &Files::new("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n", "").load().scene.meshes[0];
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn objects_and_materials_of_one_file_become_meshes() {
    let obj = "mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no a\nusemtl red\nf 1 2 3\nusemtl blue\nf 3 2 1\no b\nf 1 3 2\n";
    let loaded = Files::new(obj, "newmtl red\nKd 1 0 0\n\nnewmtl blue\nKd 0 0 1\n").load();
    let names: Vec<_> = loaded.scene.meshes.iter().map(|m| (m.name.as_str(), m.material)).collect();
    assert_eq!(names, [("a", 0), ("a", 1), ("b", 1)]);
    assert_eq!(loaded.scene.materials[1].base_color, Vec3::Z);
}

#[test]
fn lines_and_points_are_ignored() {
    let loaded =
        Files::new("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\np 1 2\nf 1 2\nf 1 2 3\n", "").load();
    assert_eq!(loaded.scene.meshes.len(), 1);
    assert_eq!(loaded.scene.meshes[0].triangles.len(), 1);
}

#[test]
fn faces_with_and_without_texture_coordinates_are_kept_apart() {
    let obj =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf 1 2 3\nf 1/1 2 3/3\n";
    let loaded = Files::new(obj, "").load();
    let counts: Vec<_> =
        loaded.scene.meshes.iter().map(|m| (m.triangles.len(), m.tex_coords.len())).collect();
    assert_eq!(counts, [(1, 3), (2, 0)]);
}

#[test]
fn what_exporters_write_besides_is_put_up_with() {
    let mut obj =
        b"\xef\xbb\xbf# caf\xe9\r\nv 0 0 0 1 0 0\r\nv 1 0 0\r\nv 0 1 0 # top\r\ns 1\r\n\tf 1 2 \\\r\n3 # face\r\n"
            .to_vec();
    assert_eq!(
        load_obj_bytes(&obj, &LoadOptions::default()).expect("loads").scene.meshes[0].triangles,
        [[0, 1, 2]]
    );
    obj.extend(b"vn 0 0 0\nf 1//1 2//1 3//1\n");
    let loaded = load_obj_bytes(&obj, &LoadOptions::default()).expect("loads");
    assert_eq!(loaded.scene.meshes[1].normals[0], Vec3::Z, "a normal without direction is made");
}

#[test]
fn the_camera_frames_a_small_scene_far_from_the_origin() {
    let obj = "v 1e6 1e6 1e6\nv 1e6 1e6 1e6\nv 1e6 1e6 1000000.1\nf 1 2 3\n";
    Files::new(obj, "").load().scene.validate().expect("a camera that sees something");
}

// ---- materials and texture lines

#[test]
fn albedo_is_the_colour_map_in_linear_light_and_kd_beside_it() {
    let files = Files::quad("Kd 0.5 0.25 1\nKs 0.1 0.2 0.3\nNs 20\nmap_Kd a.png");
    files.image("a.png", one(255, 128, 0));
    let loaded = files.load();
    let material = &loaded.scene.materials[0];
    assert_eq!(material.base_color, Vec3::new(0.5, 0.25, 1.0));
    let alpha = material.roughness * material.roughness;
    assert!((alpha * alpha - 2.0 / 22.0).abs() < 1e-6, "{alpha}");
    assert_eq!(material.surface.as_ref().expect("a surface").color_scale(), 1.0);
}

#[test]
fn what_has_no_highlight_is_rough() {
    for text in ["Ks 0.8 0.8 0.8\nNs 0", "Ks 0.8 0.8 0.8", "Ns 200", "Ks 0 0 0\nNs 200", ""] {
        let material = &Files::quad(text).load().scene.materials[0];
        assert_eq!((material.specular, material.roughness), (0.0, 1.0), "{text}");
    }
}

#[test]
fn metal_roughness_and_emission_are_read() {
    let text = "Ks 1 1 1\nNs 200\nPm 1\nPr 0.25\nKe 0.5 2 0";
    let material = &Files::quad(text).load().scene.materials[0];
    assert_eq!((material.metallic, material.specular, material.roughness), (1.0, 1.0, 0.25));
    assert_eq!(material.emissive, Vec3::new(0.5, 2.0, 0.0));
    let material = &Files::quad("pm 7\npr -1\nke 0.5").load().scene.materials[0];
    assert_eq!((material.metallic, material.roughness), (1.0, 0.0), "cut to their ranges");
    assert_eq!(material.emissive, Vec3::splat(0.5));
}

#[test]
fn paths_are_relative_to_the_mtl_with_spaces_and_backslashes() {
    let files = Files::new(&QUAD.replace("s.mtl", "sub\\my mats.mtl"), "");
    files.write("sub/my mats.mtl", "newmtl stone\nmap_Kd ..\\tex\\my stone.png\n");
    files.image("tex/my stone.png", one(9, 9, 9));
    assert!(files.load().scene.materials[0].surface.is_some());
}

#[test]
fn several_mtl_files_on_one_line_are_all_read() {
    let files = Files::new(&QUAD.replace("s.mtl", "a.mtl s.mtl"), "newmtl stone\nKd 1 0 0\n");
    files.write("a.mtl", "newmtl other\nKd 0 1 0\n");
    let scene = files.load().scene;
    assert_eq!(scene.materials[scene.meshes[0].material].base_color, Vec3::X);
}

#[test]
fn scale_and_offset_of_the_colour_map_move_the_texture_coordinates() {
    let files = Files::quad("map_Kd -s 2 3 1 -o 0.5 -1 0 a.png");
    files.image("a.png", one(9, 9, 9));
    assert_eq!(files.load().scene.meshes[0].tex_coords[2], Vec2::new(2.5, 2.0));
}

#[test]
fn height_comes_from_disp_before_bump_whatever_the_spelling() {
    for line in ["disp h.png", "map_disp h.png", "map_Disp h.png", "MAP_DISP h.png"] {
        let files = Files::quad(&format!("map_bump b.png\n{line}"));
        files.image("h.png", gray(&[0, 255]));
        files.image("b.png", gray(&[7, 7]));
        assert_eq!(files.heights(), [0, 65535], "{line}");
        assert!(has(&files.load().choices, "height from disp h.png"), "{line}");
    }
}

#[test]
fn a_gray_bump_is_a_height_map_and_a_coloured_one_a_normal_map() {
    for keyword in ["bump", "map_bump", "map_Bump"] {
        let mut files = Files::quad(&format!("{keyword} -bm 0.2 b.png"));
        files.options.keep_normals = true;
        files.image("b.png", RgbImage::from_fn(2, 1, |x, _| Rgb([x as u8 * 255; 3])));
        assert_eq!(files.heights(), [0, 65535], "gray in three channels");
        assert_eq!(files.surface().relief_depth(), 0.2);
        files.image("b.png", one(128, 128, 255));
        assert_eq!(files.surface().relief_depth(), 0.0);
        assert!(has(&files.load().choices, "normals from map_Bump b.png"));
    }
}

#[test]
fn norm_and_map_kn_are_normal_maps_with_green_up_or_down() {
    for line in ["norm n.png", "map_Kn n.png"] {
        let mut files = Files::quad(line);
        files.options.keep_normals = true;
        files.image("n.png", one(128, 255, 128));
        let up = format!("{:?}", files.surface().base());
        files.options.all.normal_y = Some(NormalY::Down);
        assert_ne!(up, format!("{:?}", files.surface().base()), "{line}");
        files.options.keep_normals = false;
        assert!(
            files.load().scene.materials[0].surface.is_none(),
            "nothing else is in the material"
        );
    }
}

#[test]
fn textures_of_metal_roughness_and_emission_are_read_for_light() {
    let lines = "Pm 0\nPr 0.3\nmap_Pm m.png\nmap_Pr -imfchan g r.png\nmap_Ke e.png";
    let mut files = Files::quad(lines);
    files.image("m.png", gray(&[0, 255]));
    files.image("r.png", one(9, 51, 200));
    files.image("e.png", one(255, 0, 255));
    files.image("o.png", gray(&[255; 3]));
    assert!(files.load().scene.materials[0].surface.is_none(), "nothing is drawn without light");
    files.options.keep_normals = true;
    files.options.all.occlusion_map = Some(files.path("o.png"));
    let material = files.load().scene.materials.remove(0);
    assert_eq!(
        (material.metallic, material.roughness, material.emissive),
        (1.0, 1.0, Vec3::ONE),
        "textures in place of numbers"
    );
    let finish = material.finish(|map| map.at([0.75, 0.5]));
    assert_eq!((finish.metallic, finish.occlusion), (1.0, 1.0));
    assert!((finish.roughness - 0.2).abs() < 1e-4 && finish.emissive == Vec3::new(1.0, 0.0, 1.0));
    let surface = material.surface.expect("a surface");
    assert_eq!(surface.base().size(), [3, 2], "as many texels as its textures have");
    files.options.all.emissive = Some(Vec3::splat(3.0));
    assert_eq!(files.load().scene.materials[0].emissive, Vec3::splat(3.0));
}

#[test]
fn bm_is_the_depth_unless_the_caller_says_another() {
    let mut files = Files::quad("disp h.png -bm 0.1");
    files.image("h.png", gray(&[0, 255]));
    assert_eq!(files.surface().relief_depth(), 0.1);
    files.options.all.relief_depth = Some(0.02);
    assert_eq!(files.surface().relief_depth(), 0.02);
    files.options.all.relief_depth = Some(f32::NAN);
    assert!(files.refusal().contains("relief_depth"));
}

/// Texels are packed in 15 bits: 16-bit values come back to within one.
fn assert_near(found: &[i32], expected: &[i32]) {
    let is_near = found.len() == expected.len()
        && found.iter().zip(expected).all(|(a, b)| a.abs_diff(*b) <= 1);
    assert!(is_near, "{found:?} for {expected:?}");
}

#[test]
fn mm_maps_the_range_and_the_sense_turns_it() {
    let mut files = Files::quad("disp -mm 0.2 0.6 h.png");
    files.image("h.png", gray(&[0, 255]));
    assert_near(&files.heights(), &[13107, 52428]);
    files.options.all.height_sense = Some(HeightSense::WhiteDeep);
    assert_near(&files.heights(), &[52428, 13107]);
}

#[test]
fn imfchan_picks_the_channel() {
    for (channel, height) in [("r", 10), ("g", 20), ("b", 30), ("m", 40), ("z", 10), ("l", 19)] {
        let files = Files::quad(&format!("disp -imfchan {channel} h.png"));
        files.image("h.png", RgbaImage::from_pixel(2, 2, Rgba([10, 20, 30, 40])));
        assert!(
            (files.heights()[0] - height * 257).abs() < 200,
            "{channel}: {:?}",
            files.heights()
        );
    }
}

#[test]
fn clamp_and_the_wrap_option() {
    let mut files = Files::quad("map_Kd -clamp on a.png");
    files.image("a.png", one(1, 2, 3));
    assert_eq!(files.surface().wrap(), Wrap::Clamp);
    files.options.all.wrap = Some(Wrap::Mirror);
    assert_eq!(files.surface().wrap(), Wrap::Mirror);
    files.options.all.wrap = None;
    files.write("s.mtl", "newmtl stone\nmap_Kd -clamp off a.png\n");
    assert_eq!(files.surface().wrap(), Wrap::Repeat);
}

#[test]
fn unsupported_options_are_named_with_their_line() {
    let files = Files::quad("map_Kd -blendu off -type sphere a.png");
    files.image("a.png", one(1, 2, 3));
    let loaded = files.load();
    assert!(
        has(&loaded.warnings, "s.mtl:2: option -blendu of map_Kd is not supported"),
        "{:?}",
        loaded.warnings
    );
    assert!(has(&loaded.warnings, "-type") && loaded.scene.materials[0].surface.is_some());
}

#[test]
fn equal_maps_share_a_surface() {
    let obj = format!("{QUAD}usemtl other\nf 1/1 2/2 3/3\nusemtl third\nf 1/1 2/2 3/3\n");
    let files = Files::new(
        &obj,
        "newmtl stone\nmap_Kd a.png\nnewmtl other\nmap_Kd ./a.png\nnewmtl third\nmap_Kd b.png\n",
    );
    files.image("a.png", one(1, 2, 3));
    files.image("b.png", one(1, 2, 3));
    let materials = files.load().scene.materials;
    let surface = |i: usize| materials[i].surface.as_ref().expect("a surface");
    assert!(std::sync::Arc::ptr_eq(surface(0), surface(1)));
    assert!(!std::sync::Arc::ptr_eq(surface(0), surface(2)));
}

#[test]
fn files_that_the_caller_names_replace_the_materials_own() {
    let outside = tempfile::tempdir().expect("a folder");
    let height = outside.path().join("height.png");
    gray(&[0, 255]).save(&height).expect("saved");
    let mut files = Files::quad("map_Kd gone.png\ndisp gone.png");
    files.options.all.albedo = Some(height.clone());
    files.options.all.height = Some(height.clone());
    files.options.all.normal = Some(height);
    assert_eq!(files.heights(), [0, 65535]);
    assert!(files.load().warnings.is_empty());
    files.write("s.obj", QUAD.replace("mtllib s.mtl", "").replace("usemtl stone", ""));
    assert_eq!(files.heights(), [0, 65535], "a mesh without material gets one");
    files.options.all.height = Some(files.path("none.png"));
    assert_eq!(files.refusal(), "none.png: no such file");
}

// ---- images

#[test]
fn sixteen_bit_gray_does_not_go_through_eight_bits() {
    let files = Files::quad("disp h.png");
    files.image(
        "h.png",
        ImageBuffer::from_fn(3, 1, |x, _| Luma([[1_u16, 40001, 65535][x as usize]])),
    );
    assert_near(&files.heights(), &[1, 40001, 65535]);
    files.write("s.mtl", "newmtl stone\ndisp h.tif\n");
    files.image(
        "h.tif",
        ImageBuffer::from_fn(3, 1, |x, _| Luma([[1_u16, 40001, 65535][x as usize]])),
    );
    assert_near(&files.heights(), &[1, 40001, 65535]);
}

#[test]
fn rows_are_turned_over() {
    let files = Files::quad("disp h.png");
    files.image("h.png", GrayImage::from_fn(1, 2, |_, y| Luma([if y == 1 { 255 } else { 0 }])));
    assert_eq!(files.heights(), [65535], "the last row of the file is v = 0");
}

#[test]
fn every_format_is_read() {
    for name in ["h.png", "h.jpg", "h.tga", "h.tif", "h.bmp"] {
        let files = Files::quad(&format!("map_Kd {name}\ndisp {name}"));
        files.image(name, one(200, 200, 200));
        assert!((files.heights()[0] - 200 * 257).abs() < 600, "{name}: {:?}", files.heights());
    }
}

#[test]
fn an_exr_of_one_channel_is_a_height_map() {
    use exr::prelude::{SpecificChannels, WritableImage};
    for name in ["Y", "Z"] {
        let files = Files::quad("disp h.exr");
        let channels = SpecificChannels::build().with_channel(name);
        let height = |place: exr::math::Vec2<usize>| ([0.25_f32, 0.75][place.x()],);
        let image = exr::image::Image::from_channels((2, 1), channels.with_pixel_fn(height));
        image.write().to_file(files.path("h.exr")).unwrap();
        assert_near(&files.heights(), &[16384, 49151]);
    }
}

#[test]
fn high_dynamic_range_keeps_its_scale() {
    for name in ["a.exr", "a.hdr"] {
        let files = Files::quad(&format!("map_Kd {name}"));
        files.image(
            name,
            Rgb32FImage::from_fn(2, 1, |x, _| Rgb([[0.5, 8.0][x as usize], 0.25, 0.0])),
        );
        assert_eq!(files.surface().color_scale(), 8.0, "{name}");
    }
}

#[test]
fn any_size_and_maps_of_different_sizes() {
    let files = Files::quad("map_Kd a.png\ndisp h.png");
    files.image("a.png", RgbImage::from_pixel(7, 3, Rgb([9, 9, 9])));
    files.image("h.png", gray(&[0, 100, 200, 100, 0]));
    assert_eq!(files.surface().base().size(), [7, 3]);
}

// ---- what is missing or wrong

#[test]
fn a_missing_texture_or_mtl_is_a_warning() {
    let files = Files::quad("Kd 1 0 0\nmap_Kd ../gone.png");
    let loaded = files.load();
    assert!(
        has(&loaded.warnings, "s.mtl:3: map_Kd '../gone.png' is missing"),
        "{:?}",
        loaded.warnings
    );
    assert!(loaded.scene.materials[0].surface.is_none());
    fs::remove_file(files.path("s.mtl")).expect("removed");
    assert!(has(&files.load().warnings, "s.mtl: no such file"));
}

#[test]
fn an_undefined_material_is_a_warning() {
    let files = Files::new(&QUAD.replace("usemtl stone", "usemtl wood"), "newmtl stone\n");
    assert!(has(&files.load().warnings, "s.obj:11: material 'wood'"));
}

#[test]
fn a_missing_or_empty_obj_is_refused() {
    let files = Files::new("# nothing\nv 0 0 0\n", "");
    assert_eq!(files.refusal(), "s.obj: has no faces");
    fs::remove_file(files.path("s.obj")).expect("removed");
    assert_eq!(files.refusal(), "s.obj: no such file");
}

#[test]
fn an_index_out_of_range_is_refused_with_its_line() {
    let head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
    for (face, reason) in [
        ("f 1 2 4", "s.obj:5: index 4 is out of range: 3 exist"),
        ("f 1 2 0", "s.obj:5: index 0: indices count from 1, or back from -1"),
        ("f 1 2 -4", "s.obj:5: index -4 is out of range: only 3 so far"),
        ("f 1/1 2/9 3/1", "s.obj:5: index 9 is out of range: 1 exist"),
        ("f 1//1 2//1 3//1", "s.obj:5: names normals, and the file has none"),
        (
            "f 1/-9223372036854775808 2/1 3/1",
            "s.obj:5: index -9223372036854775808 is out of range: only 1 so far",
        ),
        (
            "f 1/9223372036854775807 2/1 3/1",
            "s.obj:5: index 9223372036854775807 is out of range: 1 exist",
        ),
    ] {
        assert_eq!(Files::new(&format!("{head}{face}\n"), "").refusal(), reason);
    }
}

#[test]
fn numbers_that_are_not_finite_or_absurd_are_refused_with_their_line() {
    for bad in ["v nan 0 0", "v inf 0 0", "v 0 2e18 0", "v 1 1 1 1e-30"] {
        let files = Files::new(&format!("v 0 0 0\nv 1 0 0\n{bad}\nf 1 2 3\n"), "");
        assert_eq!(files.refusal(), format!("s.obj:3: '{bad}' is not finite or too large"));
    }
    let files = Files::new("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt nan 0\nf 1/1 2/1 3/1\n", "");
    assert_eq!(files.refusal(), "s.obj:4: 'vt nan 0' is not finite or too large");
}

#[test]
fn broken_lines_are_refused_with_their_number() {
    assert_eq!(Files::new("v 0 0 0\nv 1 x 0\n", "").refusal(), "s.obj:2: 'v' needs three numbers");
    assert_eq!(Files::new("v 0 0\n", "").refusal(), "s.obj:1: 'v' needs three numbers");
    assert!(
        Files::new("v 0 0 0\nf 1 2 a\n", "").refusal().starts_with("s.obj:2: a face needs corners")
    );
    assert_eq!(Files::quad("Kd 1 nan 0").refusal(), "s.mtl:2: Kd: 'nan' is not a finite number");
    assert_eq!(Files::quad("Kd 1 0").refusal(), "s.mtl:2: Kd: three numbers are needed");
    assert_eq!(Files::quad("Ns shiny").refusal(), "s.mtl:2: Ns: 'shiny' is not a finite number");
    assert_eq!(
        Files::quad("disp -bm x.png y.png").refusal(),
        "s.mtl:2: option -bm needs 1 number(s)"
    );
    assert_eq!(
        Files::new(QUAD, "Kd 1 1 1\n").refusal(),
        "s.mtl:1: Kd stands before the first newmtl"
    );
    assert!(has(
        &Files::quad("Kd 0.5\nmap_Kd").load().warnings,
        "s.mtl:3: map_Kd names no file or value"
    ));
}

#[test]
fn damaged_images_are_refused_by_name() {
    let files = Files::quad("map_Kd a.png");
    files.image("a.png", RgbImage::from_fn(64, 64, |x, y| Rgb([x as u8, y as u8, (x * y) as u8])));
    let whole = fs::read(files.path("a.png")).expect("read");
    files.write("a.png", &whole[..whole.len() / 2]);
    assert!(files.refusal().contains("a.png: "), "{}", files.refusal());
    files.write("a.png", "not an image");
    assert!(files.refusal().contains("a.png: "), "{}", files.refusal());
    files.write("a.png", "");
    assert!(files.refusal().contains("a.png: "), "{}", files.refusal());
}

// ---- hostile input

#[test]
fn limits_name_their_option() {
    let mut files = Files::quad("map_Kd a.png\ndisp h.png");
    files.image("a.png", RgbImage::from_pixel(64, 8, Rgb([9, 9, 9])));
    files.image("h.png", gray(&[0, 255]));
    files.options.max_textures = 1;
    assert!(files.refusal().starts_with("max_textures: "));
    files.options = LoadOptions { max_image_side: 63, ..LoadOptions::default() };
    assert!(files.refusal().contains("a.png"), "{}", files.refusal());
    files.options = LoadOptions { max_triangles: 1, ..LoadOptions::default() };
    assert!(files.refusal().contains("max_triangles"), "{}", files.refusal());
}

#[test]
fn a_huge_image_is_refused_before_it_is_decoded() {
    let files = Files::quad("map_Kd a.bmp");
    let mut head = b"BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0".to_vec();
    head.extend(30000_u32.to_le_bytes());
    head.extend(30000_u32.to_le_bytes());
    head.extend([1, 0, 24, 0]);
    head.extend([0; 24]);
    files.write("a.bmp", &head);
    assert!(files.refusal().contains("a.bmp"), "{}", files.refusal());
    // One that fits by itself, and not with all that is made of it.
    head[18..26].copy_from_slice(&[0x70, 0x17, 0, 0, 0x70, 0x17, 0, 0]);
    files.write("a.bmp", &head);
    assert!(files.refusal().starts_with("max_image_mib: "), "{}", files.refusal());
}

#[test]
fn refusals_keep_their_cause() {
    use std::error::Error as _;
    let missing = load(Path::new("none.obj"), &LoadOptions::default()).expect_err("refused");
    assert_eq!(missing.to_string(), "none.obj: no such file");
    let cause = missing
        .source()
        .and_then(|cause| cause.downcast_ref::<std::io::Error>())
        .expect("an error of the system");
    assert_eq!(cause.kind(), std::io::ErrorKind::NotFound);
    let files = Files::quad("map_Kd a.png");
    files.write("a.png", "no picture");
    let damaged = files.try_load().expect_err("refused");
    assert!(damaged.source().is_some_and(|cause| cause.is::<image::ImageError>()), "{damaged}");
    let large = Files::new(&"v 0 0 0\n".repeat(3), "");
    let options = LoadOptions { max_triangles: 2, ..LoadOptions::default() };
    let large = load(&large.path("s.obj"), &options).expect_err("refused");
    assert!(
        matches!(large, Error::Limit { line: Some(3), option: "max_triangles", .. }),
        "{large:?}"
    );
}

#[test]
fn textures_outside_the_folder_need_permission() {
    let files = Files::new("", "");
    let mut options = LoadOptions::default();
    files.write("scene/s.obj", QUAD);
    files.write("scene/s.mtl", "newmtl stone\nmap_Kd ../a.png\n");
    files.image("a.png", one(1, 2, 3));
    let load = |options: &LoadOptions| load(&files.path("scene/s.obj"), options);
    let text = load(&options).expect_err("refused").to_string();
    assert!(
        text.contains("s.mtl:2: '../a.png' lies outside") && text.contains("(allow_outside)"),
        "{text}"
    );
    options.allow_outside = true;
    assert!(load(&options).expect("loads").scene.materials[0].surface.is_some());
    options.allow_outside = false;
    let absolute = files.path("a.png");
    files.write("scene/s.mtl", format!("newmtl stone\nmap_Kd {}\n", absolute.display()));
    assert!(load(&options).is_err());
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder_devices_and_pipes_are_refused() {
    let files = Files::new("", "");
    files.write("scene/s.obj", QUAD);
    files.write("scene/s.mtl", "newmtl stone\nmap_Kd link.png\n");
    files.image("a.png", one(1, 2, 3));
    std::os::unix::fs::symlink(files.path("a.png"), files.path("scene/link.png")).expect("linked");
    let refusal = || {
        load(&files.path("scene/s.obj"), &LoadOptions::default()).expect_err("refused").to_string()
    };
    assert!(refusal().contains("lies outside"), "{}", refusal());
    files.write("scene/s.mtl", "newmtl stone\nmap_Kd folder\n");
    fs::create_dir(files.path("scene/folder")).expect("made");
    assert!(refusal().contains("not a regular file"), "{}", refusal());
    files.write("scene/s.obj", QUAD.replace("s.mtl", "/dev/zero"));
    assert!(refusal().contains("/dev/zero"), "{}", refusal());
    let zero =
        load(Path::new("/dev/zero"), &LoadOptions::default()).expect_err("refused").to_string();
    assert_eq!(zero, "/dev/zero: not a regular file");
    let made = std::process::Command::new("mkfifo")
        .arg(files.path("pipe"))
        .status()
        .is_ok_and(|s| s.success());
    if made {
        let all =
            MaterialOptions { albedo: Some(files.path("pipe")), ..MaterialOptions::default() };
        let options = LoadOptions { all, ..LoadOptions::default() };
        files.write("scene/s.obj", QUAD);
        let text = load(&files.path("scene/s.obj"), &options).expect_err("refused").to_string();
        assert!(text.contains("not a regular file"), "{text}");
    }
}

// ---- many materials

/// Four materials of different sizes, of which some share images.
fn four_materials() -> Files {
    let names = ["a", "b", "c", "d"];
    let faces: String =
        names.iter().map(|name| format!("usemtl {name}\nf 1/1 2/2 3/3 4/4\n")).collect();
    let maps = [
        "map_Kd x.png\ndisp h.png",
        "map_Kd x.png",
        "map_Kd y.png\ndisp h.png",
        "map_Kd -clamp on x.png",
    ];
    let materials = names.iter().zip(maps).map(|(name, maps)| format!("newmtl {name}\n{maps}\n"));
    let files = Files::new(
        &format!("{}{faces}", &QUAD[..QUAD.find("usemtl").expect("in it")]),
        &materials.collect::<String>(),
    );
    let spotted = |side: u32| {
        RgbImage::from_fn(side, side, |x, y| Rgb([(x * 37) as u8, (y * 59) as u8, (x * y) as u8]))
    };
    files.image("x.png", spotted(48));
    files.image("y.png", spotted(21));
    files.image("h.png", GrayImage::from_fn(64, 32, |x, y| Luma([(x * 31 + y * 17) as u8])));
    files
}

#[test]
fn surfaces_built_in_parallel_are_the_same() {
    let files = four_materials();
    let on_threads = |num: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(num).build().expect("threads");
        let materials = pool.install(|| files.load().scene.materials);
        assert!(
            materials.len() == 4 && materials.iter().all(|material| material.surface.is_some())
        );
        format!("{materials:?}")
    };
    let alone = on_threads(1);
    assert!((0..4).all(|_| on_threads(4) == alone));
}

#[test]
fn stages_are_told_in_order() {
    let files = four_materials();
    let stages = Mutex::new(Vec::new());
    let report = |stage| stages.lock().expect("whole").push(stage);
    load_reporting(&files.path("s.obj"), &files.options, &report).expect("loads");
    let images = (0..=3).map(|done| LoadStage::Images { done, num: 3 });
    let pyramids = (0..=4).map(|done| LoadStage::Pyramids { done, num: 4 });
    let expected: Vec<_> = [LoadStage::Model].into_iter().chain(images).chain(pyramids).collect();
    assert_eq!(stages.into_inner().expect("whole"), expected);
    let words: Vec<_> = [0, 4, 8].iter().map(|&i| expected[i].to_string()).collect();
    assert_eq!(
        words,
        ["reading the model", "decoding images (3 of 3)", "building pyramids (3 of 4)"]
    );
}
