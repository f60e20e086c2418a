//! What a mip level loses in occlusion.
//!
//! A level's heights are means. Relief finer than its texels is gone from it, and with it what that
//! relief hides: joints between stones open up, thin ridges vanish. How much that changes the
//! picture depends on the material and on how slant the view is, so it is measured: the heights
//! that are seen on a level against those seen on the base level, for every length of the
//! displacement. Heights and not colours, so that it is a fact of the relief: a filter whose level
//! hung on the texture's colours would not be linear in them. A sweep then takes a finer level
//! where its own would lose too much.

use super::directions::{Lengths, NUM_LENGTHS};
use super::seen::{Heights, View, seen_image, square_difference};
use crate::texture::Surface;
use rayon::prelude::*;
use std::sync::OnceLock;

/// Most texels of the images that are compared.
const MOST_TEXELS: usize = 128 * 128;

/// Greatest root-mean-square difference, of the relief's depth, that levels 1 and 2 may make in the
/// heights that are seen before sweeps must be finer. Measured over all lengths, materials of 1024
/// texels a side, levels 1 and 2: rounded stones up to 0.015 and 0.032, bricks 0.007 and 0.015,
/// rock 0.007 and 0.014, chain mail 0.018 and 0.037, thin high ridges 0.13 to 0.34 and 0.18 to
/// 0.48; the ridges alone are seen to suffer.
const MOST_LOSS: [f32; 2] = [0.02, 0.04];

/// Directions in which the loss of a level is measured, as diamond angles: along u, and one that
/// lies along no axis.
const PROBES: [f32; 2] = [0.0, 2.0625];

/// How much finer than its footprint asks for a sweep must be, by the length of its displacement. A
/// length is measured when it is first asked for.
#[derive(Clone, Debug)]
pub struct LevelLoss {
    lengths: Lengths,
    /// The level whose size the images that are compared have; `None` for a surface of fewer levels
    /// than are measured.
    compared: Option<usize>,
    /// Levels finer, for each length.
    bias: [OnceLock<u8>; NUM_LENGTHS],
}

impl LevelLoss {
    /// Nothing is measured yet.
    pub fn new(surface: &Surface) -> Self {
        // Images are as large as the coarsest level that is measured at the most.
        let is_small = |level: &usize| {
            surface.levels()[*level].size().iter().product::<usize>() <= MOST_TEXELS
        };
        let compared = (MOST_LOSS.len()..surface.levels().len()).find(is_small);
        Self { lengths: Lengths::new(surface), compared, bias: Default::default() }
    }

    /// Measures all lengths of the surface, side by side.
    pub fn measure_all(&self, surface: &Surface) {
        (0..NUM_LENGTHS).into_par_iter().for_each(|length| {
            self.of_length(surface, length);
        });
    }

    /// How many mip levels finer than its footprint asks for a sweep must be for its displacement
    /// (base texels).
    pub fn bias(&self, surface: &Surface, displacement: [f32; 2]) -> usize {
        usize::from(self.of_length(surface, (self.lengths.place_of(displacement) + 0.5) as usize))
    }

    fn of_length(&self, surface: &Surface, length: usize) -> u8 {
        *self.bias[length].get_or_init(|| self.measure(surface, length))
    }

    fn measure(&self, surface: &Surface, length: usize) -> u8 {
        let Some(compared) = self.compared else { return 0 };
        let size = surface.levels()[compared].size();
        let views = PROBES.map(|angle| View {
            displacement: self.lengths.displacement(length, angle),
            plane: surface.mean_depth(),
        });
        // See the relief on the base level, which loses nothing.
        let exact = views.map(|view| seen_image(surface, &Heights, 0, size, view));
        let is_lost = |level: usize| {
            let squares = views.iter().zip(&exact).map(|(view, exact)| {
                square_difference(exact, &seen_image(surface, &Heights, level, size, *view))
            });
            (squares.sum::<f32>() / PROBES.len() as f32).sqrt() > MOST_LOSS[level - 1]
        };
        // Level 1 first: where it loses too much, level 2 need not be swept.
        if is_lost(1) { 2 } else { u8::from(is_lost(2)) }
    }
}
