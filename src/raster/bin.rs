//! Which triangles may be seen in which tile.
//!
//! The triangles' chunks are split into groups; each group sorts its own triangles by tile with two passes, one that counts
//! and one that fills, into one flat list. A tile reads its part of group after group, which is the triangles' order, so
//! neither groups nor threads show.

use super::block::SHADED_BLOCK;
use super::edge::{BLOCK, Edges, Rect};
use crate::geometry::{Geometry, ScreenTriangle, offset_bounds, sample_offsets};
use crate::settings::{Region, Settings};
use rayon::prelude::*;

/// Groups a thread: more balance better and cost `4 * num_tiles` bytes each.
const GROUPS_PER_THREAD: usize = 2;

/// Not one tile alone.
const MANY: u32 = u32::MAX;

/// What a part of a frame is widened to: blocks of coverage and of shading lie where they do in the whole frame.
const ALIGNED: i32 = if SHADED_BLOCK as i32 > BLOCK { SHADED_BLOCK as i32 } else { BLOCK };

/// The tiles of a frame, or of a part of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileGrid {
    /// Side of a tile in pixels: that of a block of shading at least.
    pub tile_size: i32,
    /// Columns and rows of tiles.
    pub num_tiles: [i32; 2],
    /// The pixels that the tiles cover: the region of the settings, widened to whole blocks within the frame.
    pub area: Rect,
    /// Least and largest offset of a sample from its pixel's corner in 1/256 pixel.
    pub offset_bounds: [i32; 2],
}

impl TileGrid {
    /// The tiles that cover what `settings` draw.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        let Region { x, y, width, height } = settings.drawn();
        let frame = [settings.width as i32, settings.height as i32];
        let ends = [x + width, y + height].map(|end| (end as i32 + ALIGNED - 1) & -ALIGNED);
        let area = Rect { min: [x, y].map(|v| v as i32 & -ALIGNED), max: [0, 1].map(|i| ends[i].min(frame[i])) };
        // What a block of shading sees of a material is drawn at once.
        let tile_size = settings.tile_size.max(SHADED_BLOCK as u32) as i32;
        let num_tiles = area.size().map(|s| (s + tile_size - 1) / tile_size);
        Self { tile_size, num_tiles, area, offset_bounds: offset_bounds(settings.msaa) }
    }

    /// The pixels of a tile that lie in the area; tiles count from the left, row by row.
    #[must_use]
    pub fn rect(&self, tile: usize) -> Rect {
        let tile = tile as i32;
        let place = [tile % self.num_tiles[0], tile / self.num_tiles[0]];
        let min = [0, 1].map(|i| self.area.min[i] + place[i] * self.tile_size);
        Rect { min, max: [0, 1].map(|i| (min[i] + self.tile_size).min(self.area.max[i])) }
    }

    /// How many tiles there are.
    #[must_use]
    pub fn num(&self) -> usize {
        self.num_tiles[0] as usize * self.num_tiles[1] as usize
    }
}

/// The pixels within `rect` of which a sample may lie in the triangle's bounding box; empty ones have `max <= min`.
/// `least` and `most` bound the samples' offsets.
#[inline]
pub(super) fn bounds(triangle: &ScreenTriangle, rect: &Rect, [least, most]: [i32; 2]) -> Rect {
    let [a, b, c] = triangle.corners;
    let mut bounds = *rect;
    for i in 0..2 {
        let (min, max) = (a[i].min(b[i]).min(c[i]), a[i].max(b[i]).max(c[i]));
        bounds.min[i] = bounds.min[i].max((min - most + 255) >> 8);
        bounds.max[i] = bounds.max[i].min(((max - least) >> 8) + 1);
    }
    bounds
}

/// The triangles of a run of chunks by tile.
#[derive(Clone, Debug, Default)]
struct Group {
    /// Where each tile's part of `triangles` begins, and the end.
    starts: Vec<u32>,
    triangles: Vec<u32>,
    /// The only tile of each triangle, or [`MANY`].
    tiles: Vec<u32>,
}

impl Group {
    fn fill(&mut self, geometry: &Geometry, chunks: std::ops::Range<usize>, grid: &TileGrid) {
        self.starts.clear();
        self.starts.resize(grid.num() + 1, 0);
        self.tiles.clear();
        self.tiles.reserve_exact(chunks.clone().map(|chunk| geometry.chunk(chunk).len()).sum());
        for (_, triangle) in chunks.clone().flat_map(|chunk| geometry.chunk(chunk)) {
            let range = TileRange::new(triangle, grid);
            self.tiles.push(range.only());
            range.for_each(triangle, grid, |tile| self.starts[tile + 1] += 1);
        }
        let mut sum = 0;
        for start in &mut self.starts {
            sum += *start;
            *start = sum;
        }
        // `starts[tile]` is moved on to the tile's end while filling, and set back by one tile after.
        self.triangles.resize(sum as usize, 0);
        let all = chunks.flat_map(|chunk| geometry.chunk(chunk));
        for ((index, triangle), &only) in all.zip(&self.tiles) {
            let mut add = |tile: usize| {
                self.triangles[self.starts[tile] as usize] = index;
                self.starts[tile] += 1;
            };
            if only == MANY {
                TileRange::new(triangle, grid).for_each(triangle, grid, add);
            } else {
                add(only as usize);
            }
        }
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }
}

/// The tiles that a triangle's bounding box touches.
struct TileRange {
    first: [i32; 2],
    last: [i32; 2],
    columns: i32,
}

impl TileRange {
    #[inline(always)]
    fn new(triangle: &ScreenTriangle, grid: &TileGrid) -> Self {
        let bounds = bounds(triangle, &grid.area, grid.offset_bounds);
        let shift = grid.tile_size.trailing_zeros();
        let is_empty = bounds.min[0] >= bounds.max[0] || bounds.min[1] >= bounds.max[1];
        let first = [0, 1].map(|i| (bounds.min[i] - grid.area.min[i]) >> shift);
        let last =
            [0, 1].map(|i| if is_empty { first[i] - 1 } else { (bounds.max[i] - 1 - grid.area.min[i]) >> shift });
        Self { first, last, columns: grid.num_tiles[0] }
    }

    #[inline(always)]
    fn tile(&self, x: i32, y: i32) -> usize {
        (y * self.columns + x) as usize
    }

    /// The only tile, or [`MANY`] if there is not just one.
    #[inline(always)]
    fn only(&self) -> u32 {
        if self.first == self.last { self.tile(self.first[0], self.first[1]) as u32 } else { MANY }
    }

    /// The tiles that the triangle may be seen in, row by row.
    #[inline(always)]
    fn for_each(&self, triangle: &ScreenTriangle, grid: &TileGrid, mut found: impl FnMut(usize)) {
        let Self { first, last, .. } = *self;
        if last[0] - first[0] <= 1 && last[1] - first[1] <= 1 {
            (first[1]..=last[1]).for_each(|y| (first[0]..=last[0]).for_each(|x| found(self.tile(x, y))));
            return;
        }
        // The corners of the box around all samples stand for them.
        let [least, most] = grid.offset_bounds;
        let edges = Edges::<4>::new(&triangle.corners, &[[least; 2], [most, least], [least, most], [most; 2]]);
        for y in first[1]..=last[1] {
            for x in first[0]..=last[0] {
                if !edges.misses(&grid.rect(self.tile(x, y))) {
                    found(self.tile(x, y));
                }
            }
        }
    }
}

/// The triangles of a frame by tile. Keeps its buffers between frames.
#[derive(Clone, Debug, Default)]
pub struct Bins {
    groups: Vec<Group>,
}

impl Bins {
    /// Sorts the triangles of `geometry` into the tiles of `grid`.
    pub fn fill(&mut self, geometry: &Geometry, grid: &TileGrid) {
        let num_chunks = geometry.num_chunks();
        let num_groups = num_chunks.min(rayon::current_num_threads() * GROUPS_PER_THREAD);
        self.groups.resize_with(num_groups, Group::default);
        self.groups.par_iter_mut().enumerate().for_each(|(i, group)| {
            let chunks = i * num_chunks / num_groups..(i + 1) * num_chunks / num_groups;
            group.fill(geometry, chunks, grid);
        });
    }

    /// Appends the indices of the triangles of a tile, in order.
    pub fn list(&self, tile: usize, triangles: &mut Vec<u32>) {
        for group in &self.groups {
            let [start, end] = [group.starts[tile], group.starts[tile + 1]];
            triangles.extend_from_slice(&group.triangles[start as usize..end as usize]);
        }
    }

    /// How many entries all tiles hold together.
    #[must_use]
    pub fn num_entries(&self) -> usize {
        self.groups.iter().map(|group| group.triangles.len()).sum()
    }
}

/// How often each pixel's samples are covered, without depth: a sum over the samples of each pixel of the grid's area,
/// cut off at 255. What tests of coverage look at, and what shows overdraw.
#[must_use]
pub fn hit_counts(geometry: &Geometry, settings: &Settings) -> Vec<u8> {
    match settings.msaa {
        8 => count_hits::<8>(geometry, settings),
        4 => count_hits::<4>(geometry, settings),
        _ => count_hits::<1>(geometry, settings),
    }
}

fn count_hits<const S: usize>(geometry: &Geometry, settings: &Settings) -> Vec<u8> {
    let grid = TileGrid::new(settings);
    let mut bins = Bins::default();
    bins.fill(geometry, &grid);
    let [width, height] = grid.area.size().map(|side| side as usize);
    let mut counts = vec![0_u8; width * height];
    let mut list = Vec::new();
    for tile in 0..grid.num() {
        list.clear();
        bins.list(tile, &mut list);
        let rect = grid.rect(tile);
        for &index in &list {
            let triangle = geometry.triangle(index);
            let edges = Edges::<S>::new(&triangle.corners, sample_offsets(settings.msaa));
            edges.cover(&bounds(triangle, &rect, grid.offset_bounds), &mut |row| {
                let [x, y] = [row.x - grid.area.min[0], row.y - grid.area.min[1]].map(|v| v as usize);
                let start = y * width + x;
                let num = (rect.max[0] - row.x).min(8) as usize;
                for (count, is_covered) in counts[start..start + num].iter_mut().zip(row.mask.to_array()) {
                    *count = count.saturating_add((is_covered & 1) as u8);
                }
            });
        }
    }
    counts
}
