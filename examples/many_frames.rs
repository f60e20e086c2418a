//! Many small frames with their layers, as data sets ask for them: a thousand cameras around a
//! scene, all in memory that is kept. Prints what a frame took.
//!
//! `cargo run --release --example many_frames -- [number of frames] [FILE.obj] [TEXTURE]`

use basrelief::layers::{PixelsMut, ValuesMut};
use basrelief::load::{LoadOptions, MaterialOptions, load};
use basrelief::{Camera, Filter, Layer, Renderer, Settings, scene};
use glam::Quat;
use std::f32::consts::TAU;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Pixels a side.
const SIDE: u32 = 256;

fn main() -> basrelief::Result<()> {
    let mut args = std::env::args_os().skip(1);
    let num = args.next().and_then(|num| num.to_str()?.parse::<u32>().ok()).unwrap_or(1000).max(1);
    let (file, albedo) = (args.next(), args.next().map(PathBuf::from));
    let all = MaterialOptions { albedo, ..MaterialOptions::default() };
    let scene = match file {
        Some(file) => load(Path::new(&file), &LoadOptions { all, ..LoadOptions::default() })?.scene,
        None => scene::builtin(),
    };
    let filter = Filter::Trilinear(Default::default());
    let settings = Settings { width: SIDE, height: SIDE, filter, msaa: 1, ..Settings::default() };
    let renderer = Renderer::new(scene, settings)?;
    // On a thread of the pool that frames are drawn on: none is woken for each frame anew.
    rayon::scope(|_| draw(renderer, num))
}

fn draw(mut renderer: Renderer, num: u32) -> basrelief::Result<()> {
    let first = renderer.scene().camera;
    // Row by row: a picture in sRGB, distances, and which mesh a pixel sees.
    let num_pixels = (SIDE * SIDE) as usize;
    let mut colors = vec![[0_u8; 4]; num_pixels];
    let (mut depths, mut objects) = (vec![0.0_f32; num_pixels], vec![0_u32; num_pixels]);
    let mut num_seen = 0;
    let start = Instant::now();
    for i in 0..num {
        let turn = Quat::from_rotation_y(TAU * i as f32 / num as f32);
        let eye = first.target + turn * (first.eye - first.target);
        renderer.set_camera(Camera { eye, ..first })?;
        let layers = vec![
            (Layer::Depth, ValuesMut::Floats(&mut depths)),
            (Layer::Object, ValuesMut::Ids(&mut objects)),
        ];
        renderer.render_with_layers_to(PixelsMut::Bytes(&mut colors), layers);
        num_seen += objects.iter().filter(|object| **object != u32::MAX).count();
    }
    let ms = start.elapsed().as_secs_f64() * 1e3 / f64::from(num);
    let share = num_seen as f64 / (num_pixels as f64 * f64::from(num));
    println!("{num} frames of {SIDE}x{SIDE} pixels, {ms:.3} ms each; {:.0} % seen", share * 100.0);
    Ok(())
}
