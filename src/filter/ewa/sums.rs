//! Weighted sums of texels, texels in lanes.

use crate::simd::{
    LineLanes, halves, high_halves, join, join_words, low_halves, split, sums, u32x16,
};
use crate::texture::{Rows, Texel, unpack_normals};

/// Sixteen texels at a time: of a row, or eight of each of two.
#[derive(Default)]
pub(super) struct WideSums<const HAS_NORMALS: bool> {
    weight: LineLanes,
    color: [LineLanes; 3],
    normal: [LineLanes; 3],
}

impl<const HAS_NORMALS: bool> WideSums<HAS_NORMALS> {
    /// Adds sixteen texels of a row, from `start`.
    #[inline(always)]
    pub(super) fn add_run(&mut self, rows: &Rows, start: usize, weight: LineLanes) {
        let (stride, num_planes) = (rows.stride(), if HAS_NORMALS { 3 } else { 2 });
        // One check for all planes.
        let words = &rows.words()[start..][..(num_planes - 1) * stride + 16];
        self.add(|plane| Rows::long_run(words, plane * stride), weight);
    }

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

    /// The mean; `None` without a weight.
    #[inline(always)]
    pub(super) fn mean(&self) -> Option<Texel> {
        let sums_of = |[x, y, z]: [LineLanes; 3]| {
            // Add the halves, then the lanes, in one fixed order: every machine rounds alike.
            let of_halves = [self.weight, x, y, z].map(split).map(|[a, b]| a + b);
            let [weight, x, y, z] = sums(of_halves);
            (weight, [x, y, z])
        };
        let (weight, color) = sums_of(self.color);
        let share = 1.0 / weight;
        let mean = |sums: [f32; 3]| sums.map(|sum| sum * share);
        let normal = if HAS_NORMALS { mean(sums_of(self.normal).1) } else { Texel::UP };
        (weight > 0.0).then(|| Texel { color: mean(color), normal })
    }
}
