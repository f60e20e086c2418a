//! The pixels of one tile while their colours are added up.

use super::gather::SeenQuad;
use crate::frame::{Development, Pixel};
use crate::simd::{PixelLanes, quads_by_pixel};

/// Pixels in linear light, row by row: RGB, premultiplied by the fourth component, the opacity.
/// Rows and columns are an even number, so that every quad lies within.
#[derive(Debug, Default)]
pub(super) struct Canvas {
    pixels: Vec<[f32; 4]>,
    /// Pixels a row.
    stride: usize,
    size: [usize; 2],
}

impl Canvas {
    /// Takes the size of a tile, in pixels; what the pixels are then is left open.
    pub(super) fn resize(&mut self, size: [usize; 2]) {
        self.size = size;
        // Quads at the right and the lower edge reach a pixel beyond an odd side.
        let [stride, num_rows] = size.map(|side| side.next_multiple_of(2));
        self.stride = stride;
        self.pixels.resize(stride * num_rows, [0.0; 4]);
    }

    /// Makes all pixels transparent.
    pub(super) fn clear(&mut self) {
        self.pixels.fill([0.0; 4]);
    }

    /// Adds the colours of one or two quads to the pixels, `share` for each sample; gives how many
    /// pixels took part.
    #[inline]
    pub(super) fn add(&mut self, pair: &[SeenQuad], share: f32, colors: &[PixelLanes; 3]) -> u64 {
        let of_quad = |i: usize| pair.get(i).map_or(0, |quad| u32::from_le_bytes(quad.coverage));
        let coverage = (u64::from(of_quad(0)) | u64::from(of_quad(1)) << 32).to_le_bytes();
        let shares = PixelLanes::new(coverage.map(f32::from)) * share;
        // Pixels without a sample add 0, which changes no sum: no branch to guess wrong. What their
        // lanes hold may be anything, and is not multiplied with 0.
        let is_covered = shares.simd_gt(PixelLanes::ZERO);
        let [r, g, b] = colors.map(|lanes| is_covered.select(lanes * shares, PixelLanes::ZERO));
        for (quad, added) in pair.iter().zip(quads_by_pixel([r, g, b, shares])) {
            let [x, y] = quad.origin.map(usize::from);
            // One slice from the quad's first pixel to its last holds both rows.
            let rows = &mut self.pixels[y * self.stride + x..][..self.stride + 2];
            for (lane, added) in added.iter().enumerate() {
                // Each triangle adds in the list's order, which is the same for every tiling: so
                // are the sums.
                let pixel = &mut rows[lane / 2 * self.stride + lane % 2];
                (0..4).for_each(|c| pixel[c] += added[c]);
            }
        }
        u64::from(is_covered.to_bitmask().count_ones())
    }

    /// Sets the pixels of one or two quads of which one triangle covers every sample; gives how
    /// many pixels that were.
    #[inline]
    pub(super) fn set(&mut self, pair: &[SeenQuad], colors: &[PixelLanes; 3]) -> u64 {
        let [r, g, b] = *colors;
        let quads = quads_by_pixel([r, g, b, PixelLanes::ONE]);
        for (quad, [a, b, c, d]) in pair.iter().zip(quads) {
            let [x, y] = quad.origin.map(usize::from);
            // One slice from the quad's first pixel to its last holds both rows.
            let rows = &mut self.pixels[y * self.stride + x..][..self.stride + 2];
            [rows[0], rows[1]] = [a, b];
            [rows[self.stride], rows[self.stride + 1]] = [c, d];
        }
        4 * pair.len() as u64
    }

    /// Adds what is seen behind pixels that are not covered wholly.
    pub(super) fn add_background(&mut self, background: [f32; 4]) {
        for pixel in &mut self.pixels {
            // Shares are multiples of 1/8 at least: their sum is exact.
            let left = 1.0 - pixel[3];
            if left > 0.0 {
                (0..4).for_each(|i| pixel[i] += background[i] * left);
            }
        }
    }

    /// Brings light to the range of the frame.
    pub(super) fn develop(&mut self, development: &Development) {
        if !development.is_none() {
            self.pixels.iter_mut().for_each(|pixel| *pixel = development.apply(*pixel));
        }
    }

    /// Sets the tile's rows of the frame.
    pub(super) fn copy_to<P: Pixel>(&self, rows: &mut [&mut [P]]) {
        for (row, pixels) in
            rows.iter_mut().zip(self.pixels.chunks_exact(self.stride)).take(self.size[1])
        {
            // The row of the frame may be a pixel shorter than the canvas, whose sides are even.
            P::set_row(row, &pixels[..row.len()]);
        }
    }
}
