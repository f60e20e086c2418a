//! Displacements that bow: rays over a curved surface as the lines of a patch see them.
//!
//! A texel at depth `d` is seen over the place from which a ray has moved by `d D + d (d - s) B` when it
//! gets there, with the bow `B` ([`bow`](crate::relief::bow)) and the depth `s` for which `D` is right.

use super::sweep_frame::{SweepFrame, total};
use crate::simd::PixelLanes;

/// Most that a displacement may bow, forth and back, as shares of it.
const MOST_BOW: [f32; 2] = [0.6, 1.5];

/// The mean over the picked lanes of bows.
pub(super) fn mean_bow(bows: &[[PixelLanes; 2]], picked: &[PixelLanes], num: usize) -> [f32; 2] {
    [0, 1].map(|axis| total(bows, picked, |bow| bow[axis]) / num as f32)
}

impl SweepFrame<'_> {
    /// Gives it the mean bow, in repeats, of displacements. What bows across them is left out.
    pub(super) fn bowed(mut self, bow: [f32; 2]) -> Self {
        let bow = self.turn(bow)[1] * self.texels[1] * self.toward;
        // Displacements must grow from the polygon down to the deepest relief.
        self.bow = bow.clamp(-MOST_BOW[0] * self.depth, MOST_BOW[1] * self.depth);
        self
    }
}
