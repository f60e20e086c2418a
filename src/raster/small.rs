//! Edge functions of small triangles, as [`Edges`](super::edge::Edges) has them, in 32 bits and
//! without blocks.

use super::edge::{BLOCK, Rect, Row};
use crate::simd::i32x8;

/// Largest side of the bounding box in 1/256 pixel: 16 pixels. Products with places up to a block
/// beyond it stay below 2^26.
const MOST: i32 = 16 << 8;

/// The edge functions of a small triangle, in squares of 1/256 pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct SmallEdges {
    corners: [[i32; 2]; 3],
    /// Per row.
    step_y: [i32x8; 3],
    /// At the lanes of a row less that at the first.
    along: [i32x8; 3],
}

impl SmallEdges {
    /// Whether a triangle is small.
    #[inline(always)]
    pub(super) fn suit([a, b, c]: &[[i32; 2]; 3]) -> bool {
        (0..2).all(|i| a[i].max(b[i]).max(c[i]) - a[i].min(b[i]).min(c[i]) <= MOST)
    }

    #[inline(always)]
    pub(super) fn new(corners: &[[i32; 2]; 3]) -> Self {
        // Neighbouring pixels lie 256 apart in units of 1/256 pixel.
        let lanes = i32x8::new([0, 256, 512, 768, 1024, 1280, 1536, 1792]);
        let slopes = slopes(corners);
        Self {
            corners: *corners,
            step_y: slopes.map(|[_, b]| i32x8::splat(b << 8)),
            along: slopes.map(|[a, _]| i32x8::splat(a) * lanes),
        }
    }

    /// Calls `sink` for rows of eight pixels within `bounds`, as
    /// [`Edges::cover`](super::edge::Edges::cover) does, and for some that are not covered at all.
    #[inline(always)]
    pub(super) fn cover(&self, offsets: &[[i32; 2]], bounds: &Rect, sink: &mut impl FnMut(Row)) {
        for (sample, offset) in offsets.iter().enumerate() {
            // Columns begin on multiples of 8, where the lane vectors of the tile's buffers do.
            for x in (bounds.min[0] & -BLOCK..bounds.max[0]).step_by(BLOCK as usize) {
                // Walk down the rows: three additions each, and no products.
                let mut values = self.at([x, bounds.min[1]], *offset);
                for y in bounds.min[1]..bounds.max[1] {
                    let [a, b, c] = values;
                    // Inside, no edge function is negative.
                    sink(Row { sample, x, y, mask: !((a | b | c) >> 31_u32) });
                    values.iter_mut().zip(self.step_y).for_each(|(value, step)| *value += step);
                }
            }
        }
    }

    /// The edge functions at a sample of eight pixels from column `x` of row `y`.
    #[inline(always)]
    fn at(&self, [x, y]: [i32; 2], offset: [i32; 2]) -> [i32x8; 3] {
        let slopes = slopes(&self.corners);
        std::array::from_fn(|i| {
            let ([a, b], p) = (slopes[i], self.corners[i]);
            let owns_edge = a > 0 || (a == 0 && b > 0);
            // Differences before products: it is they that are small, so that 32 bits hold all. The
            // last term is the fill rule: 0, on an edge that is not owned, becomes negative.
            let first = a * (x * 256 + offset[0] - p[0]) + b * (y * 256 + offset[1] - p[1])
                - i32::from(!owns_edge);
            self.along[i] + i32x8::splat(first)
        })
    }
}

/// Change of each edge function by 1/256 pixel along x and y.
#[inline(always)]
fn slopes(corners: &[[i32; 2]; 3]) -> [[i32; 2]; 3] {
    [0, 1, 2].map(|i: usize| {
        let (p, q) = (corners[i], corners[(i + 1) % 3]);
        [p[1] - q[1], q[0] - p[0]]
    })
}

#[cfg(test)]
mod tests {
    use super::super::edge::Edges;
    use super::*;
    use crate::geometry::sample_offsets;

    /// Both kinds of edge functions take the same samples, whatever the triangle and where it lies.
    #[test]
    fn small_triangles_take_the_samples_of_large_ones() {
        let mut state = 1_u64;
        let mut random = |most: i32| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            ((state >> 33) % (most as u64 + 1)) as i32
        };
        let offsets = sample_offsets(8);
        let mut num_covered = 0;
        for case in 0..3000 {
            // Also many with corners on samples and with edges along the axes.
            let unit = [1, 16, 128][case % 3];
            let origin = [random(8_000_000) & -256, random(8_000_000) & -256];
            let size = random(MOST / unit);
            let mut corner = || [0, 1].map(|i| origin[i] + random(size) * unit);
            let [a, b, c] = [corner(), corner(), corner()];
            let area = i64::from(b[0] - a[0]) * i64::from(c[1] - a[1])
                - i64::from(b[1] - a[1]) * i64::from(c[0] - a[0]);
            let corners = if area < 0 { [a, c, b] } else { [a, b, c] };
            if area == 0 || !SmallEdges::suit(&corners) {
                continue;
            }
            let min = origin.map(|c| (c >> 8) & -BLOCK);
            let rect = Rect { min, max: min.map(|c| c + 32) };
            let mut expected = std::collections::BTreeMap::new();
            Edges::<8>::new(&corners, offsets).cover(&rect, &mut |row| {
                expected.insert((row.sample, row.x, row.y), row.mask.to_array());
            });
            SmallEdges::new(&corners).cover(offsets, &rect, &mut |Row { sample, x, y, mask }| {
                let found = mask.to_array();
                assert_eq!(
                    found,
                    expected.get(&(sample, x, y)).copied().unwrap_or_default(),
                    "{corners:?}"
                );
                num_covered += found.iter().filter(|lane| **lane != 0).count();
            });
        }
        assert!(num_covered > 100_000, "only {num_covered} samples");
    }
}
