//! `basrelief compare`: how far two pictures are apart.

use crate::folder::{Folder, json, size_of_image, text};
use basrelief::Frame;

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
