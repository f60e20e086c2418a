//! The lights of a block of a curved surface, as its texels are lit while they are swept.

use crate::light::{Curved, CurvedSun, Disc, FrameLanes, Slant};
use crate::raster::{LitLanes, QuadBlock};
use crate::scene::{Light, Scene, Sky};
use glam::Vec3;
use std::ops::Range;

/// What lights pairs of a block.
#[derive(Debug, Default)]
pub(super) struct CurvedLights {
    suns: Vec<CurvedSun>,
    frames: Vec<FrameLanes>,
    slants: Vec<Slant>,
}

impl CurvedLights {
    /// The suns of a scene on pairs of a block.
    pub(super) fn new(scene: &Scene, block: &QuadBlock, pairs: Range<usize>) -> Self {
        let mut all = Self::default();
        let discs = scene.lights.iter().filter_map(|light| match *light {
            Light::Sun { to_light, intensity, angular_size } => {
                Some((Disc::new(to_light.normalize_or_zero(), angular_size), intensity))
            }
            Light::Point { .. } => None,
        });
        let discs: Vec<(Disc, Vec3)> = discs.collect();
        all.suns.extend(
            discs
                .iter()
                .map(|(disc, intensity)| CurvedSun { intensity: *intensity, radius: disc.radius }),
        );
        for pair in pairs.map(|index| block.pair(index)) {
            let Some(LitLanes { position, normal, tangent_u, tangent_v }) = pair.lit() else {
                continue;
            };
            let frame =
                FrameLanes::new(&position, &normal, &[tangent_u, tangent_v], scene.camera.eye);
            all.slants.extend(discs.iter().map(|(disc, _)| frame.slant(disc.to_middle)));
            all.frames.push(frame);
        }
        all
    }

    /// All of them, under a sky.
    pub(super) fn all<'a>(&'a self, sky: &'a Sky) -> Curved<'a> {
        Curved { suns: &self.suns, sky, frames: &self.frames, slants: &self.slants }
    }
}
