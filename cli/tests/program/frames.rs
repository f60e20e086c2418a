//! Many frames, shards, regions and their joining: the same bytes whichever way the work is split.

use crate::folder::{Folder, json, text};
use std::collections::BTreeMap;
use std::fs;

const SMALL: &str = "quad.obj -q --size 24x16 -f nearest";

/// Names and bytes of the PNG files of a folder within the test's.
fn pictures(folder: &Folder, name: &str) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder.path(name)).unwrap().map(|entry| entry.unwrap());
    entries.map(|e| (e.file_name().into_string().unwrap(), fs::read(e.path()).unwrap())).collect()
}

fn folder_with(subfolders: &[&str]) -> Folder {
    let folder = Folder::new();
    subfolders.iter().for_each(|name| fs::create_dir(folder.path(name)).unwrap());
    folder
}

#[test]
fn turntable_draws_numbered_frames_that_differ() {
    let folder = folder_with(&["a"]);
    folder.succeeds(&format!("{SMALL} --turntable 5 -o a/f##.png"));
    let frames = pictures(&folder, "a");
    assert_eq!(
        frames.keys().collect::<Vec<_>>(),
        ["f01.png", "f02.png", "f03.png", "f04.png", "f05.png"]
    );
    let different: std::collections::BTreeSet<_> = frames.values().collect();
    assert_eq!(different.len(), 5);
    // The first is the still picture.
    folder.succeeds(&format!("{SMALL} -o still.png"));
    assert_eq!(fs::read(folder.path("still.png")).unwrap(), frames["f01.png"]);
    // Without a name, in the current folder.
    folder.succeeds(&format!("{SMALL} --turntable 5 --frames 4"));
    assert_eq!(fs::read(folder.path("frame_0004.png")).unwrap(), frames["f04.png"]);
}

#[test]
fn frames_are_picked_and_those_past_the_end_are_no_error() {
    let folder = folder_with(&["a", "b"]);
    folder.succeeds(&format!("{SMALL} --turntable 12 -o a/#.png --frames 2-100x4,11"));
    assert_eq!(
        pictures(&folder, "a").keys().collect::<Vec<_>>(),
        ["10.png", "11.png", "2.png", "6.png"]
    );
    folder.succeeds(&format!("{SMALL} --turntable 12 -o b/#.png --frames 13-99"));
    assert!(pictures(&folder, "b").is_empty());
}

#[test]
fn shards_and_repeated_runs_draw_the_same_bytes() {
    let folder = folder_with(&["whole", "split", "slurm"]);
    let line = format!("{SMALL} --turntable 10 -o");
    folder.succeeds(&format!("{line} whole/#.png"));
    let whole = pictures(&folder, "whole");
    assert_eq!(whole.len(), 10);
    for (i, threads) in [(1, 1), (3, 2), (2, 3)] {
        folder.succeeds(&format!("{line} split/#.png --shard {i}/3 --threads {threads}"));
    }
    assert!(pictures(&folder, "split") == whole);
    // One frame lost, one damaged: only what is missing is drawn again.
    fs::remove_file(folder.path("split/7.png")).unwrap();
    folder.put("split/8.png", "mine");
    folder.succeeds(&format!("{line} split/#.png --skip-existing"));
    let mut expected = whole.clone();
    expected.insert("8.png".into(), b"mine".to_vec());
    assert!(pictures(&folder, "split") == expected);
    for task in 5..9 {
        let mut command = folder.command(&format!("{line} slurm/#.png"));
        for (name, value) in [("ID", task), ("MIN", 5), ("MAX", 8), ("COUNT", 4), ("STEP", 1)] {
            command.env(format!("SLURM_ARRAY_TASK_{name}"), value.to_string());
        }
        assert!(command.status().unwrap().success());
        let expected = [3, 6, 8, 10][task - 5];
        assert_eq!(pictures(&folder, "slurm").len(), expected, "after task {task}");
    }
    assert!(pictures(&folder, "slurm") == whole);
}

#[test]
fn indexed_job_needs_the_number_of_its_pods() {
    let folder = folder_with(&["a"]);
    let run = |options: &str| {
        let line = format!("{SMALL} --turntable 7 -o a/#.png {options}");
        folder.command(&line).env("JOB_COMPLETION_INDEX", "1").output().unwrap()
    };
    assert!(run("--shards 3").status.success());
    assert_eq!(pictures(&folder, "a").keys().collect::<Vec<_>>(), ["2.png", "5.png"]);
    let refused = run("");
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("--shards N"));
    assert!(run("--shard 1/1").status.success());
    assert_eq!(pictures(&folder, "a").len(), 7);
    folder.refuses(&format!("{SMALL} --turntable 7 --shards 3"), &["JOB_COMPLETION_INDEX"]);
}

#[test]
fn single_pictures_take_no_notice_of_a_cluster() {
    let folder = Folder::new();
    let mut command = folder.command(&format!("{SMALL} -o a.png"));
    command.env("SLURM_ARRAY_TASK_ID", "3").env("JOB_COMPLETION_INDEX", "1");
    assert!(command.status().unwrap().success() && folder.path("a.png").is_file());
}

#[test]
fn camera_path_is_followed() {
    let folder = folder_with(&["a"]);
    folder.put(
        "path.toml",
        "[[key]]\nframe = 3\neye = [0, 0, 4]\n[[key]]\nframe = 5\neye = [1.0, 0, 3]\nfov = 30\n",
    );
    folder.succeeds(&format!("{SMALL} --target 0,0,0 --camera-path path.toml -o a/#.png"));
    let frames = pictures(&folder, "a");
    assert_eq!(frames.keys().collect::<Vec<_>>(), ["3.png", "4.png", "5.png"]);
    folder.succeeds(&format!("{SMALL} --target 0,0,0 --eye 1,0,3 --fov 30 -o still.png"));
    assert_eq!(fs::read(folder.path("still.png")).unwrap(), frames["5.png"]);
    folder.put("wrong.toml", "[[key]]\nframe = 3\n\nlens = 50\n");
    folder.refuses(&format!("{SMALL} --camera-path wrong.toml"), &["wrong.toml:4", "lens"]);
    // Between the keys the camera would pass through its target.
    folder.put(
        "wrong.toml",
        "[[key]]\nframe = 1\neye = [0, 0, 4]\ntarget = [0, 0, 0]\n[[key]]\nframe = 3\neye = [0, 0, -4]\n",
    );
    folder.refuses(&format!("{SMALL} --camera-path wrong.toml"), &["frame 2", "camera"]);
}

#[test]
fn options_that_do_not_fit_together_are_refused() {
    let folder = Folder::new();
    for (line, word) in [
        ("--turntable 0", "--turntable"),
        ("--turntable 3 --camera-path a.toml", "--camera-path"),
        ("--camera-path missing.toml", "missing.toml"),
        ("--turntable 3 -o plain.png", "plain.png"),
        ("--turntable 3 -o -", "####"),
        ("--turntable 3 -o no/#.png", "no/#.png"),
        ("--turntable 3 -o #.gif", "#.gif"),
        ("--turntable 3 --frames 5-1", "--frames"),
        ("--turntable 3 --shard 4/3", "--shard"),
        ("--turntable 3 --repeat 2", "--repeat"),
        ("--frames 1-3", "--frames"),
        ("--shard 1/2", "--shard"),
        ("--json -o -", "--json"),
        ("--json --stats -", "--json"),
        ("-o a.png --save-scene a.png", "--save-scene"),
    ] {
        folder.refuses(&format!("{SMALL} {line}"), &[word]);
    }
}

#[test]
fn every_picture_is_a_line_of_json() {
    let folder = folder_with(&["a"]);
    let output = folder.succeeds(&format!("{SMALL} --turntable 3 -o a/#.png --json"));
    let lines: Vec<_> = output.stdout.split_inclusive(|&byte| byte == b'\n').map(json).collect();
    let seen: Vec<_> = lines
        .iter()
        .map(|line| (line["file"].as_str().unwrap(), line["frame"].as_u64().unwrap()))
        .collect();
    assert_eq!(seen, [("a/1.png", 1), ("a/2.png", 2), ("a/3.png", 3)]);
    let still = json(&folder.succeeds(&format!("{SMALL} -o b.png --json")).stdout);
    assert!(still["file"] == "b.png" && still["frame"].is_null() && still["frame_ms"].is_number());
}

#[test]
fn existing_picture_is_left_alone() {
    let folder = Folder::new();
    folder.put("a.png", "mine");
    let output = folder.succeeds("missing.obj -o a.png --skip-existing");
    assert!(text(&output.stderr).contains("1 of 1"));
    assert_eq!(fs::read(folder.path("a.png")).unwrap(), b"mine");
}

#[test]
fn joined_parts_are_the_whole() {
    let folder = Folder::new();
    for background in ["skyblue", "transparent"] {
        let line = format!(
            "quad.obj -q --size 90x70 --background {background} --eye 0.4,0.5,2 --target 0,0,0"
        );
        folder.succeeds(&format!("{line} -o whole.png"));
        // Columns and rows that are odd, and parts without any pixel of the quad.
        let parts = ["0,0,33,41", "33,0,57,17", "33,17,57,24", "0,41,1,29", "1,41,89,29"];
        for (i, part) in parts.iter().enumerate() {
            folder.succeeds(&format!("{line} --region {part} -o part{i}.png"));
        }
        folder.succeeds("join part3.png part0.png part4.png part1.png part2.png -o joined.png");
        let [whole, joined] =
            ["whole.png", "joined.png"].map(|name| fs::read(folder.path(name)).unwrap());
        assert!(whole == joined, "{background}");
        assert_eq!(
            folder.succeeds("join part3.png part0.png part4.png part1.png part2.png -o -").stdout,
            whole
        );
    }
}

#[test]
fn parts_that_do_not_fit_are_refused() {
    let folder = Folder::new();
    for (name, part) in [
        ("a", "0,0,24,8"),
        ("b", "0,8,12,8"),
        ("c", "12,8,12,8"),
        ("d", "10,8,14,8"),
        ("e", "0,9,24,7"),
        ("f", "4,2,8,2"),
    ] {
        folder.succeeds(&format!("{SMALL} --region {part} -o {name}.png"));
    }
    folder.succeeds(&format!("{SMALL} -o plain.png"));
    folder.succeeds(&format!("{SMALL} --region 0,8,12,8 -o b.exr"));
    folder.succeeds("quad.obj -q --size 24x17 --region 0,8,24,9 -o other.png");
    folder.succeeds("join a.png b.png c.png -o whole.png");
    for (parts, words) in [
        ("a.png b.png", ["no part covers", "x 12, y 8"]),
        ("b.png c.png", ["no part covers", "x 0, y 0"]),
        ("a.png", ["no part covers", "x 0, y 8"]),
        ("a.png e.png", ["no part covers", "x 0, y 8"]),
        ("a.png b.png d.png", ["d.png", "overlaps"]),
        ("a.png b.png c.png f.png", ["f.png", "overlaps"]),
        ("a.png a.png b.png c.png", ["a.png", "overlaps"]),
        ("a.png other.png", ["24x16", "24x17"]),
        ("plain.png", ["plain.png", "does not say where it lies"]),
        ("quad.obj", ["quad.obj", "PNG"]),
        ("b.exr c.png", ["b.exr", "not a PNG file"]),
        ("missing.png", ["missing.png", ""]),
    ] {
        folder.refuses(&format!("join {parts} -o new.png"), &words);
    }
    folder.refuses("join a.png b.png c.png -o new.tga", &[".png"]);
    // A part that was cut off shows only in its rows.
    let whole = fs::read(folder.path("b.png")).unwrap();
    folder.put("b.png", &whole[..whole.len() - 40]);
    folder.refuses("join a.png b.png c.png -o new.png", &["b.png"]);
}

#[test]
fn picture_in_bands_is_the_picture_of_its_parts() {
    // Just above the size from which on bands are drawn, 2^24 pixels, of 128 rows each; parts are
    // drawn at once.
    let folder = Folder::new();
    let line = "quad.obj -q --size 32768x520 -f nearest --eye 0,0,0.02 --target 0,0,0 --background #204060";
    folder.succeeds(&format!("{line} -o whole.png"));
    for (i, rows) in ["0,0,32768,263", "0,263,32768,257"].iter().enumerate() {
        folder.succeeds(&format!("{line} --region {rows} -o {i}.png"));
    }
    folder.succeeds("join 0.png 1.png -o joined.png");
    let [whole, joined] =
        ["whole.png", "joined.png"].map(|name| fs::read(folder.path(name)).unwrap());
    assert!(whole == joined);
}
