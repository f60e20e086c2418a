//! The quads of one material in a block of the screen, which are shaded together.

use super::gather::SeenQuad;
use super::quad::{AttributePlanes, QuadPair};

/// Side of a block in pixels; blocks lie on multiples of it in the frame.
pub const SHADED_BLOCK: usize = 16;

/// What a block of 16x16 pixels sees of one material: each triangle's quads, row by row of each 8x8 pixels.
#[derive(Clone, Copy, Debug)]
pub struct QuadBlock<'a> {
    /// Index of the material.
    pub material: usize,
    /// Column and row of the tile's upper left pixel.
    pub(super) tile: [i32; 2],
    pub(super) quads: &'a [SeenQuad],
    pub(super) planes: &'a [AttributePlanes],
}

impl<'a> QuadBlock<'a> {
    /// The quads two by two; a last lone one has no coverage in its other half.
    pub fn pairs(&self) -> impl Iterator<Item = QuadPair<'a>> {
        let Self { material, tile, planes, .. } = *self;
        self.quads.chunks(2).map(move |pair| {
            let [first, second] = [&pair[0], &pair[pair.len() - 1]];
            let mut coverage = [0; 8];
            coverage[..4].copy_from_slice(&first.coverage);
            if pair.len() == 2 {
                coverage[4..].copy_from_slice(&second.coverage);
            }
            let origin = [first, second].map(|quad| [0, 1].map(|i| tile[i] + i32::from(quad.origin[i])));
            QuadPair::new(material, origin, coverage, [first, second].map(|quad| &planes[quad.triangle as usize]))
        })
    }
}
