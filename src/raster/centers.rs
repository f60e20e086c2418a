//! What the centres of a frame's pixels see: depth and triangles as they are, quads with their
//! attributes where those are asked for. Nothing is shaded, and nothing is summed.

use super::block::QuadBlock;
use super::draw::{Drawn, Painter, Rasterizer};
use super::edge::Rect;
use super::gather::gather;
use super::grid::TileGrid;
use super::quad::QuadPair;
use super::scratch::Scratch;
use super::tile::NONE;
use crate::geometry::Geometry;
use crate::simd::{PixelLanes, u32x8};
use rayon::prelude::*;

/// A tile as the centres of its pixels see it.
pub struct CenterTile<'a> {
    rect: Rect,
    geometry: &'a Geometry,
    scratch: &'a Scratch,
}

/// Eight pixels of a row.
#[derive(Clone, Copy, Debug)]
pub struct CenterRow {
    /// Column of the first pixel.
    pub x: i32,
    /// Row of the pixels.
    pub y: i32,
    /// A bit for each pixel that sees a triangle.
    pub seen: u8,
    /// Distance along the view to the triangle, above 0 and finite where one is seen.
    pub w: PixelLanes,
    triangles: u32x8,
}

impl Rasterizer {
    /// Finds what the centres of pixels see, tile by tile, and hands it to `see`. `bands` has one
    /// for each row of the [grid](TileGrid) of the settings, whose `msaa` must be 1. Quads are only
    /// listed where `has_quads` asks for them.
    pub fn see_centers<T: Send>(
        &mut self,
        geometry: &Geometry,
        (drawn, has_quads): (Drawn, bool),
        bands: &mut [T],
        see: &(impl Fn(&CenterTile, &mut T) + Sync),
    ) {
        let grid = TileGrid::new(drawn.settings);
        self.bins.fill(geometry, &grid);
        let clock = &|| 0.0;
        let painter = Painter { geometry, drawn, grid, bins: &self.bins, clock };
        let scratches = &self.scratches;
        bands.par_iter_mut().enumerate().for_each_init(
            || scratches.take(),
            |scratch, (row, band)| {
                let across = grid.num_tiles[0] as usize;
                for tile in row * across..(row + 1) * across {
                    painter.see_center_tile(tile, has_quads, scratch, &mut |tile| see(tile, band));
                }
            },
        );
    }
}

impl Painter<'_> {
    fn see_center_tile(
        &self,
        tile: usize,
        has_quads: bool,
        scratch: &mut Scratch,
        see: &mut dyn FnMut(&CenterTile),
    ) {
        scratch.list.clear();
        self.bins.list(tile, &mut scratch.list);
        if scratch.list.is_empty() {
            return;
        }
        let rect = self.grid.rect(tile);
        self.see_samples::<1>(&rect, scratch);
        scratch.quads.clear();
        if has_quads {
            gather::<1>(&scratch.visibility, &mut scratch.quads);
            self.find_planes(scratch);
            // The stable sort keeps the order of places.
            scratch.quads.sort_by_key(|quad| quad.group);
        }
        see(&CenterTile { rect, geometry: self.geometry, scratch });
    }
}

impl<'a> CenterTile<'a> {
    /// The rows of eight pixels that see something, from the top.
    pub fn rows(&self) -> impl Iterator<Item = CenterRow> {
        let [num_columns, _] = self.scratch.visibility.size();
        let num_rows = (self.rect.max[1] - self.rect.min[1]) as usize;
        (0..num_rows)
            .flat_map(move |row| (0..num_columns).map(move |column| self.row(column, row)))
            .filter(|row| row.seen != 0)
    }

    #[inline(always)]
    fn row(&self, column: usize, row: usize) -> CenterRow {
        let visibility = &self.scratch.visibility;
        let triangles = visibility.triangles(0, column, row);
        CenterRow {
            x: self.rect.min[0] + 8 * column as i32,
            y: self.rect.min[1] + row as i32,
            seen: !(triangles.simd_eq(u32x8::splat(NONE)).to_bitmask() as u8),
            w: self.geometry.projection().distance(visibility.nearness(0, column, row)),
            triangles,
        }
    }

    /// Indices of mesh and triangle that pixels of a row see; those that see nothing stay as they
    /// are.
    #[inline(always)]
    pub fn names(&self, row: &CenterRow, names: &mut [[u32; 2]; 8]) {
        for (name, &local) in names.iter_mut().zip(row.triangles.as_array()) {
            if local != NONE {
                let triangle = self.geometry.triangle(self.scratch.list[local as usize]);
                *name = [triangle.mesh, triangle.triangle];
            }
        }
    }

    /// Distances along the view at the pixels of a pair that see a triangle, as in [`Self::rows`].
    pub fn distances(&self, pair: &QuadPair) -> PixelLanes {
        let mut distances = PixelLanes::ONE;
        for lane in pair.covered() {
            let [x, y] = [0, 1].map(|i| (pair.pixel(lane)[i] - self.rect.min[i]) as usize);
            distances.as_mut_array()[lane] = self.row(x / 8, y).w.as_array()[x % 8];
        }
        distances
    }

    /// The quads that see something, material by material.
    pub fn blocks(&self) -> impl Iterator<Item = QuadBlock<'a>> {
        let Scratch { quads, planes, grounds, .. } = self.scratch;
        let tile = self.rect.min;
        quads.chunk_by(|a, b| a.group == b.group).map(move |quads| {
            let [material, group] = grounds[quads[0].triangle as usize].map(|index| index as usize);
            QuadBlock { material, group, tile, quads, planes }
        })
    }
}
