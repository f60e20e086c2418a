//! Scene files: pictures that can be kept and repeated, and what is said of mistakes in them.

use crate::folder::{Folder, text};
use basrelief::Frame;
use std::fs;

/// A folder with a model of two materials, `left` and `right`, and maps.
fn model() -> Folder {
    let folder = Folder::new();
    fs::create_dir(folder.path("model")).unwrap();
    folder.put(
        "model/two.obj",
        "mtllib two.mtl\nv -1 -1 0\nv 0 -1 0\nv 1 -1 0\nv -1 1 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n\
         usemtl left\nf 1/1 2/2 5/4 4/3\nusemtl right\nf 2/1 3/2 6/4 5/3\n",
    );
    folder.put("model/two.mtl", "newmtl left\nKd 0.2 0.4 0.6\nnewmtl right\nKd 0.6 0.4 0.2\n");
    let mut map = Frame::filled(16, 16, [0.25, 0.25, 0.25, 1.0]);
    map.pixels
        .iter_mut()
        .enumerate()
        .filter(|(i, _)| i % 3 > 0)
        .for_each(|(_, pixel)| *pixel = [0.9, 0.8, 0.7, 1.0]);
    map.save(folder.path("model/map.png")).unwrap();
    folder
}

fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    fs::read(folder.path(name)).unwrap()
}

#[test]
fn saved_scene_draws_the_same_picture() {
    let folder = model();
    fs::create_dir(folder.path("kept")).unwrap();
    for (i, options) in [
        "-q --size 40x30 --far-field off",
        "-q --size 40x30 --eye 3,2,4 --fov 33.3 --near 0.1 --filter ewa --lighting lit --background skyblue --msaa 4",
        "model/two.obj -q --size 40x30 --albedo model/map.png --height model/map.png --relief-depth 0.07 --wrap mirror",
        "-q --size 40x30 --eye 3,2,4 --orthographic 2.5 --near 0.1 --filter horizon",
        "model/two.obj -q --size 40x30 --sun -1,2,3 --sun 1,0,0.5,0.1,0.2,0.3 --point-light 0,0,1 --crease-angle 20.5 --roughness 0.5",
        "model/two.obj -q --size 40x30 --base-color 0.1,0.9,0.3 --region 3,5,20,11 --cull --eye 0,4,0.001 --samples 3 -f truth",
    ]
    .iter()
    .enumerate()
    {
        folder.succeeds(&format!("{options} -o a.png --save-scene kept/{i}.toml"));
        folder.succeeds(&format!("kept/{i}.toml -q -o b.png"));
        assert!(bytes(&folder, "a.png") == bytes(&folder, "b.png"), "{options}\n{}", text(&bytes(&folder, &format!("kept/{i}.toml"))));
        // What is saved from a scene file is that scene file.
        folder.succeeds(&format!("kept/{i}.toml -q -o b.png --save-scene kept/again.toml"));
        assert_eq!(text(&bytes(&folder, &format!("kept/{i}.toml"))), text(&bytes(&folder, "kept/again.toml")));
    }
}

#[test]
fn scene_file_says_what_options_say() {
    let folder = model();
    folder.put(
        "model/scene.toml",
        r##"# Files are named relative to this one.
model = "two.obj"

[all-materials]
albedo = "map.png"
relief-depth = 0.1
wrap = "clamp"

[camera]
eye = [0.5, 1, 2.5]     # whole numbers are numbers, too
target = [0, 0, 0]
fov = 50

[light]
background = "#204060"
sky = "0.1"
[[light.sun]]
direction = [1, 1, 1]
[[light.point-light]]
position = [0, 0, 2]
color = [0.5, 0.25, 0.125]

[frame]
size = "40x30"
msaa = 4
lighting = "lit"
cull = true

[filter]
filter = "trilinear"
parallax = false

[limits]
max-textures = 3
"##,
    );
    folder.succeeds("model/scene.toml -q -o a.png");
    folder.succeeds(
        "model/two.obj -q -o b.png --albedo model/map.png --relief-depth 0.1 --wrap clamp --eye 0.5,1,2.5 --target 0,0,0 --fov 50 \
         --background #204060 --sky 0.1 --sun 1,1,1 --point-light 0,0,2,0.5,0.25,0.125 --size 40x30 --msaa 4 --lighting lit \
         --cull --filter trilinear --parallax off --max-textures 3",
    );
    assert!(bytes(&folder, "a.png") == bytes(&folder, "b.png"));
    // Options override keys; an off overrides an on.
    folder.succeeds(
        "model/scene.toml -q -o a.png --size 20x10 --fov 70 --cull=off --filter bilinear",
    );
    assert_eq!(image::image_dimensions(folder.path("a.png")).unwrap(), (20, 10));
    folder.succeeds(
        "model/two.obj -q -o b.png --albedo model/map.png --relief-depth 0.1 --wrap clamp --eye 0.5,1,2.5 --target 0,0,0 --fov 70 \
         --background #204060 --sky 0.1 --sun 1,1,1 --point-light 0,0,2,0.5,0.25,0.125 --size 20x10 --msaa 4 --lighting lit \
         --filter bilinear --parallax off",
    );
    assert!(bytes(&folder, "a.png") == bytes(&folder, "b.png"));
}

#[test]
fn single_materials_can_be_different() {
    let folder = model();
    let draw = |lines: &str| {
        folder.put(
            "model/scene.toml",
            format!(
                "model = 'two.obj'\n{lines}\n[frame]\nsize = '32x16'\n[camera]\neye = [0, 0, 2]\n"
            ),
        );
        folder.succeeds("model/scene.toml -q -o a.png");
        let image = image::open(folder.path("a.png")).unwrap().to_rgba8();
        [12, 20].map(|x| image.get_pixel(x, 8).0)
    };
    let [left, right] = draw("");
    assert_ne!(left, right);
    let changed = draw("[material.right]\nbase-color = [0.2, 0.4, 0.6]");
    assert_eq!(changed, [left, left]);
    // What is said of one goes before what is said of all.
    let changed = draw(
        "[all-materials]\nbase-color = [0.6, 0.4, 0.2]\n[material.left]\nbase-color = [0.2, 0.4, 0.6]",
    );
    assert_eq!(changed, [left, right]);
    let changed = draw("[material.left]\nalbedo = 'map.png'\nbase-color = [1, 1, 1]");
    assert!(changed[0] != left && changed[1] == right, "{changed:?}");
}

#[test]
fn mistakes_are_named_with_file_and_line() {
    let folder = model();
    for (lines, words) in [
        ("[camera]\ncolour = 3", &["s.toml:2", "unknown field `colour`", "`fov`"][..]),
        ("[cameras]\nfov = 3", &["s.toml:1", "`cameras`"]),
        ("\n\n[filter]\nfilter = 'sharp'", &["s.toml:4", "filter", "`sharp`", "horizon"]),
        ("[filter]\nlines = 99", &["s.toml:2", "lines", "2 to 64"]),
        ("[filter]\nsamples = -1", &["s.toml:2", "samples"]),
        ("[frame]\nsize = '0x3'", &["s.toml:2", "size"]),
        ("[frame]\nmsaa = 3", &["s.toml:2", "msaa", "1, 4 or 8"]),
        ("[frame]\nsize = '8x8'\nregion = '0,0,9,1'", &["s.toml:3", "region"]),
        ("[camera]\nfov = 180", &["s.toml:2", "fov", "degrees"]),
        ("[camera]\neye = [1, 2]", &["s.toml:2", "eye"]),
        ("[camera]\neye = [1, 2, nan]", &["s.toml:2", "eye"]),
        ("[light]\nsky = \"-1\"", &["s.toml:2", "sky"]),
        ("[light]\nbackground = 'nocolour'", &["s.toml:2", "background", "#rrggbb"]),
        ("[[light.sun]]\ndirection = [0, 0, 0]", &["s.toml:", "zero"]),
        ("[[light.sun]]\ncolor = [0, 0, 0]", &["s.toml:1", "direction"]),
        ("[all-materials]\nrelief-depth = 2", &["s.toml:2", "relief-depth"]),
        ("[camera\nfov = 3", &["s.toml:1"]),
        ("fov 3", &["s.toml:1"]),
        ("model = 'missing.obj'", &["missing.obj"]),
        ("model = 'model/two.obj'\n[all-materials]\nheight = 'missing.png'", &["missing.png"]),
        (
            "model = 'model/two.obj'\n[material.middle]\nheight = 'model/map.png'",
            &["middle", "left, right"],
        ),
        ("[all-materials]\nheight = 'model/map.png'", &["model"]),
    ] {
        folder.put("s.toml", lines);
        folder.refuses("s.toml -o a.png", words);
    }
    folder.refuses("missing.toml -o a.png", &["missing.toml", "no such file"]);
    folder.refuses("model/two.obj -o a.png --save-scene no/s.toml", &["no/s.toml"]);
    // The right value on the command line does not mend the file.
    folder.put("s.toml", "[filter]\nlines = 99");
    folder.refuses("s.toml -o a.png --lines 8", &["s.toml:2"]);
}

#[test]
fn saved_scene_names_files_relative_to_itself() {
    let folder = model();
    folder.succeeds(
        "model/two.obj -q --size 8x8 -o a.png --albedo model/map.png --save-scene model/kept.toml",
    );
    let kept = text(&bytes(&folder, "model/kept.toml"));
    assert!(
        kept.contains("model = \"two.obj\"") && kept.contains("albedo = \"map.png\""),
        "{kept}"
    );
    assert!(!kept.contains("all-materials.albedo = \"/"), "{kept}");
}
