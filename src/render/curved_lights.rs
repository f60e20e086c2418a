//! The lights of pairs of a block of a curved surface, for the filter that lights texels with them.

use super::ground::{Ground, Swept};
use super::prepared::PreparedScene;
use crate::footprint::Footprints;
use crate::light::{
    Curved, CurvedSun, Disc, FrameLanes, LinearSky, Sheen, Shine, Slant, Vectors, Ways,
};
use crate::raster::{LitLanes, QuadBlock};
use crate::relief::displacement;
use crate::scene::{Eye, Light, Scene};
use crate::simd::PixelLanes;
use glam::Vec3;
use std::ops::Range;

/// What lights pairs of a block.
#[derive(Debug)]
pub(super) struct CurvedLights {
    relief_depth: f32,
    discs: Vec<Disc>,
    places: Vec<Vec3>,
    suns: Vec<CurvedSun>,
    points: Vec<Vec3>,
    /// Of a glossy surface: see [`Shine`].
    shine: Option<(Eye, Sheen)>,
    /// On the pairs.
    shone: Shone,
}

/// How lights shine on vectors of places: see [`Curved`].
#[derive(Debug, Default)]
pub(super) struct Shone {
    skies: Vec<[LinearSky; 8]>,
    frames: Vec<FrameLanes>,
    slants: Vec<Slant>,
    ways: Vec<Ways>,
    to_eyes: Vec<Vectors>,
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
            shine: swept.sheen.map(|sheen| (scene.camera.viewpoint(), sheen)),
            shone: Shone::default(),
        };
        let mut shone = Shone::default();
        for pair in pairs.map(|index| block.pair(index)) {
            let Some(lit) = pair.lit() else { continue };
            all.shine_on(&lit, || displacement(&pair.view(), relief_depth), &mut shone);
            if swept.has_sky {
                let sky = skies.of_pair((scene, occluders), &pair).unwrap_or_default();
                shone.skies.push(sky);
            }
        }
        all.shone = shone;
        all
    }

    /// Adds how they shine on places, and how far what is seen there moves down to the deepest relief.
    fn shine_on(
        &self,
        lit: &LitLanes,
        displacement: impl Fn() -> [PixelLanes; 2],
        shone: &mut Shone,
    ) {
        let LitLanes { position, normal, tangent_u, tangent_v, is_back } = lit;
        let frame = FrameLanes::new(normal, &[*tangent_u, *tangent_v], *is_back);
        shone.slants.extend(self.discs.iter().map(|disc| frame.slant(disc.to_middle)));
        if !self.places.is_empty() {
            let ray = (displacement(), self.relief_depth);
            shone.ways.extend(self.places.iter().map(|at| frame.ways(position, *at, ray)));
        }
        shone.to_eyes.extend(self.shine.map(|(eye, _)| frame.to_eye(position, eye)));
        shone.frames.push(frame);
    }

    /// How they shine on the polygons above hits of a pixel's rays, under the sky of the pixel.
    pub(super) fn at_hits(&self, lit: &LitLanes, [vector, lane]: [usize; 2]) -> Shone {
        let skies = self.shone.skies.get(vector).map(|skies| [skies[lane]; 8]);
        let mut shone = Shone { skies: skies.into_iter().collect(), ..Shone::default() };
        // A hit is straight below its polygon.
        self.shine_on(lit, || [PixelLanes::ZERO; 2], &mut shone);
        shone
    }

    /// Takes from the sky what a texture of occlusion says of each pixel.
    pub(super) fn occlude(&mut self, ground: &Ground, pixels: &[Footprints]) {
        if ground.material.maps.occlusion.is_none() {
            return;
        }
        for (skies, pixels) in self.shone.skies.iter_mut().zip(pixels) {
            for lane in pixels.covered() {
                let share = ground.finish(&pixels.lane(lane)).occlusion;
                skies[lane] = LinearSky::blend([(skies[lane], share)].into_iter());
            }
        }
    }

    /// All of them on the pairs.
    pub(super) fn all(&self) -> Curved<'_> {
        self.of(&self.shone)
    }

    /// All of them on other places.
    pub(super) fn of<'a>(&'a self, shone: &'a Shone) -> Curved<'a> {
        let Self { suns, points, shine, .. } = self;
        let Shone { skies, frames, slants, ways, to_eyes } = shone;
        let shine = shine.map(|(_, sheen)| Shine { sheen, to_eyes });
        Curved { suns, skies, frames, slants, points, ways, shine }
    }
}
