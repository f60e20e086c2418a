//! Pictures as files: their size, format, background and light.

use crate::folder::{Folder, size_of_image, text};
use std::fs;

#[test]
fn picture_has_the_size_and_format_asked_for() {
    let folder = Folder::new();
    for name in ["a.png", "a.jpg", "a.tga", "a.tiff", "a.bmp", "a.exr"] {
        folder.succeeds(&format!("quad.obj --size 64x36 -o {name}"));
        assert_eq!(size_of_image(&folder.path(name)), (64, 36), "{name}");
    }
    folder.succeeds("render quad.obj --size 64x36 -o b.png");
    assert_eq!(fs::read(folder.path("a.png")).unwrap(), fs::read(folder.path("b.png")).unwrap());
    let piped = folder.succeeds("quad.obj --size 64x36 -o -");
    assert_eq!(fs::read(folder.path("a.png")).unwrap(), piped.stdout);
}

#[test]
fn bare_program_draws_the_built_in_scene_and_says_so() {
    let folder = Folder::new();
    // The size only saves time.
    let output = folder.succeeds("--size 64x36");
    let said = text(&output.stderr);
    assert!(said.contains("built-in scene") && said.contains("wrote basrelief.png"), "{said}");
    assert_eq!(size_of_image(&folder.path("basrelief.png")), (64, 36));
}

#[test]
fn quiet_says_nothing() {
    let folder = Folder::new();
    let output = folder.succeeds("quad.obj --size 64x36 -q -o a.png");
    assert!(output.stdout.is_empty() && output.stderr.is_empty(), "{}", text(&output.stderr));
}

#[test]
fn background_is_written_as_given() {
    let folder = Folder::new();
    let line = "quad.obj --size 8x8 --eye -1,2,9 --target 0,5,20";
    for (color, expected) in
        [("#1080ff", [16, 128, 255, 255]), ("7,77,177", [7, 77, 177, 255]), ("transparent", [0; 4])]
    {
        folder.succeeds(&format!("{line} --background {color} -o a.png"));
        let image = image::open(folder.path("a.png")).unwrap().to_rgba8();
        assert!(image.pixels().all(|pixel| pixel.0 == expected), "{color}");
    }
}

#[test]
fn exposure_and_tone_make_the_picture_and_tone_leaves_light_as_it_is() {
    let folder = Folder::new();
    let draw = |options: &str| {
        let line = "quad.obj -q -s 4x4 --eye 0,0,1 --target 0,0,0 --background 80,80,80 -o";
        folder.succeeds(&format!("{line} {options}"));
        image::open(folder.path(options.split(' ').next().unwrap())).unwrap().to_rgb32f()
    };
    let light = |options: &str| draw(options).get_pixel(1, 1).0[0];
    let plain = light("a.exr");
    assert_eq!(light("b.exr --exposure 2 --tone neutral"), plain * 4.0);
    // White as it is, and by a tone that keeps 1 for light of no end.
    let white = [light("a.png"), light("a.jpg")];
    let toned = [light("b.png --tone neutral"), light("b.jpg --tone neutral")];
    assert!(white[0] > 0.99 && white[1] > 0.98);
    assert!(toned[0] < 0.98 && (toned[0] - toned[1]).abs() < 0.02, "{toned:?}");
}

#[test]
fn an_environment_lights_as_a_sky_of_its_colour_does() {
    let folder = Folder::new();
    folder.put_image("sky.exr", [0.25, 0.5, 0.75, 1.0]);
    fs::create_dir(folder.path("scene")).unwrap();
    folder.put_image("scene/sky.exr", [0.25, 0.5, 0.75, 1.0]);
    folder.put("scene/s.toml", "model = '../quad.obj'\n[light]\nenvironment = 'sky.exr'");
    let draw = |options: &str| {
        folder.succeeds(&format!("{options} -q -s 8x8 --lighting lit -o a.png"));
        image::open(folder.path("a.png")).unwrap().to_rgb8()
    };
    let expected = draw("quad.obj --sky 0.25,0.5,0.75");
    let found =
        [draw("quad.obj --environment sky.exr --environment-turn 90"), draw("scene/s.toml")];
    for found in found {
        let pixels = found.iter().zip(expected.iter());
        assert!(pixels.clone().all(|(a, b)| a.abs_diff(*b) <= 1));
    }
}

#[test]
fn float_output_is_linear() {
    let folder = Folder::new();
    folder.succeeds(
        "quad.obj --size 8x8 --eye -1,2,9 --target 0,5,20 --background #808080 -q -o a.exr",
    );
    let image = image::open(folder.path("a.exr")).unwrap();
    assert_eq!(image.color(), image::ColorType::Rgb32F);
    let linear = basrelief::texture::linear_from_srgb8(0x80);
    assert!(image.into_rgb32f().pixels().all(|pixel| pixel.0 == [linear; 3]));
}
