//! What several tests need: numbers from a fixed seed, and small surfaces.
#![allow(dead_code, unreachable_pub, reason = "each test uses a part")]

use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps, Wrap, srgb_from_linear};
use basrelief::{Camera, Ewa, Filter, Frame, Horizon, Material, Mesh, Scene, Visible};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// How near two frames are where both show a surface, as they are encoded; of so many numbers at
/// least.
pub fn decibels(a: &Frame, b: &Frame, least: f32) -> f32 {
    let both = a.pixels.iter().zip(&b.pixels).filter(|(a, b)| a[3] == 1.0 && b[3] == 1.0);
    let squares = both.flat_map(|(a, b)| {
        [0, 1, 2].map(|c| (srgb_from_linear(a[c]) - srgb_from_linear(b[c])).powi(2))
    });
    let (sum, num) = squares.fold((0.0, 0.0), |(sum, num), square| (sum + square, num + 1.0));
    assert!(num > least, "a part of the picture");
    -10.0 * (sum / num).max(1e-12).log10()
}

/// Numbers from a fixed seed (splitmix64).
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// A number from `least` to `most`.
    pub fn within(&mut self, least: f32, most: f32) -> f32 {
        least + (most - least) * ((self.bits() >> 40) as f32 / (1_u64 << 24) as f32)
    }
}

/// A surface of random texels and heights.
pub fn rough_surface(width: u32, height: u32, wrap: Wrap, seed: u64) -> Surface {
    let mut random = Random(seed);
    let albedo = ColorImage::from_fn(width, height, |_, _| [0; 3].map(|_| random.within(0.0, 1.0)));
    let heights = HeightImage::from_fn(width, height, |_, _| random.within(0.0, 1.0));
    let maps = SurfaceMaps {
        albedo: Some(albedo),
        height: Some(heights),
        wrap,
        relief_depth: 0.1,
        ..Default::default()
    };
    Surface::new(maps).expect("valid maps")
}

/// A surface of random texels without relief.
pub fn flat_surface(width: u32, height: u32, wrap: Wrap, seed: u64) -> Surface {
    let mut random = Random(seed);
    let albedo = ColorImage::from_fn(width, height, |_, _| [0; 3].map(|_| random.within(0.0, 1.0)));
    Surface::new(SurfaceMaps { albedo: Some(albedo), wrap, ..Default::default() })
        .expect("valid maps")
}

/// A floor of `2 * half` units a side, `repeats` texture repeats a unit, seen from above its near
/// edge.
pub fn floor_scene(surface: Surface, repeats: f32) -> Scene {
    let half = 20.0;
    let corners = [[-half, half], [half, half], [half, -half], [-half, -half]];
    let positions = corners.iter().map(|&[x, z]| Vec3::new(x, 0.0, z)).collect();
    let tex_coords = corners.iter().map(|&[x, z]| Vec2::new(x, -z) * repeats).collect();
    Scene {
        meshes: vec![Mesh::new(positions, tex_coords, vec![], vec![[0, 1, 2], [0, 2, 3]])],
        materials: vec![Material { surface: Some(Arc::new(surface)), ..Material::default() }],
        camera: Camera {
            eye: Vec3::new(0.0, 1.6, 6.0),
            target: Vec3::new(0.0, 0.6, 0.0),
            up: Vec3::Y,
            ..Camera::default()
        },
        ..Scene::default()
    }
}

/// Rounded stones in a square pattern with dark joints, by whole-number noise and squares alone.
pub fn cobbles(size: u32, stones: u32) -> SurfaceMaps {
    let side = size as f32 / stones as f32;
    let noise = |x: u32, y: u32| {
        let hash =
            (x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77)).wrapping_mul(0xC2B2_AE3D);
        ((hash ^ hash >> 15) & 0xffff) as f32 / 65535.0
    };
    let shape = move |x: u32, y: u32| {
        let [u, v] = [x, y].map(|c| ((c as f32 + 0.5) / side).fract() * 2.0 - 1.0);
        let [u2, v2] = [u * u, v * v];
        let stone = noise((x as f32 / side) as u32 + 77, (y as f32 / side) as u32);
        ((1.0 - u2 * u2 * u2) * (1.0 - v2 * v2 * v2), stone)
    };
    let height = HeightImage::from_fn(size, size, |x, y| {
        let (dome, stone) = shape(x, y);
        dome * (0.7 + 0.3 * stone) * (0.95 + 0.05 * noise(x, y))
    });
    let albedo = ColorImage::from_fn(size, size, |x, y| {
        let (dome, stone) = shape(x, y);
        let light =
            (0.08 + 0.5 * dome.min(0.6) * (0.5 + stone)) * (0.7 + 0.3 * noise(x + 3, y + 5));
        [light, light * (0.8 + 0.2 * stone), light * 0.8]
    });
    SurfaceMaps {
        albedo: Some(albedo),
        height: Some(height),
        relief_depth: 0.06,
        ..Default::default()
    }
}

/// The filter with another limit of the anisotropy; as it is where it has none.
pub fn with_limit(filter: Filter, max_anisotropy: f32) -> Filter {
    match filter {
        Filter::Ewa(ewa) => Filter::Ewa(Ewa { max_anisotropy, ..ewa }),
        Filter::Visible(visible) => Filter::Visible(Visible { max_anisotropy, ..visible }),
        Filter::Horizon(horizon) => Filter::Horizon(Horizon { max_anisotropy, ..horizon }),
        Filter::Nearest
        | Filter::Bilinear
        | Filter::Trilinear(_)
        | Filter::Parallax(_)
        | Filter::Truth(_) => filter,
    }
}

/// The filters that have a limit of the anisotropy.
pub fn limited_filters() -> impl Iterator<Item = Filter> {
    Filter::ALL.into_iter().filter(|filter| with_limit(*filter, 1.0) != *filter)
}

/// The filter with another budget of texels; as it is where it has none.
pub fn with_budget(filter: Filter, texel_budget: u32) -> Filter {
    match filter {
        Filter::Ewa(ewa) => Filter::Ewa(Ewa { texel_budget, ..ewa }),
        Filter::Visible(visible) => Filter::Visible(Visible { texel_budget, ..visible }),
        Filter::Nearest
        | Filter::Bilinear
        | Filter::Trilinear(_)
        | Filter::Horizon(_)
        | Filter::Parallax(_)
        | Filter::Truth(_) => filter,
    }
}
