//! The page of `basrelief study` as a browser shows it. Without Chromium on the machine only its
//! text is looked at.

use crate::chromium::Chromium;
use crate::folder::{Folder, skipped};
use serde_json::json;
use std::path::Path;
use std::process::Command;

/// A study of the built-in scene, small and soon done.
fn study(folder: &Path) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_basrelief"));
    command
        .args([
            "study",
            "--size",
            "160x90",
            "--truth-samples",
            "16",
            "--repeat",
            "1",
            "--quiet",
            "-o",
        ])
        .arg(folder);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

fn number(value: &serde_json::Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is a number"))
}

#[test]
fn page_works_without_network_in_light_and_dark_by_keys_on_any_width() {
    let folder = tempfile::tempdir().unwrap();
    let page_path = folder.path().join("study/index.html");
    study(page_path.parent().unwrap());
    check_files(page_path.parent().unwrap());
    let Some(mut page) = Chromium::start() else {
        return skipped("there is no chromium on this machine: nobody has looked at the page");
    };
    page.look([1440, 900], false);
    page.open(&page_path);
    page.wait_until("[...document.images].every(image => image.naturalWidth > 0)");
    check_wipe(&mut page);
    check_errors(&mut page);
    let mut papers = Vec::new();
    for width in [1440, 400] {
        for is_dark in [false, true] {
            page.look([width, 900], is_dark);
            let overflow = page.value("document.documentElement.scrollWidth - innerWidth");
            assert!(number(&overflow) <= 0.0, "nothing stands out at {width}: {overflow}");
            papers.push(page.value("getComputedStyle(document.body).backgroundColor"));
            if let Some(shots) = std::env::var_os("BASRELIEF_SCREENSHOTS") {
                let name = format!("study-{width}-{}.png", if is_dark { "dark" } else { "light" });
                std::fs::write(Path::new(&shots).join(name), page.screenshot()).unwrap();
            }
        }
    }
    assert_ne!(papers[0], papers[1], "dark is another colour");
    assert_eq!((&papers[0], &papers[1]), (&papers[2], &papers[3]));
    assert!(page.complaints.is_empty(), "{:?}", page.complaints);
}

fn check_files(folder: &Path) {
    let html = std::fs::read_to_string(folder.join("index.html")).unwrap();
    let elsewhere = html
        .match_indices("http")
        .filter(|(i, _)| !html[*i..].starts_with("http://www.w3.org/2000/svg"));
    assert_eq!(elsewhere.count(), 0, "nothing comes from elsewhere");
    let table = std::fs::read_to_string(folder.join("study.csv")).unwrap();
    let rows: Vec<&str> = table.lines().skip(1).collect();
    assert!(rows.len() >= 12 && rows.iter().any(|row| row.ends_with("true")));
    let psnr = |name: &str| {
        let row = rows.iter().find(|row| row.starts_with(&format!("\"{name}\""))).unwrap();
        row.rsplit(',').nth(3).unwrap().parse::<f64>().unwrap()
    };
    assert!(psnr("horizon") > psnr("EWA (2)") + 5.0, "the page says what the filters are worth");
}

/// The slider by keys, the choice by numbers, the swap.
fn check_wipe(page: &mut Chromium) {
    let clip = "document.getElementById('over').style.clipPath";
    page.value("document.getElementById('slider').focus()");
    let before = page.value(clip);
    for _ in 0..8 {
        page.press("ArrowRight", "ArrowRight", false);
    }
    assert_eq!(page.value("document.getElementById('slider').value"), json!("54"));
    assert_ne!(page.value(clip), before, "the picture follows the slider");
    let bar = number(&page.value(
        "document.getElementById('bar').offsetLeft / document.getElementById('wipe').clientWidth",
    ));
    assert!((bar - 0.54).abs() < 0.01, "the bar follows the slider: {bar}");
    page.press("3", "Digit3", false);
    page.press("%", "Digit5", true);
    let chosen =
        "[document.getElementById('left').value, document.getElementById('right').value].join()";
    assert_eq!(page.value(chosen), json!("3,5"));
    let shows = |side: &str, name: &str| {
        format!(
            "document.getElementById('{side}').src === document.querySelector('[data-name=\"{name}\"]').src"
        )
    };
    assert_eq!(page.value(&shows("over", "trilinear")), json!(true));
    assert_eq!(page.value(&shows("under", "EWA (3)")), json!(true));
    page.press("x", "KeyX", false);
    assert_eq!(page.value(chosen), json!("5,3"));
    assert_eq!(page.value(&shows("over", "EWA (3)")), json!(true));
    page.press("0", "Digit0", false);
    assert_eq!(page.value(&shows("over", "truth")), json!(true));
}

/// The two kinds of heat maps, by keys.
fn check_errors(page: &mut Chromium) {
    let source = "document.querySelector('#errors img').src";
    let before = page.value(source);
    page.value("document.querySelector('[name=errors]').focus()");
    page.press("ArrowRight", "ArrowRight", false);
    assert_ne!(page.value(source), before);
    assert_eq!(page.value("document.getElementById('most').textContent"), json!("0.5 or more"));
}

#[test]
fn what_cannot_be_studied_is_refused() {
    let folder = Folder::new();
    folder.refuses("study missing.obj -o new", &["missing.obj"]);
    assert!(!folder.path("new").exists(), "no folder is made for it");
    folder.refuses("study quad.obj -q -o quad.obj", &["quad.obj", "cannot be made"]);
    folder.refuses("study quad.obj --size 0x9", &["--size"]);
    folder.refuses("study quad.obj --truth-samples 0", &["--truth-samples"]);
    folder.put("part.toml", "model = \"quad.obj\"\n[frame]\nregion = \"0,0,8,8\"\n");
    folder.refuses("study part.toml -q", &["--region"]);
}
