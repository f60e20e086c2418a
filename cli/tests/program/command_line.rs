//! The program as its users meet it: exit codes, messages, files.

use crate::folder::{Folder, json, skipped, text};
use basrelief::Frame;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The names of all files, sorted.
#[cfg(unix)]
fn names(folder: &Folder) -> Vec<std::ffi::OsString> {
    folder.contents().into_iter().map(|(path, _)| path.file_name().unwrap().to_owned()).collect()
}

fn size_of_image(path: &Path) -> (u32, u32) {
    image::image_dimensions(path).unwrap()
}

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

#[cfg(target_os = "linux")]
#[test]
fn full_disk_is_refused() {
    let folder = Folder::new();
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let output = folder.command("quad.obj --size 8x8 -q -o -").stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("stdout"));
}

/// A file that may not grow past a few kilobytes, like one on a full disk.
#[cfg(target_os = "linux")]
#[test]
fn disk_that_fills_up_leaves_the_old_file() {
    let folder = Folder::new();
    folder.put("out.bmp", "old");
    let program = env!("CARGO_BIN_EXE_basrelief");
    let script =
        format!("trap '' XFSZ; ulimit -f 8; exec {program} quad.obj --size 200x200 -q -o out.bmp");
    let mut command = Command::new("sh");
    // Where coverage is measured, its own file would not fit either.
    command
        .args(["-c", &script])
        .current_dir(folder.path("."))
        .env("LLVM_PROFILE_FILE", "/dev/null");
    let output = command.output().unwrap();
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(
        message.starts_with("basrelief: out.bmp: cannot be written: File too large"),
        "{message}"
    );
    assert!(!message.contains(".tmp") && message.lines().count() == 1, "{message}");
    assert_eq!(names(&folder), ["out.bmp", "quad.obj"]);
    assert_eq!(fs::read(folder.path("out.bmp")).unwrap(), b"old");
}

#[test]
fn line_break_in_a_name_stays_one_line() {
    let folder = Folder::new();
    let output = folder.command("").arg("no\nsuch.obj").output().unwrap();
    assert_eq!((output.status.code(), text(&output.stderr).lines().count()), (Some(2), 1));
}

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
fn every_option_is_accepted() {
    let folder = Folder::new();
    folder.put_image("map.png", [0.5, 0.5, 0.5, 1.0]);
    folder.succeeds(
        "quad.obj -o a.png --size 8x8 --filter visible --visible resolved --parallax on --derivatives flat --formulas printed \
         --texel-budget 64 --max-anisotropy 8 --max-stretch 2 --samples 2 --lines 8 --far-field off --far-field-mib 1 --lighting lit --cull \
         --msaa 1 --tile 8 --albedo map.png --height map.png --normal map.png --height-sense white-deep --relief-depth 0.1 \
         --normal-y down --wrap mirror --allow-outside --base-color 0.5 --metallic 0.5 --roughness 0.3 --emissive 0.1,0.2,0.3 --cut-out off --region 0,1,7,6 \
         --max-image-side 64 --max-image-mib 64 --max-triangles 9 --max-textures 9 --crease-angle 30 --eye -1,-1,3 --target -0.1,0,0 --up 0,1,-0.1 --fov 40 --near 0.1 \
         --sun -1,1,1 --sun 1,1,1,0.5,0.5,0.5,2 --point-light -1,0,2 --environment map.png --environment-turn -30 --exposure 0.5 --tone neutral --background skyblue --threads 1 \
         --quiet --repeat 2 --stats stats.json --save-scene kept.toml --json",
    );
}

#[test]
fn stats_have_every_figure() {
    let folder = Folder::new();
    folder.succeeds(
        "quad.obj --size 64x36 -o a.png --repeat 3 --threads 1 --filter nearest --stats stats.json",
    );
    let stats = json(&fs::read(folder.path("stats.json")).unwrap());
    let numbers = "frame_ms load_ms geometry_ms raster_ms binning_ms coverage_ms attributes_ms shade_ms pixels_shaded quads_shaded \
                   triangles_in triangles_drawn texels_tested texels_visible threads width height";
    for key in numbers.split_whitespace() {
        assert!(stats[key].as_f64().is_some_and(|value| value >= 0.0), "{key} in {stats}");
    }
    assert_eq!(
        (&stats["threads"], &stats["width"], &stats["height"]),
        (&1.into(), &64.into(), &36.into())
    );
    assert_eq!(
        (stats["simd"].as_str(), stats["filter"].as_str()),
        (Some(basrelief::SIMD_LEVEL), Some("nearest"))
    );
    assert_eq!(stats["version"], env!("CARGO_PKG_VERSION"));
    let printed = folder.succeeds("quad.obj --size 8x8 -q -o a.png --stats -");
    assert!(json(&printed.stdout)["frame_ms"].is_number());
}

#[test]
fn version_names_the_instruction_set() {
    let output = Folder::new().succeeds("--version");
    let said = text(&output.stdout);
    assert!(
        said.contains(env!("CARGO_PKG_VERSION")) && said.contains(basrelief::SIMD_LEVEL),
        "{said}"
    );
}

#[test]
fn shells_and_readers_are_served() {
    let folder = Folder::new();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = text(&folder.succeeds(&format!("completions {shell}")).stdout);
        assert!(
            ["basrelief", "turntable", "compare", "golden"]
                .iter()
                .all(|word| script.contains(word)),
            "{shell}"
        );
    }
    let page = text(&folder.succeeds("man").stdout);
    assert!(
        [".TH basrelief 1", ".SH OPTIONS", "far\\-field\\-mib", "130"]
            .iter()
            .all(|word| page.contains(word)),
        "{page}"
    );
    fs::create_dir(folder.path("man1")).unwrap();
    folder.succeeds("man -o man1");
    for name in ["basrelief", "basrelief-render", "basrelief-compare", "basrelief-join"] {
        let page = fs::read_to_string(folder.path(&format!("man1/{name}.1"))).unwrap();
        assert!(page.contains(&format!(".TH {name} 1")), "{page}");
    }
    folder.refuses("man -o missing", &["missing"]);
}

#[test]
fn help_says_what_exit_codes_mean() {
    let help = text(&Folder::new().succeeds("--help").stdout);
    assert!(help.contains("Exit codes:") && help.contains("NO_COLOR"), "{help}");
    assert!(
        help.lines().all(|line| line.chars().count() <= 120),
        "wide terminals get no wider lines"
    );
}

#[cfg(target_os = "linux")]
#[test]
fn no_color_is_heeded_on_terminals() {
    // script(1) gives the program a terminal.
    let help = |no_color: Option<&str>| {
        let mut command = Command::new("script");
        command
            .args(["-qec", concat!(env!("CARGO_BIN_EXE_basrelief"), " --help"), "/dev/null"])
            .env("TERM", "xterm");
        command.env_remove("NO_COLOR").envs(no_color.map(|value| ("NO_COLOR", value)));
        command.stdin(std::process::Stdio::null()).output().map(|output| text(&output.stdout))
    };
    let Ok(styled) = help(None) else { return skipped("there is no script(1) on this machine") };
    assert!(styled.contains("\u{1b}["), "{styled}");
    let plain = help(Some("1")).unwrap();
    assert!(plain.contains("--turntable") && !plain.contains('\u{1b}'), "{plain}");
}

#[cfg(target_os = "linux")]
#[test]
fn progress_tells_the_stages_on_terminals() {
    let folder = Folder::new();
    let mut command = Command::new("script");
    let line = concat!(
        env!("CARGO_BIN_EXE_basrelief"),
        " quad.obj --albedo a.png --size 16x16 -o out.png"
    );
    folder.put_image("a.png", [0.5, 0.25, 0.125, 1.0]);
    command.args(["-qec", line, "/dev/null"]).env("TERM", "xterm").current_dir(folder.path("."));
    let Ok(output) = command.stdin(std::process::Stdio::null()).output() else {
        return skipped("there is no script(1) on this machine");
    };
    let seen = text(&output.stdout);
    let stages = [
        "reading the model",
        "decoding images (1 of 1)",
        "building pyramids (1 of 1)",
        "building tables",
        "drawing",
    ];
    let places: Option<Vec<usize>> = stages.iter().map(|stage| seen.find(stage)).collect();
    assert!(output.status.success() && places.is_some_and(|places| places.is_sorted()), "{seen:?}");
    assert!(folder.succeeds("quad.obj --size 16x16 -o out.png").stderr.iter().all(|&c| c != b'\r'));
}

#[test]
fn reader_that_has_seen_enough_is_no_error() {
    let folder = Folder::new();
    for line in ["--help", "completions bash", "man"] {
        let mut child = folder
            .command(line)
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert!(
            output.status.success() && output.stderr.is_empty(),
            "{line}: {}",
            text(&output.stderr)
        );
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

#[test]
fn equal_images_compare_as_equal() {
    let folder = Folder::new();
    folder.put_image("a.png", [0.5, 0.25, 0.125, 1.0]);
    let report = json(&folder.succeeds("compare a.png a.png --json --min-psnr 99").stdout);
    assert_eq!((&report["is_equal"], &report["psnr_db"]), (&true.into(), &serde_json::Value::Null));
    assert_eq!((&report["largest_error"], &report["ssim"]), (&0.0.into(), &1.0.into()));
    assert!(text(&folder.succeeds("compare a.png a.png").stdout).contains("infinite"));
}

#[test]
fn different_images_are_measured() {
    let folder = Folder::new();
    let mut frame = Frame::filled(16, 12, [0.5, 0.5, 0.5, 1.0]);
    frame.save(folder.path("a.png")).unwrap();
    frame.pixels[3 * 16 + 5][2] = 0.0;
    frame.save(folder.path("b.png")).unwrap();
    let report = json(&folder.succeeds("compare a.png b.png --json --heatmap h.png").stdout);
    assert_eq!(
        (&report["x"], &report["y"], report["channel"].as_str()),
        (&5.into(), &3.into(), Some("blue"))
    );
    // 0.5 in linear light is byte 188; one channel of one pixel of 192 is off by 188 / 255.
    let expected = 10.0 * (16.0 * 12.0 * 3.0 / (188.0_f64 / 255.0).powi(2)).log10();
    assert!((report["psnr_db"].as_f64().unwrap() - expected).abs() < 1e-4, "{report}");
    assert_eq!(size_of_image(&folder.path("h.png")), (16, 12));
    assert!(text(&folder.succeeds("compare a.png b.png --min-psnr 10").stdout).contains("PSNR"));
    let below = folder.run("compare a.png b.png --min-psnr 90");
    assert_eq!(below.status.code(), Some(1));
    assert!(text(&below.stderr).contains("--min-psnr") && text(&below.stdout).contains("SSIM"));
}

#[test]
fn images_that_cannot_be_compared_are_refused() {
    let folder = Folder::new();
    folder.put_image("a.png", [0.5, 0.5, 0.5, 1.0]);
    folder.put_image("clear.png", [0.0; 4]);
    Frame::filled(3, 2, [1.0; 4]).save(folder.path("small.png")).unwrap();
    folder.refuses(
        "compare a.png small.png --heatmap h.png",
        &["a.png", "small.png", "16x12", "3x2"],
    );
    folder.refuses("compare a.png clear.png", &["opaque"]);
    folder.refuses("compare a.png a.png --min-psnr nan", &["--min-psnr"]);
    folder.refuses("compare a.png a.png --heatmap-max 0", &["--heatmap-max"]);
}

/// Runs two ways to overwrite `out.png` in turn, ended by `end` at `num` moments spread over a
/// whole run.
#[cfg(unix)]
fn interrupt(folder: &Folder, num: u32, end: impl Fn(&mut std::process::Child)) {
    let lines = ["white", "navy"].map(|color| {
        format!("quad.obj --size 320x180 -q -f nearest -o out.png --background {color}")
    });
    let mut longest = std::time::Duration::ZERO;
    let whole = lines.each_ref().map(|line| {
        let start = std::time::Instant::now();
        folder.succeeds(line);
        longest = longest.max(start.elapsed());
        fs::read(folder.path("out.png")).unwrap()
    });
    for i in 0..num {
        let mut child = folder.command(&lines[i as usize % 2]).spawn().unwrap();
        std::thread::sleep(longest * i / num);
        end(&mut child);
        child.wait().unwrap();
        assert!(whole.contains(&fs::read(folder.path("out.png")).unwrap()), "moment {i} of {num}");
    }
}

/// The next run removes what the killed ones left.
#[cfg(unix)]
#[test]
fn program_killed_at_100_moments_leaves_a_whole_image() {
    let folder = Folder::new();
    interrupt(&folder, 100, |child| child.kill().unwrap());
    folder.succeeds("quad.obj --size 8x8 -q -o out.png");
    assert_eq!(names(&folder), ["out.png", "quad.obj"]);
}

#[cfg(unix)]
#[test]
fn interrupted_program_leaves_nothing_behind() {
    let folder = Folder::new();
    interrupt(&folder, 20, |child| {
        // It may have ended by itself.
        let _ = Command::new("kill").args(["-INT", &child.id().to_string()]).output();
    });
    assert_eq!(names(&folder), ["out.png", "quad.obj"]);
}
