//! What drawing one tile needs in memory.

use super::behind::FollowScratch;
use super::canvas::Canvas;
use super::gather::SeenQuad;
use super::quad::AttributePlanes;
use super::tile::VisibilityBuffer;
use crate::simd::PixelLanes;

/// Buffers for one tile.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    /// The tile's triangles; places in it are local indices.
    pub(super) list: Vec<u32>,
    pub(super) visibility: VisibilityBuffer,
    pub(super) followed: FollowScratch,
    pub(super) quads: Vec<SeenQuad>,
    /// Slot in `planes` of each local index, or [`NONE`].
    pub(super) slots: Vec<u32>,
    /// The triangles seen, in the order of the list.
    pub(super) planes: Vec<AttributePlanes>,
    /// Mesh of each slot, and the triangle's index in it.
    pub(super) triangles: Vec<[u32; 2]>,
    /// Material and group of each slot.
    pub(super) grounds: Vec<[u32; 2]>,
    /// Colours of the pairs of a block.
    pub(super) colors: Vec<[PixelLanes; 3]>,
    /// The tile's pixels.
    pub(super) canvas: Canvas,
}
