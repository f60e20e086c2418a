//! What a mip level loses in occlusion.
//!
//! A level's heights are means. Relief finer than its texels is gone from it, and with it what that relief hides: joints
//! between stones open up, thin ridges vanish. How much that changes the picture depends on the material and on how slant the
//! view is, so it is measured: what is seen on a level against what is seen on the base level, for every length of the
//! displacement. A sweep then takes a finer level where its own would lose too much.

use super::directions::{Lengths, NUM_LENGTHS};
use super::seen::{seen_image, square_difference};
use crate::texture::Surface;
use rayon::prelude::*;
use std::sync::OnceLock;

/// Most texels of the images that are compared.
const MOST_TEXELS: usize = 128 * 128;

/// Greatest root-mean-square difference, of the surface's colour scale, that levels 1 and 2 may make in what is seen
/// before sweeps must be finer. Measured: 0.02 keeps thin high ridges at base level; at 0.035 the level 2 of rounded
/// stones still serves.
const MOST_LOSS: [f32; 2] = [0.02, 0.035];

/// Directions in which the loss of a level is measured, as diamond angles: along u, and one that lies along no axis.
const PROBES: [f32; 2] = [0.0, 2.0625];

/// How much finer than its footprint asks for a sweep must be, by the length of its displacement. A length is measured when
/// it is first asked for.
#[derive(Clone, Debug)]
pub struct LevelLoss {
    lengths: Lengths,
    /// The level whose size the images that are compared have; `None` for a surface of fewer levels than are measured.
    compared: Option<usize>,
    /// Levels finer, for each length.
    bias: [OnceLock<u8>; NUM_LENGTHS],
}

impl LevelLoss {
    /// Nothing is measured yet.
    pub fn new(surface: &Surface) -> Self {
        // Images are as large as the coarsest level that is measured at the most.
        let is_small = |level: &usize| surface.levels()[*level].size().iter().product::<usize>() <= MOST_TEXELS;
        let compared = (MOST_LOSS.len()..surface.levels().len()).find(is_small);
        Self { lengths: Lengths::new(surface), compared, bias: Default::default() }
    }

    /// Measures all lengths of the surface, side by side.
    pub fn measure_all(&self, surface: &Surface) {
        (0..NUM_LENGTHS).into_par_iter().for_each(|length| {
            self.of_length(surface, length);
        });
    }

    /// How many mip levels finer than its footprint asks for a sweep must be for its displacement (base texels).
    pub fn bias(&self, surface: &Surface, displacement: [f32; 2]) -> usize {
        usize::from(self.of_length(surface, (self.lengths.place_of(displacement) + 0.5) as usize))
    }

    /// How much of a displacement's two nearest lengths, 0 to 1, lose anything.
    pub fn share(&self, surface: &Surface, displacement: [f32; 2]) -> f32 {
        let place = self.lengths.place_of(displacement);
        let near = (place as usize).min(NUM_LENGTHS - 2);
        let [a, b] = [near, near + 1].map(|length| f32::from(self.of_length(surface, length).min(1)));
        a + (b - a) * (place - near as f32)
    }

    fn of_length(&self, surface: &Surface, length: usize) -> u8 {
        *self.bias[length].get_or_init(|| self.measure(surface, length))
    }

    fn measure(&self, surface: &Surface, length: usize) -> u8 {
        let Some(compared) = self.compared else { return 0 };
        let size = surface.levels()[compared].size();
        let displacements = PROBES.map(|angle| self.lengths.displacement(length, angle));
        let exact = displacements.map(|displacement| seen_image(surface, 0, size, displacement));
        let is_lost = |level: usize| {
            let probes = displacements.iter().zip(&exact);
            let squares = probes.map(|(d, exact)| square_difference(exact, &seen_image(surface, level, size, *d)));
            (squares.sum::<f32>() / PROBES.len() as f32).sqrt() > MOST_LOSS[level - 1]
        };
        if is_lost(1) { 2 } else { u8::from(is_lost(2)) }
    }
}
