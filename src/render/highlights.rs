//! What reliefs reflect of lights that they are swept under: of suns, points and the sky on curved ones, and
//! of points on flat ones.
//!
//! Each texel that is seen shows its own highlights, in the shadow of the relief and of meshes, as it
//! shows diffuse light.

use super::ground::{Ground, Swept};
use super::hidden_lights::HiddenLights;
use super::mapped::MappedGloss;
use super::shade::{ShadeScratch, Shader};
use crate::footprint::Footprints;
use crate::light::{SeenGloss, Sheen};
use crate::raster::QuadBlock;
use crate::scene::Light;
use crate::simd::PixelLanes;
use glam::Vec3;

/// What a block's pairs reflect.
pub(super) struct SweptGloss {
    is_curved: bool,
    has_sky: bool,
    colors: Vec<[PixelLanes; 3]>,
}

impl Shader<'_> {
    /// What a block reflects of lights that it is swept under; `None` where there are none.
    pub(super) fn swept_gloss(
        &self,
        ground: &Ground,
        hidden: &HiddenLights,
        block: &QuadBlock,
        scratch: &mut ShadeScratch,
    ) -> Option<SweptGloss> {
        let MappedGloss { material, prepared, luster, shows_sky, .. } = ground.gloss?;
        // More lights than bits are lit place by place.
        if !self.traits.asks_for_lights || self.scene.lights.len() > 64 {
            return None;
        }
        let is_curved = ground.swept.is_some();
        let has_sky = is_curved && *shows_sky;
        let is_here = |light: &Light| is_curved || matches!(light, Light::Point { .. });
        let lights = self.scene.lights.iter().enumerate().filter(|(_, light)| is_here(light));
        let lights = lights.fold(0_u64, |lights, (i, _)| lights | 1 << i);
        if lights == 0 && !has_sky {
            return None;
        }
        let of = Ground { material, prepared, unlit: prepared, diffuse: prepared, ..*ground };
        let reflecting = Ground { baked: None, glow: None, gloss: None, ..of };
        let swept = Swept { lights, has_sky, sheen: Some(Sheen::Luster(*luster)) };
        let mut colors = Vec::with_capacity(block.num_pairs());
        self.swept(&reflecting, (swept, hidden), block, scratch, &mut colors);
        Some(SweptGloss { is_curved, has_sky, colors })
    }
}

impl SweptGloss {
    /// Adds what the covered pixels of vectors show, the first of which is a block's pair of some
    /// number.
    pub(super) fn add_to(&self, sums: &mut [SeenGloss], pixels: &[Footprints], first: usize) {
        let pixels = pixels.iter().zip(&self.colors[first..]);
        let colors = pixels.flat_map(|(pixels, color)| pixels.covered().map(move |i| (i, color)));
        for ((lane, color), sum) in colors.zip(sums) {
            sum.color += Vec3::from(color.map(|c| c.as_array()[lane]));
            sum.has_points = true;
            sum.has_suns |= self.is_curved;
            sum.has_sky |= self.has_sky;
        }
    }
}
