//! Displacements that bow: rays over a curved surface as the lines of a patch see them.
//!
//! A texel at depth `d` is seen over the place from which a ray has moved by `d D + d (d - s) B` when it
//! gets there, with the bow `B` ([`bow`](crate::relief::bow)) and the depth `s` for which `D` is right. What
//! of `B` is along the lines moves the seen places; by what is across them all lines sway alike, as the
//! ray from the middle does:
//!
//! ```text
//!   far end     )  )  )      d = 1
//!              )  )  )       d = s: where straight lines are
//!   near end    \  \  \      d = 0: so they are here
//! ```

use super::sweep_frame::{SweepFrame, total};
use crate::relief::SEEN_DEPTH;
use crate::simd::{LineLanes, PixelLanes};

/// Most that a displacement may bow, forth and back, as shares of it.
const MOST_BOW: [f32; 2] = [0.6, 1.5];

/// Most that lines may sway, as a share of the displacement.
const MOST_SWAY: f32 = 0.5;

/// The mean over the picked lanes of bows.
pub(super) fn mean_bow(bows: &[[PixelLanes; 2]], picked: &[PixelLanes], num: usize) -> [f32; 2] {
    [0, 1].map(|axis| total(bows, picked, |bow| bow[axis]) / num as f32)
}

impl SweepFrame<'_> {
    /// Gives it the mean bow, in repeats, of displacements.
    pub(super) fn bowed(mut self, bow: [f32; 2]) -> Self {
        let [across, along] = self.turn(bow);
        let (across, along) = (across * self.texels[0], along * self.texels[1] * self.toward);
        // Displacements must grow from the polygon down to the deepest relief.
        self.bow = along.clamp(-MOST_BOW[0] * self.depth, MOST_BOW[1] * self.depth);
        let most = MOST_SWAY * self.depth;
        self.sway = (across - along * self.shear).clamp(-most, most);
        self
    }

    /// By how much a row farther on lines have swayed by more than the rays of pixels there, where both
    /// see the mean depth: rays sway from where they come in, lines from the middle.
    pub(super) fn sway_ahead(&self) -> f32 {
        if self.sway == 0.0 {
            return 0.0;
        }
        let deeper = 2.0 * self.mean_depth - SEEN_DEPTH;
        let growing = 1.0 + self.mean_depth * self.growth;
        self.sway * deeper * growing / (self.depth + deeper * self.bow)
    }

    /// How far beside straight lines they meet rows so far from the middle.
    #[inline(always)]
    pub(super) fn sway_at(&self, q: LineLanes) -> LineLanes {
        let within = |d: LineLanes| d.fast_max(LineLanes::ZERO).fast_min(LineLanes::ONE);
        // The depth of the middle's ray: without its bow, and once more with that there. No bow leaves
        // the divisor less than a sixth of the depth.
        let straight = within(q * (1.0 / self.depth));
        let d = within(q / ((straight - SEEN_DEPTH) * self.bow + self.depth));
        d * (d - SEEN_DEPTH) * self.sway
    }
}
