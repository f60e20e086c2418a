//! `basrelief bench`: tables, figures for programs, and runs beside each other.

use crate::folder::{Folder, json, text};
use serde_json::Value;

/// Small and soon done.
const SMALL: &str = "--size 64x36 --truth-size 32x18 --truth-samples 4 --repeat 2 --threads 1";

fn cases(report: &Value) -> &Vec<Value> {
    report["cases"].as_array().unwrap()
}

#[test]
fn every_filter_on_every_scene_has_figures() {
    let folder = Folder::new();
    let output = folder.succeeds(&format!("bench {SMALL} --json run.json"));
    assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
    let report = json(&std::fs::read(folder.path("run.json")).unwrap());
    let table = text(&output.stdout);
    assert!(table.contains("64x36") && table.contains("32x18 against 4 rays"), "{table}");
    assert_eq!(report["threads"], 1);
    let scenes = ["floor", "wall", "torus", "triangles"];
    let filters = ["nearest", "bilinear", "trilinear", "ewa", "visible", "horizon", "parallax"];
    assert_eq!(cases(&report).len(), scenes.len() * filters.len());
    for case in cases(&report) {
        let [scene, filter] = ["scene", "filter"].map(|key| case[key].as_str().unwrap());
        assert!(scenes.contains(&scene) && filters.contains(&filter), "{case}");
        assert!(table.contains(scene) && table.contains(filter), "{table}");
        for key in ["frame_ms", "mpixel_s", "mtri_s", "psnr_db"] {
            assert!(case[key].as_f64().unwrap() > 0.0, "{key}: {case}");
        }
        assert_eq!(case["times_ms"].as_array().unwrap().len(), 2, "{case}");
    }
    let psnr = |filter: &str| {
        let case = cases(&report).iter().find(|case| case["filter"] == filter).unwrap();
        case["psnr_db"].as_f64().unwrap()
    };
    assert!(psnr("horizon") > psnr("ewa"), "the floor's joints are hidden: {table}");
}

#[test]
fn what_is_asked_for_alone_is_measured() {
    let folder = Folder::new();
    let line = format!("bench {SMALL} --scenes wall,floor --filters trilinear,nearest --json - -q");
    let report = json(&folder.succeeds(&line).stdout);
    let names: Vec<_> = cases(&report)
        .iter()
        .map(|case| format!("{} {}", case["scene"], case["filter"]).replace('"', ""))
        .collect();
    assert_eq!(names, ["floor nearest", "floor trilinear", "wall nearest", "wall trilinear"]);
}

#[test]
fn runs_are_compared() {
    let folder = Folder::new();
    let wall = format!("bench {SMALL} --scenes wall --filters nearest");
    folder.succeeds(&format!("{wall} --json then.json"));
    let mut then = json(&std::fs::read(folder.path("then.json")).unwrap());
    // As if it had taken a thousand times as long, and no longer once than another time.
    for ms in then["cases"][0]["times_ms"].as_array_mut().unwrap() {
        *ms = 1e4.into();
    }
    folder.put("slow.json", then.to_string());
    let output = folder.succeeds(&format!("{wall},bilinear --against slow.json --json now.json"));
    let table = text(&output.stdout);
    assert!(table.contains("10000") && table.contains("not measured before"), "{table}");
    let now = json(&std::fs::read(folder.path("now.json")).unwrap());
    let against = &cases(&now)[0]["against"];
    assert!(against["ratio"].as_f64().unwrap() < 0.5 && against["noise"].is_f64(), "{now}");
    assert!(cases(&now)[1]["against"].is_null(), "{now}");
    // Such a file can be compared with again.
    folder.succeeds(&format!("{wall} --against now.json"));
}

#[test]
fn what_cannot_be_measured_is_refused() {
    let folder = Folder::new();
    let wall = format!("bench {SMALL} --scenes wall --filters nearest");
    folder.refuses(&format!("{wall} --against missing.json"), &["missing.json", "cannot be read"]);
    folder.put("text.json", "no figures");
    folder.refuses(&format!("{wall} --against text.json"), &["text.json", "bench --json"]);
    folder.put("other.json", "{\"cases\": []}");
    folder.refuses(&format!("{wall} --against other.json"), &["other.json", "bench --json"]);
    let run = text(&folder.succeeds(&format!("{wall} --json - -q")).stdout);
    folder.put("run.json", &run);
    let large = wall.replace("64x36", "65x36");
    folder
        .refuses(&format!("{large} --against run.json"), &["run.json", "64x36", "65x36", "--size"]);
    let mut emptied = json(run.as_bytes());
    emptied["cases"][0]["times_ms"] = Value::Array(vec![]);
    folder.put("empty.json", emptied.to_string());
    folder.refuses(&format!("{wall} --against empty.json"), &["empty.json", "no times"]);
    folder.refuses(&format!("{wall} --json nowhere/run.json"), &["nowhere"]);
    folder.refuses("bench --scenes sea", &["--scenes", "sea"]);
    folder.refuses("bench --filters truth", &["--filters", "truth"]);
    folder.refuses("bench --repeat 1", &["--repeat"]);
    folder.refuses("bench --size 0x9", &["--size"]);
    folder.refuses("bench --truth-samples 0", &["--truth-samples"]);
}
