//! Elliptical weighted average (Heckbert 1989): the mean of a set of texels with the weight `exp(-2 r^2)`, a Gaussian
//! over the disc of radius one pixel, `r^2 = (A U^2 + B U V + C V^2) / F <= 1`.

use super::texel_set::{RowQuadric, lane_columns};
use super::{Ellipse, Filtered, TexelSet};
use crate::simd::{TexelLanes, exp_negative, high_half, low_half, sum};
use crate::texture::Level;

/// The weighted mean of the texels of `set` in the ellipse around `center` (in texels); `None` for an empty set.
#[must_use]
pub fn average(level: &Level, set: &TexelSet, ellipse: &Ellipse, center: [f32; 2]) -> Option<Filtered> {
    let [x0, y0] = center.map(|c| c - 0.5);
    let mut sums = Sums::default();
    for row in &set.rows {
        let quadric = RowQuadric::new(ellipse, row.y as f32 - y0);
        let words = level.row(row.y);
        let [first, num] = row.batches;
        for (i, &bits) in set.bits[first..first + num].iter().enumerate() {
            if bits != 0 {
                let x = row.x + 8 * i as i32;
                let r2 = quadric.at(lane_columns(x) - x0).fast_max(TexelLanes::ZERO).fast_min(TexelLanes::ONE);
                sums.add(level, words, level.run_start(x), exp_negative(r2 + r2) & lane_mask(bits));
            }
        }
    }
    sums.mean(level.has_normals())
}

/// All bits of the lanes whose bit is set.
fn lane_mask(bits: u8) -> TexelLanes {
    TexelLanes::new(std::array::from_fn(|lane| f32::from_bits(if bits >> lane & 1 == 1 { u32::MAX } else { 0 })))
}

/// Weighted sums, texels in lanes.
#[derive(Default)]
struct Sums {
    weight: TexelLanes,
    color: [TexelLanes; 3],
    normal: [TexelLanes; 3],
}

impl Sums {
    fn add(&mut self, level: &Level, words: &[u32], start: usize, weight: TexelLanes) {
        let red_green = Level::run(words, start);
        let blue_height = Level::run(words, start + level.stride());
        self.weight += weight;
        self.color[0] += low_half(red_green) * weight;
        self.color[1] += high_half(red_green) * weight;
        self.color[2] += low_half(blue_height) * weight;
        if level.has_normals() {
            let normal = super::unpack_normals(Level::run(words, start + 2 * level.stride()));
            (0..3).for_each(|i| self.normal[i] += normal[i] * weight);
        }
    }

    fn mean(&self, has_normals: bool) -> Option<Filtered> {
        let weight = sum(self.weight);
        let mean = |lanes: [TexelLanes; 3]| lanes.map(|lanes| sum(lanes) / weight);
        let normal = if has_normals { mean(self.normal) } else { [0.0, 0.0, 1.0] };
        (weight > 0.0).then(|| Filtered { color: mean(self.color), normal })
    }
}
