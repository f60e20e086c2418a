//! A row of texels where lines of light cross it.

use crate::simd::{Blend, TexelLanes, high_half};
use crate::texture::{FULL_F32, Rows};

/// A row where lines cross it that are a texel apart.
pub(super) struct Crossed<'a> {
    rows: &'a Rows,
    words: &'a [u32],
    /// The column before line 0, and how far the lines are on to the next.
    column: i32,
    blend: Blend,
}

impl<'a> Crossed<'a> {
    /// Row `y`, which line 0 crosses at `x` columns.
    #[inline(always)]
    pub(super) fn new(rows: &'a Rows, y: i32, x: f32) -> Self {
        let column = x.floor();
        let blend = Blend::new(TexelLanes::splat(x - column));
        Self { rows, words: rows.row(y), column: column as i32, blend }
    }

    /// Heights, 0 to 1, of eight texels, the first in column `x`.
    #[inline(always)]
    pub(super) fn height(&self, x: i32) -> TexelLanes {
        high_half(Rows::run(self.words, self.start(x))) * (1.0 / FULL_F32)
    }

    /// Heights where eight lines cross the row, from a line on.
    #[inline(always)]
    pub(super) fn height_between(&self, line: i32) -> TexelLanes {
        let start = self.start(self.column + line);
        let words = self.blend.mix([start, start + 1].map(|start| Rows::run(self.words, start)));
        high_half(words) * (1.0 / FULL_F32)
    }

    #[inline(always)]
    fn start(&self, x: i32) -> usize {
        self.rows.run_start(x) + self.rows.stride()
    }
}
