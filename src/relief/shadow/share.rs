//! What texels take of the light on the segments beside them.
//!
//! A texel's part is interpolated along each segment beside it. Of a segment whose part `f` is lit,
//! the end next to its far texel, the tents of both texels make `1 - (1 - f)^2` and `f^2`: then the
//! mean is `f`, and the end of a shadow falls where it is, between texels.
//!
//! The lower part of a wall that rises by many texels from one to the next is lit only where the
//! light is high, and seen only from above. Who sees no more of it than its lit end must find it
//! lit, and the colour there is that of both texels, so both take nearly all of a wall's light; and
//! a wall is long, so its foot takes more from it than from the ground before it.
//!
//! ```text
//!      lit  ____i                  tents          1 - (1-f)^2   f^2
//!          |                       steep walls    min(1, 4 f)   min(1, 2 f)
//!          |     f
//!        - |
//!          |
//!  ___i-1__|
//! ```

use crate::simd::TexelLanes;

/// Least length of a segment, in texels, that is divided by.
const LEAST_SEGMENT: f32 = 1e-6;

/// The rise, in texels, from which on a segment is taken for a wall, and how much more makes it
/// half of one. Where a softer change begins at once, walls of mail lose 0.3 dB.
pub(super) const STEEP: f32 = 4.0;
const HALF_A_WALL: f32 = 12.0;

/// The part of segments between two places that lies behind a record.
#[inline(always)]
pub(super) fn lit(from: TexelLanes, to: TexelLanes, record: TexelLanes) -> TexelLanes {
    let length = (to - from).fast_max(TexelLanes::splat(LEAST_SEGMENT));
    ((to - record) / length).fast_max(TexelLanes::ZERO).fast_min(TexelLanes::ONE)
}

/// The parts of texels without walls, by those of the segments before and after them.
#[inline(always)]
pub(super) fn flat(before: TexelLanes, after: TexelLanes) -> TexelLanes {
    (before * (2.0 - before) + after * after) * 0.5
}

/// The parts of texels, each a weighted mean over segments.
#[derive(Clone, Copy, Default)]
pub(super) struct Share {
    parts: TexelLanes,
    weight: TexelLanes,
}

impl Share {
    /// Takes the far end of segments that light passes, by their lit part and their rise or fall in
    /// texels.
    #[inline(always)]
    pub(super) fn add_far(&mut self, lit: TexelLanes, rise: TexelLanes) {
        let steep = steepness(rise);
        self.add(far(lit, steep), rise * steep + 1.0);
    }

    /// The near end.
    #[inline(always)]
    pub(super) fn add_near(&mut self, lit: TexelLanes, rise: TexelLanes) {
        let steep = steepness(rise);
        self.add(near(lit, steep), rise * steep + 1.0);
    }

    /// Takes an end of walls beside the light, which weigh nothing unless they are steep, by how
    /// far the texels at both ends lie above the last light that is cut off.
    #[inline(always)]
    pub(super) fn add_wall(&mut self, own: TexelLanes, other: TexelLanes, rise: TexelLanes) {
        let steep = steepness(rise);
        let lit = lit(own.fast_min(other), own.fast_max(other), TexelLanes::ZERO);
        let part = own.simd_ge(other).select(far(lit, steep), near(lit, steep));
        self.add(part, rise * steep);
    }

    #[inline(always)]
    fn add(&mut self, part: TexelLanes, weight: TexelLanes) {
        self.parts += part * weight;
        self.weight += weight;
    }

    /// The parts.
    #[inline(always)]
    pub(super) fn mean(self) -> TexelLanes {
        self.parts / self.weight
    }
}

/// From 0, flat, to 1, a wall.
#[inline(always)]
pub(super) fn steepness(rise: TexelLanes) -> TexelLanes {
    let more = (rise - STEEP).fast_max(TexelLanes::ZERO) * (1.0 / HALF_A_WALL);
    let square = more * more;
    let fourth = square * square;
    fourth / (fourth + 1.0)
}

#[inline(always)]
fn far(lit: TexelLanes, steep: TexelLanes) -> TexelLanes {
    let tent = lit * (2.0 - lit);
    tent + ((lit * 4.0).fast_min(TexelLanes::ONE) - tent) * steep
}

#[inline(always)]
fn near(lit: TexelLanes, steep: TexelLanes) -> TexelLanes {
    let tent = lit * lit;
    tent + ((lit + lit).fast_min(TexelLanes::ONE) - tent) * steep
}
