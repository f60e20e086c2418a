//! A frame in ten lines: the built-in scene, saved as a PNG.
//!
//!     cargo run --release --example frame [street.png]

use basrelief::{Result, Settings, render, scene};

fn main() {
    if let Err(error) = draw() {
        // One line for a person.
        eprintln!("{error}");
        std::process::exit(1);
    }
}

fn draw() -> Result<()> {
    let path = std::env::args().nth(1).unwrap_or("frame.png".into());
    // A street of cobblestones before brick walls, made of nothing.
    let scene = scene::builtin();
    // 1280x720 pixels, four samples a pixel at edges, filtered by the horizon, unlit.
    let frame = render(scene, Settings::default())?;
    // The extension says the format. The file appears whole or not at all.
    frame.save(&path)?;
    println!("{path}: {}x{} pixels", frame.width, frame.height);
    Ok(())
}
