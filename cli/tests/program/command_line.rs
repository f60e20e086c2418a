//! The program as its users meet it: options, figures, help, terminals.

use crate::folder::{Folder, json, skipped, text};
use std::fs;
use std::process::Command;

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
