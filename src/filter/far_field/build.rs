//! Builds the tables: for each direction, one floating-horizon sweep over a whole level.
//!
//! Lines run in the direction of the displacement, a texel apart, and are walked row by row along its longer axis (see
//! `filter::horizon`). The visible part of each segment, moved onto the mean depth plane, is cut at the table's rows and
//! added to the table texel it falls into; a texel is the mean of what falls into it.

use super::FarField;
use super::encode::FarImage;
use crate::simd::{Blend, TexelLanes, high_half, low_half};
use crate::texture::{FULL_F32, Level, Surface};
use rayon::prelude::*;

/// Greatest root-mean-square difference, of the surface's colour scale, that a level may make in what is seen.
const MOST_LOSS: f32 = 0.012;

/// Directions in which the loss of a level is measured, per length.
const NUM_PROBES: usize = 4;

/// Mean depth of the surface, 0 to 1.
pub(super) fn mean_depth(surface: &Surface) -> f32 {
    1.0 - surface.levels.last().map_or(1.0, |level| level.height_at(0, 0))
}

/// The tables of all directions.
pub(super) fn images(surface: &Surface, far: &FarField) -> Vec<FarImage> {
    let size = table_size(surface, far.first_level);
    let one = |i: usize| {
        let displacement = far.displacement(i / far.num_azimuths, i % far.num_azimuths);
        FarImage::new(size, seen(surface, 0, far, displacement))
    };
    (0..far.num_lengths * far.num_azimuths).into_par_iter().map(one).collect()
}

/// For each length, how many levels finer than level 1, 2 or 3 a sweep must be to lose less than [`MOST_LOSS`].
pub(super) fn level_bias(surface: &Surface, far: &FarField) -> Vec<usize> {
    let loss = |length: usize, level: usize| {
        let squares = (0..NUM_PROBES).map(|i| {
            let displacement = far.displacement(length, i * far.num_azimuths / NUM_PROBES + i % 2);
            let (exact, coarse) = (seen(surface, 0, far, displacement), seen(surface, level, far, displacement));
            let square = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).map(|c| (a[c] - b[c]) * (a[c] - b[c])).sum::<f32>();
            exact.iter().zip(&coarse).map(square).sum::<f32>() / (3 * exact.len()) as f32
        });
        (squares.sum::<f32>() / NUM_PROBES as f32).sqrt()
    };
    let bias = |length: usize| (1..=2).rev().find(|&level| loss(length, 3 - level) > MOST_LOSS).unwrap_or(0);
    (0..far.num_lengths).into_par_iter().map(bias).collect()
}

fn table_size(surface: &Surface, level: usize) -> [usize; 2] {
    [surface.levels[level].width, surface.levels[level].height]
}

/// The image seen along a displacement (base texels), swept on a mip level, with the size of the finest table.
fn seen(surface: &Surface, level: usize, far: &FarField, [du, dv]: [f32; 2]) -> Vec<[f32; 3]> {
    let size = table_size(surface, far.first_level);
    let (source, base) = (&surface.levels[level], &surface.levels[0]);
    let scale = [source.width as f32 / base.width as f32, source.height as f32 / base.height as f32];
    let (du, dv) = (du * scale[0], dv * scale[1]);
    let runs_along_u = du.abs() > dv.abs();
    let mut sweep = if runs_along_u {
        Sweep::new(&surface.transposed[level], [dv, du], far.mean_depth, [size[1], size[0]])
    } else {
        Sweep::new(source, [du, dv], far.mean_depth, size)
    };
    for first in (0..sweep.level.width).step_by(8) {
        sweep.lines(first);
    }
    let mean = |sum: &[f32; 4]| [0, 1, 2].map(|i| sum[i] / (sum[3].max(f32::MIN_POSITIVE) * FULL_F32));
    if !runs_along_u {
        return sweep.sums.iter().map(mean).collect();
    }
    (0..size[0] * size[1]).map(|i| mean(&sweep.sums[i % size[0] * size[1] + i / size[0]])).collect()
}

/// A sweep over one whole level: rows along y, lines as lanes.
struct Sweep<'a> {
    level: &'a Level,
    toward: f32,
    depth: f32,
    shear: f32,
    mean_depth: f32,
    size: [usize; 2],
    /// Table texels per texel of the level.
    scale: [f32; 2],
    /// Colour times length, and length, of what fell into each texel.
    sums: Vec<[f32; 4]>,
}

/// The eight lines in one row.
#[derive(Clone, Copy)]
struct Row {
    place: [f32; 8],
    color: [[f32; 8]; 3],
}

impl<'a> Sweep<'a> {
    fn new(level: &'a Level, [dx, dy]: [f32; 2], mean_depth: f32, size: [usize; 2]) -> Self {
        let shear = if dy == 0.0 { 0.0 } else { dx / dy };
        let scale = [size[0] as f32 / level.width as f32, size[1] as f32 / level.height as f32];
        let toward = if dy < 0.0 { -1.0 } else { 1.0 };
        let sums = vec![[0.0; 4]; size[0] * size[1]];
        Self { level, toward, depth: dy.abs(), shear, mean_depth, size, scale, sums }
    }

    /// Walks eight lines over one period of the pattern, after a walk that finds what hides its beginning.
    fn lines(&mut self, first: usize) {
        let num_rows = self.level.height as i32;
        let lead = (self.depth.ceil() as i32 + 1).min(num_rows);
        let num_lines = (self.level.width - first).min(8);
        let mut previous = self.row(first, -lead);
        let mut horizon = previous.place;
        // What is seen of one period: between the record at its beginning and the same a period on.
        let (begin, end) = (-self.depth * self.mean_depth, num_rows as f32 - self.depth * self.mean_depth);
        for i in 1 - lead.. {
            let row = self.row(first, i);
            let mut is_done = true;
            for lane in 0..num_lines {
                let place = row.place[lane];
                if place > horizon[lane] {
                    let from = horizon[lane].max(begin);
                    let to = place.min(end);
                    if to > from {
                        self.add(lane as f32 + first as f32, [from, to], [&previous, &row], lane);
                    }
                    horizon[lane] = place;
                }
                is_done &= horizon[lane] >= end;
            }
            if is_done || i > num_rows + self.depth as i32 + 1 {
                return;
            }
            previous = row;
        }
    }

    /// Projected places and colours of the lines in the i-th row of the walk.
    fn row(&self, first: usize, i: i32) -> Row {
        let eta = i as f32 * self.toward;
        let words = self.level.row(eta as i32);
        let x = first as f32 + self.shear * eta;
        let left = x.floor();
        let start = self.level.run_start(left as i32);
        let blend = Blend::new(TexelLanes::splat(x - left));
        let pick = |plane: usize| {
            let start = start + plane * self.level.stride();
            blend.mix([Level::run(words, start), Level::run(words, start + 1)])
        };
        let (red_green, blue_height) = (pick(0), pick(1));
        let depth = TexelLanes::ONE - high_half(blue_height) * (1.0 / FULL_F32);
        Row {
            place: (TexelLanes::splat(i as f32) - depth * self.depth).to_array(),
            color: [low_half(red_green), high_half(red_green), low_half(blue_height)].map(TexelLanes::to_array),
        }
    }

    /// Adds the part from `begin` to `end` of the segment between two rows, cut at the table's rows.
    fn add(&mut self, line: f32, [begin, end]: [f32; 2], [near, far]: [&Row; 2], lane: usize) {
        let shift = self.depth * self.mean_depth;
        let inverse = 1.0 / (far.place[lane] - near.place[lane]).max(1e-6);
        let mut from = begin;
        while from < end {
            // Texel centres lie at whole numbers, so the table's texel edges are half a texel away.
            let table_row = ((from + shift + 0.5 * self.toward) * self.scale[1] + 1e-4).floor();
            let to = ((table_row + 1.0) / self.scale[1] - shift - 0.5 * self.toward).min(end).max(from + 1e-3);
            let middle = (from + to) * 0.5;
            let part = ((middle - near.place[lane]) * inverse).clamp(0.0, 1.0);
            let eta = (middle + shift) * self.toward;
            let column = ((line + self.shear * eta + 0.5) * self.scale[0]).floor() as i32;
            let x = column.rem_euclid(self.size[0] as i32) as usize;
            let y = (((eta + 0.5) * self.scale[1]).floor() as i32).rem_euclid(self.size[1] as i32) as usize;
            let sum = &mut self.sums[y * self.size[0] + x];
            for c in 0..3 {
                sum[c] += (near.color[c][lane] + (far.color[c][lane] - near.color[c][lane]) * part) * (to - from);
            }
            sum[3] += to - from;
            from = to;
        }
    }
}
