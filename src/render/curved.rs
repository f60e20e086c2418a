//! Blocks of a curved surface, whose texels are lit as they are swept.
//!
//! Suns that other meshes, or the mesh itself, hide from a part of a block are swept apart, and each
//! pixel takes of them what it sees.

use super::ground::{Ground, Swept};
use super::shade::{ShadeScratch, Shader};
use crate::raster::QuadBlock;
use crate::simd::PixelLanes;

impl Shader<'_> {
    /// Appends the lit colours of a block's pairs.
    pub(super) fn swept(
        &self,
        ground: &Ground,
        all: Swept,
        block: &QuadBlock,
        scratch: &mut ShadeScratch,
        colors: &mut Vec<[PixelLanes; 3]>,
    ) {
        let (hidden, shown) = self.hidden_on_curved(ground, block);
        // Find the suns that reach all of the block, and those that reach a part.
        let (mut whole, mut parts) = (all, Vec::new());
        for (i, hidden) in hidden.iter().enumerate() {
            let covered = || hidden.iter().zip(block.pairs());
            let all_are = |value: f32| {
                covered().all(|(hidden, pair)| {
                    pair.covered().all(|lane| hidden.as_array()[lane] == value)
                })
            };
            if !all_are(0.0) {
                whole.suns &= !(1 << i);
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
            let sun = Swept { suns: 1 << i, has_sky: false };
            self.textured(&Ground { swept: Some(sun), ..*ground }, block, scratch, &mut part);
            for ((color, part), hidden) in colors[start..].iter_mut().zip(&part).zip(hidden) {
                (0..3).for_each(|c| color[c] += part[c] * (PixelLanes::ONE - *hidden));
            }
        }
        for (color, shown) in colors[start..].iter_mut().zip(shown) {
            color.iter_mut().for_each(|channel| *channel *= shown);
        }
    }
}
