//! Bounds on what hides the texels of a set, for all of its rays at once.
//!
//! The rays of a pixel have one direction and one slope. Add that slope to the relief, row by row
//! away from the eye, and every ray is level: a texel is seen if nothing before it is higher, as on
//! a floating horizon. Rays run between texels, each row's elsewhere, so the horizon itself would
//! differ from row to row; two bounds on it do not:
//!
//! ```text
//!              cell k, where the rays are        rows run across the rays, away from the eye;
//!                  \   \                         a cell is a texel wide, and holds in each row
//! row n-2      *  * \* *\ *   *                  the rays that go through it
//! row n-1      *   * \ * \*   *
//! row n        *   *  \*  x   *                  what lies on the rays of a cell is within the
//!                                                least and the greatest of the texels beside them
//! ```
//!
//! The greatest so far of the greatest texels is an upper bound on what hides texel x, that of the
//! least ones a lower one. What lies above the upper bound is seen, what lies below the lower one
//! is hidden, and only texels between the two need a ray; it may end as soon as it is above the
//! upper bound of the row that it has come to.

use crate::simd::{LineLanes, high_halves};
use crate::texture::Rows;

/// Most cells in all rows, 48 MiB of them: beyond, rays go without bounds.
const MOST_CELLS: usize = 1 << 22;

/// How far beyond a cell, in texels, rounding may put a ray of it: a ray of 65536 steps is off by
/// a 128th at most.
const MARGIN: f32 = 1.0 / 64.0;

/// Texels that the rays of a cell lie between: one more than without the margin.
const BESIDE: usize = 4;

/// Below any height with a slope added.
const LOWEST: f32 = -1e30;

/// Cells that are swept at once.
const LANES: usize = 16;

/// Rows that a ray skips at once.
pub(super) const BLOCK: usize = 8;

/// The bounds, row by row away from the eye. Kept between pixels for its buffers.
#[derive(Clone, Debug, Default)]
pub(super) struct Bounds {
    /// The greatest height beside the rays of each cell in each row.
    greatest: Vec<f32>,
    /// The same in blocks of rows.
    blocks: Vec<f32>,
    /// On the greatest height before each row; the lower one of rows of the set alone.
    upper: Vec<f32>,
    lower: Vec<f32>,
    /// Cells a row.
    pitch: usize,
    /// The texel, along the rays and across, that rows and cells are counted from, and the first
    /// ones.
    origin: [i32; 2],
    first_row: i32,
    first_cell: i32,
    course: Course,
    /// What rounding may add up to in a ray's height and a row's.
    slack: f32,
}

/// How the rays of a pixel go.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Course {
    pub(super) runs_along_x: bool,
    /// 1 where rows along the rays are numbered away from the eye, or -1.
    pub(super) away: i32,
    /// Texels across a step, and how much a ray rises in one.
    pub(super) across: f32,
    pub(super) rise: f32,
    /// Steps of the longest ray.
    pub(super) num_steps: i32,
}

/// Where sixteen neighbouring texels are among the bounds: each by itself where rays run along x,
/// and else, where all are in one row, the first.
pub(super) struct Spot<const N: usize> {
    rows: [usize; N],
    cells: [usize; N],
    /// Their heights with the slopes of their rows.
    heights: LineLanes,
}

impl Bounds {
    /// Finds the bounds for the rays of so many batches of texels, of which those at the ends of
    /// rows are given; `rows` are the level's that run across the rays. `None` where rays do better
    /// without.
    pub(super) fn of(
        &mut self,
        (ends, num_batches): (impl Iterator<Item = [i32; 2]> + Clone, usize),
        course: Course,
        rows: &Rows,
    ) -> Option<&Self> {
        self.course = course;
        let first = ends.clone().next()?;
        self.origin = course.turned(first);
        let (mut rows_of_set, mut cells) = ([i32::MAX, i32::MIN], [f32::INFINITY, -f32::INFINITY]);
        for (row, cell) in ends.map(|texel| self.row_and_cell(texel)) {
            rows_of_set = [rows_of_set[0].min(row), rows_of_set[1].max(row)];
            cells = [cells[0].min(cell), cells[1].max(cell)];
        }
        // One more at each end, for rounding.
        self.first_cell = cells[0].floor() as i32 - 1;
        self.first_row = rows_of_set[0] - course.num_steps;
        let num_cells = (cells[1].floor() as i32 + 2 - self.first_cell) as usize;
        let num_rows = (rows_of_set[1] + 1 - self.first_row) as usize;
        self.pitch = num_cells.next_multiple_of(LANES);
        // A few short rays take no longer than the sweep: one of sixteen texels goes an eighth of
        // its steps, and a step takes as long as that of a sweep over sixteen cells.
        let most = MOST_CELLS.min(num_batches * course.num_steps as usize);
        self.pitch.checked_mul(num_rows).filter(|&num| num <= most)?;
        // A ray adds up its steps, a row multiplies them.
        self.slack = num_rows as f32 * (1.0 / 512.0 + course.rise * (1.0 / 4_194_304.0));
        self.sweep(rows, num_rows);
        Some(self)
    }

    fn sweep(&mut self, rows: &Rows, num_rows: usize) {
        let (pitch, lead) = (self.pitch, self.course.num_steps as usize);
        self.make_room(num_rows);
        for number in 0..num_rows - 1 {
            let row = self.first_row + number as i32;
            let start = rows.row_start(self.origin[0] + self.course.away * row) + rows.stride();
            let place = self.first_cell as f32 - row as f32 * self.course.across - MARGIN;
            let first = self.origin[1] + place.floor() as i32;
            let slope = row as f32 * self.course.rise;
            let greatest = &mut self.greatest[number * pitch..][..pitch];
            let block = &mut self.blocks[number / BLOCK * pitch..][..pitch];
            let [upper, next_upper] = two_rows(&mut self.upper, number, pitch);
            // Rows before the set's share one lower bound.
            let [lower, next_lower] = two_rows(&mut self.lower, number.saturating_sub(lead), pitch);
            for cell in (0..pitch).step_by(LANES) {
                let start = start + rows.run_start(first + cell as i32);
                let words = &rows.words()[start..start + LANES + BESIDE - 1];
                let run = |i: usize| Rows::long_run(words, i);
                // Heights are the upper halves of words, so they decide.
                let most = (1..BESIDE).fold(run(0), |most, i| most.max(run(i)));
                let least = (1..BESIDE).fold(run(0), |least, i| least.min(run(i)));
                let [most, least] = [most, least].map(|words| high_halves(words) + slope);
                put(greatest, cell, most);
                put(block, cell, most.fast_max(lanes_at(block, cell)));
                put(next_upper, cell, most.fast_max(lanes_at(upper, cell)));
                let least = least.fast_max(lanes_at(lower, cell));
                put(if number < lead { &mut *lower } else { &mut *next_lower }, cell, least);
            }
        }
    }

    /// Makes the buffers large enough, and empties what is added to.
    fn make_room(&mut self, num_rows: usize) {
        let pitch = self.pitch;
        let num_blocks = num_rows.div_ceil(BLOCK);
        for (bounds, num_rows) in [
            (&mut self.greatest, num_rows),
            (&mut self.blocks, num_blocks),
            (&mut self.upper, num_rows),
            (&mut self.lower, num_rows + 1 - self.course.num_steps as usize),
        ] {
            bounds.resize(bounds.len().max(num_rows * pitch), 0.0);
        }
        self.blocks[..num_blocks * pitch].fill(LOWEST);
        self.upper[..pitch].fill(LOWEST);
        self.lower[..pitch].fill(LOWEST);
    }

    /// The row of a texel, and where its ray goes across in row 0.
    fn row_and_cell(&self, texel: [i32; 2]) -> (i32, f32) {
        let [along, across] = self.course.turned(texel);
        let row = self.course.away * (along - self.origin[0]);
        (row, (across - self.origin[1]) as f32 + row as f32 * self.course.across)
    }

    /// Where the texel at `x`, `y` and the fifteen beside it are, with their heights.
    #[inline(always)]
    pub(super) fn spot<const N: usize>(&self, x: i32, y: i32, heights: LineLanes) -> Spot<N> {
        let (mut rows, mut cells, mut slopes) = ([0; N], [0; N], [0.0; N]);
        for lane in 0..N {
            let (row, cell) = self.row_and_cell([x + lane as i32, y]);
            rows[lane] = (row - self.first_row) as usize;
            cells[lane] = (cell.floor() as i32 - self.first_cell) as usize;
            slopes[lane] = row as f32 * self.course.rise;
        }
        let slope = LineLanes::new(std::array::from_fn(|lane| slopes[lane % N]));
        Spot { rows, cells, heights: heights + slope }
    }

    /// The texels at a spot that are surely hidden, a bit each, by relief that is higher than rays
    /// from so far above them.
    #[inline(always)]
    pub(super) fn hidden<const N: usize>(&self, spot: &Spot<N>, above: f32) -> u16 {
        let lower = self.read(&self.lower, spot, |row| row - self.course.num_steps as usize);
        lower.simd_gt(spot.heights + (above + self.slack)).to_bitmask() as u16
    }

    /// The rays from the texels at a spot that may meet higher relief in the given step.
    #[inline(always)]
    pub(super) fn meets<const N: usize>(&self, spot: &Spot<N>, step: usize) -> u16 {
        self.below(self.read(&self.greatest, spot, |row| row - step), spot)
    }

    /// [`Self::meets`] of as many steps as a block has rows, from the given one on.
    #[inline(always)]
    pub(super) fn meets_soon<const N: usize>(&self, spot: &Spot<N>, step: usize) -> u16 {
        // They may end in the next block.
        let of_last = |row: usize| (row - step).saturating_sub(BLOCK - 1) / BLOCK;
        let near = self.read(&self.blocks, spot, |row| (row - step) / BLOCK);
        self.below(near.fast_max(self.read(&self.blocks, spot, of_last)), spot)
    }

    /// The rays from the texels at a spot that may yet meet higher relief after the given step.
    #[inline(always)]
    pub(super) fn open<const N: usize>(&self, spot: &Spot<N>, step: usize) -> u16 {
        self.below(self.read(&self.upper, spot, |row| row - step), spot)
    }

    /// The rays that are not surely above a bound.
    #[inline(always)]
    fn below<const N: usize>(&self, bound: LineLanes, spot: &Spot<N>) -> u16 {
        bound.simd_gt(spot.heights - self.slack).to_bitmask() as u16
    }

    /// What bounds say at a spot; `to_row` says which of their rows belongs to one of the sweep.
    #[inline(always)]
    fn read<const N: usize>(
        &self,
        bounds: &[f32],
        spot: &Spot<N>,
        to_row: impl Fn(usize) -> usize,
    ) -> LineLanes {
        let place = |lane: usize| to_row(spot.rows[lane]) * self.pitch + spot.cells[lane];
        if N == 1 {
            lanes_at(bounds, place(0))
        } else {
            LineLanes::new(std::array::from_fn(|lane| bounds[place(lane % N)]))
        }
    }
}

impl Course {
    /// A texel's place along the rays and across.
    fn turned(&self, [x, y]: [i32; 2]) -> [i32; 2] {
        if self.runs_along_x { [x, y] } else { [y, x] }
    }
}

/// A row and the next one.
fn two_rows(bounds: &mut [f32], number: usize, pitch: usize) -> [&mut [f32]; 2] {
    let (row, next) = bounds[number * pitch..][..2 * pitch].split_at_mut(pitch);
    [row, next]
}

#[inline(always)]
fn put(row: &mut [f32], cell: usize, lanes: LineLanes) {
    row[cell..cell + LANES].copy_from_slice(lanes.as_array());
}

#[inline(always)]
fn lanes_at(numbers: &[f32], start: usize) -> LineLanes {
    let lanes: &[f32; LANES] =
        numbers[start..start + LANES].try_into().expect("a slice of sixteen");
    LineLanes::new(*lanes)
}
