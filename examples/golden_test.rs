//! A golden test: a picture that must be drawn again, bit by bit or nearly so.
//!
//!     cargo run --release --example golden_test [golden.png]
//!
//! The first run accepts the picture that it draws; look at the file before you trust it. Each
//! later run checks against it. In a project of your own, `check` is a `#[test]`, the PNG lies in
//! the repository, and an environment variable asks for acceptance.

use basrelief::golden::{self, OnDifference, Thresholds};
use basrelief::{Result, Settings, render, scene};
use std::path::PathBuf;

fn main() {
    if let Err(error) = check() {
        // One line for a person.
        eprintln!("{error}");
        std::process::exit(1);
    }
}

fn check() -> Result<()> {
    let path = PathBuf::from(std::env::args().nth(1).unwrap_or("golden.png".into()));
    // Small frames are quick, and show as much.
    let settings = Settings { width: 64, height: 64, ..Settings::default() };
    let frame = render(scene::builtin(), settings)?;

    // No pixel may be off by more than one step of 255. `Thresholds::default()` allows nothing.
    let thresholds = Thresholds { tolerance: 1.0 / 255.0, share: 0.0 };
    let is_new = !path.exists();
    let on_difference = if is_new { OnDifference::Accept } else { OnDifference::Fail };
    // A difference is an error that says how many pixels differ and where to look: a folder
    // `failed` beside the PNG shows what was expected, what was drawn and where they differ.
    golden::check(&path, &frame, thresholds, on_difference)?;
    println!("{}: {}", path.display(), if is_new { "accepted" } else { "drawn again" });
    Ok(())
}
