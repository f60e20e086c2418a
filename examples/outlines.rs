//! How near pictures of reliefs on curved meshes come to the same reliefs as real geometry: the
//! overlap of what is covered, the colour, the depth. Writes both, for the eye.
//!
//! `cargo run --release --example outlines [WIDTH HEIGHT [SEGMENTS PIECES]]`

#[path = "../tests/common/mod.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with the tests")]
mod common;
#[path = "../tests/common/displaced.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with the tests")]
mod displaced;

use basrelief::{Filter, Layer, Rays, Renderer, Settings};
use displaced::{decibels, depths_within, overlap, scene, show, sphere, torus};

fn main() -> Result<(), basrelief::Error> {
    let numbers: Vec<u32> = std::env::args().skip(1).filter_map(|arg| arg.parse().ok()).collect();
    let or = |i: usize, default: u32| numbers.get(i).copied().unwrap_or(default);
    let [width, height, segments, pieces] = [or(0, 640), or(1, 360), or(2, 48), or(3, 16)];
    for (name, mesh, distance) in [
        ("torus", torus([2 * segments, segments]), 3.4),
        ("sphere", sphere([2 * segments, segments]), 2.6),
    ] {
        let scene = scene(mesh, common::cobbles(128, 4), distance);
        let settings = Settings { width, height, ..Settings::default() };
        let geometry = displaced::displaced(&scene, pieces);
        println!("{name}: {} triangles", geometry.meshes[0].triangles.len());
        let shown = show(&geometry, &settings);
        shown.colors.save(format!("{name}_geometry.png"))?;
        let [u, v] = scene.meshes[0].tangents[scene.meshes[0].tangents.len() / 2];
        let depth = u.cross(v).length().sqrt() * 0.06;
        let rays = Filter::Truth(Rays { samples: or(4, 16) });
        for filter in [Filter::default(), rays] {
            let settings = Settings { filter, ..settings.clone() };
            let mut renderer = Renderer::new(scene.clone(), settings)?;
            let frame = renderer.render();
            let layers = renderer.render_layers(&[Layer::Depth]);
            println!(
                "{filter:?}: overlap {:.4}, {:.2} dB, depth within 1 % of {depth:.4} {:.4}",
                overlap(&frame, &shown.coverage),
                decibels(&frame, &shown.colors),
                depths_within(layers.floats(Layer::Depth), &shown.depth, depth * 0.01),
            );
            for share in [0.5, 0.9, 0.95, 0.99] {
                let most =
                    displaced::depth_quantile(layers.floats(Layer::Depth), &shown.depth, share);
                print!("{share} {:.4} ", most / depth);
            }
            println!();
            let word = if filter == rays { "truth" } else { "horizon" };
            frame.save(format!("{name}_{word}.png"))?;
        }
    }
    Ok(())
}
