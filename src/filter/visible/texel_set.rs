//! A set of texels of one mip level, row by row: the paper's T, `T_vis`, and what lies between.
//!
//! Rows hold runs of eight neighbouring texels, a bit each, so that membership and visibility are
//! decided a batch at a time and the sums visit only batches that hold a texel. A texel's place is
//! its column and row in the endless pattern.

use super::bounds::Bounds;
use crate::footprint::{Ellipse, RowQuadric};
use crate::simd::{TexelLanes, lane_columns};

/// One row of a [`TexelSet`].
#[derive(Clone, Copy, Debug)]
pub struct TexelRow {
    /// The row in the endless pattern.
    pub y: i32,
    /// The column of the first batch's first texel.
    pub x: i32,
    /// Where the row's batches begin in the set, and how many there are.
    pub batches: [usize; 2],
}

/// A set of texels. Kept between pixels, so that it allocates only while it grows.
#[derive(Clone, Debug, Default)]
pub struct TexelSet {
    /// Rows that may hold texels.
    pub rows: Vec<TexelRow>,
    /// A bit a texel, a byte a batch.
    pub bits: Vec<u8>,
    /// For [`remove_hidden`](super::remove_hidden), which fills it.
    pub(super) bounds: Bounds,
}

impl TexelSet {
    /// Makes this the set T: texels whose centre lies in the ellipse around `center`, given in
    /// texels.
    pub fn fill_ellipse(&mut self, ellipse: &Ellipse, center: [f32; 2]) {
        self.rows.clear();
        self.bits.clear();
        // Texel centres lie at halves.
        let [x0, y0] = center.map(|c| c - 0.5);
        let half_height = ellipse.half_height();
        // Put so that a NaN, too, leaves the set empty.
        if !(half_height < 1e6 && ellipse.f > 0.0) {
            return;
        }
        for y in (y0 - half_height).ceil() as i32..=(y0 + half_height).floor() as i32 {
            let v = y as f32 - y0;
            let Some([left, right]) = ellipse.row(v) else { continue };
            // One more at each end: the lanes decide.
            let (first, last) = ((x0 + left).floor() as i32, (x0 + right).ceil() as i32);
            let num = (last - first) as usize / 8 + 1;
            self.rows.push(TexelRow { y, x: first, batches: [self.bits.len(), num] });
            let quadric = RowQuadric::new(ellipse, v);
            self.bits.extend((0..num as i32).map(|i| {
                let r2 = quadric.at(lane_columns(first + 8 * i) - x0);
                r2.simd_le(TexelLanes::ONE).to_bitmask() as u8
            }));
        }
    }

    /// Whether the set holds no texel.
    pub fn is_empty(&self) -> bool {
        self.bits.iter().all(|&bits| bits == 0)
    }

    /// How many texels the set holds.
    pub fn len(&self) -> usize {
        self.bits.iter().map(|bits| bits.count_ones() as usize).sum()
    }

    /// Whether the set holds a texel.
    pub fn contains(&self, x: i32, y: i32) -> bool {
        place(&self.rows, [x, y]).is_some_and(|(byte, bit)| self.bits[byte] & bit != 0)
    }

    /// All texels of the set, row by row.
    pub fn iter(&self) -> impl Iterator<Item = [i32; 2]> + '_ {
        texels(&self.rows, &self.bits)
    }
}

/// The byte and bit of a texel, if a batch of the rows spans it.
pub(super) fn place(rows: &[TexelRow], [x, y]: [i32; 2]) -> Option<(usize, u8)> {
    let row = &rows[rows.binary_search_by_key(&y, |row| row.y).ok()?];
    let column = usize::try_from(x - row.x).ok()?;
    (column / 8 < row.batches[1]).then(|| (row.batches[0] + column / 8, 1 << (column % 8)))
}

/// The texels of rows whose bits are set, row by row.
pub(super) fn texels(rows: &[TexelRow], bits: &[u8]) -> impl Iterator<Item = [i32; 2]> {
    rows.iter().flat_map(move |row| {
        let [first, num] = row.batches;
        (0..8 * num)
            .filter(move |i| bits[first + i / 8] >> (i % 8) & 1 == 1)
            .map(|i| [row.x + i as i32, row.y])
    })
}
