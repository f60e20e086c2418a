//! The base level's heights and a pyramid of their maxima.
//!
//! A *cell* spans four neighbouring texel centres; the relief in it is the bilinear patch of their
//! heights. Cell `(i, j)` begins at the centre of texel `(i, j)`.

use super::maxima::Maxima;
use crate::simd::{RayLanes, i32x16};
use crate::texture::{FULL_F32, Rows, Surface, Wrap};
use std::sync::OnceLock;

/// Heights of a surface's base level, read where the surface has them, with maxima.
#[derive(Clone, Debug)]
pub struct HeightField {
    /// Texels along u and v before the pattern wraps.
    pub size: [i32; 2],
    /// Depth of the deepest relief in texture repeats.
    pub relief_depth: f32,
    /// Texels per texture repeat along u and v.
    pub texels_per_repeat: [f32; 2],
    /// One over `size`.
    pub inverse_size: [f32; 2],
    /// Whether the pattern ends at its edges instead of repeating.
    pub is_clamped: bool,
    base: Rows,
    maxima: Maxima,
    /// Depths that no relief reaches, of nodes of blocks; made when they are first asked for, which
    /// only outlines do.
    deepest: OnceLock<Maxima>,
}

/// Cells a side of a block: those of the pyramid of depths, which is asked around places only.
const BLOCK: usize = 4;

impl HeightField {
    /// The heights of a surface.
    pub fn new(surface: &Surface) -> Self {
        let base = surface.base();
        let [w, h] = base.size();
        let mut field = Self {
            size: [w as i32, h as i32],
            inverse_size: [1.0 / w as f32, 1.0 / h as f32],
            relief_depth: surface.relief_depth(),
            texels_per_repeat: base.texels_per_repeat(),
            is_clamped: surface.wrap() == Wrap::Clamp,
            base: base.rows(false).clone(),
            maxima: Maxima::new([1, 1], |_, _| 0),
            deepest: OnceLock::new(),
        };
        let greatest = |x: usize, y: usize| {
            field.corners(x as i32, y as i32).into_iter().fold(0.0, f32::max) as u16
        };
        field.maxima = Maxima::new([w, h], greatest);
        field
    }

    /// See the field of that name.
    fn deepest(&self) -> &Maxima {
        self.deepest.get_or_init(|| {
            // The corners of these cells are all texels of a block, and those beyond it.
            let cells = |block: usize, axis: usize| {
                [0, 2, 3].map(|i| ((block * BLOCK + i) as i32).min(self.size[axis] - 1))
            };
            let deepest = |x: usize, y: usize| {
                let (columns, rows) = (cells(x, 0), cells(y, 1));
                let all = rows.into_iter().flat_map(|y| columns.map(|x| self.corners(x, y)));
                let least = all.flatten().fold(FULL_F32, f32::min);
                (FULL_F32 - least) as u16
            };
            Maxima::new(self.size.map(|side| (side as usize).div_ceil(BLOCK)), deepest)
        })
    }

    /// Whether all relief that is no farther from a place than so many repeats lies above a depth. It
    /// may say no where that is so.
    pub fn is_above(&self, uv: [f64; 2], around: [f64; 2], depth: f64) -> bool {
        let texels = self.texels_per_repeat.map(f64::from);
        let [at, reach] = [uv, around].map(|pair| [0, 1].map(|i| pair[i] * texels[i]));
        // Nodes no smaller than the steps between the places that are looked at: none is left out.
        let step = 0.5 * reach[0].max(reach[1]);
        let size = |level: i32| (BLOCK << level) as f64;
        let deepest = self.deepest();
        let Some(level) = (0..deepest.num_levels()).find(|level| size(*level) >= step) else {
            return false;
        };
        let nodes = |i: usize| {
            [-1.0, -0.5, 0.0, 0.5, 1.0].map(|way| {
                let cell = (at[i] - 0.5 + way * reach[i]).floor() as i32;
                self.fold(i, cell).max(0) >> BLOCK.ilog2()
            })
        };
        let (columns, rows) = (nodes(0), nodes(1));
        let is_above = |node: [i32; 2]| f64::from(deepest.above_one(level, node)) <= depth;
        rows.into_iter().all(|y| columns.into_iter().all(|x| is_above([x, y])))
    }

    /// Heights that no relief reaches, of nodes of cells.
    #[inline(always)]
    pub(super) fn maxima(&self) -> &Maxima {
        &self.maxima
    }

    /// A height, 0 to just above 1, that no relief reaches in the node that holds a folded cell.
    #[inline(always)]
    pub(super) fn height_above(&self, level: i32, cell: [i32; 2]) -> f64 {
        f64::from(self.maxima.above_one(level, cell.map(|c| c.max(0))))
    }

    /// The level that a ray of that many texels begins on: a node holds about a fourth of its way.
    pub fn first_level(&self, length: f32) -> i32 {
        // The exponent is the logarithm rounded down; a fourth is two levels less.
        let exponent = (length.max(1.0).to_bits() >> 23) as i32 - 127;
        (exponent - 2).clamp(0, self.maxima.num_levels() - 1)
    }

    /// The place of a cell in the stored pattern. Cells beyond the edges of a clamped pattern,
    /// where the relief is level across the edge, are -1 and the last.
    pub fn fold(&self, axis: usize, i: i32) -> i32 {
        if self.is_clamped {
            i.clamp(-1, self.size[axis] - 1)
        } else if self.size[axis] & (self.size[axis] - 1) == 0 {
            // As most are: without a division.
            i & (self.size[axis] - 1)
        } else {
            i.rem_euclid(self.size[axis])
        }
    }

    /// [`Self::fold`] of sixteen cells along both axes.
    #[inline(always)]
    pub(super) fn fold_lanes(&self, cells: [i32x16; 2]) -> [i32x16; 2] {
        let one = i32x16::splat(1);
        let sizes = self.size.map(i32x16::splat);
        if self.is_clamped {
            return [0, 1].map(|axis| cells[axis].max(-one).min(sizes[axis] - one));
        }
        if self.size.iter().all(|size| size & (size - 1) == 0) {
            return [0, 1].map(|axis| cells[axis] & (sizes[axis] - one));
        }
        [0, 1].map(|axis| {
            let (cell, size) = (cells[axis], sizes[axis]);
            let patterns = RayLanes::from_i32x16(cell) * self.inverse_size[axis];
            let at = cell - patterns.floor().fast_trunc_int() * size;
            // The product may round to the next whole number.
            let at = at.simd_lt(i32x16::splat(0)).select(at + size, at);
            at.simd_lt(size).select(at, at - size)
        })
    }

    /// The heights, 0 to [`FULL`](crate::texture::FULL), at the corners of a folded cell: (0,0),
    /// (1,0), (0,1), (1,1).
    #[inline]
    pub fn corners(&self, x: i32, y: i32) -> [f32; 4] {
        // The row above the last is the last again or, where the pattern repeats, the first.
        let above = match y + 1 == self.size[1] {
            true if self.is_clamped => y,
            true => 0,
            false => y + 1,
        };
        let [[a, b], [c, d]] = [y.max(0), above].map(|y| self.base.two_heights(x, y));
        [a as f32, b as f32, c as f32, d as f32]
    }

    /// The bilinear height, 0 to 1, at a place in texels (texel centres lie at halves).
    pub fn height_at(&self, u: f64, v: f64) -> f64 {
        let (x, y) = ((u - 0.5).floor(), (v - 0.5).floor());
        let (fx, fy) = (u - 0.5 - x, v - 0.5 - y);
        let [a, b, c, d] =
            self.corners(self.fold(0, x as i32), self.fold(1, y as i32)).map(f64::from);
        let (low, high) = (a + (b - a) * fx, c + (d - c) * fx);
        (low + (high - low) * fy) / f64::from(FULL_F32)
    }
}
