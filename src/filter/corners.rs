//! The two by two texels of a level around each of eight places.
//!
//! Neighbouring pixels look at neighbouring texels. So the rows that eight places need are read once, sixteen words of each,
//! and every place picks its own by a shuffle; places that lie too far apart for that are read one by one, to the same bits.

use crate::simd::{self, i32x8, join_words, u32x8, u32x16};
use crate::texture::Level;

/// One plane's words at eight places: the eight texels to the left of each, then the eight to the right.
#[derive(Clone, Copy)]
pub(super) struct Corners {
    pub(super) above: u32x16,
    pub(super) below: u32x16,
}

/// How far left of the first place's texel the words begin that all places pick from, and how many rows above it.
const BEFORE: i32 = 7;
const ABOVE: i32 = 8;

/// The first two planes' texels at columns `x` and `x + 1`, rows `y` and `y + 1` of the endless pattern, within 2^30.
#[inline(always)]
pub(super) fn corners(level: &Level, x: i32x8, y: i32x8) -> [Corners; 2] {
    let first = [x.as_array()[0] - BEFORE, y.as_array()[0] - ABOVE];
    let (columns, rows) = (x - i32x8::splat(first[0]), y - i32x8::splat(first[1]));
    // A place whose column and the next are not among 16 words, or whose rows are not among 32 bits, has a sign somewhere.
    let beyond = columns | (i32x8::splat(14) - columns) | rows | (i32x8::splat(30) - rows);
    if simd::HAS_SHUFFLE && !beyond.simd_lt(i32x8::ZERO).any() {
        picked(level, first, simd::as_unsigned(columns), simd::as_unsigned(rows))
    } else {
        one_by_one(level, x, y)
    }
}

#[inline(always)]
fn picked(level: &Level, [x, y]: [i32; 2], columns: u32x8, rows: u32x8) -> [Corners; 2] {
    let numbers = join_words([columns, columns + 1]);
    let mut needed = (u32x8::splat(3) << rows).to_array().into_iter().fold(0, |all, bits| all | bits);
    let rows = join_words([rows, rows]);
    let (start, stride) = (level.run_start(x), level.stride());
    let mut corners = [Corners { above: u32x16::ZERO, below: u32x16::ZERO }; 2];
    while needed != 0 {
        let row = needed.trailing_zeros();
        needed &= needed - 1;
        let is_above = rows.simd_eq(u32x16::splat(row));
        let is_below = rows.simd_eq(u32x16::splat(row.wrapping_sub(1)));
        let start = level.row_start(y + row as i32) + start;
        for (plane, corners) in corners.iter_mut().enumerate() {
            let words = simd::pick(level.words(), start + plane * stride, numbers);
            corners.above = is_above.bitselect(words, corners.above);
            corners.below = is_below.bitselect(words, corners.below);
        }
    }
    corners
}

#[inline(never)]
fn one_by_one(level: &Level, x: i32x8, y: i32x8) -> [Corners; 2] {
    let mut found = [[[0; 16]; 2]; 2];
    for lane in 0..8 {
        let start = level.run_start(x.as_array()[lane]);
        for row in 0..2 {
            let start = start + level.row_start(y.as_array()[lane] + row as i32);
            let words = &level.words()[start..start + level.stride() + 2];
            for (plane, found) in found.iter_mut().enumerate() {
                let at = plane * level.stride();
                (found[row][lane], found[row][lane + 8]) = (words[at], words[at + 1]);
            }
        }
    }
    found.map(|[above, below]| Corners { above: u32x16::new(above), below: u32x16::new(below) })
}
