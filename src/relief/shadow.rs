//! How much of each texel light from one direction reaches over the relief around it.
//!
//! The floating horizon once more, run along the light instead of the view: a ray of light moves
//! along the texture by `D` on its way from the polygon down to the deepest relief, so the one that
//! meets the surface at place `i` and depth `d_i` came in at `p_i = i - d_i D`. It gets there if
//! nothing before it on the line came in as late: if `p_i` is a record.
//!
//! ```text
//!   light                     the segment from i-1 to i rises above the record M: of its way from
//!      \                      p_{i-1} to p_i the part behind M is lit, and that is the end next to i
//!   ____\_____M_p_i____ polygon
//!        \   __\__/____
//!         \ /   \/ i
//!          X    /\
//!     ____/ \__/  \_____
//!              i-1
//! ```
//!
//! Light falls on segments and is kept at texels, to be interpolated between them: each texel takes
//! the lit parts of the two segments beside it, weighed by the tent that interpolation is. What a
//! segment shows of light is then the same, and so is every mean.

use crate::simd::{Blend, TexelLanes, high_half};
use crate::texture::{FULL_F32, Level, Rows, Wrap};
use rayon::prelude::*;

/// Lines that are walked together, in whole vectors: a row's parts of them are whole cache lines.
const LINES: usize = 8 * VECTORS;
const VECTORS: usize = 8;

/// Least length of a segment, in texels, that is divided by.
const LEAST_SEGMENT: f32 = 1e-6;

/// How much of each texel of a level light reaches, 0 to 1.
///
/// Rows are those of the level's texels along u, or along v where [`Self::is_turned`].
#[derive(Debug)]
pub struct LitParts {
    /// Whether rows run along v.
    pub is_turned: bool,
    width: usize,
    wrap: Wrap,
    /// Columns that lines move from one row to the next.
    shear: f32,
    /// The column of the first line in row 0.
    first_line: i32,
    num_lines: usize,
    height: usize,
    /// Groups of [`LINES`] lines, row by row.
    parts: Vec<[f32; LINES]>,
}

/// Lines over the rows of a level, in the order in which light passes them.
#[derive(Clone, Copy)]
struct Walk<'a> {
    rows: &'a Rows,
    /// Texels along the walk down to the deepest relief.
    depth: f32,
    shear: f32,
    toward: i32,
}

impl LitParts {
    /// Sweeps a level along light that moves by `displacement`, in repeats, on its way from the
    /// polygon down to the deepest relief.
    pub fn new(level: &Level, displacement: [f32; 2]) -> Self {
        let [du, dv] = level.in_texels(displacement);
        let is_turned = du.abs() > dv.abs();
        let [dx, dy] = if is_turned { [dv, du] } else { [du, dv] };
        let rows = level.rows(is_turned);
        let shear = if dy == 0.0 { 0.0 } else { dx / dy };
        let walk = Walk { rows, depth: dy.abs(), shear, toward: if dy < 0.0 { -1 } else { 1 } };
        let (width, height) = (rows.width(), rows.height());
        // Lines of a pattern that repeats come in again at the other side. Where it ends, more of
        // them are needed, so that every row is covered.
        let reach = (shear * (height - 1) as f32).floor() as i32;
        let (first_line, num_lines) = match rows.wrap() {
            Wrap::Repeat | Wrap::Mirror => (0, width),
            Wrap::Clamp => (-1 - reach.max(0), width + 1 + reach.unsigned_abs() as usize),
        };
        let num_groups = num_lines.div_ceil(LINES);
        let mut parts = vec![[0.0; LINES]; num_groups * height];
        parts.par_chunks_exact_mut(height).enumerate().for_each(|(group, parts)| {
            walk.lines(first_line + (group * LINES) as i32, parts);
        });
        Self { is_turned, width, wrap: rows.wrap(), shear, first_line, num_lines, height, parts }
    }

    /// The parts of a row of texels, into `to`, which is made as long as the level is wide; `lines`
    /// is a buffer.
    pub fn row(&self, y: usize, lines: &mut Vec<f32>, to: &mut Vec<f32>) {
        // Put the lines of the row side by side, the first one again after the last.
        lines.clear();
        lines.extend(self.parts.chunks_exact(self.height).flat_map(|group| group[y]));
        lines.truncate(self.num_lines);
        lines.push(lines[0]);
        // A texel lies between two lines.
        let shift = self.shear * y as f32;
        let whole = shift.floor();
        let part = shift - whole;
        let first = -(whole as i32) - 1;
        let start = match self.wrap {
            Wrap::Repeat | Wrap::Mirror => first.rem_euclid(self.width as i32),
            Wrap::Clamp => first - self.first_line,
        } as usize;
        to.clear();
        let mix = |pair: &[f32]| pair[1] + (pair[0] - pair[1]) * part;
        let end = (start + self.width).min(self.num_lines);
        to.extend(lines[start..=end].windows(2).map(mix));
        to.extend(lines[..=start + self.width - end].windows(2).map(mix));
    }
}

impl Walk<'_> {
    /// Walks the lines of a group, the first of which crosses row 0 at column `first`, and writes
    /// each row's parts.
    fn lines(&self, first: i32, parts: &mut [[f32; LINES]]) {
        let num_rows = parts.len() as i32;
        // What hides the first row begins so far before it.
        let lead = self.depth.ceil() as i32 + 1;
        let start = if self.toward > 0 { 0 } else { num_rows - 1 };
        let row_of = |i: i32| start + i * self.toward;
        let mut lines = [Line::default(); VECTORS];
        for i in -lead..=num_rows {
            let row = self.row(first, row_of(i));
            let mut unseen = [0.0; LINES];
            // A segment tells what is lit of the texel where it begins.
            let parts = if i > 0 { &mut parts[row_of(i - 1) as usize] } else { &mut unseen };
            for (v, line) in lines.iter_mut().enumerate() {
                let depth = TexelLanes::ONE - row.height(first, v) * (1.0 / FULL_F32);
                let place = TexelLanes::splat(i as f32) - depth * self.depth;
                let lit = if i == -lead { line.begin(place) } else { line.step(place) };
                parts[v * 8..][..8].copy_from_slice(lit.as_array());
            }
        }
    }

    /// The texels of a row that the lines cross.
    #[inline(always)]
    fn row(&self, first: i32, row: i32) -> Crossed<'_> {
        let x = first as f32 + self.shear * row as f32;
        let left = x.floor();
        let (words, column) = (self.rows.row(row), left as i32 - first);
        Crossed { rows: self.rows, words, column, blend: Blend::new(TexelLanes::splat(x - left)) }
    }
}

/// A row where lines cross it.
struct Crossed<'a> {
    rows: &'a Rows,
    words: &'a [u32],
    /// How many columns the lines have moved.
    column: i32,
    /// How far they are on to the next column.
    blend: Blend,
}

impl Crossed<'_> {
    /// Heights of the v-th eight lines.
    #[inline(always)]
    fn height(&self, first: i32, v: usize) -> TexelLanes {
        let column = first + self.column + (v * 8) as i32;
        let start = self.rows.run_start(column) + self.rows.stride();
        high_half(self.blend.mix([start, start + 1].map(|start| Rows::run(self.words, start))))
    }
}

/// Eight lines on their way.
#[derive(Clone, Copy, Default)]
struct Line {
    /// Where light came in that meets the last row, and the latest so far.
    place: TexelLanes,
    record: TexelLanes,
    /// What the segment before the last row lit of that row's texels.
    kept: TexelLanes,
}

impl Line {
    #[inline(always)]
    fn begin(&mut self, place: TexelLanes) -> TexelLanes {
        *self = Self { place, record: place, kept: TexelLanes::ZERO };
        self.kept
    }

    /// Goes on to the next row; gives what is lit of the last one's texels.
    #[inline(always)]
    fn step(&mut self, place: TexelLanes) -> TexelLanes {
        let length = (place - self.place).fast_max(TexelLanes::splat(LEAST_SEGMENT));
        let lit = ((place - self.record) / length).fast_max(TexelLanes::ZERO);
        let lit = lit.fast_min(TexelLanes::ONE);
        // Of a lit part next to the far end, the tents of both ends take these shares.
        let near = lit * lit * 0.5;
        let whole = self.kept + near;
        *self = Self { place, record: self.record.fast_max(place), kept: lit - near };
        whole
    }
}
