//! Weighted sums of texels, texels in lanes.

use crate::filter::{Filtered, unpack_normals};
use crate::simd::{
    LineLanes, TexelLanes, halves, high_half, high_halves, join, join_words, low_half, low_halves, split, sum,
};
use crate::texture::Level;

/// Over two rows at a time, eight texels of each.
#[derive(Default)]
pub(super) struct PairSums<const HAS_NORMALS: bool> {
    weight: LineLanes,
    color: [LineLanes; 3],
    normal: [LineLanes; 3],
}

impl<const HAS_NORMALS: bool> PairSums<HAS_NORMALS> {
    #[inline(always)]
    pub(super) fn add(&mut self, level: &Level, runs: [usize; 2], weight: LineLanes) {
        let pair = |plane: usize| join_words(runs.map(|run| Level::run(level.words(), run + plane * level.stride())));
        let (red_green, blue_height) = (pair(0), pair(1));
        self.weight += weight;
        self.color[0] += low_halves(red_green) * weight;
        self.color[1] += high_halves(red_green) * weight;
        self.color[2] += low_halves(blue_height) * weight;
        if HAS_NORMALS {
            let normals = halves(pair(2)).map(unpack_normals);
            (0..3).for_each(|i| self.normal[i] += join(normals.map(|normal| normal[i])) * weight);
        }
    }

    /// The mean over both rows; `None` without a weight.
    #[inline(always)]
    pub(super) fn mean(&self) -> Option<Filtered> {
        let fold = |lanes: LineLanes| {
            let [a, b] = split(lanes);
            a + b
        };
        Sums { weight: fold(self.weight), color: self.color.map(fold), normal: self.normal.map(fold) }.mean(HAS_NORMALS)
    }
}

/// Over sixteen texels of a row at a time.
#[derive(Default)]
pub(super) struct LineSums<const HAS_NORMALS: bool> {
    weight: LineLanes,
    color: [LineLanes; 3],
    normal: [LineLanes; 3],
}

impl<const HAS_NORMALS: bool> LineSums<HAS_NORMALS> {
    #[inline(always)]
    pub(super) fn add(&mut self, level: &Level, start: usize, weight: LineLanes) {
        let plane = |plane: usize| Level::long_run(level.words(), start + plane * level.stride());
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

    /// The mean, if there is a weight.
    #[inline(always)]
    pub(super) fn mean(&self) -> Filtered {
        let share = 1.0 / sum_of_all(self.weight);
        let mean = |lanes: &[LineLanes; 3]| [0, 1, 2].map(|i| sum_of_all(lanes[i]) * share);
        let normal = if HAS_NORMALS { mean(&self.normal) } else { [0.0, 0.0, 1.0] };
        Filtered { color: mean(&self.color), normal }
    }
}

#[inline(always)]
fn sum_of_all(lanes: LineLanes) -> f32 {
    let [a, b] = split(lanes);
    sum(a + b)
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
