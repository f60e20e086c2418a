//! What the centres of a frame's pixels see: depth and triangles as they are, quads with their
//! attributes where those are asked for. Nothing is shaded, and nothing is summed.

use super::block::QuadBlock;
use super::draw::{Drawn, Painter, Rasterizer, Shade, rows_by_tile};
use super::edge::Rect;
use super::gather::gather;
use super::grid::TileGrid;
use super::quad::QuadPair;
use super::scratch::Scratch;
use super::tile::NONE;
use crate::frame::{Development, Pixel};
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

/// What is asked of the centres of pixels.
#[derive(Clone, Copy)]
pub struct Centers<'a, T> {
    /// What is drawn; `msaa` of its settings is 1.
    pub drawn: Drawn<'a>,
    /// Whether quads are listed.
    pub has_quads: bool,
    /// Takes what a tile sees, with the band of its row.
    pub see: &'a (dyn Fn(&CenterTile, &mut T) + Sync),
}

impl Rasterizer {
    /// Finds what the centres of pixels see, tile by tile. `bands` has one for each row of the
    /// [grid](TileGrid) of the settings.
    pub fn see_centers<T: Send>(
        &mut self,
        geometry: &Geometry,
        centers: Centers<T>,
        bands: &mut [T],
    ) {
        let drawn = centers.drawn;
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
                    scratch.list.clear();
                    painter.bins.list(tile, &mut scratch.list);
                    if !scratch.list.is_empty() {
                        painter.see_samples::<1>(&grid.rect(tile), scratch);
                        painter.see_tile(tile, &centers, (scratch, band));
                    }
                }
            },
        );
    }

    /// [`Self::draw`], and [`Self::see_centers`] of the same frame: a pixel's only sample is its
    /// centre, so what tiles see is found once. Both are drawn by the same settings, but for what
    /// attributes there are.
    pub fn draw_and_see<P: Pixel, T: Send>(
        &mut self,
        geometry: &Geometry,
        (drawn, shade): (Drawn, Shade),
        pixels: &mut [P],
        centers: Centers<T>,
        bands: &mut [T],
    ) {
        let grid = TileGrid::new(drawn.settings);
        self.bins.fill(geometry, &grid);
        let clock = &|| 0.0;
        let painter = Painter { geometry, drawn, grid, bins: &self.bins, clock };
        let seer = Painter { drawn: centers.drawn, ..painter };
        let development = Development::of(drawn.settings, P::IS_PICTURE);
        let scratches = &self.scratches;
        let mut rows = rows_by_tile(pixels, &grid);
        let [tile_size, across] = [grid.tile_size, grid.num_tiles[0]].map(|num| num as usize);
        let bands = bands.par_iter_mut().zip(rows.par_chunks_mut(across * tile_size));
        bands.enumerate().for_each_init(
            || scratches.take(),
            |scratch, (row, (band, rows))| {
                for (column, rows) in rows.chunks_mut(tile_size).enumerate() {
                    let tile = row * across + column;
                    painter.paint(tile, rows, scratch, (shade, &development));
                    // What the tile's samples see stands in the scratch still.
                    if !scratch.list.is_empty() {
                        seer.see_tile(tile, &centers, (scratch, band));
                    }
                }
            },
        );
    }
}

impl Painter<'_> {
    /// Hands on what a tile's samples see, which has been found.
    fn see_tile<T>(
        &self,
        tile: usize,
        &Centers { has_quads, see, .. }: &Centers<T>,
        (scratch, band): (&mut Scratch, &mut T),
    ) {
        let rect = self.grid.rect(tile);
        scratch.quads.clear();
        if has_quads {
            gather::<1>(&scratch.visibility, &mut scratch.quads);
            self.find_planes(scratch);
            // The stable sort keeps the order of places.
            scratch.quads.sort_by_key(|quad| quad.group);
        }
        see(&CenterTile { rect, geometry: self.geometry, scratch }, band);
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
