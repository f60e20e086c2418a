//! `basrelief compare --golden`: pictures against those of a folder.

use crate::options::compare::CompareOptions;
use crate::output;
use crate::refusal::Refusal;
use basrelief::frame::Format;
use basrelief::golden::{OnDifference, Thresholds, Verdict, judge};
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The environment variable that, set to 1, makes pictures that differ the golden ones.
const ACCEPT: &str = "BASRELIEF_ACCEPT";

/// One JSON object a line.
#[derive(Serialize)]
struct Report<'a> {
    file: String,
    golden: String,
    passed: bool,
    /// Whether it has become the golden image.
    accepted: bool,
    /// Why it has not passed.
    reason: Option<&'a str>,
}

/// Compares the images that the options name with those of the same names in `folder`.
pub(crate) fn run(options: &CompareOptions, folder: &Path) -> Result<ExitCode, Refusal> {
    if !folder.is_dir() {
        return Err(format!("--golden {}: is not a folder", folder.display()).into());
    }
    let thresholds = Thresholds { tolerance: options.tolerance, share: options.share };
    let accept = std::env::var_os(ACCEPT).is_some_and(|value| value == "1");
    let on_difference = if accept { OnDifference::Accept } else { OnDifference::Fail };
    let mut all_passed = true;
    for (file, golden) in pairs(options, folder)? {
        let verdict = match std::fs::read(&file) {
            Ok(bytes) => {
                match judge(&golden, &bytes, thresholds, on_difference, options.max_pixels)? {
                    Verdict::Failed(reason) => {
                        Verdict::Failed(format!("{reason}, or accept it with {ACCEPT}=1"))
                    }
                    verdict => verdict,
                }
            }
            Err(e) if e.kind() == std::io::ErrorKind::NotFound && golden.is_file() => {
                Verdict::Failed("there is no such image to compare".into())
            }
            Err(e) => return Err(Refusal::file(&file, e)),
        };
        all_passed &= !matches!(verdict, Verdict::Failed(_));
        let text =
            if options.json { json(&file, &golden, &verdict)? } else { line(&file, &verdict) };
        output::print(text.as_bytes())?;
    }
    Ok(if all_passed { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Each image with its golden one. A folder stands for its images, and for those that are golden.
fn pairs(options: &CompareOptions, folder: &Path) -> Result<Vec<(PathBuf, PathBuf)>, Refusal> {
    let mut pairs = Vec::new();
    for given in [&options.a].into_iter().chain(&options.b).chain(&options.more) {
        if given.is_dir() {
            let names = images(given)?.into_iter().chain(images(folder)?).collect::<BTreeSet<_>>();
            pairs.extend(names.iter().map(|name| (given.join(name), folder.join(name))));
        } else {
            let name =
                given.file_name().ok_or_else(|| format!("{}: names no file", given.display()))?;
            pairs.push((given.clone(), folder.join(name)));
        }
    }
    if pairs.is_empty() {
        Err("--golden: there are no images to compare".into())
    } else {
        Ok(pairs)
    }
}

fn images(folder: &Path) -> Result<Vec<PathBuf>, Refusal> {
    let refuse = |e: std::io::Error| Refusal::file(folder, e);
    let entries = std::fs::read_dir(folder).map_err(refuse)?;
    let mut names = Vec::new();
    for entry in entries {
        let path = entry.map_err(refuse)?.path();
        if path.is_file() && Format::of(&path).is_ok() {
            names.extend(path.file_name().map(PathBuf::from));
        }
    }
    Ok(names)
}

fn line(file: &Path, verdict: &Verdict) -> String {
    match verdict {
        Verdict::Passed => format!("passed    {}\n", file.display()),
        Verdict::Accepted => format!("accepted  {}\n", file.display()),
        Verdict::Failed(reason) => format!("FAILED    {}: {reason}\n", file.display()),
    }
}

fn json(file: &Path, golden: &Path, verdict: &Verdict) -> Result<String, Refusal> {
    let report = Report {
        file: file.display().to_string(),
        golden: golden.display().to_string(),
        passed: *verdict == Verdict::Passed,
        accepted: *verdict == Verdict::Accepted,
        reason: if let Verdict::Failed(reason) = verdict { Some(reason) } else { None },
    };
    Ok(serde_json::to_string(&report).map_err(|e| format!("--json: {e}"))? + "\n")
}
