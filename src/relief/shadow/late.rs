//! The sweep of light over a relief: how late the latest light came in before each texel.

use super::crossed::Crossed;
use crate::simd::TexelLanes;
use crate::texture::{Rows, Wrap};
use rayon::prelude::*;

/// Lines that are walked together, in whole vectors: a row's of them are whole cache lines.
const LINES: usize = 8 * VECTORS;
const VECTORS: usize = 8;

/// Where the latest light came in that met the relief before a place, in rows from that place along
/// the walk.
#[derive(Debug)]
pub(super) struct Latest {
    width: usize,
    wrap: Wrap,
    /// Columns that lines move from one row to the next.
    shear: f32,
    /// The column of the first line in row 0.
    first_line: i32,
    num_lines: usize,
    height: usize,
    /// Groups of [`LINES`] lines, row by row.
    groups: Vec<[f32; LINES]>,
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

impl Latest {
    /// Sweeps rows along light that moves by so many columns and rows on its way from the polygon
    /// down to the deepest relief; not more columns than rows.
    pub(super) fn new(rows: &Rows, [dx, dy]: [f32; 2]) -> Self {
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
        let mut groups = vec![[0.0; LINES]; num_groups * height];
        groups.par_chunks_exact_mut(height).enumerate().for_each(|(group, latest)| {
            walk.lines(first_line + (group * LINES) as i32, latest);
        });
        Self { width, wrap: rows.wrap(), shear, first_line, num_lines, height, groups }
    }

    /// Those of a row of texels, into `to`, which is made as long as the level is wide; `lines` is
    /// a buffer.
    pub(super) fn row(&self, y: usize, lines: &mut Vec<f32>, to: &mut Vec<f32>) {
        // Put the lines of the row side by side, the first one again after the last.
        lines.clear();
        lines.extend(self.groups.chunks_exact(self.height).flat_map(|group| group[y]));
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
    /// each row's latest.
    fn lines(&self, first: i32, latest: &mut [[f32; LINES]]) {
        let num_rows = latest.len() as i32;
        // What hides the first row begins so far before it.
        let lead = self.depth.ceil() as i32 + 1;
        let start = if self.toward > 0 { 0 } else { num_rows - 1 };
        let mut records = [TexelLanes::splat(f32::MIN); VECTORS];
        for i in -lead..num_rows {
            let row_number = start + i * self.toward;
            let x = first as f32 + self.shear * row_number as f32;
            let row = Crossed::new(self.rows, row_number, x);
            let mut unseen = [0.0; LINES];
            let latest = if i < 0 { &mut unseen } else { &mut latest[row_number as usize] };
            for (v, record) in records.iter_mut().enumerate() {
                let depth = TexelLanes::ONE - row.height_between((v * 8) as i32);
                let place = TexelLanes::splat(i as f32) - depth * self.depth;
                latest[v * 8..][..8].copy_from_slice((*record - i as f32).as_array());
                *record = record.fast_max(place);
            }
        }
    }
}
