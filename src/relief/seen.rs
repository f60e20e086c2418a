//! The image of a relief seen along one displacement, over a whole repeat of the pattern.
//!
//! A floating-horizon sweep over a whole level: lines run in the direction of the displacement, a
//! texel apart, and are walked row by row along its longer axis (see `filter::horizon`). The
//! visible part of each segment, moved along the view onto one plane, is cut at the image's rows
//! and added to the image's texel that it falls into; a texel is the mean of what falls into it.
//!
//! ```text
//!  row i-1          row i           record M so far: what lies before it is hidden
//!     *---------------*
//!           |=========|             the visible part of the segment, from M to the place of row i
//!        M  ^         ^             it falls into one or more texels of the image
//! ```

use crate::simd::{Blend, TexelLanes, high_half, lane_columns, low_half, u32x8};
use crate::texture::{FULL_F32, Rows, Surface, Wrap, unpack_normals, wrap_index};

/// Least length of a segment, in texels, that a place in it is divided by.
const LEAST_SEGMENT: f32 = 1e-6;

/// An image of what is seen, row by row along u.
pub type SeenImage = Vec<[f32; 3]>;

/// What is seen: what is read of texels, and what is shown between two of them.
pub(crate) trait Sight: Sync {
    /// What is read.
    type Values: Copy;

    /// Reads the texels where lines cross a row.
    fn read(&self, crossing: &Crossing) -> Self::Values;

    /// What is shown at a part of the way between two rows, in units of the surface's stored colours.
    fn between(&self, values: [&Self::Values; 2], part: TexelLanes) -> [TexelLanes; 3];
}

/// Linear colours.
pub(crate) struct Colors;

/// Heights, three times each.
pub(crate) struct Heights;

impl Sight for Colors {
    type Values = [TexelLanes; 3];

    fn read(&self, crossing: &Crossing) -> Self::Values {
        crossing.colors()
    }

    #[inline(always)]
    fn between(&self, [near, far]: [&Self::Values; 2], part: TexelLanes) -> [TexelLanes; 3] {
        std::array::from_fn(|i| near[i] + (far[i] - near[i]) * part)
    }
}

impl Sight for Heights {
    type Values = TexelLanes;

    fn read(&self, crossing: &Crossing) -> Self::Values {
        crossing.height()
    }

    #[inline(always)]
    fn between(&self, [near, far]: [&Self::Values; 2], part: TexelLanes) -> [TexelLanes; 3] {
        [*near + (*far - *near) * part; 3]
    }
}

/// Where eight lines, a texel apart, cross a row.
#[derive(Clone, Copy)]
pub(crate) struct Crossing<'a> {
    rows: &'a Rows,
    /// Whether rows run along v.
    pub(crate) is_turned: bool,
    /// The row of the endless pattern, and the column of the first line's texel.
    row: i32,
    column: i32,
    /// Where lines lie between their texels and the next ones.
    part: f32,
    /// Blue and height.
    blue_height: u32x8,
}

impl Crossing<'_> {
    /// Linear colours, in stored units.
    pub(crate) fn colors(&self) -> [TexelLanes; 3] {
        let red_green = self.blended(0);
        [low_half(red_green), high_half(red_green), low_half(self.blue_height)]
    }

    /// Heights, in stored units.
    pub(crate) fn height(&self) -> TexelLanes {
        high_half(self.blue_height)
    }

    /// Normals, of any length.
    pub(crate) fn normals(&self) -> [TexelLanes; 3] {
        if !self.rows.has_normals() {
            return [TexelLanes::ZERO, TexelLanes::ZERO, TexelLanes::ONE];
        }
        let [near, far] = self.both(self.rows, 2).map(unpack_normals);
        std::array::from_fn(|i| self.mix(near[i], far[i]))
    }

    /// The words of the texels before and after each line in a plane of rows of the same size.
    pub(crate) fn both(&self, rows: &Rows, plane: usize) -> [u32x8; 2] {
        let words = rows.row(self.row);
        let start = rows.run_start(self.column) + plane * rows.stride();
        [Rows::run(words, start), Rows::run(words, start + 1)]
    }

    /// Both halves of the words of a plane of the surface's own rows, between texels.
    fn blended(&self, plane: usize) -> u32x8 {
        Blend::new(TexelLanes::splat(self.part)).mix(self.both(self.rows, plane))
    }

    /// Between what texels before and after each line say.
    pub(crate) fn mix(&self, near: TexelLanes, far: TexelLanes) -> TexelLanes {
        near + (far - near) * self.part
    }

    /// Where lines lie between the two.
    pub(crate) fn part(&self) -> TexelLanes {
        TexelLanes::splat(self.part)
    }
}

/// How a surface is seen.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Base texels down to the deepest relief.
    pub displacement: [f32; 2],
    /// The depth of the plane, 0 to 1, on which an image has its places.
    pub plane: f32,
}

/// The image of `surface` seen in a view, swept on a mip level, in an image of `size`, which is at
/// most the level's.
pub(crate) fn seen_image(
    surface: &Surface,
    sight: &impl Sight,
    level: usize,
    size: [usize; 2],
    view: View,
) -> SeenImage {
    let [du, dv] = view.displacement;
    let source = &surface.levels()[level];
    let [to, from] = [source, surface.base()].map(|level| level.size().map(|n| n as f32));
    let (du, dv) = (du * (to[0] / from[0]), dv * (to[1] / from[1]));
    // Rows are walked along the longer axis, so that lines shift by at most a texel from one row to
    // the next. The level has a copy turned for that.
    let is_turned = du.abs() > dv.abs();
    let rows = source.rows(is_turned);
    let mut sweep = if is_turned {
        Sweep::new((rows, sight, true), [dv, du], view.plane, [size[1], size[0]])
    } else {
        Sweep::new((rows, sight, false), [du, dv], view.plane, size)
    };
    for first in (0..sweep.rows.width()).step_by(8) {
        sweep.lines(first);
    }
    let mean =
        |sum: &[f32; 4]| [0, 1, 2].map(|i| sum[i] / (sum[3].max(f32::MIN_POSITIVE) * FULL_F32));
    if !is_turned {
        return sweep.sums.iter().map(mean).collect();
    }
    (0..size[0] * size[1]).map(|i| mean(&sweep.sums[i % size[0] * size[1] + i / size[0]])).collect()
}

/// The mean depth of what is seen of `surface` along displacements, 0 to 1, in images of `size`
/// swept on a mip level: what is seen of a deep part counts by its size on the screen.
pub fn seen_depth(
    surface: &Surface,
    level: usize,
    size: [usize; 2],
    displacements: &[[f32; 2]],
) -> f32 {
    // A mean over a whole repeat is the same on any plane.
    let plane = surface.mean_depth();
    let sum_of = |&displacement: &[f32; 2]| {
        let image = seen_image(surface, &Heights, level, size, View { displacement, plane });
        image.iter().map(|[height, ..]| f64::from(1.0 - height)).sum::<f64>() / image.len() as f64
    };
    let sum: f64 = displacements.iter().map(sum_of).sum();
    (sum / displacements.len() as f64) as f32
}

/// The mean square of the differences of two images.
pub fn square_difference(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
    let square =
        |(a, b): (&[f32; 3], &[f32; 3])| (0..3).map(|c| (a[c] - b[c]) * (a[c] - b[c])).sum::<f32>();
    a.iter().zip(b).map(square).sum::<f32>() / (3 * a.len()) as f32
}

/// A sweep over one whole level: rows along y, lines as lanes.
struct Sweep<'a, S: Sight> {
    rows: &'a Rows,
    sight: &'a S,
    is_turned: bool,
    toward: f32,
    depth: f32,
    shear: f32,
    plane: f32,
    size: [usize; 2],
    /// Image texels per texel of the level.
    scale: [f32; 2],
    /// Values times length, and length, of what fell into each texel.
    sums: Vec<[f32; 4]>,
}

impl<'a, S: Sight> Sweep<'a, S> {
    fn new(
        (rows, sight, is_turned): (&'a Rows, &'a S, bool),
        [dx, dy]: [f32; 2],
        plane: f32,
        size: [usize; 2],
    ) -> Self {
        let shear = if dy == 0.0 { 0.0 } else { dx / dy };
        let scale = [size[0] as f32 / rows.width() as f32, size[1] as f32 / rows.height() as f32];
        let toward = if dy < 0.0 { -1.0 } else { 1.0 };
        let sums = vec![[0.0; 4]; size[0] * size[1]];
        Self { rows, sight, is_turned, toward, depth: dy.abs(), shear, plane, size, scale, sums }
    }

    /// Walks eight lines over one period of the pattern, after a walk that finds what hides its
    /// beginning.
    fn lines(&mut self, first: usize) {
        let num_rows = self.rows.height() as i32;
        let lead = (self.depth.ceil() as i32 + 1).min(num_rows);
        let num_lines = (self.rows.width() - first).min(8);
        let (mut near, mut near_place) = self.cross(first, -lead);
        let mut horizon = near_place;
        // What is seen of one period: between the record at its beginning and the same a period on.
        let (begin, end) = (-self.depth * self.plane, num_rows as f32 - self.depth * self.plane);
        let last = num_rows + self.depth as i32 + 1;
        // Most rows are hidden, and not read.
        let mut read = None;
        for i in 1 - lead..=last {
            let (row, place) = self.cross(first, i);
            // Lanes beyond the last line set no record.
            let records = place.simd_gt(horizon).to_bitmask() & ((1 << num_lines) - 1);
            let seen = (records != 0).then(|| self.sight.read(&row));
            if let Some(seen) = &seen {
                let from = horizon.fast_max(TexelLanes::splat(begin));
                let to = place.fast_min(TexelLanes::splat(end));
                let before = read.unwrap_or_else(|| self.sight.read(&near));
                self.add(first, [from, to], ([near_place, place], [&before, seen]), records);
                horizon = horizon.fast_max(place);
                // From the period's end on, all records are those of the next one.
                if horizon.simd_ge(TexelLanes::splat(end)).all() {
                    return;
                }
            }
            (near, near_place, read) = (row, place, seen);
        }
    }

    /// The lines in the i-th row of the walk, and their projected places.
    fn cross(&self, first: usize, i: i32) -> (Crossing<'a>, TexelLanes) {
        let eta = i as f32 * self.toward;
        let x = first as f32 + self.shear * eta;
        let left = x.floor();
        let (row, column) = (eta as i32, left as i32);
        let (rows, is_turned, part) = (self.rows, self.is_turned, x - left);
        let blue_height = u32x8::ZERO;
        let mut crossing = Crossing { rows, is_turned, row, column, part, blue_height };
        // Most rows are hidden: nothing else is read of them.
        crossing.blue_height = crossing.blended(1);
        let depth = TexelLanes::ONE - crossing.height() * (1.0 / FULL_F32);
        (crossing, TexelLanes::splat(i as f32) - depth * self.depth)
    }

    /// Adds the parts from `from` to `to` of the segments between two rows, where there is a
    /// record.
    fn add(
        &mut self,
        first: usize,
        [from, to]: [TexelLanes; 2],
        ([near, far], values): ([TexelLanes; 2], [&S::Values; 2]),
        records: u32,
    ) {
        let inverse = TexelLanes::ONE / (far - near).fast_max(TexelLanes::splat(LEAST_SEGMENT));
        let line = lane_columns(first as i32);
        // Most parts are short and fall into one texel; a long one is cut into parts shorter than a
        // texel.
        let longest = ((to - from) * self.scale[1]).to_array();
        let longest = (0..8)
            .filter(|lane| records >> lane & 1 == 1)
            .map(|lane| longest[lane])
            .fold(0.0, f32::max);
        let num_parts = (longest * 2.0) as i32 + 1;
        let length = (to - from) * (1.0 / num_parts as f32);
        for part in 0..num_parts {
            let middle = from + length * (part as f32 + 0.5);
            let at =
                ((middle - near) * inverse).fast_max(TexelLanes::ZERO).fast_min(TexelLanes::ONE);
            let [r, g, b] = self.sight.between(values, at).map(|value| value * length);
            let eta = (middle + self.depth * self.plane) * self.toward;
            // Texel centres lie at whole numbers.
            let x = ((line + eta * self.shear + 0.5) * self.scale[0])
                .floor()
                .fast_trunc_int()
                .to_array();
            let y = ((eta + 0.5) * self.scale[1]).floor().fast_trunc_int().to_array();
            let sums = [r, g, b, length].map(TexelLanes::to_array);
            // Add lane by lane: lines may fall into one texel, which lanes could not add to at
            // once.
            let mut left = records;
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                if sums[3][lane] > 0.0 {
                    let place = wrap_index(Wrap::Repeat, y[lane], self.size[1]) * self.size[0]
                        + wrap_index(Wrap::Repeat, x[lane], self.size[0]);
                    self.sums[place]
                        .iter_mut()
                        .zip(&sums)
                        .for_each(|(sum, lanes)| *sum += lanes[lane]);
                }
            }
        }
    }
}
