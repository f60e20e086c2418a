//! Coverage of one triangle by edge functions, in whole numbers: exact, and each sample of a mesh
//! belongs to one triangle.
//!
//! For an edge from `p` to `q`, `E(x, y) = a x + b y + c` with `a = p.y - q.y`, `b = q.x - p.x`
//! (1/256 pixel) is positive inside. A sample on an edge belongs to the triangle if the edge is a
//! left one (`a > 0`) or a top one (`a = 0, b > 0`); other edges take 1 off `c`, so that inside is
//! `E >= 0` (the top-left fill rule).
//!
//! At samples, `x = 256 column + offset`, so that `E = 256 (a column + b row) + e`, and
//! `floor(E / 256) = a column + b row + floor(e / 256)` has the same sign. That quotient fits 32
//! bits wherever an edge crosses a block of 8x8 pixels: `|a|, |b| < 2^26`, and within the block it
//! varies by at most `14 * 2^26`. Blocks that an edge does not cross are decided by their corners in
//! 64 bits.

use crate::simd::i32x8;

/// Side of a block in pixels: one row is eight lanes.
pub const BLOCK: i32 = 8;

/// A rectangle of pixels: first column and row, and one past the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// First column and row.
    pub min: [i32; 2],
    /// One past the last column and row.
    pub max: [i32; 2],
}

impl Rect {
    /// Columns and rows.
    #[inline]
    pub fn size(&self) -> [i32; 2] {
        [self.max[0] - self.min[0], self.max[1] - self.min[1]]
    }
}

/// Eight pixels of a row as one sample of each sees the triangle.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Index of the sample.
    pub sample: usize,
    /// Column of the first pixel, a multiple of 8.
    pub x: i32,
    /// Row of the pixels.
    pub y: i32,
    /// All bits set where the sample is covered.
    pub mask: i32x8,
}

/// The edge functions of a triangle, per pixel, for `S` samples.
#[derive(Clone, Copy, Debug)]
pub struct Edges<const S: usize> {
    a: [i32; 3],
    b: [i32; 3],
    /// `floor(e / 256)` at column 0, row 0.
    c: [[i64; 3]; S],
}

impl<const S: usize> Edges<S> {
    /// The edge functions of a triangle of positive area (corners in 1/256 pixel).
    #[inline]
    pub fn new(corners: &[[i32; 2]; 3], offsets: &[[i32; 2]]) -> Self {
        let mut edges = Self { a: [0; 3], b: [0; 3], c: [[0; 3]; S] };
        for i in 0..3 {
            let (p, q) = (corners[i], corners[(i + 1) % 3]);
            let (a, b) = (p[1] - q[1], q[0] - p[0]);
            let owns_edge = a > 0 || (a == 0 && b > 0);
            // A product of place and slope passes 32 bits; `E / 256` at column 0, row 0 may, too.
            let [a_wide, b_wide] = [i64::from(a), i64::from(b)];
            let c = -(a_wide * i64::from(p[0]) + b_wide * i64::from(p[1])) - i64::from(!owns_edge);
            (edges.a[i], edges.b[i]) = (a, b);
            for (of_sample, offset) in edges.c.iter_mut().zip(offsets) {
                // The shift rounds down on both sides of 0, so that the sign is kept.
                of_sample[i] =
                    (a_wide * i64::from(offset[0]) + b_wide * i64::from(offset[1]) + c) >> 8;
            }
        }
        edges
    }

    /// Whether no sample of the rectangle is inside; may say no where that is so, never yes where
    /// it is not.
    #[inline]
    pub fn misses(&self, rect: &Rect) -> bool {
        (0..3).any(|i| {
            // Take the corner and the sample where the edge function is greatest: if it is negative
            // there, it is so everywhere.
            let x = if self.a[i] > 0 { rect.max[0] - 1 } else { rect.min[0] };
            let y = if self.b[i] > 0 { rect.max[1] - 1 } else { rect.min[1] };
            let c = self.c.iter().map(|c| c[i]).max().unwrap_or(0);
            c + i64::from(self.a[i]) * i64::from(x) + i64::from(self.b[i]) * i64::from(y) < 0
        })
    }

    /// Calls `sink` for every eight pixels of `rect` with a covered sample, or one on blocks that
    /// edges cross. `rect` should be no larger than the triangle's bounds; its columns are widened
    /// to whole blocks.
    #[inline(always)]
    pub fn cover(&self, rect: &Rect, sink: &mut impl FnMut(Row)) {
        // Blocks begin on multiples of 8 of the frame, so that tiles agree on them.
        let [x0, y0] = rect.min.map(|v| v & -BLOCK);
        for y in (y0..rect.max[1]).step_by(BLOCK as usize) {
            let rows = [y.max(rect.min[1]), (y + BLOCK).min(rect.max[1])];
            for x in (x0..rect.max[0]).step_by(BLOCK as usize) {
                for sample in 0..S {
                    self.cover_block(sample, [x, y], rows, sink);
                }
            }
        }
    }

    #[inline(always)]
    fn cover_block(
        &self,
        sample: usize,
        [x, y]: [i32; 2],
        rows: [i32; 2],
        sink: &mut impl FnMut(Row),
    ) {
        // Find the edges that cross the block. The others stay 0, which counts as inside.
        let mut crossing = [(0, 0, 0); 3];
        let mut is_crossed = false;
        for (i, crossing) in crossing.iter_mut().enumerate() {
            let (a, b) = (self.a[i], self.b[i]);
            let corner =
                self.c[sample][i] + i64::from(a) * i64::from(x) + i64::from(b) * i64::from(y);
            // Seven steps lead from a block's first pixel to its last.
            let (step_a, step_b) = (i64::from(a) * 7, i64::from(b) * 7);
            if corner + step_a.max(0) + step_b.max(0) < 0 {
                return;
            }
            // The least value is negative and the greatest is not: the value at the corner fits 32
            // bits.
            if corner + step_a.min(0) + step_b.min(0) < 0 {
                *crossing = (a, b, corner as i32);
                is_crossed = true;
            }
        }
        if !is_crossed {
            // All of the block is inside every edge: no row needs a test.
            for y in rows[0]..rows[1] {
                sink(Row { sample, x, y, mask: i32x8::splat(-1) });
            }
            return;
        }
        // Test the rows that the edges cross, one addition an edge and row.
        let lanes = i32x8::new([0, 1, 2, 3, 4, 5, 6, 7]);
        let first =
            crossing.map(|(a, b, c)| lanes * i32x8::splat(a) + i32x8::splat(c + b * (rows[0] - y)));
        let step = crossing.map(|(_, b, _)| i32x8::splat(b));
        let mut values = first;
        for y in rows[0]..rows[1] {
            // One negative edge function sets the sign bit, and the shift spreads it over the lane.
            let is_outside = values[0] | values[1] | values[2];
            sink(Row { sample, x, y, mask: !(is_outside >> 31_u32) });
            values = [values[0] + step[0], values[1] + step[1], values[2] + step[2]];
        }
    }
}
