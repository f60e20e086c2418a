//! The mean of a set of texels.

use super::texel_set::TexelSet;
use crate::footprint::{Ellipse, RowQuadric};
use crate::simd::{TexelLanes, bits_mask, exp_negative, high_half, lane_columns, low_half, sum};
use crate::texture::{Level, Rows, Texel, unpack_normals};

/// The weighted mean of the texels of `set` in the ellipse around `center` (in texels); `None` for
/// an empty set.
pub fn average(
    level: &Level,
    set: &TexelSet,
    ellipse: &Ellipse,
    center: [f32; 2],
) -> Option<Texel> {
    let [x0, y0] = center.map(|c| c - 0.5);
    let rows = level.rows(false);
    let mut sums = Sums::default();
    for row in &set.rows {
        let quadric = RowQuadric::new(ellipse, row.y as f32 - y0);
        let start = rows.row_start(row.y);
        let [first, num] = row.batches;
        for (i, &bits) in set.bits[first..first + num].iter().enumerate() {
            if bits != 0 {
                let x = row.x + 8 * i as i32;
                // Texels outside share a batch with those inside: bring their r^2 to where the
                // exponential holds, and mask their weights.
                let r2 = quadric
                    .at(lane_columns(x) - x0)
                    .fast_max(TexelLanes::ZERO)
                    .fast_min(TexelLanes::ONE);
                sums.add(rows, start + rows.run_start(x), exp_negative(r2 + r2) & bits_mask(bits));
            }
        }
    }
    sums.mean(level.has_normals())
}

/// Eight texels at a time.
#[derive(Default)]
struct Sums {
    weight: TexelLanes,
    color: [TexelLanes; 3],
    normal: [TexelLanes; 3],
}

impl Sums {
    #[inline(always)]
    fn add(&mut self, rows: &Rows, start: usize, weight: TexelLanes) {
        let words = rows.words();
        let red_green = Rows::run(words, start);
        let blue_height = Rows::run(words, start + rows.stride());
        self.weight += weight;
        self.color[0] += low_half(red_green) * weight;
        self.color[1] += high_half(red_green) * weight;
        self.color[2] += low_half(blue_height) * weight;
        if rows.has_normals() {
            let normal = unpack_normals(Rows::run(words, start + 2 * rows.stride()));
            (0..3).for_each(|i| self.normal[i] += normal[i] * weight);
        }
    }

    /// `None` without a weight.
    #[inline(always)]
    fn mean(&self, has_normals: bool) -> Option<Texel> {
        let weight = sum(self.weight);
        let mean = |lanes: [TexelLanes; 3]| lanes.map(|lanes| sum(lanes) / weight);
        let normal = if has_normals { mean(self.normal) } else { Texel::UP };
        (weight > 0.0).then(|| Texel { color: mean(self.color), normal })
    }
}
