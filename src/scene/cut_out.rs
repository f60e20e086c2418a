//! Holes in surfaces: leaves, fences, grids.

use crate::texture::Texture;
use std::sync::Arc;

/// Where a surface is there and where it has holes, sample by sample: no more than that is blended.
///
/// Where texels are larger than pixels, holes have sharp edges. Where a pixel covers many, a sample is
/// there by chance, as often as texels are: so leaves stay as dense as they are however far, while a
/// threshold alone would make them thinner, or solid.
#[derive(Clone, Debug)]
pub struct CutOut {
    /// See [`Texture::opacity`], which knows the threshold.
    pub opacity: Arc<Texture>,
}

impl CutOut {
    /// Whether the surface is there at a place in repeats, where pixels' neighbours lie at so many
    /// repeats from each other: right and down. `chance` is any number from 0 to below 1, of samples
    /// beside each other spread evenly.
    pub(crate) fn is_there(&self, place: [f32; 2], neighbors: [[f32; 2]; 2], chance: f32) -> bool {
        let [right, down] = neighbors.map(|way| self.opacity.length(way));
        // From sharp edges, at a texel a pixel, to chance, at two.
        let blur = (right.max(down) - 1.0).clamp(0.0, 1.0);
        self.opacity.over(place, neighbors)[0] > 0.5 + (chance - 0.5) * blur
    }
}
