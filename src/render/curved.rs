//! Blocks whose texels are lit as they are swept: curved ones, and flat ones under points.
//!
//! Lights that other meshes, or the mesh itself, hide from a part of a block are swept apart, and
//! each pixel takes of them what it sees.

use super::ground::{Ground, Swept};
use super::hidden_lights::HiddenLights;
use super::shade::{ShadeScratch, Shader};
use crate::raster::QuadBlock;
use crate::simd::PixelLanes;

impl Shader<'_> {
    /// Appends what a block's pairs show of some lights.
    pub(super) fn swept(
        &self,
        ground: &Ground,
        (all, hidden): (Swept, &HiddenLights),
        block: &QuadBlock,
        scratch: &mut ShadeScratch,
        colors: &mut Vec<[PixelLanes; 3]>,
    ) {
        if ground.is_all_metal() {
            colors.resize(colors.len() + block.num_pairs(), [PixelLanes::ZERO; 3]);
            return;
        }
        // Find the lights that reach all of the block, and those that reach a part.
        let (mut whole, mut parts) = (all, Vec::new());
        for (i, hidden) in hidden.lights.iter().enumerate() {
            if hidden.is_empty() || all.lights >> i & 1 == 0 {
                continue;
            }
            let covered = || hidden.iter().zip(block.pairs());
            let all_are = |value: f32| {
                covered().all(|(hidden, pair)| {
                    pair.covered().all(|lane| hidden.as_array()[lane] == value)
                })
            };
            if !all_are(0.0) {
                whole.lights &= !(1 << i);
                if !all_are(1.0) {
                    parts.push((i, hidden));
                }
            }
        }
        let start = colors.len();
        self.textured(&Ground { swept: Some(whole), ..*ground }, block, scratch, colors);
        let mut part = Vec::new();
        for (i, hidden) in parts {
            part.clear();
            let light = Swept { lights: 1 << i, has_sky: false, ..all };
            self.textured(&Ground { swept: Some(light), ..*ground }, block, scratch, &mut part);
            for ((color, part), hidden) in colors[start..].iter_mut().zip(&part).zip(hidden) {
                (0..3).for_each(|c| color[c] += part[c] * (PixelLanes::ONE - *hidden));
            }
        }
    }
}
