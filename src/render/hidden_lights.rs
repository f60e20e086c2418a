//! What meshes hide of a scene's lights from the pixels of a block.

use crate::light::LocalLights;
use crate::raster::QuadBlock;
use crate::simd::PixelLanes;
use std::ops::Range;

/// The parts of a scene's lights that meshes hide from a block's pixels: light by light and pair by
/// pair. Nothing for a light that all of them see.
#[derive(Clone, Debug)]
pub(super) struct HiddenLights(pub(super) Vec<Vec<PixelLanes>>);

impl HiddenLights {
    /// Nothing is hidden of so many lights.
    pub(super) fn none(num: usize) -> Self {
        Self(vec![Vec::new(); num])
    }

    /// Takes what is hidden from the lights of the covered pixels of some pairs.
    pub(super) fn dim(
        &self,
        lights: &mut [LocalLights],
        (block, pairs): (&QuadBlock, Range<usize>),
    ) {
        if self.0.iter().all(Vec::is_empty) {
            return;
        }
        let pixels = pairs.flat_map(|i| block.pair(i).covered().map(move |lane| (i, lane)));
        for (lights, (pair, lane)) in lights.iter_mut().zip(pixels) {
            for (light, hidden) in lights.lights.iter_mut().zip(&self.0) {
                let hidden = hidden.get(pair).map_or(0.0, |hidden| hidden.as_array()[lane]);
                light.intensity *= 1.0 - hidden;
            }
        }
    }
}
