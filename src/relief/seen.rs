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

/// See [`Seen::Shining`].
type Shown<'a> = &'a (dyn Fn([[TexelLanes; 3]; 2], u32x8) -> [TexelLanes; 3] + Sync);

/// What is seen.
#[derive(Clone, Copy)]
pub(crate) enum Seen<'a> {
    /// Linear colours, 0 to 1 of the surface's scale.
    Colors,
    /// What texels show, 0 or more, by their colours and normals and, where rows of the same size say more of
    /// them, by the word of the nearest.
    Shining(Shown<'a>, Option<&'a Rows>),
    /// Heights, 0 to 1, three times each.
    Heights,
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
    seen: Seen<'_>,
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
        Sweep::new((rows, seen), [dv, du], view.plane, [size[1], size[0]])
    } else {
        Sweep::new((rows, seen), [du, dv], view.plane, size)
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
        let image = seen_image(surface, Seen::Heights, level, size, View { displacement, plane });
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
struct Sweep<'a> {
    rows: &'a Rows,
    seen: Seen<'a>,
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

/// The eight lines in one row.
#[derive(Clone, Copy)]
struct Row {
    place: TexelLanes,
    values: [TexelLanes; 3],
}

impl<'a> Sweep<'a> {
    fn new(
        (rows, seen): (&'a Rows, Seen<'a>),
        [dx, dy]: [f32; 2],
        plane: f32,
        size: [usize; 2],
    ) -> Self {
        let shear = if dy == 0.0 { 0.0 } else { dx / dy };
        let scale = [size[0] as f32 / rows.width() as f32, size[1] as f32 / rows.height() as f32];
        let toward = if dy < 0.0 { -1.0 } else { 1.0 };
        let sums = vec![[0.0; 4]; size[0] * size[1]];
        Self { rows, seen, toward, depth: dy.abs(), shear, plane, size, scale, sums }
    }

    /// Walks eight lines over one period of the pattern, after a walk that finds what hides its
    /// beginning.
    fn lines(&mut self, first: usize) {
        let num_rows = self.rows.height() as i32;
        let lead = (self.depth.ceil() as i32 + 1).min(num_rows);
        let num_lines = (self.rows.width() - first).min(8);
        let mut previous = self.row(first, -lead);
        let mut horizon = previous.place;
        // What is seen of one period: between the record at its beginning and the same a period on.
        let (begin, end) = (-self.depth * self.plane, num_rows as f32 - self.depth * self.plane);
        let last = num_rows + self.depth as i32 + 1;
        for i in 1 - lead..=last {
            let row = self.row(first, i);
            // Lanes beyond the last line set no record.
            let records = row.place.simd_gt(horizon).to_bitmask() & ((1 << num_lines) - 1);
            if records != 0 {
                let from = horizon.fast_max(TexelLanes::splat(begin));
                let to = row.place.fast_min(TexelLanes::splat(end));
                self.add(first, [from, to], [&previous, &row], records);
                horizon = horizon.fast_max(row.place);
                // From the period's end on, all records are those of the next one.
                if horizon.simd_ge(TexelLanes::splat(end)).all() {
                    return;
                }
            }
            previous = row;
        }
    }

    /// Projected places and values of the lines in the i-th row of the walk.
    fn row(&self, first: usize, i: i32) -> Row {
        let eta = i as f32 * self.toward;
        let words = self.rows.row(eta as i32);
        let x = first as f32 + self.shear * eta;
        let left = x.floor();
        let start = self.rows.run_start(left as i32);
        let blend = Blend::new(TexelLanes::splat(x - left));
        let both = |plane: usize| {
            let start = start + plane * self.rows.stride();
            [Rows::run(words, start), Rows::run(words, start + 1)]
        };
        let pick = |plane: usize| blend.mix(both(plane));
        let (red_green, blue_height) = (pick(0), pick(1));
        let height = high_half(blue_height);
        let depth = TexelLanes::ONE - height * (1.0 / FULL_F32);
        let colors = || [low_half(red_green), high_half(red_green), low_half(blue_height)];
        let values = match self.seen {
            Seen::Colors => colors(),
            Seen::Shining(shown, others) => {
                let normal = if self.rows.has_normals() {
                    let [near, far] = both(2).map(unpack_normals);
                    [0, 1, 2].map(|i| near[i] + (far[i] - near[i]) * (x - left))
                } else {
                    [TexelLanes::ZERO, TexelLanes::ZERO, TexelLanes::ONE]
                };
                let nearest = i32::from(x - left >= 0.5);
                let word = others.map_or(u32x8::ZERO, |rows| {
                    Rows::run(rows.row(eta as i32), rows.run_start(left as i32 + nearest))
                });
                shown([colors(), normal], word)
            }
            Seen::Heights => [height; 3],
        };
        Row { place: TexelLanes::splat(i as f32) - depth * self.depth, values }
    }

    /// Adds the parts from `from` to `to` of the segments between two rows, where there is a
    /// record.
    fn add(
        &mut self,
        first: usize,
        [from, to]: [TexelLanes; 2],
        [near, far]: [&Row; 2],
        records: u32,
    ) {
        let inverse =
            TexelLanes::ONE / (far.place - near.place).fast_max(TexelLanes::splat(LEAST_SEGMENT));
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
            let at = ((middle - near.place) * inverse)
                .fast_max(TexelLanes::ZERO)
                .fast_min(TexelLanes::ONE);
            let value =
                |i: usize| (near.values[i] + (far.values[i] - near.values[i]) * at) * length;
            let eta = (middle + self.depth * self.plane) * self.toward;
            // Texel centres lie at whole numbers.
            let x = ((line + eta * self.shear + 0.5) * self.scale[0])
                .floor()
                .fast_trunc_int()
                .to_array();
            let y = ((eta + 0.5) * self.scale[1]).floor().fast_trunc_int().to_array();
            let sums = [value(0), value(1), value(2), length].map(TexelLanes::to_array);
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
