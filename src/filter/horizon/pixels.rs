//! What a sweep must know of its pixels, eight in the lanes of a vector.

use crate::filter::footprint::{Differences, Footprint, bounded_place};
use crate::simd::PixelLanes;

/// Least half axis in texels: what a magnified pixel covers is that much at least, so that no division overflows.
const LEAST_AXIS: f32 = 1.0 / 256.0;

/// Places, derivatives and displacements of eight pixels, in texture repeats.
#[derive(Clone, Copy, Debug)]
pub struct PixelFootprints {
    /// Base coordinates `(u, v)` of the middles.
    pub center: [PixelLanes; 2],
    /// `(du/dx, dv/dx)`.
    pub dx: [PixelLanes; 2],
    /// `(du/dy, dv/dy)`.
    pub dy: [PixelLanes; 2],
    /// How far the view ray moves along the texture down to the deepest relief.
    pub displacement: [PixelLanes; 2],
}

impl PixelFootprints {
    /// One pixel in all lanes.
    #[must_use]
    pub fn splat(footprint: &Footprint, displacement: [f32; 2]) -> Self {
        let Footprint { center, dx, dy } = *footprint;
        let [center, dx, dy, displacement] = [center, dx, dy, displacement].map(|pair| pair.map(PixelLanes::splat));
        Self { center, dx, dy, displacement }
    }

    /// The pixels around `center` with the given derivatives, which are shortened to 16 repeats.
    #[must_use]
    pub fn new(center: &[PixelLanes; 2], differences: &Differences, displacement: [PixelLanes; 2]) -> Self {
        let Differences { dx, dy } = differences.shortened();
        Self { center: bounded_place(*center), dx, dy, displacement }
    }

    /// One of the pixels.
    #[must_use]
    pub fn footprint(&self, lane: usize) -> Footprint {
        let at = |lanes: [PixelLanes; 2]| lanes.map(|lanes| lanes.as_array()[lane]);
        Footprint { center: at(self.center), dx: at(self.dx), dy: at(self.dy) }
    }

    /// Full shorter axes of the ellipses in texels of a level with that many texels a repeat.
    pub(in crate::filter) fn width(&self, texels: [f32; 2], max_anisotropy: f32) -> PixelLanes {
        self.conics(texels, max_anisotropy).short.sqrt() * 2.0
    }

    /// The ellipses in texels of a level with that many texels a repeat.
    #[inline]
    pub(in crate::filter) fn conics(&self, texels: [f32; 2], max_anisotropy: f32) -> Conics {
        let [ux, vx] = [self.dx[0] * texels[0], self.dx[1] * texels[1]];
        let [uy, vy] = [self.dy[0] * texels[0], self.dy[1] * texels[1]];
        let root = ux * vy - uy * vx;
        let (a, b, c) = (vx * vx + vy * vy, (ux * vx + uy * vy) * -2.0, ux * ux + uy * uy);
        Conics::bounded(a, b, c, root * root, max_anisotropy)
    }
}

/// Eight ellipses `A U^2 + B U V + C V^2 = F` around their middles, bounded like [`Ellipse::bounded`], and the squares of
/// their half axes.
///
/// [`Ellipse::bounded`]: crate::filter::Ellipse::bounded
#[derive(Clone, Copy, Debug)]
pub(in crate::filter) struct Conics {
    pub(in crate::filter) a: PixelLanes,
    pub(in crate::filter) b: PixelLanes,
    pub(in crate::filter) c: PixelLanes,
    pub(in crate::filter) f: PixelLanes,
    pub(in crate::filter) short: PixelLanes,
    pub(in crate::filter) long: PixelLanes,
}

impl Conics {
    /// The ellipses with the squares of their half axes less by `amount`, but by half at most.
    #[inline]
    pub(super) fn sharpened(self, amount: f32) -> Self {
        let amount = (self.short * 0.5).fast_min(PixelLanes::splat(amount));
        let (short, long) = (self.short - amount, self.long - amount);
        Self { a: self.a - amount, b: self.b, c: self.c - amount, f: short * long, short, long }
    }

    #[inline]
    fn bounded(a: PixelLanes, b: PixelLanes, c: PixelLanes, determinant: PixelLanes, max_anisotropy: f32) -> Self {
        let zero = PixelLanes::ZERO;
        let difference = a - c;
        let half = (difference * difference * 0.25 + b * b * 0.25).sqrt();
        let least = PixelLanes::splat(LEAST_AXIS * LEAST_AXIS);
        let long = ((a + c) * 0.5 + half).fast_max(least);
        let short = determinant / long;
        let lift = ((long * (1.0 / (max_anisotropy * max_anisotropy))).fast_max(least) - short).fast_max(zero);
        // The square of the short axis grows along its own direction, the eigenvector of `short`; a circle all around.
        let gap = long - short;
        let is_long = gap.simd_gt(long * 1e-6);
        let share = lift / is_long.select(gap, PixelLanes::ONE);
        Self {
            a: a + is_long.select(share * (long - a).fast_max(zero), lift),
            b: b - is_long.select(share * b, zero),
            c: c + is_long.select(share * (long - c).fast_max(zero), lift),
            f: long * (short + lift),
            short: short + lift,
            long,
        }
    }
}
