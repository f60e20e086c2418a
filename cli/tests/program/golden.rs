//! Golden images, by the library and by the program.

use crate::folder::{Folder, json, text};
use basrelief::Frame;
use basrelief::golden::{OnDifference::*, Thresholds, check};
use std::fs;

fn names(folder: &Folder, name: &str) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder.path(name))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn library_checks_frames() {
    let folder = Folder::new();
    fs::create_dir(folder.path("golden")).unwrap();
    let exact = Thresholds::default();
    for name in ["floor.png", "floor.exr", "floor.tga"] {
        let golden = folder.path("golden").join(name);
        let mut frame = Frame::filled(20, 10, [0.3, 0.2, 0.1, 1.0]);
        let missing = check(&golden, &frame, exact, Fail).unwrap_err().to_string();
        assert!(
            missing.contains(name)
                && missing.contains("no golden image")
                && missing.contains("failed"),
            "{missing}"
        );
        assert_eq!(names(&folder, "golden/failed"), [name.replace("floor.", "floor.actual.")]);
        frame.save(&golden).unwrap();
        check(&golden, &frame, exact, Fail).unwrap();
        assert!(!folder.path("golden/failed").exists(), "what failed before is gone");
        frame.pixels[25][2] = 0.9;
        let differs = check(&golden, &frame, exact, Fail).unwrap_err().to_string();
        assert!(
            differs.contains("1 pixels (0.5000%)") && differs.contains("x 5, y 1"),
            "{differs}"
        );
        let shown =
            ["actual", "expected"].map(|what| name.replace("floor.", &format!("floor.{what}.")));
        assert_eq!(names(&folder, "golden/failed"), [&shown[0], "floor.difference.png", &shown[1]]);
        assert_eq!(
            fs::read(folder.path("golden/failed").join(&shown[1])).unwrap(),
            fs::read(&golden).unwrap()
        );
        // The difference is black but for the one pixel.
        let shown =
            image::open(folder.path("golden/failed/floor.difference.png")).unwrap().to_rgb8();
        let bright: Vec<_> = shown
            .enumerate_pixels()
            .filter(|(.., p)| p.0 != [0; 3])
            .map(|(x, y, _)| (x, y))
            .collect();
        assert_eq!(bright, [(5, 1)]);
        check(&golden, &frame, Thresholds { tolerance: 0.0, share: 0.005 }, Fail).unwrap();
        check(&golden, &frame, exact, Accept).unwrap();
        assert!(!folder.path("golden/failed").exists(), "what is accepted has not failed");
        check(&golden, &frame, exact, Fail).unwrap();
    }
    let other = check(folder.path("golden/floor.png"), &Frame::filled(3, 2, [1.0; 4]), exact, Fail)
        .unwrap_err()
        .to_string();
    assert!(other.contains("20x10") && other.contains("3x2"), "{other}");
}

#[test]
fn program_checks_and_accepts_files() {
    let folder = Folder::new();
    ["golden", "out"].iter().for_each(|name| fs::create_dir(folder.path(name)).unwrap());
    folder.put_image("golden/same.png", [0.5, 0.5, 0.5, 1.0]);
    folder.put_image("golden/other.png", [0.5, 0.5, 0.5, 1.0]);
    folder.put_image("out/same.png", [0.5, 0.5, 0.5, 1.0]);
    folder.put_image("out/other.png", [0.5, 0.25, 0.5, 1.0]);
    folder.put_image("out/new.png", [0.1, 0.2, 0.3, 1.0]);
    assert!(
        text(&folder.succeeds("compare out/same.png --golden golden").stdout).contains("passed")
    );
    let output = folder.run("compare out --golden golden --json");
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let lines: Vec<_> = output.stdout.split_inclusive(|&byte| byte == b'\n').map(json).collect();
    let seen: Vec<_> = lines
        .iter()
        .map(|line| (line["file"].as_str().unwrap(), line["passed"].as_bool().unwrap()))
        .collect();
    assert_eq!(seen, [("out/new.png", false), ("out/other.png", false), ("out/same.png", true)]);
    let reason = lines[1]["reason"].as_str().unwrap();
    assert!(
        reason.contains("192 pixels (100.0000%)") && reason.contains("BASRELIEF_ACCEPT=1"),
        "{reason}"
    );
    assert_eq!(
        names(&folder, "golden/failed"),
        ["new.actual.png", "other.actual.png", "other.difference.png", "other.expected.png"]
    );
    // 0.5 and 0.25 in linear light are bytes 188 and 137.
    folder.succeeds("compare out/other.png --golden golden --tolerance 0.21");
    assert_eq!(
        folder.run("compare out/other.png --golden golden --tolerance 0.19").status.code(),
        Some(1)
    );
    let accepted = folder
        .command("compare out --golden golden")
        .env("BASRELIEF_ACCEPT", "1")
        .output()
        .unwrap();
    assert!(accepted.status.success() && text(&accepted.stdout).matches("accepted").count() == 2);
    assert_eq!(names(&folder, "golden"), ["new.png", "other.png", "same.png"]);
    folder.succeeds("compare out --golden golden");
    // A picture that is no longer drawn fails, too.
    fs::remove_file(folder.path("out/same.png")).unwrap();
    assert_eq!(folder.run("compare out --golden golden").status.code(), Some(1));
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let folder = Folder::new();
    fs::create_dir(folder.path("golden")).unwrap();
    folder.put_image("a.png", [0.5, 0.5, 0.5, 1.0]);
    folder.put("golden/text.png", "no picture");
    folder.put("text.png", "no picture");
    folder.refuses("compare a.png --golden missing", &["missing"]);
    folder.refuses("compare text.png --golden golden", &["text.png"]);
    folder.refuses("compare missing.png --golden golden", &["missing.png"]);
    folder.refuses("compare a.png --golden golden --share 2", &["--share"]);
    folder.put_image("golden/a.png", [0.5, 0.5, 0.5, 1.0]);
    folder.refuses(
        "compare a.png --golden golden --max-pixels 191",
        &["a.png", "16 x 12", "--max-pixels"],
    );
    folder.succeeds("compare a.png --golden golden --max-pixels 192");
    folder.refuses("compare a.png b.png --tolerance 0.1", &["--golden"]);
    folder.refuses("compare a.png", &["<B>"]);
}
