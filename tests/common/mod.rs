//! What several tests need: numbers from a fixed seed, and small surfaces.
#![allow(dead_code, reason = "each test uses a part")]

use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps, Wrap};

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
    let maps =
        SurfaceMaps { albedo: Some(albedo), height: Some(heights), wrap, relief_depth: 0.1, ..Default::default() };
    Surface::new(maps).expect("valid maps")
}

/// A surface of random texels without relief.
pub fn flat_surface(width: u32, height: u32, wrap: Wrap, seed: u64) -> Surface {
    let mut random = Random(seed);
    let albedo = ColorImage::from_fn(width, height, |_, _| [0; 3].map(|_| random.within(0.0, 1.0)));
    Surface::new(SurfaceMaps { albedo: Some(albedo), wrap, ..Default::default() }).expect("valid maps")
}
