//! What must hold of marches, coverage and whole frames.

use super::check::{Checked, ensure};
use crate::footprint::Footprint;
use crate::geometry::project;
use crate::raster::hit_counts;
use crate::reference::{Ray, first_hit};
use crate::relief::{HeightField, march};
use crate::scene::{Camera, Material, Mesh, Scene};
use crate::settings::Settings;
use crate::simd::PixelLanes;
use crate::texture::Surface;
use glam::Vec3;

/// The march of the pixel's view ray ends at a crossing of ray and relief, and not behind the first
/// one that a dense march finds, by more than a twentieth texel. Rays that graze relief within 1e-4
/// of its depth may hit it or not.
///
/// # Errors
/// Says what broke.
pub fn march_finds_first_hit(surface: &Surface, pixel: &Footprint) -> Checked {
    let lanes = |v: [f32; 2]| v.map(PixelLanes::splat);
    let found = march(&HeightField::new(surface), &lanes(pixel.base), &lanes(pixel.displacement))
        .to_array()[0];
    ensure((0.0..=1.0).contains(&found), || format!("depth {found}"))?;
    let (level, ray) = (surface.base(), Ray::new(surface, pixel.base, pixel.displacement));
    let (found, expected) = (f64::from(found), first_hit(level, &ray, 64.0));
    let texels = ray.displacement[0].abs().max(ray.displacement[1].abs());
    // The place itself is known to an f32's digits of the texture coordinate.
    let near = 0.05 + 1e-5 * (ray.base[0].abs() + ray.base[1].abs() + texels);
    let grazes =
        ray.gap(level, found).abs() < 1e-4 || ray.gap(level, expected.min(found)).abs() < 1e-4;
    let error = (found - expected) * texels;
    ensure(
        error.abs() <= near
            || (error < 0.0 && grazes)
            || passes_close(level, &ray, expected, found),
        || format!("hit at depth {found}, first crossing at {expected}, {error} texels apart"),
    )
}

/// Whether relief between two depths rises above the ray by less than 1e-4 only.
fn passes_close(level: &crate::texture::Level, ray: &Ray, from: f64, to: f64) -> bool {
    let places = (0..=256).map(|i| from + (to - from) * f64::from(i) / 256.0);
    to > from && places.map(|depth| ray.gap(level, depth)).fold(0.0, f64::min) > -1e-4
}

/// A closed fan of triangles around `center` hits no pixel twice. `ring` holds the distances of its
/// corners, evenly spread over the sides of a square around the centre, all in pixels of a frame of
/// 64 x 64; `tilt` is how fast the fan's plane recedes, so that parts of it may lie behind the eye.
///
/// A fan so small or so edge-on that snapping to 1/256 pixel could turn a triangle over is not
/// looked at: its centre must be half to twice as far as the frame's plane, and its corners 4 to
/// 1e7 pixels away.
///
/// # Errors
/// Says what broke.
pub fn fan_is_hit_once(center: [f32; 2], ring: &[f32; 8], tilt: [f32; 2], msaa: u32) -> Checked {
    let settings = Settings { width: 64, height: 64, msaa, ..Settings::default() };
    // A field of view of 90 degrees: 32 pixels are as far from the middle as the plane is from the
    // eye.
    let corner = |x: f32, y: f32| {
        let [x, y] = [(center[0] + x) / 32.0, (center[1] + y) / 32.0];
        Vec3::new(x, y, -1.0 - tilt[0] * x - tilt[1] * y)
    };
    const DIRECTIONS: [[f32; 2]; 8] = [
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [-1.0, 1.0],
        [-1.0, 0.0],
        [-1.0, -1.0],
        [0.0, -1.0],
        [1.0, -1.0],
    ];
    let mut positions = vec![corner(0.0, 0.0)];
    positions.extend(ring.iter().zip(DIRECTIONS).map(|(r, [x, y])| corner(r * x, r * y)));
    let triangles = (0..8).map(|i| [0, 1 + i, 1 + (i + 1) % 8]).collect();
    let scene = Scene {
        meshes: vec![Mesh::new(positions, vec![], vec![], triangles)],
        materials: vec![Material::default()],
        camera: Camera {
            eye: Vec3::ZERO,
            target: -Vec3::Z,
            up: Vec3::Y,
            fov_degrees: 90.0,
            ..Camera::default()
        },
        ..Scene::default()
    };
    let distance = -scene.meshes[0].positions[0].z;
    let is_wide = (0.5..=2.0).contains(&distance) && ring.iter().all(|r| (4.0..=1e7).contains(r));
    if !is_wide || scene.validate().is_err() {
        return Ok(());
    }
    let counts = hit_counts(&project(&scene, &settings), &settings);
    let twice = counts.iter().position(|&count| u32::from(count) > msaa);
    ensure(twice.is_none(), || {
        format!("pixel {twice:?} is hit {} times", counts[twice.unwrap_or(0)])
    })
}

/// A frame is refused with a reason, or drawn with finite colours and an opacity within 0 to 1.
///
/// # Errors
/// Says what broke.
pub fn frame_is_finite(scene: Scene, settings: Settings) -> Checked {
    let Ok(frame) = crate::render(scene, settings) else { return Ok(()) };
    let is_good = |p: &[f32; 4]| p.iter().all(|c| c.is_finite() && *c >= 0.0) && p[3] <= 1.001;
    let bad = frame.pixels.iter().position(|p| !is_good(p));
    ensure(bad.is_none(), || format!("pixel {bad:?} is {:?}", frame.pixels[bad.unwrap_or(0)]))
}
