//! How view rays bow over curved meshes.

use crate::raster::QuadBlock;
use crate::relief::{HeightField, bow};
use crate::simd::PixelLanes;
use std::ops::Range;

/// How much the displacements of pairs of a block grow with the depth; nothing where none does.
pub(super) fn find_bows(
    field: &HeightField,
    (block, pairs): (&QuadBlock, Range<usize>),
    bows: &mut Vec<[PixelLanes; 2]>,
) {
    let of_pair = |index: usize| {
        let pair = block.pair(index);
        let (view, bend) = (pair.view(), pair.bend()?);
        Some(bow(&view, &bend, field.relief_depth))
    };
    if pairs.clone().any(|index| block.pair(index).bend().is_some()) {
        bows.extend(pairs.map(|index| of_pair(index).unwrap_or_default()));
    }
}
