//! Eight ellipses of formula (1) at once, with their axes.

use super::{Ellipse, Footprints, LEAST_AXIS};
use crate::simd::PixelLanes;

/// Eight ellipses `A U^2 + B U V + C V^2 = F` around their middles, bounded like
/// [`Ellipse::bounded`], and the squares of their half axes. As meant: kernels in lanes do not
/// evaluate the printed F.
#[derive(Clone, Copy, Debug)]
pub struct Ellipses {
    /// `Vx^2 + Vy^2`.
    pub a: PixelLanes,
    /// `-2 (Ux Vx + Uy Vy)`.
    pub b: PixelLanes,
    /// `Ux^2 + Uy^2`.
    pub c: PixelLanes,
    /// The right side.
    pub f: PixelLanes,
    /// Square of the shorter half axis in texels.
    pub short: PixelLanes,
    /// Square of the longer half axis in texels.
    pub long: PixelLanes,
}

impl Ellipses {
    /// The ellipses of footprints in texels of a level with that many texels a repeat.
    #[inline]
    pub fn new(pixels: &Footprints, texels: [f32; 2], max_anisotropy: f32) -> Self {
        let [ux, vx] = [pixels.dx[0] * texels[0], pixels.dx[1] * texels[1]];
        let [uy, vy] = [pixels.dy[0] * texels[0], pixels.dy[1] * texels[1]];
        let root = ux * vy - uy * vx;
        let (a, b, c) = (vx * vx + vy * vy, (ux * vx + uy * vy) * -2.0, ux * ux + uy * uy);
        Self::bounded([a, b, c], root * root, max_anisotropy)
    }

    /// The ellipses in smaller texels, so many times as many a repeat along u and along v.
    #[inline]
    pub fn scaled(&self, times: f32) -> Self {
        let square = times * times;
        let Self { a, b, c, f, short, long } = *self;
        let [a, b, c, short, long] = [a, b, c, short, long].map(|lanes| lanes * square);
        Self { a, b, c, f: f * (square * square), short, long }
    }

    /// One of the ellipses.
    pub fn lane(&self, lane: usize) -> Ellipse {
        let [a, b, c, f] = [self.a, self.b, self.c, self.f].map(|lanes| lanes.as_array()[lane]);
        Ellipse { a, b, c, f }
    }

    /// The ellipses with the squares of their half axes less by `amount`, but by half at most.
    #[inline]
    pub fn sharpened(self, amount: f32) -> Self {
        // Variances add up, so what a level has blurred comes off both squares alike.
        let amount = (self.short * 0.5).fast_min(PixelLanes::splat(amount));
        let (short, long) = (self.short - amount, self.long - amount);
        Self { a: self.a - amount, b: self.b, c: self.c - amount, f: short * long, short, long }
    }

    #[inline]
    fn bounded([a, b, c]: [PixelLanes; 3], determinant: PixelLanes, max_anisotropy: f32) -> Self {
        let zero = PixelLanes::ZERO;
        let difference = a - c;
        let half = (difference * difference * 0.25 + b * b * 0.25).sqrt();
        let least = PixelLanes::splat(LEAST_AXIS * LEAST_AXIS);
        let long = ((a + c) * 0.5 + half).fast_max(least);
        // By the product of both and not by a difference, which would cancel for thin ellipses.
        let short = determinant / long;
        let lift = ((long * (1.0 / (max_anisotropy * max_anisotropy))).fast_max(least) - short)
            .fast_max(zero);
        // The square of the short axis grows along its own direction, the eigenvector of `short`; a
        // circle all around.
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
