//! Which triangles may be seen in which tile.
//!
//! The triangles' chunks are split into groups; each group sorts its own triangles by tile with two
//! passes, one that counts and one that fills, into one flat list. A tile reads its part of group
//! after group, which is the triangles' order, so neither groups nor threads show.

use super::edge::Edges;
use super::grid::{TileGrid, bounds};
use crate::geometry::{Geometry, ScreenTriangle};
use rayon::prelude::*;

/// Groups a thread: more balance better and cost `4 * num_tiles` bytes each.
const GROUPS_PER_THREAD: usize = 2;

/// Marks a triangle that touches several tiles.
const MANY: u32 = u32::MAX;

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
        // Count each tile's triangles one place up, so that sums over the counts are beginnings.
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
        // `starts[tile]` is moved on to the tile's end while filling, and set back by one tile
        // after.
        self.triangles.resize(sum as usize, 0);
        let all = chunks.flat_map(|chunk| geometry.chunk(chunk));
        for ((index, triangle), &only) in all.zip(&self.tiles) {
            let mut add = |tile: usize| {
                self.triangles[self.starts[tile] as usize] = index;
                self.starts[tile] += 1;
            };
            // The first pass kept the tile of a triangle that lies in just one; the others' ranges
            // are found again, so that four bytes a triangle do.
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
        // An empty box ends before it begins, so that loops over its tiles find none.
        let last = [0, 1].map(|i| {
            if is_empty { first[i] - 1 } else { (bounds.max[i] - 1 - grid.area.min[i]) >> shift }
        });
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
        // Up to two tiles a side go by the box alone: a triangle listed too often costs time, but
        // changes no pixel.
        if last[0] - first[0] <= 1 && last[1] - first[1] <= 1 {
            (first[1]..=last[1])
                .for_each(|y| (first[0]..=last[0]).for_each(|x| found(self.tile(x, y))));
            return;
        }
        // The corners of the box around all samples stand for them.
        let [least, most] = grid.offset_bounds;
        let edges = Edges::<4>::new(
            &triangle.corners,
            &[[least; 2], [most, least], [least, most], [most; 2]],
        );
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
        // No more groups than chunks: none is empty, and without chunks nothing is divided by 0.
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
}
