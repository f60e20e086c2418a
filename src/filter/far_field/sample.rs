//! A pixel from the tables: elliptical weighted average over the blend of four directions.
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
        let share = (across - HAND_OVER) / (HAND_OVER * (HAND_OVER_END - 1.0));
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
        // Take the place on the tables' plane, where the four agree.
        let base = near_origin(base, surface.wrap());
        let place = [0, 1].map(|i| base[i] + displacement[i] * self.plane);
        let place = surface.levels()[index].in_texels(place).map(|c| c - 0.5);
        let nearest = self.neighbours(surface.base().in_texels(displacement));
        let level = index - self.first_level;
        let images = nearest.map(|(image, share)| {
            let image = self.image(surface, image);
            (image.level(level), share * image.scale)
        });
        let color = average(&images, &ellipse, place);
        Texel { color: std::array::from_fn(|i| color[i] * UNITS[i] * FULL_F32), normal: Texel::UP }
    }
}

/// Runs that are weighed at once.
const MOST_RUNS: usize = 32;

/// `exp(-2 s)` for s within 0 to 1 by powers of s: a fit at Chebyshev's nodes, off by 0.0003.
const GAUSSIAN: [f32; 5] = [0.999_782_47, -1.988_696_7, 1.904_147_7, -1.037_488, 0.257_774_15];

/// Where a run that is not there lies: far outside any ellipse.
const NOWHERE: f32 = 1e6;

/// Runs of eight texels of a level, the same in all four images.
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

/// The Gaussian mean over the ellipse around `place` (texel centres at whole numbers) of four
/// images by their shares.
fn average(images: &[(&FarLevel, f32); 4], ellipse: &Ellipse, place: [f32; 2]) -> [f32; 3] {
    let level = images[0].0;
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
    fn add(&mut self, images: &[(&FarLevel, f32); 4], quadric: &Quadric, runs: &mut Runs) {
        if !runs.num.is_multiple_of(2) {
            runs.push(0, [NOWHERE; 2]);
        }
        let lanes = lane_indices();
        let columns = join([lanes, lanes]);
        for i in (0..runs.num).step_by(2) {
            let two = |c: usize| join([0, 1].map(|j| TexelLanes::splat(runs.left[i + j][c])));
            // Weigh sixteen texels: the weights are the same in all four images.
            let s = quadric.at(columns + two(0), two(1)).fast_max(LineLanes::ZERO);
            let [c0, c1, c2, c3, c4] = GAUSSIAN;
            let t = s.fast_min(LineLanes::ONE);
            let weight = (((t * c4 + c3) * t + c2) * t + c1) * t + c0;
            let weight = weight & s.simd_le(LineLanes::ONE);
            self.weight += weight;
            for (image, share) in images {
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
