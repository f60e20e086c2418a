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
//! the lit parts of the segments beside it, before and after it on the light's line, and of walls
//! between it and its neighbours in the row ([`Share`]).

mod crossed;
mod edge;
mod late;
mod share;

use crate::simd::TexelLanes;
use crate::texture::{Level, Rows};
use crossed::Crossed;
use late::Latest;
use share::{STEEP, Share, flat, lit};

/// Least way of light down to the deepest relief, in rows, that is divided by.
const LEAST_DOWN: f32 = 1e-3;

/// How much of each texel of a level light reaches, 0 to 1.
///
/// Rows are those of the level's texels along u, or along v where [`Self::is_turned`].
#[derive(Debug)]
pub struct LitParts<'a> {
    /// Whether rows run along v.
    pub is_turned: bool,
    rows: &'a Rows,
    /// Rows that light passes on its way from the polygon down to the deepest relief.
    down: f32,
    /// From a row to the one that light passes next, and how many columns it moves meanwhile.
    toward: i32,
    shear: f32,
    /// The depth of the deepest relief, in columns and in rows.
    deep: [f32; 2],
    latest: Latest,
}

/// Buffers of [`LitParts::row`].
#[derive(Debug, Default)]
pub struct RowScratch {
    lines: Vec<f32>,
    latest: Vec<f32>,
    padded: Vec<f32>,
}

impl<'a> LitParts<'a> {
    /// Sweeps a level along light that moves by `displacement` on its way from the polygon down to
    /// the deepest relief, at `relief_depth`; both in repeats.
    pub fn new(level: &'a Level, displacement: [f32; 2], relief_depth: f32) -> Self {
        let [du, dv] = level.in_texels(displacement);
        let is_turned = du.abs() > dv.abs();
        let swap = |[u, v]: [f32; 2]| if is_turned { [v, u] } else { [u, v] };
        let [dx, dy] = swap([du, dv]);
        let rows = level.rows(is_turned);
        Self {
            is_turned,
            rows,
            down: dy.abs(),
            toward: if dy < 0.0 { -1 } else { 1 },
            shear: if dy == 0.0 { 0.0 } else { dx / dy.abs() },
            deep: swap(level.in_texels([relief_depth; 2])),
            latest: Latest::new(rows, [dx, dy]),
        }
    }

    /// The parts of a row of texels, into `to`, in whole vectors of eight.
    pub fn row(&self, y: usize, scratch: &mut RowScratch, to: &mut Vec<f32>) {
        let [before, own, after] = self.crossed(y);
        let columns = self.latest_row(y, scratch);
        to.clear();
        for (columns, x) in columns.windows(10).step_by(8).zip((0..).step_by(8)) {
            let columns = [0, 1, 2].map(|i| lanes(&columns[i..]));
            let heights = [-1, 0, 1].map(|step| own.height(x + step));
            let along = [before.height_between(x), after.height_between(x)];
            to.extend_from_slice(self.parts(columns, heights, along).as_array());
        }
    }

    /// Where the edges of shadows lie on a row of texels, in whole vectors of eight: the heights above
    /// which light reaches them, and how wide the edges are at least; 1 is from the deepest relief to
    /// the polygon.
    pub fn edges(&self, y: usize, scratch: &mut RowScratch, to: &mut Vec<[TexelLanes; 2]>) {
        let [before, own, after] = self.crossed(y);
        let columns = self.latest_row(y, scratch);
        let inverse = 1.0 / self.down.max(LEAST_DOWN);
        to.clear();
        to.extend(columns.windows(10).step_by(8).zip((0..).step_by(8)).map(|(columns, x)| {
            let (latest, height) = (lanes(&columns[1..]), own.height(x));
            let along = [before.height_between(x), after.height_between(x)];
            let places = self.places(height, along);
            let rise = (along[0] - height).abs() * self.deep[1];
            let above = edge::above(latest, places, rise) * inverse;
            let [left, right] = [own.height(x - 1), own.height(x + 1)];
            [height - above, edge::least_width(height, [along[0], along[1], left, right])]
        }));
    }

    /// The rows that lines through the texels of one pass before it, it, and the one after.
    fn crossed(&self, y: usize) -> [Crossed<'a>; 3] {
        [-1, 0, 1].map(|step| {
            Crossed::new(self.rows, y as i32 + step * self.toward, step as f32 * self.shear)
        })
    }

    /// What [`Latest`] says of a row, in whole vectors of eight, with a column more on both sides: it
    /// begins with the last one.
    fn latest_row<'b>(&self, y: usize, scratch: &'b mut RowScratch) -> &'b [f32] {
        let RowScratch { lines, latest, padded } = scratch;
        self.latest.row(y, lines, latest);
        padded.clear();
        padded.push(latest[latest.len() - 1]);
        padded.extend(latest.iter().cycle().take(self.rows.width().div_ceil(8) * 8 + 1));
        padded
    }

    /// Where light comes in that meets texels and the places before and after them on its lines, in
    /// rows.
    #[inline(always)]
    fn places(&self, height: TexelLanes, along: [TexelLanes; 2]) -> [TexelLanes; 3] {
        let place = |height: TexelLanes| (height - 1.0) * self.down;
        [place(along[0]) - 1.0, place(height), place(along[1]) + 1.0]
    }

    /// The parts of eight texels, by what stands of their columns and those beside them: the latest
    /// light and the heights; and the heights before and after them on their lines.
    #[inline(always)]
    fn parts(
        &self,
        latest: [TexelLanes; 3],
        heights: [TexelLanes; 3],
        along: [TexelLanes; 2],
    ) -> TexelLanes {
        let place = |height: TexelLanes| (height - 1.0) * self.down;
        let [left, own, right] = [0, 1, 2].map(|i| place(heights[i]) - latest[i]);
        let [before, here, after] = self.places(heights[1], along);
        let record = latest[1].fast_max(before);
        let far = lit(before, here, record);
        let near = lit(here, after, record.fast_max(here));
        let [back, ahead] = [0, 1].map(|i| (along[i] - heights[1]).abs() * self.deep[1]);
        let [left_wall, right_wall] =
            [0, 2].map(|i| (heights[i] - heights[1]).abs() * self.deep[0]);
        let steepest = back.fast_max(ahead).fast_max(left_wall.fast_max(right_wall));
        if !steepest.simd_gt(TexelLanes::splat(STEEP)).any() {
            return flat(far, near);
        }
        let mut share = Share::default();
        share.add_far(far, back);
        share.add_near(near, ahead);
        // How far light that comes in as late as the latest passes above or below tells between
        // texels of a row where it is cut off.
        share.add_wall(own, left, left_wall);
        share.add_wall(own, right, right_wall);
        share.mean()
    }
}

#[inline(always)]
fn lanes(numbers: &[f32]) -> TexelLanes {
    TexelLanes::new(numbers[..8].try_into().expect("eight"))
}
