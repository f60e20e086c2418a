//! Visibility to quads: each triangle that a 2x2 quad of pixels sees is listed once, with its
//! coverage.
//!
//! Quads start on even columns and rows of the frame. Those of one quad come in the order of their
//! triangles, so that a pixel's sum does not depend on the tiling.

use super::grid::SHADED_BLOCK;
use super::tile::{NONE, VisibilityBuffer};
use crate::simd::u32x8;

/// A triangle seen in a quad.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SeenQuad {
    /// The triangle's local index, later its slot among the tile's seen triangles.
    pub(super) triangle: u32,
    /// Column and row of the quad's upper left pixel within the tile.
    pub(super) origin: [u16; 2],
    /// How many samples of each pixel see the triangle, lane `2 * dy + dx`.
    pub(super) coverage: [u8; 4],
    /// The triangle's group, when it is known.
    pub(super) group: u32,
}

/// Rows of a part of a block: each is as wide as a lane vector, and neighbours in the list are
/// neighbours on the screen.
const PART: usize = 8;

/// Lists what `buffer` sees, block by block, part by part and quad by quad.
pub(super) fn gather<const S: usize>(buffer: &VisibilityBuffer, seen: &mut Vec<SeenQuad>) {
    seen.clear();
    let [num_columns, num_rows] = buffer.size();
    for (column, start) in parts(num_columns, num_rows) {
        for row in (start..num_rows.min(start + PART)).step_by(2) {
            let pixels: [[u32x8; 2]; S] = std::array::from_fn(|s| {
                [buffer.triangles(s, column, row), buffer.triangles(s, column, row + 1)]
            });
            // Find out whether all samples of the four quads see the same: `xor` leaves bits where
            // a lane differs from the first.
            let first = pixels[0][0].as_array()[0];
            let differs = pixels
                .iter()
                .flatten()
                .fold(u32x8::ZERO, |all, p| all | (*p ^ u32x8::splat(first)));
            let origin = |quad: usize| [(column * PART + quad * 2) as u16, row as u16];
            if differs != u32x8::ZERO {
                (0..4).for_each(|quad| gather_quad(&pixels, quad, origin(quad), seen));
            } else if first != NONE {
                // Four whole quads of one triangle: nothing to sort and nothing to count.
                let whole = |quad| SeenQuad {
                    triangle: first,
                    origin: origin(quad),
                    coverage: [S as u8; 4],
                    group: 0,
                };
                seen.extend((0..4).map(whole));
            }
        }
    }
}

/// The lane column and the first row of each part, block by block.
fn parts(num_columns: usize, num_rows: usize) -> impl Iterator<Item = (usize, usize)> {
    const ACROSS: usize = SHADED_BLOCK / PART;
    let [blocks_across, blocks_down] =
        [num_columns, num_rows.div_ceil(PART)].map(|parts| parts.div_ceil(ACROSS));
    // All parts of a block come before the next block, so that a block is one run of the list.
    (0..blocks_across * blocks_down * ACROSS * ACROSS)
        .map(move |i| {
            let (block, part) = (i / (ACROSS * ACROSS), i % (ACROSS * ACROSS));
            let [column, row] = [block % blocks_across, block / blocks_across].map(|c| c * ACROSS);
            (column + part % ACROSS, (row + part / ACROSS) * PART)
        })
        // Blocks at the right and the lower edge may hold parts beyond the tile.
        .filter(move |&(column, row)| column < num_columns && row < num_rows)
}

/// Lists the triangles of one quad of two rows of eight pixels, in order.
#[inline(always)]
fn gather_quad<const S: usize>(
    pixels: &[[u32x8; 2]; S],
    quad: usize,
    origin: [u16; 2],
    seen: &mut Vec<SeenQuad>,
) {
    let start = seen.len();
    for rows in pixels {
        for lane in 0..4 {
            let triangle = rows[lane >> 1].as_array()[quad * 2 + (lane & 1)];
            if triangle == NONE {
                continue;
            }
            // Insert in the triangles' order. The quad has at most 32 samples, and so the walk back
            // from the end is short.
            let mut at = seen.len();
            while at > start && seen[at - 1].triangle > triangle {
                at -= 1;
            }
            if at == start || seen[at - 1].triangle != triangle {
                seen.insert(at, SeenQuad { triangle, origin, coverage: [0; 4], group: 0 });
                at += 1;
            }
            seen[at - 1].coverage[lane] += 1;
        }
    }
}
