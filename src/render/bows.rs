//! How view rays bow over curved meshes.

use crate::footprint::Footprints;
use crate::raster::QuadBlock;
use crate::relief::{HeightField, bow};
use crate::simd::PixelLanes;
use std::ops::Range;

/// How much the displacements of pairs of a block grow with the depth, and makes those of their pixels
/// right for that; nothing where none grows.
pub(super) fn find_bows(
    field: &HeightField,
    (block, pairs): (&QuadBlock, Range<usize>),
    pixels: &mut [Footprints],
    bows: &mut Vec<[PixelLanes; 2]>,
) {
    if !pairs.clone().any(|index| block.pair(index).bend().is_some()) {
        return;
    }
    bows.extend(pairs.zip(pixels).map(|(index, pixels)| {
        let pair = block.pair(index);
        let Some(bend) = pair.bend() else { return Default::default() };
        let [bow, more] = bow(&pair.view(), &bend, field.relief_depth);
        (0..2).for_each(|i| pixels.displacement[i] += more[i]);
        bow
    }));
}
