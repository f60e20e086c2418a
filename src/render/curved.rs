//! Blocks of a curved surface, whose texels are lit as they are swept.
//!
//! Suns that other meshes, or the mesh itself, hide from a part of a block are swept apart, and each
//! pixel takes of them what it sees.

use super::ground::{Ground, Swept};
use super::shade::{ShadeScratch, Shader};
use super::skies::Skies;
use crate::light::{Curved, CurvedSun, Disc, FrameLanes, LinearSky, Slant};
use crate::raster::{LitLanes, QuadBlock};
use crate::scene::{Light, Scene};
use crate::simd::PixelLanes;
use glam::Vec3;
use std::ops::Range;

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

/// What lights pairs of a block.
#[derive(Debug)]
pub(super) struct CurvedLights {
    skies: Vec<[LinearSky; 8]>,
    suns: Vec<CurvedSun>,
    frames: Vec<FrameLanes>,
    slants: Vec<Slant>,
}

impl CurvedLights {
    /// Some of a scene's lights on pairs of a block.
    pub(super) fn new(
        (scene, skies): (&Scene, &Skies),
        swept: Swept,
        block: &QuadBlock,
        pairs: Range<usize>,
    ) -> Self {
        let discs = scene.lights.iter().enumerate().filter_map(|(i, light)| match *light {
            Light::Sun { to_light, intensity, angular_size } if swept.suns >> i & 1 == 1 => {
                Some((Disc::new(to_light.normalize_or_zero(), angular_size), intensity))
            }
            _ => None,
        });
        let discs: Vec<(Disc, Vec3)> = discs.collect();
        let sun = |(disc, intensity): &(Disc, Vec3)| CurvedSun {
            intensity: *intensity,
            radius: disc.radius,
        };
        let suns = discs.iter().map(sun).collect();
        let (frames, slants, of_pairs) = Default::default();
        let mut all = Self { skies: of_pairs, suns, frames, slants };
        for pair in pairs.map(|index| block.pair(index)) {
            let Some(LitLanes { position, normal, tangent_u, tangent_v }) = pair.lit() else {
                continue;
            };
            let frame =
                FrameLanes::new(&position, &normal, &[tangent_u, tangent_v], scene.camera.eye);
            all.slants.extend(discs.iter().map(|(disc, _)| frame.slant(disc.to_middle)));
            if swept.has_sky {
                all.skies.push(skies.of_pair(scene, &pair, &frame));
            }
            all.frames.push(frame);
        }
        all
    }

    /// All of them.
    pub(super) fn all(&self) -> Curved<'_> {
        let Self { skies, suns, frames, slants } = self;
        Curved { suns, skies, frames, slants }
    }
}
