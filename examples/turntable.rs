//! Frames around a scene, one PNG each.
//!
//!     cargo run --release --example turntable [number of frames] [folder] [scene.obj]
//!
//! Eight frames of the built-in scene into the current folder, unless told otherwise.

use basrelief::{Camera, Renderer, Result, Scene, Settings, load, scene};
use glam::Quat;
use std::f32::consts::TAU;
use std::path::Path;

fn main() {
    if let Err(error) = turn() {
        // One line for a person.
        eprintln!("{error}");
        std::process::exit(1);
    }
}

fn turn() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let num = args.first().map_or(Ok(8), |num| num.parse::<u32>());
    let Some(num) = num.ok().filter(|num| (1..=999).contains(num)) else {
        eprintln!("the number of frames must be a whole number from 1 to 999");
        std::process::exit(2);
    };
    let folder = Path::new(args.get(1).map_or(".", String::as_str));
    let scene = args.get(2).map_or_else(|| Ok(scene::builtin()), |path| open(path.as_ref()))?;

    let settings = Settings { width: 320, height: 180, ..Settings::default() };
    // A renderer keeps buffers, and what it has prepared of the scene, from frame to frame.
    let mut renderer = Renderer::new(scene, settings)?;
    let first = renderer.scene().camera;
    for i in 0..num {
        let turned = Quat::from_rotation_y(TAU * i as f32 / num as f32);
        renderer.set_camera(around(first, turned))?;
        let path = folder.join(format!("turntable-{i:03}.png"));
        renderer.render().save(&path)?;
        println!("{}", path.display());
    }
    Ok(())
}

/// An OBJ file with its materials and images, and a camera that sees all of it.
fn open(path: &Path) -> Result<Scene> {
    let loaded = load::load(path, &load::LoadOptions::default())?;
    for warning in &loaded.warnings {
        eprintln!("{warning}");
    }
    Ok(loaded.scene)
}

/// The eye goes around what it looks at, at the same height.
fn around(camera: Camera, turned: Quat) -> Camera {
    Camera { eye: camera.target + turned * (camera.eye - camera.target), ..camera }
}
