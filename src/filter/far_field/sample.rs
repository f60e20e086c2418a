//! A pixel from the tables: elliptical weighted average over the blend of the nearest directions.
//!
//! ```text
//!     row    . . .[# # * * * * * #]. .
//!            . . . .[# * * * * * # #].        * texels in the ellipse
//!            . . . .[* * * * * # # #].        # others of the runs of eight that hold it
//! ```
//!
//! Two runs at a time are the sixteen lanes, whatever rows they lie in: most ellipses are thin, and
//! one run a row holds them.

use super::encode::{FarLevel, RUN, UNITS, decode};
use super::tables::FarField;
use crate::footprint::levels::{for_tables, rows_in_excess};
use crate::footprint::{Ellipse, Ellipses, Footprint, Footprints};
use crate::settings::Horizon;
use crate::simd::{
    LineLanes, PixelLanes, TexelLanes, join, join_words, lane_indices, line_indices, split, sum,
};
use crate::texture::{FULL_F32, Surface, Texel, near_origin};

/// Texels of the finest table across a footprint where the tables begin to count. Measured, 400x225,
/// dB of the wall, the torus and a tiled facade: 3.8 gives 48.0 41.2 50.2, 4.2 gives 48.8 42.1 49.7,
/// 5.0 gives 49.3 41.4 46.4: sweeps then run into the bound on their rows.
const HAND_OVER: f32 = 4.2;

/// The same of highlights, which are rougher: metal of roughness 0.3 on the floor has 39.5 dB with 4.2, 39.8
/// with 5, 40.1 with 6 in 1.3 of the time, and 38.7 with 8.
const HAND_OVER_OF_HIGHLIGHTS: f32 = 6.0;

/// Times as many where nothing but the tables counts.
const HAND_OVER_END: f32 = 4.0 / 3.0;

impl FarField {
    /// How much of the colour of eight pixels the tables give, 0 to 1: all of it where a footprint
    /// is large.
    pub(in crate::filter) fn shares(
        &self,
        surface: &Surface,
        (pixels, base): (&Footprints, &Ellipses),
        horizon: &Horizon,
    ) -> PixelLanes {
        let texels = surface.levels()[self.first_level].texels_per_repeat();
        let across = Ellipses::new(pixels, texels, horizon.max_anisotropy).short.sqrt() * 2.0;
        // Where sweeps would be too long and take a coarser level, tables begin earlier, by the
        // square of it: on a tiled facade at 1280x720 45.7 dB without the square, 37.0 without all.
        let excess = rows_in_excess(surface, pixels, base, horizon).fast_max(PixelLanes::ONE);
        let across = across * excess * excess;
        let begin = if self.is_bent { HAND_OVER_OF_HIGHLIGHTS } else { HAND_OVER };
        let share = (across - begin) / (begin * (HAND_OVER_END - 1.0));
        share.fast_max(PixelLanes::ZERO).fast_min(PixelLanes::ONE)
    }

    /// The mean of what is seen in a footprint around its base place.
    pub(in crate::filter) fn mean(
        &self,
        surface: &Surface,
        footprint: &Footprint,
        max_anisotropy: f32,
    ) -> Texel {
        let Footprint { base, displacement, .. } = *footprint;
        let (index, ellipse) = for_tables(surface, self.first_level, footprint, max_anisotropy);
        // Take the place on the tables' plane, where tables agree.
        let base = near_origin(base, surface.wrap());
        let place = [0, 1].map(|i| base[i] + displacement[i] * self.plane);
        let place = surface.levels()[index].in_texels(place).map(|c| c - 0.5);
        let displacement = surface.base().in_texels(displacement);
        let level = index - self.first_level;
        let color = if self.is_bent {
            let nearest = self.neighbours(displacement, cubic);
            average(&self.images(surface, level, nearest), &ellipse, place)
        } else {
            let nearest = self.neighbours(displacement, straight);
            average(&self.images(surface, level, nearest), &ellipse, place)
        };
        // Shares of a curve may be less than none.
        let color = std::array::from_fn(|i| (color[i] * UNITS[i] * FULL_F32).max(0.0));
        Texel { color, normal: Texel::UP }
    }

    /// A level of tables, and their shares.
    fn images<const N: usize>(
        &self,
        surface: &Surface,
        level: usize,
        tables: [[(usize, f32); N]; 2],
    ) -> Images<'_, N> {
        tables.map(|of_length| {
            of_length.map(|(index, share)| {
                let image = self.image(surface, index);
                (image.level(level), share * image.scale)
            })
        })
    }
}

/// The same level of tables of two lengths, and their shares.
type Images<'a, const N: usize> = [[(&'a FarLevel, f32); N]; 2];

/// The shares of two points at a part of the way between them.
fn straight(t: f32) -> [f32; 2] {
    [1.0 - t, t]
}

/// The shares of four points in a row at a part of the way between the middle ones (Catmull and Rom 1974).
fn cubic(t: f32) -> [f32; 4] {
    let s = 1.0 - t;
    let [before, after] = [t * s * s, t * t * s].map(|c| c * 0.5);
    [-before, s + 2.0 * before - after, t + 2.0 * after - before, -after]
}

/// Runs that are weighed at once.
const MOST_RUNS: usize = 32;

/// `exp(-2 s)` for s within 0 to 1 by powers of s: a fit at Chebyshev's nodes, off by 0.0003.
const GAUSSIAN: [f32; 5] = [0.999_782_47, -1.988_696_7, 1.904_147_7, -1.037_488, 0.257_774_15];

/// Where a run that is not there lies: far outside any ellipse.
const NOWHERE: f32 = 1e6;

/// Runs of eight texels of a level, the same in all images.
struct Runs {
    num: usize,
    /// Where they start among the level's words.
    starts: [usize; MOST_RUNS],
    /// Their first texels, from the middle of the ellipse.
    left: [[f32; 2]; MOST_RUNS],
}

impl Runs {
    fn push(&mut self, start: usize, left: [f32; 2]) {
        (self.starts[self.num], self.left[self.num]) = (start, left);
        self.num += 1;
    }
}

/// The Gaussian mean over the ellipse around `place` (texel centres at whole numbers) of images by
/// their shares.
fn average<const N: usize>(images: &Images<'_, N>, ellipse: &Ellipse, place: [f32; 2]) -> [f32; 3] {
    let level = images[0][0].0;
    let half_height = ellipse.half_height();
    let [first, last] = [(place[1] - half_height).ceil(), (place[1] + half_height).floor()];
    let (mut runs, mut sums) =
        (Runs { num: 0, starts: [0; MOST_RUNS], left: [[0.0; 2]; MOST_RUNS] }, Sums::default());
    let quadric = Quadric::new(ellipse);
    let mut y = first as i32;
    while y <= last as i32 {
        // Find where sixteen rows enter and leave the ellipse.
        let v = line_indices() + (y as f32 - place[1]);
        let (left, num_more) = quadric.columns(v, place[0]);
        for row in 0..16 {
            // Most rows take one run.
            let mut more = num_more[row];
            let mut x = left[row];
            while more >= 0 {
                if runs.num == MOST_RUNS {
                    sums.add(images, &quadric, &mut runs);
                }
                runs.push(
                    level.start_at(x, y + row as i32),
                    [x as f32 - place[0], v.as_array()[row]],
                );
                (x, more) = (x + RUN as i32, more - RUN as i32);
            }
        }
        y += 16;
    }
    sums.add(images, &quadric, &mut runs);
    sums.mean()
}

/// `r^2 = (a u + b v) u + c v^2` around the middle of an ellipse.
struct Quadric {
    a: f32,
    b: f32,
    c: f32,
    /// 1 over a.
    inverse_a: f32,
}

impl Quadric {
    fn new(ellipse: &Ellipse) -> Self {
        let inverse = 1.0 / ellipse.f;
        let [a, b, c] = [ellipse.a, ellipse.b, ellipse.c].map(|c| c * inverse);
        Self { a, b, c, inverse_a: 1.0 / a }
    }

    /// The first column inside in each of sixteen rows around a middle, and how many more there
    /// are; less than none where the row misses.
    #[inline(always)]
    fn columns(&self, v: LineLanes, middle: f32) -> ([i32; 16], [i32; 16]) {
        // Solve a u^2 + b v u + c v^2 - 1 = 0 for u.
        let half_b = v * (self.b * 0.5);
        let discriminant = half_b * half_b - (v * v * self.c - 1.0) * self.a;
        let root = discriminant.fast_max(LineLanes::ZERO).sqrt() * self.inverse_a;
        let center = LineLanes::splat(middle) - half_b * self.inverse_a;
        let [left, right] = [(center - root).ceil(), (center + root).floor()];
        let misses = discriminant.simd_lt(LineLanes::ZERO);
        let num_more = misses.select(LineLanes::splat(-1.0), right - left);
        (left.fast_trunc_int().to_array(), num_more.fast_trunc_int().to_array())
    }

    #[inline(always)]
    fn at(&self, u: LineLanes, v: LineLanes) -> LineLanes {
        (u * self.a + v * self.b) * u + v * v * self.c
    }
}

/// Weighted sums.
#[derive(Default)]
struct Sums {
    weight: LineLanes,
    color: [LineLanes; 3],
}

impl Sums {
    /// Adds the texels of runs, and empties them.
    #[inline(always)]
    fn add<const N: usize>(&mut self, images: &Images<'_, N>, quadric: &Quadric, runs: &mut Runs) {
        if !runs.num.is_multiple_of(2) {
            runs.push(0, [NOWHERE; 2]);
        }
        let lanes = lane_indices();
        let columns = join([lanes, lanes]);
        for i in (0..runs.num).step_by(2) {
            let two = |c: usize| join([0, 1].map(|j| TexelLanes::splat(runs.left[i + j][c])));
            // Weigh sixteen texels: the weights are the same in all images.
            let s = quadric.at(columns + two(0), two(1)).fast_max(LineLanes::ZERO);
            let [c0, c1, c2, c3, c4] = GAUSSIAN;
            let t = s.fast_min(LineLanes::ONE);
            let weight = (((t * c4 + c3) * t + c2) * t + c1) * t + c0;
            let weight = weight & s.simd_le(LineLanes::ONE);
            self.weight += weight;
            for (image, share) in images.iter().flatten() {
                let texel = decode(join_words([0, 1].map(|j| image.run(runs.starts[i + j]))));
                let weight = weight * *share;
                (0..3).for_each(|c| self.color[c] += texel[c] * weight);
            }
        }
        runs.num = 0;
    }

    fn mean(&self) -> [f32; 3] {
        // Sum the lanes in one fixed order, for the same bytes on every machine.
        let total = |lanes: LineLanes| {
            let [a, b] = split(lanes);
            sum(a + b)
        };
        let weight = total(self.weight).max(f32::MIN_POSITIVE);
        self.color.map(|lanes| total(lanes) / weight)
    }
}
