//! The heights of every mip level in cells, so that one look-up finds the four around a place.
//!
//! A cell is a word of 64 bits, and all levels lie in one list. So each of eight places, which may
//! be on eight levels, costs one load, and the rest is done in lanes:
//!
//! ```text
//! texel centres   (0,1) ---- (1,1)
//!                   |          |        bits   0..16  height at (0,0)    16..32  at (1,0)
//!                 (0,0) ---- (1,0)            32..48  height at (0,1)    48..64  at (1,1)
//! ```
//!
//! Filters whose rays take steps of one length use them; the march to the exact hit skips most
//! cells and reads the few that are left where the surface has them.

use crate::simd::{PixelLanes, as_unsigned, gather, high_halves, i32x8, join, low_halves, split};
use crate::texture::{Level, Surface, Wrap, wrap_index};
use rayon::prelude::*;

/// Most cells: a place among them is a positive i32.
const MOST_CELLS: usize = i32::MAX as usize;

/// Most patterns from the first that a ray over a clamped map starts at: all beyond looks like its
/// edge.
const FARTHEST: f32 = 128.0;

/// The heights of a surface, cell by cell. Takes 32/3 bytes a texel.
#[derive(Clone, Debug)]
pub struct HeightCells {
    cells: Vec<u64>,
    levels: Vec<CellLevel>,
    /// The finest level that is kept: 0, but for maps that are larger than any machine's memory.
    first: usize,
    fold: Fold,
    /// A mirrored pattern spans two repeats.
    patterns_per_repeat: f32,
}

/// Where a level's cells are.
#[derive(Clone, Copy, Debug)]
struct CellLevel {
    /// Its first cell among all.
    start: i32,
    /// The last column and row.
    last: [i32; 2],
}

/// How a place's cell is found in the pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fold {
    /// All sides are powers of two, as usual: the lowest bits are kept.
    Mask,
    /// The rest of a division.
    Divide,
    /// Cells before the first texel and after the last are level.
    Clamp,
}

/// Eight rays, each over the cells of a level of its own.
#[derive(Clone, Copy, Debug)]
pub struct CellRays {
    /// Where they meet the polygon, in cells, and how far they move to the deepest relief.
    start: [PixelLanes; 2],
    step: [PixelLanes; 2],
    /// The last column and row of their levels, the cells a row, and the first cell.
    last: [i32x8; 2],
    pitch: i32x8,
    first: i32x8,
}

impl HeightCells {
    /// The heights of a surface.
    pub fn new(surface: &Surface) -> Self {
        let wrap = surface.wrap();
        // A clamped level has a row and a column of cells before its first texels.
        let more = usize::from(wrap == Wrap::Clamp);
        let num_cells = |level: &Level| level.size().map(|n| n + more);
        let (mut levels, mut num) = (Vec::new(), 0);
        for level in surface.levels().iter().rev() {
            let [width, height] = num_cells(level);
            if num + width * height > MOST_CELLS {
                break;
            }
            levels
                .push(CellLevel { start: num as i32, last: [width, height].map(|n| n as i32 - 1) });
            num += width * height;
        }
        levels.reverse();
        let first = surface.levels().len() - levels.len();
        let mut cells = vec![0; num];
        for (level, at) in surface.levels()[first..].iter().zip(&levels) {
            let [width, height] = num_cells(level);
            let rows = cells[at.start as usize..][..width * height].par_chunks_mut(width);
            let edge = -(more as i32);
            rows.enumerate().for_each(|(y, cells)| {
                let y = edge + y as i32;
                let rows = [y, y + 1].map(|y| wrap_index(wrap, y, level.size()[1]));
                fill(cells, level, rows, edge);
            });
        }
        let [w, h] = surface.base().size();
        let fold = match wrap {
            Wrap::Clamp => Fold::Clamp,
            _ if w.is_power_of_two() && h.is_power_of_two() => Fold::Mask,
            _ => Fold::Divide,
        };
        let patterns_per_repeat = surface.base().texels_per_repeat()[0] / w as f32;
        Self { cells, levels, first, fold, patterns_per_repeat }
    }

    /// The number of the coarsest level.
    pub fn last_level(&self) -> usize {
        self.first + self.levels.len() - 1
    }

    /// Rays over the levels of those numbers, from `base` along `displacement`, both in repeats.
    #[inline(always)]
    pub fn rays(
        &self,
        levels: i32x8,
        base: &[PixelLanes; 2],
        displacement: &[PixelLanes; 2],
    ) -> CellRays {
        let of = |level: i32| &self.levels[(level as usize).max(self.first) - self.first];
        // Neighbouring pixels mostly have one level.
        let level = levels.as_array()[0];
        let is_one = levels.simd_eq(i32x8::splat(level)).all();
        let each = |value: fn(&CellLevel) -> i32| match is_one {
            true => i32x8::splat(value(of(level))),
            false => i32x8::new(levels.as_array().map(|level| value(of(level)))),
        };
        let last = [each(|level| level.last[0]), each(|level| level.last[1])];
        let start = [0, 1].map(|axis| {
            let place = self.folded_start(base[axis] * self.patterns_per_repeat);
            place * self.size(last[axis]) - 0.5
        });
        let step = [0, 1]
            .map(|axis| displacement[axis] * self.patterns_per_repeat * self.size(last[axis]));
        CellRays { start, step, last, pitch: last[0] + 1, first: each(|level| level.start) }
    }

    /// Texels of a pattern with those last columns or rows of cells.
    #[inline(always)]
    fn size(&self, last: i32x8) -> PixelLanes {
        PixelLanes::from_i32x8(if self.fold == Fold::Clamp { last } else { last + 1 })
    }

    /// Places in patterns, without whole ones, so that far tiles keep their precision.
    #[inline(always)]
    fn folded_start(&self, patterns: PixelLanes) -> PixelLanes {
        match self.fold {
            Fold::Mask | Fold::Divide => patterns - patterns.floor(),
            Fold::Clamp => patterns
                .fast_max(PixelLanes::splat(-FARTHEST))
                .fast_min(PixelLanes::splat(FARTHEST)),
        }
    }

    /// The bilinear heights, 0 to [`FULL`](crate::texture::FULL), under rays at a depth from 0, on
    /// the polygon, to 1.
    #[inline(always)]
    pub fn heights(&self, rays: &CellRays, depth: f32) -> PixelLanes {
        let at = [0, 1].map(|axis| rays.start[axis] + rays.step[axis] * depth);
        let floors = at.map(|at| at.floor());
        let [x, y] = [0, 1].map(|axis| self.folded(floors[axis], rays.last[axis]));
        let rows = gather(&self.cells, as_unsigned(rays.first + y * rays.pitch + x));
        // Interpolate along both rows at once: they lie in one vector.
        let [left, right] = [low_halves(rows), high_halves(rows)];
        let part = at[0] - floors[0];
        let [near, far] = split(left + (right - left) * join([part, part]));
        near + (far - near) * (at[1] - floors[1])
    }

    /// The column or row of the cells that begin at whole places.
    #[inline(always)]
    fn folded(&self, floor: PixelLanes, last: i32x8) -> i32x8 {
        match self.fold {
            Fold::Mask => floor.fast_trunc_int() & last,
            Fold::Divide => {
                let size = self.size(last);
                // Exact: rays move fewer texels than an f32 tells apart.
                (floor - (floor / size).floor() * size).fast_trunc_int()
            }
            // The first cell lies before the first texel.
            Fold::Clamp => (floor.fast_trunc_int() + 1).max(i32x8::ZERO).min(last),
        }
    }
}

/// Fills a row of cells, from the column `first` on, with the heights of two stored rows.
fn fill(cells: &mut [u64], level: &Level, rows: [usize; 2], first: i32) {
    let texels = level.rows(false);
    for (x, cell) in (first..).zip(cells) {
        let [[a, b], [c, d]] = rows.map(|y| texels.two_heights(x, y as i32));
        *cell = u64::from(a | b << 16) | u64::from(c | d << 16) << 32;
    }
}
