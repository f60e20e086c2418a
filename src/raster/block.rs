//! The quads of one material and group in a block of the screen, which are shaded together.

use super::gather::SeenQuad;
use super::quad::{AttributePlanes, QuadPair};

/// What a block of 16x16 pixels sees of one material and group: each triangle's quads, row by row of
/// each 8x8 pixels.
#[derive(Clone, Copy, Debug)]
pub struct QuadBlock<'a> {
    /// Index of the material.
    pub material: usize,
    /// Number of the [group](super::Drawn::group).
    pub group: usize,
    /// Column and row of the tile's upper left pixel.
    pub(super) tile: [i32; 2],
    pub(super) quads: &'a [SeenQuad],
    pub(super) planes: &'a [AttributePlanes],
}

impl<'a> QuadBlock<'a> {
    /// The quads two by two; a last lone one has no coverage in its other half.
    pub fn pairs(&self) -> impl Iterator<Item = QuadPair<'a>> {
        let block = *self;
        (0..self.num_pairs()).map(move |index| block.pair(index))
    }

    /// How many pairs there are.
    pub fn num_pairs(&self) -> usize {
        self.quads.len().div_ceil(2)
    }

    /// One of [`Self::pairs`].
    #[inline(always)]
    pub fn pair(&self, index: usize) -> QuadPair<'a> {
        let Self { material, tile, planes, quads, .. } = *self;
        let first = &quads[2 * index];
        // A lone quad is paired with itself: its second half computes on valid planes, unseen.
        let (second, coverage) = match quads.get(2 * index + 1) {
            Some(second) => (second, second.coverage),
            None => (first, [0; 4]),
        };
        // Put together in a register, not as two halves of an array that are read as a whole: such
        // a read waits for both stores.
        let coverage = [first.coverage, coverage].map(|bytes| u64::from(u32::from_le_bytes(bytes)));
        let coverage = (coverage[0] | coverage[1] << 32).to_le_bytes();
        let origin =
            [first, second].map(|quad| [0, 1].map(|i| tile[i] + i32::from(quad.origin[i])));
        let planes = [first, second].map(|quad| &planes[quad.triangle as usize]);
        QuadPair::new(material, origin, coverage, planes)
    }
}
