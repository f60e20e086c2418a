//! Visibility of one tile: which triangle each sample sees, by depth.
//!
//! The buffers hold, sample by sample and row by row, eight pixels a lane vector: the greatest
//! nearness, and the triangle's *local index*, its place in the tile's list. Lists are in the triangles'
//! order, so the smaller local index is the earlier triangle, and it stays where depths are equal.
//! All pieces of a clipped triangle go by the first one's index.

use super::edge::{Edges, Rect, Row};
use super::grid::bounds;
use super::small::SmallEdges;
use crate::geometry::{Geometry, Plane, ScreenTriangle, offset_bounds, sample_offsets};
use crate::simd::{f32x8, i32x8, lane_indices, u32x8};

/// No triangle.
pub(super) const NONE: u32 = u32::MAX;
/// Farther than any triangle: a floor's nearness may round to 0 or below at its horizon.
pub(super) const FARTHEST: f32 = f32::NEG_INFINITY;

/// What each sample of a tile sees.
#[derive(Clone, Debug, Default)]
pub(super) struct VisibilityBuffer {
    origin: [i32; 2],
    /// Lane vectors a row, and rows.
    num_columns: usize,
    num_rows: usize,
    pub(super) nearness: Vec<f32x8>,
    pub(super) triangles: Vec<u32x8>,
    /// Depth of the farthest sample when last scanned; anything behind it is hidden: [`FARTHEST`]
    /// while a sample sees nothing.
    hidden: f32,
}

/// Triangles of a tile after which what they hide is looked for, again after twice as many, and so
/// on.
const FIRST_LOOK: usize = 32;

/// What nearness may be off by as a sample has it and as a corner has it, as a share of the plane's
/// terms.
const ROUNDING: f32 = 1.0 / (1 << 20) as f32;

impl VisibilityBuffer {
    /// Draws the triangles of `list` on the pixels of `rect`.
    pub(super) fn draw<const S: usize>(&mut self, geometry: &Geometry, list: &[u32], rect: &Rect) {
        self.clear(S, rect);
        let (mut last, mut last_index) = ((u32::MAX, u32::MAX), 0);
        for (index, &triangle) in list.iter().enumerate() {
            let triangle = geometry.triangle(triangle);
            // Pieces of a triangle follow each other.
            if (triangle.mesh, triangle.triangle) != last {
                (last, last_index) = ((triangle.mesh, triangle.triangle), index as u32);
            }
            if index >= FIRST_LOOK {
                // A look reads the whole tile. At doubling counts even a long list pays for few.
                if index.is_power_of_two() {
                    self.hidden = self.farthest();
                }
                if self.hides(triangle) {
                    continue;
                }
            }
            self.draw_triangle::<S>(triangle, last_index, rect);
        }
        self.clear_beyond(S, rect);
    }

    fn clear(&mut self, num_samples: usize, rect: &Rect) {
        self.origin = rect.min;
        self.num_columns = (rect.max[0] - rect.min[0] + 7) as usize / 8;
        // Quads read two rows.
        self.num_rows = (rect.max[1] - rect.min[1] + 1) as usize & !1;
        let num = self.num_columns * self.num_rows * num_samples;
        self.nearness.clear();
        self.nearness.resize(num, f32x8::splat(FARTHEST));
        self.triangles.clear();
        self.triangles.resize(num, u32x8::splat(NONE));
        self.hidden = FARTHEST;
    }

    /// The least nearness that is stored.
    #[inline(never)]
    fn farthest(&self) -> f32 {
        let least = self
            .nearness
            .iter()
            .fold(f32x8::splat(f32::INFINITY), |least, row| least.fast_min(*row));
        least.to_array().into_iter().fold(f32::INFINITY, f32::min)
    }

    /// Whether nothing of a triangle can be seen; it may say no where that is so.
    #[inline(always)]
    fn hides(&self, triangle: &ScreenTriangle) -> bool {
        let [dx, dy, constant] = triangle.depth;
        let [a, b, c] = triangle.corners.map(|corner| corner.map(|c| c as f32 * (1.0 / 256.0)));
        // No sample of the triangle has larger terms.
        let [x, y] = [0, 1].map(|i| a[i].abs().max(b[i].abs()).max(c[i].abs()));
        let rounding = (x * dx.abs() + y * dy.abs() + constant.abs()) * ROUNDING;
        // A plane is nearest at a corner.
        [a, b, c].into_iter().all(|[x, y]| x * dx + y * dy + constant + rounding < self.hidden)
    }

    /// Takes back what whole lane vectors drew to the right of the frame.
    fn clear_beyond(&mut self, num_samples: usize, rect: &Rect) {
        let num_inside = (rect.max[0] - rect.min[0]) % 8;
        if num_inside == 0 {
            return;
        }
        // `NONE` has all bits set, so `or` clears a lane, and 0 leaves one as it is.
        let is_beyond: [u32; 8] =
            std::array::from_fn(|lane| if lane as i32 >= num_inside { NONE } else { 0 });
        for row in 1..=self.num_rows * num_samples {
            let last = &mut self.triangles[row * self.num_columns - 1];
            *last |= u32x8::new(is_beyond);
        }
    }

    #[inline]
    fn draw_triangle<const S: usize>(
        &mut self,
        triangle: &ScreenTriangle,
        index: u32,
        rect: &Rect,
    ) {
        let index = u32x8::splat(index);
        cover::<S>(triangle, &bounds(triangle, rect, offset_bounds(S as u32)), &mut |row: Row| {
            let (at, nearness) = self.row::<S>(&row, triangle.depth);
            self.test(at, nearness, row.mask, index);
        });
    }

    /// Where the samples of a row of eight pixels are kept, and the nearness of a plane there.
    #[inline(always)]
    pub(super) fn row<const S: usize>(
        &self,
        row: &Row,
        [dx, dy, constant]: Plane,
    ) -> (usize, f32x8) {
        let offset = sample_offsets(S as u32)[row.sample];
        let [offset_x, offset_y] = offset.map(|offset| offset as f32 * (1.0 / 256.0));
        // Places count from the frame's corner and not from the tile's: the same bits of depth
        // whatever the tiling.
        let x = lane_indices() + f32x8::splat(row.x as f32 + offset_x);
        let y = row.y as f32 + offset_y;
        let nearness = x * f32x8::splat(dx) + f32x8::splat(y * dy) + f32x8::splat(constant);
        let column = (row.x - self.origin[0]) as usize / 8;
        (self.at(row.sample, column, (row.y - self.origin[1]) as usize), nearness)
    }

    /// Where on the screen, in pixels, a lane of the samples lies that are kept at an index.
    pub(super) fn place<const S: usize>(&self, at: usize, lane: usize) -> [f64; 2] {
        let offset = sample_offsets(S as u32)[at / self.num_columns / self.num_rows];
        let corner = self.corner(at, lane);
        [0, 1].map(|i| corner[i] + f64::from(offset[i]) / 256.0)
    }

    /// The upper left corner of that lane's pixel.
    pub(super) fn corner(&self, at: usize, lane: usize) -> [f64; 2] {
        let (row, column) = (at / self.num_columns, at % self.num_columns);
        let pixel = [8 * column + lane, row % self.num_rows];
        [0, 1].map(|i| f64::from(self.origin[i]) + pixel[i] as f64)
    }

    /// Keeps the nearer of what is stored and what is drawn.
    #[inline(always)]
    fn test(&mut self, at: usize, nearness: f32x8, mask: i32x8, index: u32x8) {
        let (stored, triangle) = (&mut self.nearness[at], &mut self.triangles[at]);
        // At equal depths the earlier triangle stays. Selected by bits: no branch to guess wrong.
        let is_nearer = nearness.simd_gt(*stored).to_bits() & mask.cast_unsigned();
        *stored = f32x8::from_bits(is_nearer).bitselect(nearness, *stored);
        *triangle = is_nearer.bitselect(index, *triangle);
    }

    #[inline(always)]
    fn at(&self, sample: usize, column: usize, row: usize) -> usize {
        (sample * self.num_rows + row) * self.num_columns + column
    }

    /// Lane vectors a row, and rows (an even number).
    pub(super) fn size(&self) -> [usize; 2] {
        [self.num_columns, self.num_rows]
    }

    /// The nearness that eight pixels of a row see at a sample; below any number where that is nothing.
    #[inline(always)]
    pub(super) fn nearness(&self, sample: usize, column: usize, row: usize) -> f32x8 {
        self.nearness[self.at(sample, column, row)]
    }

    /// Local indices of the triangles that eight pixels of a row see at a sample, or [`NONE`].
    #[inline(always)]
    pub(super) fn triangles(&self, sample: usize, column: usize, row: usize) -> u32x8 {
        self.triangles[self.at(sample, column, row)]
    }
}

/// Calls `sink` for the rows of eight pixels within `bounds` of which a sample may be covered. Most
/// triangles are small, and what [`Edges`] prepares would take longer than their rows themselves.
#[inline(always)]
pub(super) fn cover<const S: usize>(
    triangle: &ScreenTriangle,
    bounds: &Rect,
    sink: &mut impl FnMut(Row),
) {
    let offsets = sample_offsets(S as u32);
    if SmallEdges::suit(&triangle.corners) {
        SmallEdges::new(&triangle.corners).cover(offsets, bounds, sink);
    } else {
        Edges::<S>::new(&triangle.corners, offsets).cover(bounds, sink);
    }
}
