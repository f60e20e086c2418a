//! `basrelief inspect` and `render --view` as their users meet them.

use crate::folder::{Folder, json, text};
use std::path::PathBuf;

fn picture(path: PathBuf) -> image::RgbImage {
    image::open(path).unwrap().into_rgb8()
}

#[test]
fn figures_are_pictures_with_numbers() {
    let folder = Folder::new();
    for figure in [1, 6] {
        let name = format!("figure{figure}.png");
        let output = folder.succeeds(&format!("inspect --figure {figure} -o {name}"));
        let numbers = text(&output.stdout);
        for part in [
            "formula (2) as meant",
            "formula (3) as printed",
            "F = (Ux Vy + Uy Vx)^2",
            "T_vis",
            "the horizon rise",
        ] {
            assert!(numbers.contains(part), "{part}: {numbers}");
        }
        let picture = picture(folder.path(&name));
        let num_colors =
            picture.pixels().map(|p| p.0).collect::<std::collections::HashSet<_>>().len();
        assert!(picture.dimensions().0 > 1000 && num_colors > 500, "{num_colors} colours");
    }
}

#[test]
fn json_has_what_the_picture_shows() {
    let folder = Folder::new();
    let output = folder.succeeds("inspect --figure 5 --json");
    let json = json(&output.stdout);
    let num = |key: &str| json[key].as_array().unwrap_or_else(|| panic!("{key} is a list")).len();
    assert_eq!(num("texels"), num("visible") + num("hidden"));
    assert_eq!(num("hidden"), num("covered_by"));
    assert_eq!(json["readings"][1]["formulas"], "printed");
    assert_ne!(json["readings"][0]["formula_3"]["dvdy"], json["readings"][1]["formula_3"]["dvdy"]);
    assert!(json["cut"]["points"].as_array().unwrap().len() > 10);
}

#[test]
fn a_pixel_of_a_mesh_of_ones_own_is_inspected() {
    let folder = Folder::new();
    let heights = image::GrayImage::from_fn(16, 16, |x, y| image::Luma([((x ^ y) * 16) as u8]));
    heights.save(folder.path("height.png")).unwrap();
    let line = "inspect quad.obj --height height.png --size 64x36 --pixel 32,18";
    let numbers = text(&folder.succeeds(line).stdout);
    assert!(
        numbers.contains("level 0 (16x16 a repeat)") && numbers.contains("pixel 32,18 of 64x36"),
        "{numbers}"
    );
    folder.refuses(
        "inspect quad.obj --height height.png --size 64x36 --pixel 0,0",
        &["--pixel 0,0", "no surface"],
    );
}

#[test]
fn wrong_pixels_are_refused() {
    let folder = Folder::new();
    folder.refuses("inspect", &["--pixel X,Y"]);
    folder.refuses("inspect --pixel 3", &["--pixel", "X,Y"]);
    folder.refuses("inspect --pixel 9999,3 --size 64x36", &["--pixel 9999,3", "64x36"]);
    folder.refuses("inspect --figure 7", &["--figure"]);
    folder.refuses("inspect --figure 2 --pixel 1,2", &["--figure", "--pixel"]);
    for option in [
        "quad.obj",
        "--size 64x36",
        "--filter ewa",
        "--eye 0,0,1",
        "--background red",
        "--formulas printed",
    ] {
        folder
            .refuses(&format!("inspect --figure 2 {option}"), &["--figure", "cannot be used with"]);
    }
    folder.refuses("inspect --pixel 1,2 --region 0,0,8,8", &["--region"]);
    folder.refuses("inspect --figure 2 --json -o -", &["--json", "--output"]);
    folder.refuses("inspect --figure 2 -o missing/a.png", &["missing/a.png"]);
}

#[test]
fn views_have_a_legend_below_the_frame() {
    let folder = Folder::new();
    let mut pictures = Vec::new();
    for view in [
        "coverage",
        "mip",
        "footprint",
        "visible",
        "horizon",
        "depth",
        "normal",
        "uv",
        "shadow",
        "light",
        "occlusion",
    ] {
        folder.succeeds(&format!("--view {view} --filter visible --size 96x54 -o {view}.png"));
        let picture = picture(folder.path(&format!("{view}.png")));
        assert!(picture.width() == 96 && picture.height() > 90, "{view}");
        pictures.push(picture);
    }
    for (i, a) in pictures.iter().enumerate() {
        assert!(pictures[..i].iter().all(|b| a != b), "each view is another picture");
    }
    folder.succeeds("--view uv --legend off --size 96x54 -o bare.png");
    assert_eq!(picture(folder.path("bare.png")).dimensions(), (96, 54));
    folder.refuses("--view uv --repeat 3 -o x.png", &["--repeat", "--view"]);
    folder.refuses("--legend off -o x.png", &["--view"]);
    folder.refuses("--view what -o x.png", &["--view"]);
}

#[cfg(not(feature = "viewer"))]
#[test]
fn a_build_without_the_viewer_says_so() {
    Folder::new().refuses("view house.obj --split ewa", &["view", "--features viewer"]);
}
