//! A frame tile by tile: visibility, quads, shading, and the sum of colours.
//!
//! Each tile owns its rows of the frame, so tiles run in parallel without locks. What a tile needs while it is drawn lies in
//! a [`Scratch`], taken from a pool and given back, so a steady frame allocates nothing for tiles or triangles.

use super::bin::{Bins, TileGrid};
use super::edge::Rect;
use super::gather::{SeenQuad, gather};
use super::quad::{AttributePlanes, QuadPair};
use super::scratch::{Borrowed, Scratch};
use super::tile::NONE;
use crate::frame::Frame;
use crate::geometry::Geometry;
use crate::scene::Scene;
use crate::settings::Settings;
use crate::simd::PixelLanes;
use rayon::prelude::*;
use std::sync::Mutex;

/// Linear RGB, premultiplied by the fourth component, the opacity.
type Pixel = [f32; 4];

/// What was drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RasterStats {
    /// Screen triangles that were left after culling and clipping; a clipped one may count as several.
    pub triangles_drawn: u64,
    /// Pixels shaded: once for each triangle that a sample of the pixel sees.
    pub pixels_shaded: u64,
}

/// Draws frames, and keeps its buffers between them.
#[derive(Debug, Default)]
pub struct Rasterizer {
    bins: Bins,
    scratches: Mutex<Vec<Scratch>>,
}

/// Draws one frame; see [`Rasterizer::draw`].
pub fn draw(
    geometry: &Geometry,
    scene: &Scene,
    settings: &Settings,
    shade: &(impl Fn(&QuadPair) -> [PixelLanes; 3] + Sync),
    frame: &mut Frame,
) -> RasterStats {
    Rasterizer::default().draw(geometry, scene, settings, shade, frame)
}

impl Rasterizer {
    /// Draws the triangles of `geometry`, which must have been projected from `scene` under `settings`. `shade` gives the
    /// linear red, green and blue of eight pixels; each lane's result must depend on that lane's quad only. The frame is
    /// resized to the settings and overwritten.
    pub fn draw(
        &mut self,
        geometry: &Geometry,
        scene: &Scene,
        settings: &Settings,
        shade: &(impl Fn(&QuadPair) -> [PixelLanes; 3] + Sync),
        frame: &mut Frame,
    ) -> RasterStats {
        let grid = TileGrid::new(settings);
        self.bins.fill(geometry, &grid);
        (frame.width, frame.height) = (settings.width, settings.height);
        frame.pixels.resize(settings.width as usize * settings.height as usize, Pixel::default());
        let painter = Painter { geometry, scene, settings, grid, bins: &self.bins };
        let scratches = &self.scratches;
        let mut rows = rows_by_tile(frame, &grid);
        let pixels_shaded = rows
            .par_chunks_mut(grid.tile_size as usize)
            .enumerate()
            .map_init(
                || Borrowed::new(scratches),
                |scratch, (tile, rows)| painter.paint(tile, rows, scratch.get(), shade),
            )
            .sum();
        RasterStats { triangles_drawn: geometry.num_triangles() as u64, pixels_shaded }
    }
}

/// The frame's rows cut into tiles: `tile_size` slices a tile, tile after tile; empty ones below the frame's last row.
fn rows_by_tile<'a>(frame: &'a mut Frame, grid: &TileGrid) -> Vec<&'a mut [Pixel]> {
    let (width, tile_size) = (frame.width as usize, grid.tile_size as usize);
    let mut slices = Vec::with_capacity(grid.num() * tile_size);
    let mut rows = Vec::with_capacity(tile_size);
    for band in frame.pixels.chunks_mut(width * tile_size) {
        rows.clear();
        rows.extend(band.chunks_mut(width).map(|row| row.chunks_mut(tile_size)));
        for _ in 0..grid.num_tiles[0] {
            slices.extend(rows.iter_mut().filter_map(Iterator::next));
            slices.extend((rows.len()..tile_size).map(|_| Default::default()));
        }
    }
    slices
}

/// What all tiles share.
struct Painter<'a> {
    geometry: &'a Geometry,
    scene: &'a Scene,
    settings: &'a Settings,
    grid: TileGrid,
    bins: &'a Bins,
}

impl Painter<'_> {
    /// Draws a tile; gives how many pixels were shaded.
    fn paint(
        &self,
        tile: usize,
        rows: &mut [&mut [Pixel]],
        scratch: &mut Scratch,
        shade: &(impl Fn(&QuadPair) -> [PixelLanes; 3] + Sync),
    ) -> u64 {
        let rect = self.grid.rect(tile);
        scratch.list.clear();
        self.bins.list(tile, &mut scratch.list);
        rows.iter_mut().for_each(|row| row.fill(Pixel::default()));
        if scratch.list.is_empty() {
            self.add_background(rows);
            return 0;
        }
        self.see(&rect, scratch);
        self.find_planes(scratch);
        let num_shaded = self.shade_quads(&rect, rows, scratch, shade);
        if !self.is_full(&rect, &scratch.quads) {
            self.add_background(rows);
        }
        num_shaded
    }

    /// Lists the quads that the tile sees.
    fn see(&self, rect: &Rect, Scratch { list, visibility, quads, .. }: &mut Scratch) {
        match self.settings.msaa {
            8 => {
                visibility.draw::<8>(self.geometry, list, rect);
                gather::<8>(visibility, quads);
            }
            4 => {
                visibility.draw::<4>(self.geometry, list, rect);
                gather::<4>(visibility, quads);
            }
            _ => {
                visibility.draw::<1>(self.geometry, list, rect);
                gather::<1>(visibility, quads);
            }
        }
    }

    /// Makes the attribute planes of the triangles seen, and the order of the quads by material.
    fn find_planes(&self, scratch: &mut Scratch) {
        let Scratch { list, quads, slots, planes, materials, order, .. } = scratch;
        slots.clear();
        slots.resize(list.len(), NONE);
        materials.clear();
        order.clear();
        for (place, quad) in quads.iter_mut().enumerate() {
            let slot = &mut slots[quad.triangle as usize];
            if *slot == NONE {
                *slot = materials.len() as u32;
                if planes.len() == materials.len() {
                    planes.push(AttributePlanes::default());
                }
                let triangle = self.geometry.triangle(list[quad.triangle as usize]);
                planes[materials.len()].set(self.geometry, triangle, self.scene, self.settings);
                materials.push(self.scene.meshes[triangle.mesh as usize].material as u32);
            }
            quad.triangle = *slot;
            order.push(u64::from(materials[*slot as usize]) << 32 | place as u64);
        }
        // Places are unique, so the unstable sort (which does not allocate) is a stable one by material.
        order.sort_unstable();
    }

    /// Shades the quads two by two and adds their colours to the pixels.
    fn shade_quads(
        &self,
        rect: &Rect,
        rows: &mut [&mut [Pixel]],
        scratch: &Scratch,
        shade: &(impl Fn(&QuadPair) -> [PixelLanes; 3] + Sync),
    ) -> u64 {
        let share = 1.0 / self.settings.msaa as f32;
        let mut num_shaded = 0;
        for run in scratch.order.chunk_by(|a, b| a >> 32 == b >> 32) {
            for pair in run.chunks(2) {
                let [first, second] = [pair[0], pair[pair.len() - 1]].map(|key| &scratch.quads[key as u32 as usize]);
                let mut coverage = [0; 8];
                coverage[..4].copy_from_slice(&first.coverage);
                if pair.len() == 2 {
                    coverage[4..].copy_from_slice(&second.coverage);
                }
                let places = [first, second].map(|quad| quad.origin);
                let origin = places.map(|[x, y]| [rect.min[0] + i32::from(x), rect.min[1] + i32::from(y)]);
                let planes = [first, second].map(|quad| &scratch.planes[quad.triangle as usize]);
                let colors = shade(&QuadPair::new((pair[0] >> 32) as usize, origin, coverage, planes));
                num_shaded += add(rows, places, &coverage, share, colors);
            }
        }
        num_shaded
    }

    /// Whether every sample of the tile sees a triangle.
    fn is_full(&self, rect: &Rect, quads: &[SeenQuad]) -> bool {
        let num_seen: u64 = quads.iter().flat_map(|quad| quad.coverage).map(u64::from).sum();
        let [width, height] = [0, 1].map(|i| (rect.max[i] - rect.min[i]) as u64);
        num_seen == width * height * u64::from(self.settings.msaa)
    }

    fn add_background(&self, rows: &mut [&mut [Pixel]]) {
        let [r, g, b, a] = self.scene.background;
        let background = [r * a, g * a, b * a, a];
        for pixel in rows.iter_mut().flat_map(|row| row.iter_mut()) {
            // Shares are multiples of 1/8 at least: their sum is exact.
            let left = 1.0 - pixel[3];
            if left > 0.0 {
                (0..4).for_each(|i| pixel[i] += background[i] * left);
            }
        }
    }
}

/// Adds the colours of two quads to the pixels, `share` for each sample; gives how many pixels took part.
#[inline]
fn add(
    rows: &mut [&mut [Pixel]],
    places: [[u16; 2]; 2],
    coverage: &[u8; 8],
    share: f32,
    colors: [PixelLanes; 3],
) -> u64 {
    let shares = PixelLanes::new(coverage.map(|count| f32::from(count) * share));
    let [r, g, b] = colors.map(|color| (color * shares).to_array());
    let shares = shares.to_array();
    let mut num = 0;
    for half in 0..4 {
        let [x, y] = places[half / 2].map(usize::from);
        // Below the frame's last row there may be none, or an empty one.
        let Some(row) = rows.get_mut(y + half % 2).and_then(|row| row.get_mut(x..)) else { continue };
        for (lane, pixel) in (half * 2..half * 2 + 2).zip(row) {
            if coverage[lane] > 0 {
                let color = [r[lane], g[lane], b[lane], shares[lane]];
                (0..4).for_each(|i| pixel[i] += color[i]);
                num += 1;
            }
        }
    }
    num
}
