//! What meshes hide of a scene's lights and sky from the pixels of a block.

use crate::light::LocalLights;
use crate::raster::QuadBlock;
use crate::simd::PixelLanes;
use glam::Vec3;
use std::ops::Range;

/// What meshes hide from a block's pixels.
#[derive(Clone, Debug)]
pub(super) struct HiddenLights {
    /// The parts of lights that they do not see: light by light and pair by pair. Nothing for a
    /// light that all of them see.
    pub(super) lights: Vec<Vec<PixelLanes>>,
    /// The shares of the sky that they do see, red, green and blue, pair by pair; nothing where that is
    /// told otherwise.
    pub(super) skies: Vec<[Vec3; 8]>,
}

impl HiddenLights {
    /// Nothing is hidden of so many lights.
    pub(super) fn none(num: usize) -> Self {
        Self { lights: vec![Vec::new(); num], skies: Vec::new() }
    }

    /// Takes what is hidden from the lights and the sky of the covered pixels of some pairs.
    pub(super) fn dim(
        &self,
        lights: &mut [LocalLights],
        (block, pairs): (&QuadBlock, Range<usize>),
    ) {
        if self.lights.iter().all(Vec::is_empty) && self.skies.is_empty() {
            return;
        }
        let pixels = pairs.flat_map(|i| block.pair(i).covered().map(move |lane| [i, lane]));
        for (lights, place) in lights.iter_mut().zip(pixels) {
            self.dim_at(lights, place);
        }
    }

    /// The same at one pixel, by its pair and lane.
    pub(super) fn dim_at(&self, lights: &mut LocalLights, [pair, lane]: [usize; 2]) {
        for (light, hidden) in lights.lights.iter_mut().zip(&self.lights) {
            let hidden = hidden.get(pair).map_or(0.0, |hidden| hidden.as_array()[lane]);
            light.intensity *= 1.0 - hidden;
        }
        if let Some(skies) = self.skies.get(pair) {
            lights.occlude(skies[lane]);
        }
    }
}
