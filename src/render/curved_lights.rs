//! The lights of pairs of a block of a curved surface, for the filter that lights texels with them.

use super::ground::{Ground, Swept};
use super::prepared::PreparedScene;
use crate::footprint::Footprints;
use crate::light::{Curved, CurvedSun, Disc, FrameLanes, LinearSky, Slant, Ways};
use crate::raster::{LitLanes, QuadBlock};
use crate::relief::displacement;
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
    points: Vec<Vec3>,
    ways: Vec<Ways>,
}

impl CurvedLights {
    /// Some of a scene's lights on pairs of a block.
    pub(super) fn new(
        (scene, prepared): (&Scene, &PreparedScene),
        (swept, relief_depth): (Swept, f32),
        block: &QuadBlock,
        pairs: Range<usize>,
    ) -> Self {
        let (skies, occluders) = (prepared.skies(scene), prepared.occluders(scene));
        let lights = || {
            let lights = scene.lights.iter().enumerate();
            lights.filter(|(i, _)| swept.lights >> i & 1 == 1).map(|(_, light)| *light)
        };
        let discs = lights().filter_map(|light| match light {
            Light::Sun { intensity, .. } => Disc::of(&light).map(|disc| (disc, intensity)),
            Light::Point { .. } => None,
        });
        let discs: Vec<(Disc, Vec3)> = discs.collect();
        let places = lights().filter_map(|light| match light {
            Light::Point { position, intensity } => Some((position, intensity)),
            Light::Sun { .. } => None,
        });
        let places: Vec<(Vec3, Vec3)> = places.collect();
        let sun = |(disc, intensity): &(Disc, Vec3)| CurvedSun {
            intensity: *intensity,
            radius: disc.radius,
        };
        let suns = discs.iter().map(sun).collect();
        let (frames, slants, of_pairs) = Default::default();
        let points = places.iter().map(|(_, intensity)| *intensity).collect();
        let mut all = Self { skies: of_pairs, suns, frames, slants, points, ways: Vec::new() };
        for pair in pairs.map(|index| block.pair(index)) {
            let Some(LitLanes { position, normal, tangent_u, tangent_v }) = pair.lit() else {
                continue;
            };
            let frame = FrameLanes::new(
                &position,
                &normal,
                &[tangent_u, tangent_v],
                scene.camera.viewpoint(),
            );
            all.slants.extend(discs.iter().map(|(disc, _)| frame.slant(disc.to_middle)));
            if !places.is_empty() {
                let ray = (displacement(&pair.view(), relief_depth), relief_depth);
                all.ways.extend(places.iter().map(|(at, _)| frame.ways(&position, *at, ray)));
            }
            if swept.has_sky {
                all.skies.push(skies.of_pair((scene, occluders), &pair, &frame));
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
        let Self { skies, suns, frames, slants, points, ways } = self;
        Curved { suns, skies, frames, slants, points, ways }
    }
}
