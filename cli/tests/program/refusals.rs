//! What the program refuses, in one line with exit code 2.

use crate::folder::{Folder, text};
use std::fs;

#[test]
fn bad_scene_files_are_refused() {
    let folder = Folder::new();
    folder.refuses("missing.obj -o a.png", &["missing.obj"]);
    folder.put("empty.obj", "");
    folder.refuses("empty.obj -o a.png", &["empty.obj"]);
    folder.put("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    folder.refuses("index.obj -o a.png", &["index.obj", "4"]);
    folder.put("nan.obj", "v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n");
    folder.refuses("nan.obj -o a.png", &["nan.obj", "3"]);
    folder.refuses(". -o a.png", &["."]);
}

#[test]
fn bad_images_are_refused() {
    let folder = Folder::new();
    folder.put_image("whole.png", [0.2, 0.4, 0.6, 1.0]);
    let whole = fs::read(folder.path("whole.png")).unwrap();
    folder.put("cut.png", &whole[..whole.len() / 2]);
    folder.put("text.png", "not a picture");
    for option in ["--albedo", "--height", "--lighting lit --normal"] {
        folder.refuses(&format!("quad.obj {option} cut.png -o a.png"), &["cut.png"]);
        folder.refuses(&format!("quad.obj {option} text.png -o a.png"), &["text.png"]);
        folder.refuses(&format!("quad.obj {option} missing.png -o a.png"), &["missing.png"]);
    }
    folder.refuses("compare whole.png cut.png", &["cut.png"]);
    folder.refuses("compare text.png whole.png", &["text.png"]);
    folder.refuses("compare whole.png missing.png", &["missing.png"]);
    folder.refuses("compare . whole.png", &[".", "not a regular file"]);
}

#[test]
fn bad_options_are_refused() {
    let folder = Folder::new();
    for (line, word) in [
        ("--size 0x0", "--size"),
        ("--size 0x36", "--size"),
        ("--size 32769x1", "--size"),
        ("--size 8x8 --region 0,0,9,1", "--region"),
        ("--region 1,2,3", "--region"),
        ("--base-color -1", "--base-color"),
        ("--size 64", "--size"),
        ("--size -64x36", "--size"),
        ("--size 99999999999x1", "--size"),
        ("--filter sharp", "--filter"),
        ("--visible none", "--visible"),
        ("--parallax maybe", "--parallax"),
        ("--msaa 3", "--msaa"),
        ("--tile 33", "--tile"),
        ("--samples 0", "--samples"),
        ("--samples 1e9", "--samples"),
        ("--lines 1", "--lines"),
        ("--max-anisotropy inf", "--max-anisotropy"),
        ("--max-anisotropy -1", "--max-anisotropy"),
        ("--max-stretch 0.5", "--max-stretch"),
        ("--far-field-mib 5000", "--far-field-mib"),
        ("--background nocolour", "--background"),
        ("--background 256,0,0", "--background"),
        ("--eye nan,0,0", "--eye"),
        ("--eye 1,2", "--eye"),
        ("--target inf,0,0", "--target"),
        ("--up 0,0,0", "--up"),
        ("--up 1e30,0,0", "--up"),
        ("--fov 180", "--fov"),
        ("--fov nan", "--fov"),
        ("--near -1", "--near"),
        ("--relief-depth 2", "--relief-depth"),
        ("--max-image-side 0", "--max-image-side"),
        ("--max-triangles 1", "--max-triangles"),
        ("--threads 99999", "--threads"),
        ("--repeat 0", "--repeat"),
        ("--nonsense", "--nonsense"),
        ("--eye 0,0,1 --target 0,0,1", "--eye"),
    ] {
        folder.refuses(&format!("quad.obj -o a.png {line}"), &[word]);
    }
    folder.refuses("--height a.png -o a.png", &["SCENE"]);
    folder.refuses("compare", &["<A>"]);
}

#[test]
fn bad_options_of_light_are_refused() {
    let folder = Folder::new();
    for (line, word) in [
        ("--roughness 1.5", "--roughness"),
        ("--metallic -1", "--metallic"),
        ("--emissive -1", "--emissive"),
        ("--sun 0,0,0", "--sun"),
        ("--point-light 1,2,3,nan,0,0", "--point-light"),
        ("--sky -1", "--sky"),
        ("--sky 1/2", "--sky"),
        ("--sun 1,1,1,1,1,1,91", "--sun"),
        ("--environment missing.hdr --lighting lit", "missing.hdr"),
        ("--environment quad.obj", "quad.obj"),
        ("--environment a.hdr --sky 1", "--sky"),
        ("--environment a.hdr --environment-turn 400", "--environment-turn"),
        ("--environment-turn 40", "--environment"),
        ("--exposure 33", "--exposure"),
        ("--exposure nan", "--exposure"),
        ("--tone filmic", "--tone"),
    ] {
        folder.refuses(&format!("quad.obj -o a.png {line}"), &[word]);
    }
}

#[test]
fn unwritable_outputs_are_refused_before_the_work() {
    let folder = Folder::new();
    fs::create_dir(folder.path("folder.png")).unwrap();
    folder.put_image("a.png", [0.5, 0.5, 0.5, 1.0]);
    for option in ["-o", "-o good.png --stats"] {
        folder.refuses(&format!("missing.obj {option} no/such/a.png"), &["no/such/a.png"]);
        folder.refuses(&format!("missing.obj {option} folder.png"), &["folder.png"]);
    }
    for name in ["a", "a.gif", ".png"] {
        folder.refuses(&format!("missing.obj -o {name}"), &[name]);
    }
    folder.refuses("compare missing.png a.png --heatmap no/h.png", &["no/h.png"]);
    folder.refuses("compare a.png a.png --max-pixels 191", &["a.png", "16 x 12", "--max-pixels"]);
    folder.refuses("missing.obj -o a.png --stats a.png", &["--stats"]);
}

#[test]
fn line_break_in_a_name_stays_one_line() {
    let folder = Folder::new();
    let output = folder.command("").arg("no\nsuch.obj").output().unwrap();
    assert_eq!((output.status.code(), text(&output.stderr).lines().count()), (Some(2), 1));
}
