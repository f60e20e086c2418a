//! Weighted sums of texels, texels in lanes.

use crate::filter::{Filtered, unpack_normals};
use crate::simd::{
    LineLanes, TexelLanes, halves, high_half, high_halves, join, join_words, low_half, low_halves, split, sum, sums,
    u32x16,
};
use crate::texture::Level;

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
    pub(super) fn add_run(&mut self, level: &Level, start: usize, weight: LineLanes) {
        let (stride, num_planes) = (level.stride(), if HAS_NORMALS { 3 } else { 2 });
        // One check for all planes.
        let words = &level.words()[start..][..(num_planes - 1) * stride + 16];
        self.add(|plane| Level::long_run(words, plane * stride), weight);
    }

    /// Adds eight texels of each of two rows.
    #[inline(always)]
    pub(super) fn add_runs(&mut self, level: &Level, starts: [usize; 2], weight: LineLanes) {
        let run = |plane: usize, start: usize| Level::run(level.words(), start + plane * level.stride());
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
    pub(super) fn mean(&self) -> Option<Filtered> {
        let sums_of = |[x, y, z]: [LineLanes; 3]| {
            let of_halves = [self.weight, x, y, z].map(split).map(|[a, b]| a + b);
            let [weight, x, y, z] = sums(of_halves);
            (weight, [x, y, z])
        };
        let (weight, color) = sums_of(self.color);
        let share = 1.0 / weight;
        let mean = |sums: [f32; 3]| sums.map(|sum| sum * share);
        let normal = if HAS_NORMALS { mean(sums_of(self.normal).1) } else { [0.0, 0.0, 1.0] };
        (weight > 0.0).then(|| Filtered { color: mean(color), normal })
    }
}

/// Eight texels at a time.
#[derive(Default)]
pub(super) struct Sums {
    weight: TexelLanes,
    color: [TexelLanes; 3],
    normal: [TexelLanes; 3],
}

impl Sums {
    #[inline(always)]
    pub(super) fn add(&mut self, level: &Level, start: usize, weight: TexelLanes) {
        let words = level.words();
        let red_green = Level::run(words, start);
        let blue_height = Level::run(words, start + level.stride());
        self.weight += weight;
        self.color[0] += low_half(red_green) * weight;
        self.color[1] += high_half(red_green) * weight;
        self.color[2] += low_half(blue_height) * weight;
        if level.has_normals() {
            let normal = unpack_normals(Level::run(words, start + 2 * level.stride()));
            (0..3).for_each(|i| self.normal[i] += normal[i] * weight);
        }
    }

    /// `None` without a weight.
    #[inline(always)]
    pub(super) fn mean(&self, has_normals: bool) -> Option<Filtered> {
        let weight = sum(self.weight);
        let mean = |lanes: [TexelLanes; 3]| lanes.map(|lanes| sum(lanes) / weight);
        let normal = if has_normals { mean(self.normal) } else { [0.0, 0.0, 1.0] };
        (weight > 0.0).then(|| Filtered { color: mean(self.color), normal })
    }
}
