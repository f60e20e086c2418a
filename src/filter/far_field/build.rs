//! Builds the tables: for each direction, one floating-horizon sweep over a whole level.
//!
//! Lines run in the direction of the displacement, a texel apart, and are walked row by row along its longer axis (see
//! `filter::horizon`). The visible part of each segment, moved onto the mean depth plane, is cut at the table's rows and
//! added to the table texel it falls into; a texel is the mean of what falls into it.

use super::encode::FarImage;
use super::{FarField, NUM_LENGTHS};
use crate::filter::texel_set::lane_columns;
use crate::simd::{Blend, TexelLanes, high_half, low_half};
use crate::texture::{FULL_F32, Level, Surface, Wrap, wrap_index};
use rayon::prelude::*;

/// Greatest root-mean-square difference, of the surface's colour scale, that levels 1 and 2 may make in what is seen
/// before sweeps must be finer. Measured: 0.02 keeps thin high ridges at base level; at 0.035 the level 2 of rounded
/// stones still serves.
const MOST_LOSS: [f32; 2] = [0.02, 0.035];

/// Greatest such difference of the level that tables are built from.
const MOST_SOURCE_LOSS: f32 = 0.02;

/// Directions in which the loss of a level is measured, per length.
const NUM_PROBES: usize = 2;

/// Mean depth of the surface, 0 to 1.
pub(super) fn mean_depth(surface: &Surface) -> f32 {
    1.0 - surface.levels.last().map_or(1.0, |level| level.height_at(0, 0))
}

/// The tables of all directions.
pub(super) fn images(surface: &Surface, far: &FarField) -> Vec<FarImage> {
    let size = table_size(surface, far.first_level);
    let source = source_level(surface, far);
    let directions: Vec<_> = (0..NUM_LENGTHS).flat_map(|i| (0..far.num_azimuths(i)).map(move |j| (i, j))).collect();
    let one = |(i, j)| FarImage::new(size, seen(surface, source, far, far.displacement(i, j)));
    directions.into_par_iter().map(one).collect()
}

/// The coarsest level, up to 1, whose sweep shows nearly what the base level's does: a quarter of the work.
fn source_level(surface: &Surface, far: &FarField) -> usize {
    let probes: Vec<_> = [2, NUM_LENGTHS / 2, NUM_LENGTHS - 2].into_iter().flat_map(|i| [(i, 0), (i, 3)]).collect();
    let loss = |&(i, j): &(usize, usize)| {
        let displacement = far.displacement(i, j);
        square_difference(&seen(surface, 0, far, displacement), &seen(surface, 1, far, displacement))
    };
    let greatest = probes.par_iter().map(loss).reduce(|| 0.0, f32::max);
    usize::from(far.first_level > 1 && greatest < MOST_SOURCE_LOSS * MOST_SOURCE_LOSS)
}

/// For each length, how many levels finer a sweep must be than its lines ask for: 2 where level 1 loses too much, 1 where
/// level 2 does.
pub(super) fn level_bias(surface: &Surface, far: &FarField) -> Vec<usize> {
    let loss = |length: usize, level: usize| {
        let squares = (0..NUM_PROBES).map(|i| {
            let azimuth = (i * far.num_azimuths(length) / NUM_PROBES + i) % far.num_azimuths(length);
            let exact = far.images[far.starts[length] + azimuth].colors();
            square_difference(&exact, &seen(surface, level, far, far.displacement(length, azimuth)))
        });
        (squares.sum::<f32>() / NUM_PROBES as f32).sqrt()
    };
    let is_lost = |length: usize, level: usize| level < far.first_level && loss(length, level) > MOST_LOSS[level - 1];
    let bias = |length: usize| if is_lost(length, 1) { 2 } else { usize::from(is_lost(length, 2)) };
    (0..NUM_LENGTHS).into_par_iter().map(bias).collect()
}

/// The mean square of the differences of two images.
fn square_difference(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
    let square = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).map(|c| (a[c] - b[c]) * (a[c] - b[c])).sum::<f32>();
    a.iter().zip(b).map(square).sum::<f32>() / (3 * a.len()) as f32
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
    place: TexelLanes,
    color: [TexelLanes; 3],
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
        let last = num_rows + self.depth as i32 + 1;
        for i in 1 - lead..=last {
            let row = self.row(first, i);
            let records = row.place.simd_gt(horizon).to_bitmask() & ((1 << num_lines) - 1);
            if records != 0 {
                let from = horizon.fast_max(TexelLanes::splat(begin));
                let to = row.place.fast_min(TexelLanes::splat(end));
                self.add(first, [from, to], [&previous, &row], records);
                horizon = horizon.fast_max(row.place);
                if horizon.simd_ge(TexelLanes::splat(end)).all() {
                    return;
                }
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
            place: TexelLanes::splat(i as f32) - depth * self.depth,
            color: [low_half(red_green), high_half(red_green), low_half(blue_height)],
        }
    }

    /// Adds the parts from `from` to `to` of the segments between two rows, where there is a record.
    fn add(&mut self, first: usize, [from, to]: [TexelLanes; 2], [near, far]: [&Row; 2], records: u32) {
        let inverse = TexelLanes::ONE / (far.place - near.place).fast_max(TexelLanes::splat(1e-6));
        let line = lane_columns(first as i32);
        // Most parts are short and fall into one texel; a long one is cut into parts shorter than a texel.
        let longest = ((to - from) * self.scale[1]).to_array();
        let longest = (0..8).filter(|lane| records >> lane & 1 == 1).map(|lane| longest[lane]).fold(0.0, f32::max);
        let num_parts = (longest * 2.0) as i32 + 1;
        let length = (to - from) * (1.0 / num_parts as f32);
        for part in 0..num_parts {
            let middle = from + length * (part as f32 + 0.5);
            let at = ((middle - near.place) * inverse).fast_max(TexelLanes::ZERO).fast_min(TexelLanes::ONE);
            let color = |i: usize| (near.color[i] + (far.color[i] - near.color[i]) * at) * length;
            let eta = (middle + self.depth * self.mean_depth) * self.toward;
            // Texel centres lie at whole numbers.
            let x = ((line + eta * self.shear + 0.5) * self.scale[0]).floor().fast_trunc_int().to_array();
            let y = ((eta + 0.5) * self.scale[1]).floor().fast_trunc_int().to_array();
            let sums = [color(0), color(1), color(2), length].map(TexelLanes::to_array);
            let mut left = records;
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                if sums[3][lane] > 0.0 {
                    let place = wrap_index(Wrap::Repeat, y[lane], self.size[1]) * self.size[0]
                        + wrap_index(Wrap::Repeat, x[lane], self.size[0]);
                    self.sums[place].iter_mut().zip(&sums).for_each(|(sum, lanes)| *sum += lanes[lane]);
                }
            }
        }
    }
}
