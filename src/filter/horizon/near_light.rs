//! Points that shine on a patch: from another direction, and another distance, at each texel.
//!
//! The way from a place of the polygon to the light is linear in the place, so its length and
//! direction are right at each texel, however near the light is. A texel at depth `d` lies `d` times
//! the view ray's way down the relief from the place that it is seen over.
//!
//! Around a near light the azimuth turns within a patch: all horizons that it passes are read, and
//! each counts by how near it is. A light that is above the polygon is hidden by nothing that lies
//! farther away than it does: that would have to be higher than the polygon.

use super::fit::{Fit, Linear, azimuth};
use crate::light::{Curved, NORMAL_PLANE, NUM_AZIMUTHS, Ways};
use crate::simd::{BETWEEN_SCALE, Between, LineLanes};
use crate::texture::{FULL_F32, Rows};

/// Least square of a way, as a share of the light's of a patch's middle: a light on the surface.
const LEAST_WAY: f32 = 1e-9;

/// A height rises over this part of it: two steps of a byte, since a point has no disc.
const WIDTH: f32 = 1.0 / 128.0;

/// A point over a patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct PatchPoint {
    pub(super) intensity: [f32; 3],
    least: f32,
    /// See [`Ways`].
    to_light: [Linear; 3],
    along: [Linear; 3],
    down: [[f32; 3]; 2],
    /// The azimuth of the first horizon that is read, and how many are.
    first: f32,
    num: usize,
}

impl PatchPoint {
    /// Of one of the lights of picked pixels.
    pub(super) fn new(curved: &Curved, point: usize, picks: &[u8], fit: &Fit) -> Self {
        let at = |pick: &u8| (curved.ways(usize::from(pick / 8), point), usize::from(pick % 8));
        let of = |of: &dyn Fn(&Ways) -> crate::simd::PixelLanes| {
            fit.linear(picks.iter().map(|pick| {
                let (ways, lane) = at(pick);
                of(ways).as_array()[lane]
            }))
        };
        let share = 1.0 / picks.len() as f32;
        let down = [0, 1].map(|i| {
            [0, 1, 2].map(|c| {
                let of_pick = |pick: &u8| {
                    let (ways, lane) = at(pick);
                    ways.down[i][c].as_array()[lane]
                };
                picks.iter().map(of_pick).sum::<f32>() * share
            })
        });
        let to_light = [0, 1, 2].map(|c| of(&|ways| ways.to_light[c]));
        let along = [0, 1, 2].map(|c| of(&|ways| ways.along[c]));
        let azimuths = picks.iter().flat_map(|pick| {
            let (ways, lane) = at(pick);
            [0.0, 1.0].map(|depth| {
                let [x, y] = [0, 1].map(|c| {
                    ways.along[c].as_array()[lane] - depth * ways.down[1][c].as_array()[lane]
                });
                azimuth(x, y)
            })
        });
        let (first, num) = range(azimuths);
        let squares = to_light.iter().map(|way| way.middle * way.middle).sum::<f32>();
        let least = (squares * LEAST_WAY).max(1e-12);
        Self {
            intensity: curved.points[point].to_array(),
            least,
            to_light,
            along,
            down,
            first,
            num,
        }
    }

    /// What a white texel shows of it, by its normal, its seen place from the patch's middle and its
    /// stored height.
    #[inline(never)]
    pub(super) fn at(
        &self,
        read: (&Rows, usize, &Between),
        normal: [LineLanes; 3],
        at: [LineLanes; 3],
    ) -> [LineLanes; 3] {
        let ([x, y, z], square, lit) = self.reaching(read, at);
        let n_l = normal[0] * x + normal[1] * y + normal[2] * z;
        let falloff = n_l.fast_max(LineLanes::ZERO) / (square * square.sqrt());
        let lit = falloff * lit;
        self.intensity.map(|intensity| lit * intensity)
    }

    /// The way from texels to it, the square of its length, and whether it gets there over the relief.
    #[inline(always)]
    pub(super) fn reaching(
        &self,
        (rows, start, between): (&Rows, usize, &Between),
        [xi, p, height]: [LineLanes; 3],
    ) -> ([LineLanes; 3], LineLanes, LineLanes) {
        let depth = LineLanes::ONE - height * (1.0 / (FULL_F32 * BETWEEN_SCALE));
        let way = |of: &[Linear; 3], down: &[f32; 3], c: usize| of[c].at(xi, p) - depth * down[c];
        let [x, y, z] = [0, 1, 2].map(|c| way(&self.to_light, &self.down[0], c));
        let square = (x * x + y * y + z * z).fast_max(LineLanes::splat(self.least));
        let [u, v, up] = [0, 1, 2].map(|c| way(&self.along, &self.down[1], c));
        let length = (u * u + v * v).sqrt();
        let height = up / (up.abs() + length).fast_max(LineLanes::splat(f32::MIN_POSITIVE));
        let root = self.root((rows, start, between), [u, v]);
        let lit = (height - root * root) * (1.0 / WIDTH) + 0.5;
        ([x, y, z], square, lit.fast_max(LineLanes::ZERO).fast_min(LineLanes::ONE))
    }

    /// The root of the horizon's height towards the light.
    #[inline(always)]
    fn root(
        &self,
        (rows, start, between): (&Rows, usize, &Between),
        [u, v]: [LineLanes; 2],
    ) -> LineLanes {
        const ALL: f32 = NUM_AZIMUTHS as f32;
        let part = v / (u.abs() + v.abs()).fast_max(LineLanes::splat(f32::MIN_POSITIVE));
        let right = part.simd_lt(LineLanes::ZERO).select(part + 4.0, part);
        let angle = u.simd_lt(LineLanes::ZERO).select(-part + 2.0, right);
        let place = angle * (ALL * 0.25) - self.first;
        let place = place - (place * (1.0 / ALL)).floor() * ALL;
        // Beyond the last horizon stands the nearer end.
        let last = (self.num - 1) as f32;
        let is_before = place.simd_gt(LineLanes::splat((last + ALL) * 0.5));
        let place = is_before.select(LineLanes::ZERO, place.fast_min(LineLanes::splat(last)));
        let mut root = LineLanes::ZERO;
        for i in 0..self.num {
            let number = (self.first as usize + i) % NUM_AZIMUTHS;
            let plane = start + number / 4 * rows.stride();
            let word = between.words_at(rows.words(), plane);
            let horizon = between.bits_of(word, (number % 4 * 8) as u32, 0xff);
            let share = LineLanes::ONE - (place - i as f32).abs();
            root += horizon * share.fast_max(LineLanes::ZERO);
        }
        root * (1.0 / (255.0 * BETWEEN_SCALE))
    }
}

const _: () = assert!(NUM_AZIMUTHS.is_multiple_of(4) && NORMAL_PLANE == NUM_AZIMUTHS / 4);

/// The azimuth before some, within all the way round, and how many horizons lie from there to the
/// one after them.
fn range(azimuths: impl Iterator<Item = f32> + Clone) -> (f32, usize) {
    let all = NUM_AZIMUTHS as f32;
    let middle = azimuths.clone().next().unwrap_or_default();
    let (least, most) = azimuths.fold((0.0_f32, 0.0_f32), |(least, most), azimuth| {
        let from = azimuth - middle;
        let from = from - ((from / all) + 0.5).floor() * all;
        (least.min(from), most.max(from))
    });
    let first = (middle + least).floor() - 1.0;
    let num = ((middle + most).ceil() + 1.0 - first) as usize + 1;
    // The first one once more closes the circle.
    let num = if num > NUM_AZIMUTHS { NUM_AZIMUTHS + 1 } else { num };
    (first - (first / all).floor() * all, num)
}
