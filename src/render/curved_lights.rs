//! The lights of pairs of a block of a curved surface, for the filter that lights texels with them.

use super::ground::{Ground, Swept};
use super::skies::Skies;
use crate::footprint::Footprints;
use crate::light::{Curved, CurvedSun, Disc, FrameLanes, LinearSky, Slant};
use crate::raster::{LitLanes, QuadBlock};
use crate::scene::{Light, Scene};
use glam::Vec3;
use std::ops::Range;

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

    /// Takes from the sky what a texture of occlusion says of each pixel.
    pub(super) fn occlude(&mut self, ground: &Ground, pixels: &[Footprints]) {
        if ground.material.maps.occlusion.is_none() {
            return;
        }
        for (skies, pixels) in self.skies.iter_mut().zip(pixels) {
            for lane in pixels.covered() {
                let share = ground.finish(&pixels.lane(lane)).occlusion;
                skies[lane] = LinearSky::blend([(skies[lane], share)].into_iter());
            }
        }
    }

    /// All of them.
    pub(super) fn all(&self) -> Curved<'_> {
        let Self { skies, suns, frames, slants } = self;
        Curved { suns, skies, frames, slants }
    }
}
