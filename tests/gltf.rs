//! glTF: what is read, how it is read, and what is refused with which words.

#[path = "common/files.rs"]
#[allow(unreachable_pub, reason = "shared between tests")]
mod files;

use basrelief::load::{LoadOptions, Loaded, MaterialOptions, load, load_gltf_bytes};
use basrelief::texture::{Texture, Wrap};
use basrelief::{Camera, Error, Light, Settings, render};
use files::Files;
use glam::{Vec2, Vec3};
use image::{DynamicImage, GrayImage, Luma, Rgb, RgbImage, Rgba, RgbaImage};
use std::sync::Arc;

/// A unit square in the xy plane: positions, texture coordinates (v down), normals, indices.
const POSITIONS: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
const TEX_COORDS: [f32; 8] = [0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
const INDICES: [u16; 6] = [0, 1, 2, 0, 2, 3];

/// Bytes behind buffer views, and their JSON.
#[derive(Default)]
struct Binary {
    bytes: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl Binary {
    fn view(&mut self, bytes: impl IntoIterator<Item = u8>) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - start;
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(format!(r#"{{"buffer":0,"byteOffset":{start},"byteLength":{length}}}"#));
        self.views.len() - 1
    }

    fn accessor(&mut self, bytes: impl IntoIterator<Item = u8>, count: usize, rest: &str) {
        let view = self.view(bytes);
        self.accessors.push(format!(r#"{{"bufferView":{view},"count":{count},{rest}}}"#));
    }

    fn floats(&mut self, values: &[f32], kind: &str, per_element: usize) {
        let rest = format!(r#""componentType":5126,"type":"{kind}""#);
        let bytes = values.iter().flat_map(|v| v.to_le_bytes());
        self.accessor(bytes, values.len() / per_element, &rest);
    }

    /// Accessors 0 to 2: positions, texture coordinates, indices of a square.
    fn square() -> Self {
        let mut binary = Self::default();
        binary.floats(&POSITIONS, "VEC3", 3);
        binary.floats(&TEX_COORDS, "VEC2", 2);
        let indices = INDICES.iter().flat_map(|i| i.to_le_bytes());
        binary.accessor(indices, 6, r#""componentType":5123,"type":"SCALAR""#);
        binary
    }

    fn json(&self, uri: &str, rest: &str) -> String {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{}{uri}}}],
            "bufferViews":[{}],"accessors":[{}],{rest}}}"#,
            self.bytes.len(),
            self.views.join(","),
            self.accessors.join(",")
        )
    }

    fn glb(&self, rest: &str) -> Vec<u8> {
        let mut json = self.json("", rest).into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let size = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
        let chunks =
            [size(&json).as_slice(), b"JSON", &json, &size(&self.bytes), b"BIN\0", &self.bytes]
                .concat();
        let length = (chunks.len() as u32 + 12).to_le_bytes();
        [b"glTF".as_slice(), &2_u32.to_le_bytes(), &length, &chunks].concat()
    }
}

/// A scene with one square of one material.
fn square(material: &str, rest: &str) -> String {
    let primitive = r#"{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}"#;
    format!(
        r#""scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"name":"floor","primitives":[{primitive}]}}],"materials":[{material}]{rest}"#
    )
}

impl Files {
    fn new() -> Self {
        Self::empty(LoadOptions { keep_normals: true, ..LoadOptions::default() })
    }

    fn load(&self, name: &str) -> Loaded {
        load(&self.path(name), &self.options).unwrap_or_else(|error| panic!("{error}"))
    }

    fn refusal(&self, name: &str) -> String {
        let error = load(&self.path(name), &self.options).expect_err("a refusal").to_string();
        assert!(error.contains(name) && !error.contains('\n'), "{error}");
        error
    }
}

fn png(image: impl Into<DynamicImage>) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, image::ImageFormat::Png).expect("encoded");
    bytes.into_inner()
}

fn refused(glb: &[u8]) -> String {
    let error = load_gltf_bytes(glb, &LoadOptions::default()).expect_err("a refusal").to_string();
    assert!(!error.contains('\n'), "{error}");
    error
}

fn loaded(glb: &[u8]) -> Loaded {
    let options = LoadOptions { keep_normals: true, ..LoadOptions::default() };
    load_gltf_bytes(glb, &options).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_same_square_comes_of_a_glb_of_files_and_of_data_uris() {
    use base64::Engine as _;
    let (files, binary) = (Files::new(), Binary::square());
    let scene = square("{}", "");
    files.write("a.glb", binary.glb(&scene));
    files.write("b c.gltf", binary.json(r#","uri":"data/b%20c.bin""#, &scene));
    files.write("data/b c.bin", &binary.bytes);
    let data = base64::engine::general_purpose::STANDARD.encode(&binary.bytes);
    let uri = format!(r#","uri":"data:application/octet-stream;base64,{data}""#);
    files.write("d.gltf", binary.json(&uri, &scene));
    for name in ["a.glb", "b c.gltf", "d.gltf"] {
        let loaded = files.load(name);
        assert_eq!(loaded.warnings, [""; 0], "{name}");
        let mesh = &loaded.scene.meshes[0];
        assert_eq!((mesh.name.as_str(), mesh.positions.len()), ("floor", 4));
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        // v points up here, and down in the file.
        assert_eq!(mesh.tex_coords[..2], [Vec2::ZERO, Vec2::X]);
        assert!(mesh.normals.iter().all(|normal| *normal == Vec3::Z));
        assert_eq!(mesh.tangents[0], [Vec3::X, Vec3::Y]);
    }
}

#[test]
fn files_stay_in_the_folder_unless_more_is_allowed() {
    let (mut files, binary) = (Files::new(), Binary::square());
    files.write("outside.bin", &binary.bytes);
    files.write("in/a.gltf", binary.json(r#","uri":"../outside.bin""#, &square("{}", "")));
    let error = load(&files.path("in/a.gltf"), &files.options).expect_err("a refusal");
    assert!(matches!(error, Error::Limit { option: "allow_outside", .. }), "{error}");
    files.options.allow_outside = true;
    files.load("in/a.gltf");
    files.write("b.gltf", binary.json(r#","uri":"none.bin""#, &square("{}", "")));
    assert!(files.refusal("b.gltf").contains("buffer 0 'none.bin' is missing"));
}

/// Names in a file may hold anything; what is said of them is one line.
#[test]
fn line_breaks_in_names_are_escaped() {
    let (files, binary) = (Files::new(), Binary::square());
    files.write("a.gltf", binary.json(r#","uri":"no\nne.bin""#, &square("{}", "")));
    assert!(files.refusal("a.gltf").contains(r"buffer 0 'no\nne.bin' is missing"));
    let used = r#","extensionsUsed":["new\r\nline"]"#;
    let warnings = loaded(&binary.glb(&square("{}", used))).warnings;
    assert!(warnings.iter().any(|text| text.contains(r"new\r\nline")), "{warnings:?}");
    assert!(!warnings.iter().any(|text| text.contains('\n')), "{warnings:?}");
}

#[test]
fn nodes_place_instances_and_mirrored_ones_are_turned_over() {
    let scene = r#""scene":0,"scenes":[{"nodes":[1]}],
        "nodes":[{"mesh":0,"scale":[-2,1,1]},{"children":[0,2],"translation":[0,0,5]},
                 {"mesh":0,"rotation":[0,0.7071068,0,0.7071068]}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":2}]}]"#;
    let loaded = loaded(&Binary::square().glb(scene));
    let [mirrored, turned] = &loaded.scene.meshes[..] else { panic!("two instances") };
    assert_eq!(mirrored.positions[2], Vec3::new(-2.0, 1.0, 5.0));
    assert_eq!(mirrored.triangles[0], [0, 2, 1]);
    assert!(mirrored.normals.iter().all(|n| n.abs_diff_eq(Vec3::Z, 1e-6)));
    assert!(turned.positions[1].abs_diff_eq(Vec3::new(0.0, 0.0, 4.0), 1e-6));
    assert!(turned.normals.iter().all(|n| n.abs_diff_eq(Vec3::X, 1e-6)));
}

#[test]
fn strips_fans_and_lists_without_indices_are_triangles() {
    let mut binary = Binary::default();
    binary.floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0], "VEC3", 3);
    binary.floats(&[0.0, 0.0, 1.0].repeat(4), "VEC3", 3);
    let of_mode = |mode: u32| {
        let scene = format!(
            r#""nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1}},"mode":{mode}}}]}}]"#
        );
        binary.glb(&scene)
    };
    let triangles = |mode| loaded(&of_mode(mode)).scene.meshes[0].triangles.clone();
    assert_eq!(triangles(4), [[0, 1, 2]]);
    assert_eq!(triangles(5), [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(triangles(6), [[0, 1, 2], [0, 2, 3]]);
    assert!(refused(&of_mode(1)).contains("has no triangles"));
}

#[test]
fn integers_of_all_kinds_are_read_where_they_lie() {
    let mut binary = Binary::default();
    // Positions as signed bytes of a stride of 4, which a node scales back.
    let view = binary.view([0, 0, 0, 9, 100, 0, 0, 9, 100, 100, 0, 9, 0, 100, 0, 9]);
    binary.views[view].insert_str(1, r#""byteStride":4,"#);
    let rest = r#""componentType":5120,"type":"VEC3""#;
    binary.accessors.push(format!(r#"{{"bufferView":{view},"count":4,{rest}}}"#));
    let normalized = r#""componentType":5123,"type":"VEC2","normalized":true"#;
    let coords = TEX_COORDS.iter().flat_map(|c| ((c * 65535.0) as u16).to_le_bytes());
    binary.accessor(coords, 4, normalized);
    binary.accessor([0, 1, 2, 0, 2, 3], 6, r#""componentType":5121,"type":"SCALAR""#);
    let scene = square("{}", r#","extensionsRequired":["KHR_mesh_quantization"]"#);
    let scene = scene.replace(r#"{"mesh":0}"#, r#"{"mesh":0,"scale":[0.01,0.01,0.01]}"#);
    let mesh = &loaded(&binary.glb(&scene)).scene.meshes[0];
    assert!(mesh.positions[2].abs_diff_eq(Vec3::new(1.0, 1.0, 0.0), 1e-6));
    assert_eq!(mesh.tex_coords[2], Vec2::ONE);
}

#[test]
fn sparse_accessors_replace_single_elements() {
    let mut binary = Binary::square();
    let (at, of) =
        (binary.view([2]), binary.view([3.0_f32; 3].iter().flat_map(|v| v.to_le_bytes())));
    let sparse = format!(
        r#","sparse":{{"count":1,"indices":{{"bufferView":{at},"componentType":5121}},
        "values":{{"bufferView":{of}}}}}}}"#
    );
    let positions = &mut binary.accessors[0];
    positions.pop();
    positions.push_str(&sparse);
    let glb = binary.glb(&square("{}", ""));
    assert_eq!(loaded(&glb).scene.meshes[0].positions[2], Vec3::splat(3.0));
    binary.accessors[0] = binary.accessors[0].replace(r#""count":1"#, r#""count":2"#);
    assert!(refused(&binary.glb(&square("{}", ""))).contains("accessor 0 reaches beyond"));
    // Without bytes behind them, zeros: not more than a file of this size can have vertices.
    binary.accessors[0] = r#"{"count":4,"componentType":5126,"type":"VEC3"}"#.into();
    loaded(&binary.glb(&square("{}", "")));
    binary.accessors[0] = binary.accessors[0].replace("4,", "4000,");
    assert!(refused(&binary.glb(&square("{}", ""))).contains("4000 elements of no bytes"));
}

#[test]
fn images_in_the_file_and_beside_it_are_read_with_their_sampler() {
    let files = Files::new();
    let mut binary = Binary::square();
    // The left half is red, the upper right blue.
    let image = RgbImage::from_fn(4, 4, |x, y| match (x < 2, y < 2) {
        (true, _) => Rgb([255, 0, 0]),
        (_, true) => Rgb([0, 0, 255]),
        _ => Rgb([0, 255, 0]),
    });
    let view = binary.view(png(image.clone()));
    files.image("beside.png", image);
    for source in [
        format!(r#"{{"bufferView":{view},"mimeType":"image/png"}}"#),
        r#"{"uri":"beside.png"}"#.into(),
    ] {
        let rest = format!(
            r#","textures":[{{"source":0,"sampler":0}}],"images":[{source}],
            "samplers":[{{"wrapS":33648,"wrapT":33648}}]"#
        );
        let material = r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0},
            "baseColorFactor":[0.5,1,1,1],"metallicFactor":0,"roughnessFactor":0.25},
            "emissiveFactor":[0,1,0],
            "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":3}}}"#;
        files.write("a.glb", binary.glb(&square(material, &rest)));
        let loaded = files.load("a.glb");
        let material = &loaded.scene.materials[0];
        assert_eq!(material.base_color, Vec3::new(0.5, 1.0, 1.0));
        assert_eq!((material.metallic, material.roughness, material.specular), (0.0, 0.25, 1.0));
        assert_eq!(material.emissive, Vec3::new(0.0, 3.0, 0.0));
        let surface = material.surface.as_ref().expect("a surface");
        assert_eq!(surface.wrap(), Wrap::Mirror);
        let color = |x, y| surface.base().texel(x, y).color.map(|c| c > 16000.0);
        assert_eq!(color(0, 0), [true, false, false]);
        assert_eq!(color(3, 0), [false, true, false]);
        assert_eq!(color(3, 3), [false, false, true]);
    }
}

#[test]
fn a_texture_wraps_as_in_the_direction_in_which_it_is_left() {
    let with = |coords: &str| {
        let mut left = Binary::square();
        let view = left.view(png(RgbImage::new(2, 2)));
        let rest = format!(
            r#","textures":[{{"source":0,"sampler":0}}],"images":[{{"bufferView":{view}}}],
            "samplers":[{{"wrapS":33071,"wrapT":10497}}]"#
        );
        let texture = format!(
            r#"{{"index":0,"extensions":{{"KHR_texture_transform":{{"scale":[{coords}]}}}}}}"#
        );
        let material = format!(r#"{{"pbrMetallicRoughness":{{"baseColorTexture":{texture}}}}}"#);
        let loaded = loaded(&left.glb(&square(&material, &rest)));
        let wrap = loaded.scene.materials[0].surface.as_ref().expect("a surface").wrap();
        (wrap, loaded.warnings.len())
    };
    assert_eq!(with("3,1"), (Wrap::Clamp, 0));
    assert_eq!(with("1,3"), (Wrap::Repeat, 0));
    assert_eq!(with("3,3"), (Wrap::Clamp, 1));
}

#[test]
fn texture_transforms_move_scale_and_turn() {
    let texture = |transform: &str| {
        let material = format!(
            r#"{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0,"extensions":{{
            "KHR_texture_transform":{{{transform}}}}}}}}}}}"#
        );
        let loaded = loaded(&Binary::square().glb(&square(&material, "")));
        loaded.scene.meshes[0].tex_coords.clone()
    };
    // In the file's sense, v down, the corners are (0,1), (1,1), (1,0), (0,0).
    let at = |u: f32, v: f32| Vec2::new(u, 1.0 - v);
    assert_eq!(
        texture(r#""offset":[0.5,0.25],"scale":[2,4]"#)[..3],
        [at(0.5, 4.25), at(2.5, 4.25), at(2.5, 0.25)]
    );
    // A quarter turn counter-clockwise, as one sees it: down becomes right, right becomes up.
    let turned = texture(r#""rotation":1.5707963267948966"#);
    assert!(turned[3].abs_diff_eq(at(0.0, 0.0), 1e-6));
    assert!(turned[0].abs_diff_eq(at(1.0, 0.0), 1e-6), "{}", turned[0]);
    assert!(turned[2].abs_diff_eq(at(0.0, -1.0), 1e-6), "{}", turned[2]);
}

#[test]
fn normal_maps_use_the_tangents_of_the_file_or_those_of_mikktspace() {
    let mut binary = Binary::square();
    binary.floats(&[0.0, 0.0, 1.0].repeat(4), "VEC3", 3);
    // Another direction than that of u.
    binary.floats(&[0.6, 0.8, 0.0, -1.0].repeat(4), "VEC4", 4);
    let view = binary.view(png(RgbImage::from_pixel(2, 2, Rgb([128, 128, 255]))));
    let rest = format!(r#","textures":[{{"source":0}}],"images":[{{"bufferView":{view}}}]"#);
    let scene = square(r#"{"normalTexture":{"index":0}}"#, &rest);
    let frame = |scene: &str| loaded(&binary.glb(scene)).scene.meshes[0].tangents[0];
    let given = scene.replace(r#""TEXCOORD_0":1"#, r#""TEXCOORD_0":1,"NORMAL":3,"TANGENT":4"#);
    let [u, v] = frame(&given);
    assert!(u.abs_diff_eq(Vec3::new(0.6, 0.8, 0.0), 1e-6));
    assert!(v.abs_diff_eq(Vec3::new(0.8, -0.6, 0.0), 1e-6), "{v}");
    let [u, v] = frame(&scene);
    assert!(u.abs_diff_eq(Vec3::X, 1e-6) && v.abs_diff_eq(Vec3::Y, 1e-6), "{u} {v}");
    // A relief needs the derivatives themselves.
    let files = Files::new();
    files.write("a.glb", binary.glb(&given));
    files.image("h.png", GrayImage::from_fn(4, 4, |x, _| Luma([x as u8 * 60])));
    let all = MaterialOptions { height: Some(files.path("h.png")), ..MaterialOptions::default() };
    let options = LoadOptions { all, ..files.options.clone() };
    let relief = load(&files.path("a.glb"), &options).expect("loaded");
    assert_eq!(relief.scene.meshes[0].tangents[0], [Vec3::X, Vec3::Y]);
}

#[test]
fn textures_of_numbers_are_channels_of_images() {
    let mut binary = Binary::square();
    let view = binary.view(png(RgbImage::from_pixel(2, 2, Rgb([51, 102, 204]))));
    let rest = format!(r#","textures":[{{"source":0}}],"images":[{{"bufferView":{view}}}]"#);
    let scene = square(
        r#"{"pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0}},
        "occlusionTexture":{"index":0,"strength":0.5},
        "emissiveTexture":{"index":0},"emissiveFactor":[1,1,1]}"#,
        &rest,
    );
    let loaded = loaded(&binary.glb(&scene));
    let maps = &loaded.scene.materials[0].maps;
    let red = |texture: &Option<Arc<Texture>>| {
        texture.as_ref().map(|texture: &Arc<Texture>| texture.at([0.5, 0.5])[0])
    };
    let is =
        |found: Option<f32>, expected: f32| (found.expect("a texture") - expected).abs() < 1e-3;
    assert!(is(red(&maps.metallic), 0.8) && is(red(&maps.roughness), 0.4));
    assert!(is(red(&maps.occlusion), 0.6) && is(red(&maps.emissive), 0.033_1));
}

#[test]
fn textures_that_lie_elsewhere_are_left_out() {
    let mut binary = Binary::square();
    let view = binary.view(png(RgbImage::new(2, 2)));
    let rest = format!(r#","textures":[{{"source":0}}],"images":[{{"bufferView":{view}}}]"#);
    let material = r#"{"name":"m","pbrMetallicRoughness":{"baseColorTexture":{"index":0},
        "metallicRoughnessTexture":{"index":0,"texCoord":1}},
        "occlusionTexture":{"index":0,"texCoord":1},
        "emissiveTexture":{"index":0},"emissiveFactor":[1,1,1]}"#;
    let loaded = loaded(&binary.glb(&square(material, &rest)));
    let found = &loaded.scene.materials[0];
    assert!(found.maps.occlusion.is_none() && found.maps.metallic.is_none());
    assert!(found.maps.emissive.is_some() && found.metallic == 0.0);
    let [metal, occlusion] = &loaded.warnings[..] else { panic!("{:?}", loaded.warnings) };
    assert!(metal.contains("its metal and roughness texture lies elsewhere"), "{metal}");
    assert!(occlusion.contains("its occlusion texture lies elsewhere"), "{occlusion}");
}

#[test]
fn colours_of_vertices_multiply_the_base_colour() {
    let mut binary = Binary::square();
    let colors = [255, 0, 0, 9, 255, 0, 0, 9, 0, 0, 255, 9, 0, 0, 255, 9];
    binary.accessor(colors, 4, r#""componentType":5121,"type":"VEC4","normalized":true"#);
    let material = r#"{"pbrMetallicRoughness":{"baseColorFactor":[0.5,1,1,1]}}"#;
    let scene = square(material, "").replace(r#""TEXCOORD_0":1"#, r#""COLOR_0":3"#);
    let mut scene = loaded(&binary.glb(&scene)).scene;
    assert_eq!(scene.meshes[0].colors, [Vec3::X, Vec3::X, Vec3::Z, Vec3::Z]);
    let (eye, target) = (Vec3::new(0.5, 0.5, 2.0), Vec3::new(0.5, 0.5, 0.0));
    scene.camera = Camera { eye, target, fov_degrees: 28.0, ..Camera::default() };
    let frame = render(scene, Settings { width: 16, height: 16, ..Settings::default() });
    let frame = frame.expect("a frame");
    // Red at the bottom, where it is half as bright, to blue at the top.
    let [top, middle, bottom] = [0, 7, 15].map(|y| frame.pixels[y * 16 + 8]);
    assert!(top[0] < 0.05 && top[2] > 0.9 && top[1] == 0.0, "{top:?}");
    assert!(bottom[0] > 0.45 && bottom[0] <= 0.5 && bottom[2] < 0.05, "{bottom:?}");
    assert!((middle[2] - 0.53).abs() < 0.02 && (middle[0] - 0.235).abs() < 0.02, "{middle:?}");
}

#[test]
fn masks_are_cut_out_and_blended_materials_too() {
    let mut binary = Binary::square();
    let half = |x: u32, _| Rgba([9, 9, 9, if x < 2 { 255 } else { 100 }]);
    let view = binary.view(png(RgbaImage::from_fn(4, 4, half)));
    let rest = format!(r#","textures":[{{"source":0}}],"images":[{{"bufferView":{view}}}]"#);
    let load = |mode: &str, texture: &str| {
        let material = format!(
            r#"{{"name":"m",{mode},"pbrMetallicRoughness":{{{texture}"baseColorFactor":[1,1,1,0.8]}}}}"#
        );
        load_gltf_bytes(&binary.glb(&square(&material, &rest)), &LoadOptions::default())
    };
    let texture = r#""baseColorTexture":{"index":0},"#;
    let there = |mode: &str| {
        let loaded = load(mode, texture).expect("loaded");
        let material = &loaded.scene.materials[0];
        // The opaque half, and the other of opacity 0.8 * 100 / 255.
        let holes = material.cut_out.as_ref();
        let there = holes.map(|cut| [0.25, 0.75].map(|u| cut.opacity.at([u, 0.5])[0] > 0.5));
        (there, loaded.warnings.len())
    };
    assert_eq!(there(r#""alphaMode":"OPAQUE""#), (None, 0));
    assert_eq!(there(r#""alphaMode":"MASK""#), (Some([true, false]), 0));
    assert_eq!(there(r#""alphaMode":"MASK","alphaCutoff":0.9"#), (Some([false, false]), 0));
    // Nothing is below: no holes.
    assert_eq!(there(r#""alphaMode":"MASK","alphaCutoff":0.2"#), (None, 0));
    assert_eq!(there(r#""alphaMode":"BLEND""#), (Some([true, false]), 1));
    let none = load(r#""alphaMode":"MASK","alphaCutoff":0.9"#, "").expect_err("a refusal");
    assert!(none.to_string().contains("has no triangles"), "{none}");
}

#[test]
fn unlit_materials_send_out_their_colour() {
    let binary = Binary::square();
    let material = r#"{"pbrMetallicRoughness":{"baseColorFactor":[0.5,1,0,1]},
        "extensions":{"KHR_materials_unlit":{}}}"#;
    let lit = loaded(&binary.glb(&square(material, ""))).scene.materials.swap_remove(0);
    assert_eq!((lit.base_color, lit.emissive), (Vec3::ZERO, Vec3::new(0.5, 1.0, 0.0)));
    // Without light, colours are what is drawn.
    let unlit = load_gltf_bytes(&binary.glb(&square(material, "")), &LoadOptions::default());
    assert_eq!(unlit.expect("loaded").scene.materials[0].base_color, Vec3::new(0.5, 1.0, 0.0));
}

#[test]
fn extras_name_a_height_map_and_its_depth() {
    let files = Files::new();
    let mut binary = Binary::square();
    let heights = || GrayImage::from_fn(4, 4, |x, _| Luma([x as u8 * 60]));
    let view = binary.view(png(heights()));
    files.image("h.png", heights());
    for (height, depth, expected) in
        [("0", r#","basrelief_depth":0.2"#, 0.2), (r#""h.png""#, "", 0.05)]
    {
        let material = format!(r#"{{"extras":{{"basrelief_height":{height}{depth}}}}}"#);
        let rest = format!(r#","textures":[{{"source":0}}],"images":[{{"bufferView":{view}}}]"#);
        files.write("a.glb", binary.glb(&square(&material, &rest)));
        let loaded = files.load("a.glb");
        let surface = loaded.scene.materials[0].surface.clone().expect("a surface");
        assert_eq!(surface.relief_depth(), expected);
        assert!(surface.base().height_at(3, 0) > 0.7 && surface.base().height_at(0, 0) == 0.0);
    }
    let wrong = square(r#"{"name":"m","extras":{"basrelief_depth":2}}"#, "");
    let error = refused(&binary.glb(&wrong));
    assert!(error.contains("material 'm': basrelief_depth must be within 0 to 1"), "{error}");
}

#[test]
fn cameras_and_lights_of_the_file_are_the_scenes() {
    let rest = r#","cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.25}}],
        "extensionsUsed":["KHR_lights_punctual"],
        "extensions":{"KHR_lights_punctual":{"lights":[
            {"type":"directional","intensity":3.1415927},
            {"type":"point","color":[1,0.5,0],"intensity":6.2831855}]}}"#;
    let nodes = r#"[{"mesh":0},
        {"camera":0,"translation":[0,0,4],"extensions":{"KHR_lights_punctual":{"light":0}}},
        {"translation":[1,2,3],"extensions":{"KHR_lights_punctual":{"light":1}}}]"#;
    let scene = square("{}", rest)
        .replace(r#""nodes":[0]"#, r#""nodes":[0,1,2]"#)
        .replace(r#"[{"mesh":0}]"#, nodes);
    let loaded = loaded(&Binary::square().glb(&scene));
    assert_eq!(loaded.warnings, [""; 0]);
    let scene = &loaded.scene;
    assert_eq!((scene.camera.eye, scene.camera.near), (Vec3::Z * 4.0, 0.25));
    assert!((scene.camera.fov_degrees - 28.647_89).abs() < 1e-4);
    assert!(scene.camera.axes()[2].abs_diff_eq(Vec3::NEG_Z, 1e-6));
    let [Light::Sun { to_light, intensity, .. }, Light::Point { position, intensity: at_one }] =
        scene.lights[..]
    else {
        panic!("a sun and a point: {:?}", scene.lights)
    };
    assert!(to_light.abs_diff_eq(Vec3::Z, 1e-6) && intensity.abs_diff_eq(Vec3::ONE, 1e-6));
    assert_eq!(position, Vec3::new(1.0, 2.0, 3.0));
    assert!(at_one.abs_diff_eq(Vec3::new(2.0, 1.0, 0.0), 1e-6));
}

#[test]
fn what_is_not_supported_is_refused_or_named() {
    let glb = |rest: &str| Binary::square().glb(&square("{}", rest));
    let error = refused(&glb(r#","extensionsRequired":["KHR_draco_mesh_compression"]"#));
    assert!(error.contains("KHR_draco_mesh_compression, which is not supported"), "{error}");
    let warnings = loaded(&glb(r#","extensionsUsed":["KHR_materials_sheen"]"#)).warnings;
    let still = loaded(&glb(r#","skins":[{"joints":[0]}],"animations":[]"#)).warnings;
    assert_eq!(still, [""; 0], "no mesh has this skin");
    let skinned = square("{}", r#","skins":[{"joints":[0]}]"#)
        .replace(r#"{"mesh":0}"#, r#"{"mesh":0,"skin":0}"#);
    let still = loaded(&Binary::square().glb(&skinned)).warnings;
    assert_eq!(still, ["scene.gltf: skins are not supported; meshes stand still"]);
    assert_eq!(
        warnings,
        ["scene.gltf: extension KHR_materials_sheen is not supported; drawn without it"]
    );
}

#[test]
fn broken_files_are_refused_by_one_line_that_says_where() {
    let whole = Binary::square().glb(&square("{}", ""));
    for length in 0..whole.len() {
        refused(&whole[..length]);
    }
    let changed = |from: &str, to: &str| {
        let mut binary = Binary::square();
        let scene = square("{}", "").replace(from, to);
        binary.accessors.iter_mut().for_each(|accessor| *accessor = accessor.replace(from, to));
        binary.views.iter_mut().for_each(|view| *view = view.replace(from, to));
        refused(&binary.glb(&scene))
    };
    for (from, to, expected) in [
        (r#""indices":2"#, r#""indices":7"#, "accessor 7 does not exist"),
        (r#""POSITION":0"#, r#""POSITION":1"#, "accessor 1 needs elements of 3"),
        (r#""POSITION":0"#, r#""NORMAL":0"#, "has no positions"),
        (r#""count":6"#, r#""count":9"#, "accessor 2 reaches beyond"),
        (r#""count":4"#, r#""count":99999999999"#, "more than max_triangles allows"),
        (r#""count":4"#, r#""count":3"#, "index 3 of 3 vertices"),
        (r#""byteLength":48"#, r#""byteLength":18446744073709551615"#, "buffer view 0 reaches"),
        (r#""material":0"#, r#""material":5"#, "material that does not exist"),
        (r#"{"mesh":0}"#, r#"{"mesh":9}"#, "mesh 9 does not exist"),
        (r#"{"mesh":0}"#, r#"{"mesh":0,"children":[0]}"#, "reached twice"),
        (r#"{"mesh":0}"#, r#"{"mesh":0,"scale":[1e38,1e38,1e38]}"#, "beyond 1e18"),
        (r#"{"mesh":0}"#, r#"{"mesh":0,"rotation":[0,0,0,0]}"#, "rotation that is none"),
    ] {
        let error = changed(from, to);
        assert!(error.contains(expected), "{to}: {error}");
    }
    let load = |text: &str| refused(text.as_bytes());
    assert!(load(r#"{"buffers":{"a":{}}}"#).contains("is glTF 1; only glTF 2"));
    assert!(load(r#"{"asset":{"version":"1.1"}}"#).contains("is glTF 1.1; only glTF 2"));
    assert!(load(r#"{"asset":{"version":"2.0"},"#).contains("is no valid glTF: EOF"));
    let mut old = whole.clone();
    old[4] = 1;
    assert!(refused(&old).contains("GLB of version 1"));
    // Animations are not played; what is wrong with them does not matter.
    loaded(&Binary::square().glb(&square("{}", r#","animations":[{"channels":5}]"#)));
    let options = LoadOptions { max_triangles: 1, ..LoadOptions::default() };
    let error = load_gltf_bytes(&whole, &options).expect_err("a refusal");
    assert!(error.to_string().contains("max_triangles"), "{error}");
}

#[test]
fn orthographic_cameras_have_the_height_of_the_file() {
    let rest = r#","cameras":[{"type":"orthographic","orthographic":
        {"xmag":3,"ymag":1.5,"znear":0,"zfar":10}}]"#;
    let nodes = r#"[{"mesh":0},{"camera":0,"translation":[0,0,4]}]"#;
    let scene = square("{}", rest)
        .replace(r#""nodes":[0]"#, r#""nodes":[0,1]"#)
        .replace(r#"[{"mesh":0}]"#, nodes);
    let loaded = loaded(&Binary::square().glb(&scene));
    assert_eq!(loaded.warnings, [""; 0]);
    let camera = loaded.scene.camera;
    assert_eq!((camera.eye, camera.orthographic), (Vec3::Z * 4.0, Some(3.0)));
    assert!((camera.near - 1e-5).abs() < 1e-9);
}
