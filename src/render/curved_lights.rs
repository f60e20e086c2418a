//! The lights of pairs of a block of a curved surface, for the filter that lights texels with them.

use super::ground::{Ground, Swept};
use super::prepared::PreparedScene;
use crate::footprint::Footprints;
use crate::light::{Curved, CurvedSun, Disc, FrameLanes, LinearSky, Slant, Ways};
use crate::raster::{LitLanes, QuadBlock};
use crate::relief::displacement;
use crate::scene::{Light, Scene};
use crate::simd::PixelLanes;
use glam::Vec3;
use std::ops::Range;

/// What lights pairs of a block.
#[derive(Debug)]
pub(super) struct CurvedLights {
    relief_depth: f32,
    discs: Vec<Disc>,
    places: Vec<Vec3>,
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
        let mut all = Self {
            relief_depth,
            suns: discs.iter().map(sun).collect(),
            discs: discs.iter().map(|(disc, _)| *disc).collect(),
            points: places.iter().map(|(_, intensity)| *intensity).collect(),
            places: places.iter().map(|(place, _)| *place).collect(),
            skies: Vec::new(),
            frames: Vec::new(),
            slants: Vec::new(),
            ways: Vec::new(),
        };
        for pair in pairs.map(|index| block.pair(index)) {
            let Some(lit) = pair.lit() else { continue };
            let frame = all.add(&lit, || displacement(&pair.view(), relief_depth));
            if swept.has_sky {
                let sky = skies.of_pair((scene, occluders), &pair, &frame);
                all.skies.push(sky);
            }
        }
        all
    }

    /// Adds how they shine on places, and how far what is seen there moves down to the deepest relief.
    fn add(&mut self, lit: &LitLanes, displacement: impl Fn() -> [PixelLanes; 2]) -> FrameLanes {
        let LitLanes { position, normal, tangent_u, tangent_v, is_back } = lit;
        let frame = FrameLanes::new(normal, &[*tangent_u, *tangent_v], *is_back);
        self.slants.extend(self.discs.iter().map(|disc| frame.slant(disc.to_middle)));
        if !self.places.is_empty() {
            let ray = (displacement(), self.relief_depth);
            self.ways.extend(self.places.iter().map(|at| frame.ways(position, *at, ray)));
        }
        self.frames.push(frame);
        frame
    }

    /// The same lights on the polygons above hits of a pixel's rays, under the sky of the pixel.
    pub(super) fn at_hits(&self, lit: &LitLanes, [vector, lane]: [usize; 2]) -> Self {
        let skies = self.skies.get(vector).map(|skies| [skies[lane]; 8]);
        let mut all = Self {
            relief_depth: self.relief_depth,
            suns: self.suns.clone(),
            discs: self.discs.clone(),
            points: self.points.clone(),
            places: self.places.clone(),
            skies: skies.into_iter().collect(),
            frames: Vec::new(),
            slants: Vec::new(),
            ways: Vec::new(),
        };
        // A hit is straight below its polygon.
        all.add(lit, || [PixelLanes::ZERO; 2]);
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
        let Self { skies, suns, frames, slants, points, ways, .. } = self;
        Curved { suns, skies, frames, slants, points, ways }
    }
}
