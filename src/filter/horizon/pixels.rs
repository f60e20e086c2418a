//! Pixels on the lines of a sweep.
//!
//! ```text
//!      p, along the lines
//!      ^    .-"""-.   half_height
//!      |  /    q    \
//!      | |     *-----| half_width      the ellipse of a pixel in the coordinates of a sweep
//!      |  \         /
//!      |    `-...-'
//!      +------------------> xi, across the lines
//! ```

use crate::simd::PixelLanes;

/// A vector of pixels on the lines of a frame: the ellipse at line `xi` and seen row `p` has
/// `r^2 = across (xi - xi_i)^2 + z^2`, `z = along (p - q_i + skew (xi - xi_i))`.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelsOnLines {
    pub(super) xi: PixelLanes,
    pub(super) q: PixelLanes,
    pub(super) along: PixelLanes,
    pub(super) skew: PixelLanes,
    pub(super) across: PixelLanes,
    pub(super) half_width: PixelLanes,
    pub(super) half_height: PixelLanes,
}

impl PixelsOnLines {
    #[inline(always)]
    pub(super) fn lane(&self, i: usize) -> PixelOnLines {
        let at = |lanes: &PixelLanes| lanes.as_array()[i];
        PixelOnLines {
            xi: at(&self.xi),
            q: at(&self.q),
            along: at(&self.along),
            skew: at(&self.skew),
            across: at(&self.across),
            half_width: at(&self.half_width),
            half_height: at(&self.half_height),
        }
    }
}

/// A pixel's ellipse on the lines of a patch: a lane of [`PixelsOnLines`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PixelOnLines {
    pub(super) xi: f32,
    pub(super) q: f32,
    pub(super) along: f32,
    pub(super) skew: f32,
    pub(super) across: f32,
    pub(super) half_width: f32,
    pub(super) half_height: f32,
}
