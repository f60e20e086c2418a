//! What drawing one tile needs in memory, and the pool that keeps it.
//!
//! A task takes a [`Scratch`] from the rasterizer's pool and gives it back when it ends, so there are as many as tasks ever
//! ran at once, and their buffers have grown to what the frame needs after the first one.

use super::canvas::Canvas;
use super::gather::SeenQuad;
use super::quad::AttributePlanes;
use super::tile::VisibilityBuffer;
use crate::simd::PixelLanes;
use std::sync::{Mutex, PoisonError};

/// Buffers for one tile.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    /// The tile's triangles; places in it are local indices.
    pub(super) list: Vec<u32>,
    pub(super) visibility: VisibilityBuffer,
    pub(super) quads: Vec<SeenQuad>,
    /// Slot in `planes` of each local index, or [`NONE`].
    pub(super) slots: Vec<u32>,
    /// The triangles seen, in the order in which quads found them.
    pub(super) planes: Vec<AttributePlanes>,
    /// Mesh of each slot, and the triangle's index in it.
    pub(super) triangles: Vec<[u32; 2]>,
    /// Material of each slot.
    pub(super) materials: Vec<u32>,
    /// Colours of the pairs of a block.
    pub(super) colors: Vec<[PixelLanes; 3]>,
    /// The tile's pixels.
    pub(super) canvas: Canvas,
}

/// A [`Scratch`] on loan from the pool.
pub(super) struct Borrowed<'a> {
    pool: &'a Mutex<Vec<Scratch>>,
    scratch: Option<Scratch>,
}

impl<'a> Borrowed<'a> {
    pub(super) fn new(pool: &'a Mutex<Vec<Scratch>>) -> Self {
        Self { pool, scratch: pool.lock().unwrap_or_else(PoisonError::into_inner).pop() }
    }

    pub(super) fn get(&mut self) -> &mut Scratch {
        self.scratch.get_or_insert_default()
    }
}

impl Drop for Borrowed<'_> {
    fn drop(&mut self) {
        self.pool.lock().unwrap_or_else(PoisonError::into_inner).extend(self.scratch.take());
    }
}
