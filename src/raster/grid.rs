//! The tiles of a frame.
//!
//! ```text
//!   frame    +-------+-------+---+    tile: one task, its own pixels
//!            | block |       |   |    block of shading: 16x16 pixels, shaded together by material
//!            |   +---+       |   |    block of coverage: 8x8 pixels, one row is eight lanes
//!            +---+---+-------+---+    quad: 2x2 pixels, on even columns and rows
//! ```

use super::edge::{BLOCK, Rect};
use crate::geometry::{ScreenTriangle, offset_bounds};
use crate::settings::{Region, Settings};

/// Side of a block of shading in pixels; blocks lie on multiples of it in the frame.
pub const SHADED_BLOCK: usize = 16;

/// What a part of a frame is widened to: blocks of coverage and of shading lie where they do in the
/// whole frame.
const ALIGNED: i32 = if SHADED_BLOCK as i32 > BLOCK { SHADED_BLOCK as i32 } else { BLOCK };

/// The tiles of a frame, or of a part of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileGrid {
    /// Side of a tile in pixels: that of a block of shading at least.
    pub tile_size: i32,
    /// Columns and rows of tiles.
    pub num_tiles: [i32; 2],
    /// The pixels that the tiles cover: the region of the settings, widened to whole blocks within
    /// the frame.
    pub area: Rect,
    /// Least and largest offset of a sample from its pixel's corner in 1/256 pixel.
    pub offset_bounds: [i32; 2],
}

impl TileGrid {
    /// The tiles that cover what `settings` draw.
    pub fn new(settings: &Settings) -> Self {
        let Region { x, y, width, height } = settings.drawn();
        let frame = [settings.width as i32, settings.height as i32];
        // `ALIGNED` is a power of two, so masks round down to multiples of it.
        let ends = [x + width, y + height].map(|end| (end as i32 + ALIGNED - 1) & -ALIGNED);
        let area = Rect {
            min: [x, y].map(|v| v as i32 & -ALIGNED),
            max: [0, 1].map(|i| ends[i].min(frame[i])),
        };
        // What a block of shading sees of a material is drawn at once.
        let tile_size = settings.tile_size.max(SHADED_BLOCK as u32) as i32;
        let num_tiles = area.size().map(|s| (s + tile_size - 1) / tile_size);
        Self { tile_size, num_tiles, area, offset_bounds: offset_bounds(settings.msaa) }
    }

    /// The pixels of a tile that lie in the area; tiles count from the left, row by row.
    pub fn rect(&self, tile: usize) -> Rect {
        let tile = tile as i32;
        let place = [tile % self.num_tiles[0], tile / self.num_tiles[0]];
        let min = [0, 1].map(|i| self.area.min[i] + place[i] * self.tile_size);
        Rect { min, max: [0, 1].map(|i| (min[i] + self.tile_size).min(self.area.max[i])) }
    }

    /// How many tiles there are.
    pub fn num(&self) -> usize {
        self.num_tiles[0] as usize * self.num_tiles[1] as usize
    }
}

/// The pixels within `rect` of which a sample may lie in the triangle's bounding box; empty ones
/// have `max <= min`. `least` and `most` bound the samples' offsets.
#[inline]
pub(super) fn bounds(triangle: &ScreenTriangle, rect: &Rect, [least, most]: [i32; 2]) -> Rect {
    let [a, b, c] = triangle.corners;
    let mut bounds = *rect;
    for i in 0..2 {
        let (min, max) = (a[i].min(b[i]).min(c[i]), a[i].max(b[i]).max(c[i]));
        // The first pixel is the one whose last sample reaches the box, the last one that whose
        // first sample does.
        bounds.min[i] = bounds.min[i].max((min - most + 255) >> 8);
        bounds.max[i] = bounds.max[i].min(((max - least) >> 8) + 1);
    }
    bounds
}
