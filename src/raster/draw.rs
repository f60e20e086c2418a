//! A frame tile by tile: visibility, quads, shading, and the sum of colours.
//!
//! Each tile owns its rows of the frame, so tiles run in parallel without locks. What a tile needs
//! while it is drawn lies in a [`Scratch`], taken from a pool and given back, so a steady frame
//! allocates nothing for tiles or triangles.

use super::attributes::PlaneMaker;
use super::behind::{Asked, Follow};
use super::bin::Bins;
use super::block::QuadBlock;
use super::edge::Rect;
use super::gather::{SeenQuad, gather};
use super::grid::{SHADED_BLOCK, TileGrid};
use super::pool::Pool;
use super::quad::{AttributePlanes, QuadPair};
use super::scratch::Scratch;
use super::tile::NONE;
use crate::frame::{Development, Frame, Pixel};
use crate::geometry::{Geometry, ScreenTriangle};
use crate::scene::Scene;
use crate::settings::Settings;
use crate::simd::PixelLanes;
use rayon::prelude::*;

/// What was drawn, and what it took. Times are in milliseconds, of all threads together but for
/// `binning_ms`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RasterStats {
    /// Screen triangles that were left after culling and clipping; a clipped one may count as
    /// several.
    pub triangles_drawn: u64,
    /// Pixels shaded: once for each triangle that a sample of the pixel sees.
    pub pixels_shaded: u64,
    /// Quads of 2x2 pixels shaded: once for each triangle that a sample of the quad sees.
    pub quads_shaded: u64,
    /// Listing the triangles of each tile, of the whole frame.
    pub binning_ms: f64,
    /// Coverage, depth and the quads that are seen.
    pub coverage_ms: f64,
    /// Attribute planes of the triangles that are seen.
    pub attributes_ms: f64,
    /// Shading, with the sum of its colours.
    pub shade_ms: f64,
}

impl RasterStats {
    fn add(self, other: Self) -> Self {
        Self {
            triangles_drawn: self.triangles_drawn + other.triangles_drawn,
            pixels_shaded: self.pixels_shaded + other.pixels_shaded,
            quads_shaded: self.quads_shaded + other.quads_shaded,
            binning_ms: self.binning_ms + other.binning_ms,
            coverage_ms: self.coverage_ms + other.coverage_ms,
            attributes_ms: self.attributes_ms + other.attributes_ms,
            shade_ms: self.shade_ms + other.shade_ms,
        }
    }
}

/// Draws frames, and keeps its buffers between them.
#[derive(Debug, Default)]
pub struct Rasterizer {
    pub(super) bins: Bins,
    pub(super) scratches: Pool<Scratch>,
}

/// Draws one frame, shaded pair by pair; see [`Rasterizer::draw`].
pub fn draw(
    geometry: &Geometry,
    scene: &Scene,
    settings: &Settings,
    shade: &(impl Fn(&QuadPair) -> [PixelLanes; 3] + Sync),
    frame: &mut Frame,
) -> RasterStats {
    let shade = |block: &QuadBlock, colors: &mut Vec<_>| {
        colors.extend(block.pairs().map(|pair| shade(&pair)));
    };
    let drawn = Drawn { scene, settings, group: None, follow: None };
    frame.fit(TileGrid::new(settings).area.size().map(|side| side as u32));
    Rasterizer::default().draw(geometry, drawn, &shade, &|| 0.0, &mut frame.pixels)
}

/// What is drawn, and how.
#[derive(Clone, Copy)]
pub struct Drawn<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The settings.
    pub settings: &'a Settings,
    /// A number for each triangle, by the index of its mesh and in it: quads of one number, which
    /// must be of one material, are shaded together. `None` for that of the material.
    pub group: Option<&'a (dyn Fn([u32; 2]) -> u32 + Sync)>,
    /// What follows rays behind polygons; `None` where all see their nearest polygon.
    pub follow: Option<&'a dyn Follow>,
}

/// Appends the linear red, green and blue of eight pixels for each pair of a block; they must depend
/// on that block only.
pub type Shade<'a> = &'a (dyn Fn(&QuadBlock, &mut Vec<[PixelLanes; 3]>) + Sync);

impl Rasterizer {
    /// Draws the triangles of `geometry`, which must have been projected from `scene` under
    /// `settings`. `clock` gives milliseconds. The pixels, row by row those of the
    /// [area](TileGrid::area) of the tiles, are overwritten.
    pub fn draw<P: Pixel>(
        &mut self,
        geometry: &Geometry,
        drawn: Drawn,
        shade: Shade,
        clock: &(dyn Fn() -> f64 + Sync),
        pixels: &mut [P],
    ) -> RasterStats {
        let grid = TileGrid::new(drawn.settings);
        let start = clock();
        self.bins.fill(geometry, &grid);
        let binning_ms = clock() - start;
        // Paint the tiles in parallel. Only times and counts come back to be summed, so the order
        // in which threads end shows nowhere in the picture.
        let painter = Painter { geometry, drawn, grid, bins: &self.bins, clock };
        let development = Development::of(drawn.settings, P::IS_PICTURE);
        let scratches = &self.scratches;
        let mut rows = rows_by_tile(pixels, &grid);
        let tiles = rows
            .par_chunks_mut(grid.tile_size as usize)
            .enumerate()
            .map_init(
                || scratches.take(),
                |scratch, (tile, rows)| painter.paint(tile, rows, scratch, (shade, &development)),
            )
            .reduce(RasterStats::default, RasterStats::add);
        RasterStats { triangles_drawn: geometry.num_triangles() as u64, binning_ms, ..tiles }
    }
}

/// The frame's rows cut into tiles: `tile_size` slices a tile, tile after tile; empty ones below
/// the frame's last row.
pub(super) fn rows_by_tile<'a, P>(pixels: &'a mut [P], grid: &TileGrid) -> Vec<&'a mut [P]> {
    let [width, height] = grid.area.size().map(|side| side as usize);
    assert_eq!(pixels.len(), width * height, "the pixels must be those of the tiles");
    let tile_size = grid.tile_size as usize;
    let mut slices = Vec::with_capacity(grid.num() * tile_size);
    let mut rows = Vec::with_capacity(tile_size);
    // Take from every row of a band the piece that belongs to the next tile.
    for band in pixels.chunks_mut(width * tile_size) {
        rows.clear();
        rows.extend(band.chunks_mut(width).map(|row| row.chunks_mut(tile_size)));
        for _ in 0..grid.num_tiles[0] {
            slices.extend(rows.iter_mut().filter_map(Iterator::next));
            // A band that the frame's lower edge cuts off is filled up: a tile is always as many
            // slices.
            slices.extend((rows.len()..tile_size).map(|_| Default::default()));
        }
    }
    slices
}

/// What all tiles share.
pub(super) struct Painter<'a> {
    pub(super) geometry: &'a Geometry,
    pub(super) drawn: Drawn<'a>,
    pub(super) grid: TileGrid,
    pub(super) bins: &'a Bins,
    pub(super) clock: &'a (dyn Fn() -> f64 + Sync),
}

impl Painter<'_> {
    /// Draws a tile; gives what that took.
    pub(super) fn paint<P: Pixel>(
        &self,
        tile: usize,
        rows: &mut [&mut [P]],
        scratch: &mut Scratch,
        (shade, development): (Shade, &Development),
    ) -> RasterStats {
        let rect = self.grid.rect(tile);
        scratch.list.clear();
        self.bins.list(tile, &mut scratch.list);
        if scratch.list.is_empty() {
            // A tile without triangles is encoded once and copied; no buffer is touched.
            let mut background = [P::default()];
            P::set_row(&mut background, &[development.apply(self.background())]);
            rows.iter_mut().for_each(|row| row.fill(background[0]));
            return RasterStats::default();
        }
        // Find what the tile sees, then the planes of that alone.
        let start = (self.clock)();
        self.see(&rect, scratch);
        let seen = (self.clock)();
        self.find_planes(scratch);
        let found = (self.clock)();
        // Where whole quads fill the tile, each pixel is set before it is read: no need to clear.
        let is_full = self.is_full(&rect, &scratch.quads);
        let is_set = is_full && scratch.quads.iter().all(|quad| self.is_whole(quad));
        scratch.canvas.resize(rect.size().map(|side| side as usize));
        if !is_set {
            scratch.canvas.clear();
        }
        let pixels_shaded = self.shade_quads(&rect, scratch, shade);
        let shaded = (self.clock)();
        let background = self.background();
        // Nothing is added where pixels are transparent.
        if !is_full && background != [0.0; 4] {
            scratch.canvas.add_background(background);
        }
        scratch.canvas.develop(development);
        scratch.canvas.copy_to(rows);
        RasterStats {
            pixels_shaded,
            quads_shaded: scratch.quads.len() as u64,
            coverage_ms: seen - start,
            attributes_ms: found - seen,
            shade_ms: shaded - found,
            ..RasterStats::default()
        }
    }

    /// Lists the quads that the tile sees.
    fn see(&self, rect: &Rect, scratch: &mut Scratch) {
        // The number of samples is a constant of the code below, so that its arrays have a size and
        // its loops a length that the compiler knows.
        match self.drawn.settings.msaa {
            8 => self.see_quads::<8>(rect, scratch),
            4 => self.see_quads::<4>(rect, scratch),
            _ => self.see_quads::<1>(rect, scratch),
        }
    }

    fn see_quads<const S: usize>(&self, rect: &Rect, scratch: &mut Scratch) {
        self.see_samples::<S>(rect, scratch);
        gather::<S>(&scratch.visibility, &mut scratch.quads);
    }

    /// Finds what the samples of a tile see.
    pub(super) fn see_samples<const S: usize>(
        &self,
        rect: &Rect,
        Scratch { list, visibility, followed, .. }: &mut Scratch,
    ) {
        visibility.draw::<S>(self.geometry, list, rect);
        if let Some(follow) = self.drawn.follow {
            let asked = Asked { geometry: self.geometry, list, rect, follow };
            followed.find::<S>(visibility, &asked);
        }
    }

    /// Makes the attribute planes of the triangles seen.
    pub(super) fn find_planes(&self, scratch: &mut Scratch) {
        let Scratch { list, quads, slots, planes, triangles, grounds, .. } = scratch;
        // Mark the triangles that are seen; hidden ones get no planes.
        slots.clear();
        slots.resize(list.len(), NONE);
        quads.iter().for_each(|quad| slots[quad.triangle as usize] = 0);
        triangles.clear();
        grounds.clear();
        // In the list's order, neighbours in the mesh are neighbours here and find their vertices
        // in the cache.
        for (slot, &index) in slots.iter_mut().zip(list.iter()).filter(|(slot, _)| **slot != NONE) {
            *slot = triangles.len() as u32;
            let ScreenTriangle { mesh, triangle, .. } = *self.geometry.triangle(index);
            triangles.push([mesh, triangle]);
            let material = self.drawn.scene.meshes[mesh as usize].material as u32;
            let group = self.drawn.group.map_or(material, |group| group([mesh, triangle]));
            grounds.push([material, group]);
        }
        // From here on a quad names its triangle by the slot of its planes.
        for quad in quads.iter_mut() {
            quad.triangle = slots[quad.triangle as usize];
            quad.group = grounds[quad.triangle as usize][1];
        }
        // Never shrunk, so that the boxes of lit planes are there for the next tile.
        if planes.len() < triangles.len() {
            planes.resize_with(triangles.len(), AttributePlanes::default);
        }
        PlaneMaker::new(self.geometry, self.drawn.scene, self.drawn.settings)
            .fill(&mut planes[..triangles.len()], triangles);
    }

    /// Shades the quads block by block and adds their colours to the pixels; gives how many pixels
    /// that was.
    fn shade_quads(&self, rect: &Rect, scratch: &mut Scratch, shade: Shade) -> u64 {
        let Scratch { quads, planes, grounds, colors, canvas, .. } = scratch;
        // One over a power of two: shares of a pixel add up to 1 without rounding.
        let share = 1.0 / self.drawn.settings.msaa as f32;
        let block_of = |quad: &SeenQuad| quad.origin.map(|c| usize::from(c) / SHADED_BLOCK);
        let mut num_shaded = 0;
        // The list goes block by block, so each block is one run of it.
        for block in quads.chunk_by_mut(|a, b| block_of(a) == block_of(b)) {
            // The stable sort keeps the order of places and triangles.
            block.sort_by_key(|quad| quad.group);
            for quads in block.chunk_by(|a, b| a.group == b.group) {
                colors.clear();
                let [material, group] =
                    grounds[quads[0].triangle as usize].map(|index| index as usize);
                shade(&QuadBlock { material, group, tile: rect.min, quads, planes }, colors);
                for (pair, color) in quads.chunks(2).zip(colors.iter()) {
                    // A pair of whole quads is stored; where others may add their share, it is
                    // added.
                    let is_whole = pair.iter().all(|quad| self.is_whole(quad));
                    num_shaded += if is_whole {
                        canvas.set(pair, color)
                    } else {
                        canvas.add(pair, share, color)
                    };
                }
            }
        }
        num_shaded
    }

    /// Whether the triangle is all that the quad's samples see.
    #[inline(always)]
    fn is_whole(&self, quad: &SeenQuad) -> bool {
        quad.coverage == [self.drawn.settings.msaa as u8; 4]
    }

    /// Whether every sample of the tile sees a triangle.
    fn is_full(&self, rect: &Rect, quads: &[SeenQuad]) -> bool {
        // A sample counts for one triangle at most, so only full coverage reaches the product.
        let num_seen: u64 = quads.iter().flat_map(|quad| quad.coverage).map(u64::from).sum();
        let [width, height] = [0, 1].map(|i| (rect.max[i] - rect.min[i]) as u64);
        num_seen == width * height * u64::from(self.drawn.settings.msaa)
    }

    fn background(&self) -> [f32; 4] {
        let [r, g, b, a] = self.drawn.scene.background;
        [r * a, g * a, b * a, a]
    }
}
