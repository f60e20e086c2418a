//! Weighted sums of texels, texels in lanes.

use crate::simd::{
    LineLanes, as_pairs, as_unsigned_words, halves, high_halves, i16x32, i32x16, join, join_words,
    low_halves, split, sums, u32x16,
};
use crate::texture::{Rows, Texel, unpack_normals};

/// Sixteen texels at a time.
#[derive(Default)]
pub(super) struct WideSums<const HAS_NORMALS: bool> {
    weight: LineLanes,
    color: [LineLanes; 3],
    normal: [LineLanes; 3],
}

impl<const HAS_NORMALS: bool> WideSums<HAS_NORMALS> {
    /// Adds eight texels of each of two rows.
    #[inline(always)]
    pub(super) fn add_runs(&mut self, rows: &Rows, starts: [usize; 2], weight: LineLanes) {
        let run =
            |plane: usize, start: usize| Rows::run(rows.words(), start + plane * rows.stride());
        self.add(|plane| join_words([run(plane, starts[0]), run(plane, starts[1])]), weight);
    }

    #[inline(always)]
    fn add(&mut self, plane: impl Fn(usize) -> u32x16, weight: LineLanes) {
        let (red_green, blue_height) = (plane(0), plane(1));
        self.weight += weight;
        self.color[0] += low_halves(red_green) * weight;
        self.color[1] += high_halves(red_green) * weight;
        self.color[2] += low_halves(blue_height) * weight;
        if HAS_NORMALS {
            let normals = halves(plane(2)).map(unpack_normals);
            (0..3).for_each(|i| self.normal[i] += join(normals.map(|normal| normal[i])) * weight);
        }
    }

    /// Adds what was summed in whole numbers.
    #[inline(always)]
    pub(super) fn add_block(&mut self, block: &PairSums<HAS_NORMALS>) {
        // Both halves of a word, each once.
        let weight = block.weight.dot(as_pairs(u32x16::splat(0x0001_0001)));
        self.weight += LineLanes::from_i32x16(weight);
        for i in 0..3 {
            self.color[i] += LineLanes::from_i32x16(block.color[i]);
            if HAS_NORMALS {
                self.normal[i] += block.normal[i];
            }
        }
    }

    /// Weights, and weighted red, green and blue.
    #[inline(always)]
    pub(super) fn colors(&self) -> [LineLanes; 4] {
        [self.weight, self.color[0], self.color[1], self.color[2]]
    }

    /// Weights, and weighted normals.
    #[inline(always)]
    pub(super) fn normals(&self) -> [LineLanes; 4] {
        [self.weight, self.normal[0], self.normal[1], self.normal[2]]
    }

    /// The mean; `None` without a weight.
    #[inline(always)]
    pub(super) fn mean(&self) -> Option<Texel> {
        // Add the halves, then the lanes, in one fixed order: every machine rounds alike.
        let totals = |lanes: [LineLanes; 4]| sums(lanes.map(split).map(|[a, b]| a + b));
        let [weight, color @ ..] = totals(self.colors());
        let share = 1.0 / weight;
        let mean = |sums: [f32; 3]| sums.map(|sum| sum * share);
        let normal = if HAS_NORMALS {
            let [_, normal @ ..] = totals(self.normals());
            mean(normal)
        } else {
            Texel::UP
        };
        (weight > 0.0).then(|| Texel { color: mean(color), normal })
    }
}

/// What a weight of 1 is in whole numbers: with a profile of up to 1.002 within 32767.
pub(super) const WEIGHT_SCALE: f32 = 32700.0;

/// Sums in whole numbers over two rows of sixteen texels at a time: a product of pairs adds both.
///
/// All weights of a column together are at most 1.2, and texels are below 32768: no sum overflows.
#[derive(Default)]
pub(super) struct PairSums<const HAS_NORMALS: bool> {
    /// Of the upper rows in the lower halves of words, of the lower ones in the upper halves.
    weight: i16x32,
    color: [i32x16; 3],
    normal: [LineLanes; 3],
}

impl<const HAS_NORMALS: bool> PairSums<HAS_NORMALS> {
    /// Adds sixteen texels of each of two rows, by weights in units of 1 / [`WEIGHT_SCALE`].
    #[inline(always)]
    pub(super) fn add_rows(&mut self, rows: &Rows, starts: [usize; 2], weights: [LineLanes; 2]) {
        let (stride, num_planes) = (rows.stride(), if HAS_NORMALS { 3 } else { 2 });
        // One check for all planes of a row.
        let words = |start: usize| &rows.words()[start..][..(num_planes - 1) * stride + 16];
        let (above, below) = (words(starts[0]), words(starts[1]));
        let [near, far] = weights.map(|weight| as_unsigned_words(weight.fast_trunc_int()));
        let weight = as_pairs(near | far << 16_u32);
        self.weight += weight;
        let [low, high] = [0xffff, 0xffff_0000].map(u32x16::splat);
        let (a, b) = (Rows::long_run(above, 0), Rows::long_run(below, 0));
        let (c, d) = (Rows::long_run(above, stride), Rows::long_run(below, stride));
        self.color[0] += as_pairs(a & low | b << 16_u32).dot(weight);
        self.color[1] += as_pairs(a >> 16_u32 | b & high).dot(weight);
        self.color[2] += as_pairs(c & low | d << 16_u32).dot(weight);
        if HAS_NORMALS {
            self.add_normals(Rows::long_run(above, 2 * stride), near);
            self.add_normals(Rows::long_run(below, 2 * stride), far);
        }
    }

    #[inline(always)]
    fn add_normals(&mut self, packed: u32x16, weight: u32x16) {
        let weight = low_halves(weight);
        let normals = halves(packed).map(unpack_normals);
        (0..3).for_each(|i| self.normal[i] += join(normals.map(|normal| normal[i])) * weight);
    }
}
