//! The two by two texels of a level around each of eight places.
//!
//! Neighbouring pixels look at neighbouring texels. So a row is read once for all places near one
//! of them, sixteen words of it, and every place picks its own by a shuffle. Without a shuffle
//! instruction each place is read by itself, to the same bits.

use crate::simd::{self, i32x8, join_words, u32x8, u32x16};
use crate::texture::Rows;

/// One plane's words at eight places: the eight texels to the left of each, then the eight to the
/// right.
#[derive(Clone, Copy, Default)]
pub(super) struct Corners {
    pub(super) above: u32x16,
    pub(super) below: u32x16,
}

/// How far left of a place's texel the words begin that its neighbours pick from, and how many rows
/// above it.
const BEFORE: i32 = 7;
const ABOVE: i32 = 8;

/// The first two planes' texels at columns `x` and `x + 1`, rows `y` and `y + 1` of the endless
/// pattern, within 2^30.
#[inline(always)]
pub(super) fn corners(texels: &Rows, x: i32x8, y: i32x8) -> [Corners; 2] {
    if !simd::HAS_SHUFFLE {
        return one_by_one(texels, x, y);
    }
    let first = [x.as_array()[0] - BEFORE, y.as_array()[0] - ABOVE];
    let (columns, rows) = (x - i32x8::splat(first[0]), y - i32x8::splat(first[1]));
    // The last of sixteen columns and of 32 rows is left for the texels to the right and below.
    if (beyond(columns, 14) | beyond(rows, 30)).to_bitmask() == 0 {
        picked(texels, first, simd::as_unsigned(columns), simd::as_unsigned(rows))
    } else {
        row_by_row(texels, x, y)
    }
}

/// A sign for every place that is not within 0 to `most`.
#[inline(always)]
fn beyond(places: i32x8, most: i32) -> i32x8 {
    places | (i32x8::splat(most) - places)
}

/// All places pick from the same columns: those 0 to 15, and rows 0 to 31, from the first word on.
#[inline(always)]
fn picked(texels: &Rows, first: [i32; 2], columns: u32x8, rows: u32x8) -> [Corners; 2] {
    let numbers = join_words([columns, columns + 1]);
    // Mark the rows that any place needs: two neighbouring bits each.
    let needed = (u32x8::splat(3) << rows).to_array().into_iter().fold(0, |all, bits| all | bits);
    let top = needed.trailing_zeros();
    let num_rows = 32 - needed.leading_zeros() - top;
    let (mut starts, column) =
        (texels.row_starts(first[1] + top as i32), texels.run_start(first[0]));
    // Rows down to the one of each place.
    let mut down = join_words([rows, rows]) - u32x16::splat(top);
    let mut corners = [Corners::default(); 2];
    for _ in 0..num_rows {
        // One row past a place its count has wrapped around: that row is the lower one.
        let places = [down.simd_eq(u32x16::ZERO), down.simd_eq(u32x16::splat(u32::MAX))];
        take(
            &texels.words()[starts.next() + column..],
            texels.stride(),
            numbers,
            places,
            &mut corners,
        );
        down -= u32x16::ONE;
    }
    corners
}

/// Of a row's words, those with the given numbers, for the places whose row, or whose next row, it
/// is.
#[inline(always)]
fn take(
    row: &[u32],
    stride: usize,
    numbers: u32x16,
    [is_above, is_below]: [u32x16; 2],
    corners: &mut [Corners; 2],
) {
    // One check for both planes.
    let row = &row[..stride + 16];
    for (plane, corners) in corners.iter_mut().enumerate() {
        let words = simd::pick(Rows::long_run(row, plane * stride), numbers);
        corners.above = is_above.bitselect(words, corners.above);
        corners.below = is_below.bitselect(words, corners.below);
    }
}

/// Places of a row pick from columns of their own, such as those of pixels that lie along a slanted
/// footprint.
#[inline(never)]
fn row_by_row(texels: &Rows, x: i32x8, y: i32x8) -> [Corners; 2] {
    let mut corners = [Corners::default(); 2];
    // Bits of the places whose row, and whose next row, has not been read.
    let mut left = [u8::MAX; 2];
    while left != [0; 2] {
        let place = (left[0] | left[1]).trailing_zeros() as usize;
        // Take the upper row of the first place that waits, or else its lower one, and serve all
        // other places that it reaches.
        let row = y.as_array()[place] + i32::from(left[0] >> place & 1 == 0);
        let first = x.as_array()[place] - BEFORE;
        let columns = x - i32x8::splat(first);
        let is_near = !(beyond(columns, 14).to_bitmask() as u8);
        let of_row =
            [row, row - 1].map(|row| y.simd_eq(i32x8::splat(row)).to_bitmask() as u8 & is_near);
        // Places that are not near pick anything within bounds: they are left out below.
        let columns = simd::as_unsigned(columns) & u32x8::splat(15);
        let numbers = join_words([columns, columns + 1]);
        let [is_above, is_below] = of_row.map(|places| join_words([simd::bits(places); 2]));
        let words = &texels.words()[texels.start_at(first, row)..];
        take(words, texels.stride(), numbers, [is_above, is_below], &mut corners);
        left = [left[0] & !of_row[0], left[1] & !of_row[1]];
    }
    corners
}

#[inline(never)]
fn one_by_one(texels: &Rows, x: i32x8, y: i32x8) -> [Corners; 2] {
    let mut found = [[[0; 16]; 2]; 2];
    for lane in 0..8 {
        let start = texels.run_start(x.as_array()[lane]);
        for row in 0..2 {
            let start = start + texels.row_start(y.as_array()[lane] + row as i32);
            let words = &texels.words()[start..start + texels.stride() + 2];
            for (plane, found) in found.iter_mut().enumerate() {
                let at = plane * texels.stride();
                (found[row][lane], found[row][lane + 8]) = (words[at], words[at + 1]);
            }
        }
    }
    found.map(|[above, below]| Corners { above: u32x16::new(above), below: u32x16::new(below) })
}
