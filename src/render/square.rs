//! Pixels of one block by filters that take the footprint for a square: those that are seen, eight at a time.
//!
//! Of the eight pixels of a pair of quads, small triangles cover one or two. What is seen of a block is therefore lined up
//! before it is looked up in the texture, unless it is all of a pair.

use super::quads::{Ground, QuadShader};
use crate::filter::{self, trilinear};
use crate::raster::QuadBlock;
use crate::simd::PixelLanes;
use crate::texture::FULL_F32;

/// Pixels that wait for their look-ups: seven left over and eight of the next pair.
#[derive(Default)]
struct Queue {
    place: [[f32; 16]; 2],
    size: [f32; 16],
    /// Pair of the block times 8 plus lane.
    pixel: [u32; 16],
    num: usize,
}

impl QuadShader<'_> {
    /// Appends the colours of a block's pairs by the trilinear filter, unlit.
    pub(super) fn trilinear(&self, ground: &Ground, block: &QuadBlock, colors: &mut Vec<[PixelLanes; 3]>) {
        let first = colors.len();
        let mut queue = Queue::default();
        colors.resize(first + block.num_pairs(), [PixelLanes::ZERO; 3]);
        for index in 0..block.num_pairs() {
            let pair = block.pair(index);
            let (place, differences) = self.hits(ground, &pair);
            let place = filter::bounded_place(place);
            let size = trilinear::longest_side(ground.surface, &differences);
            if pair.is_whole() {
                colors[first + index] = look_up(ground, place, size);
                continue;
            }
            let (place, size) = (place.map(PixelLanes::to_array), size.to_array());
            for lane in pair.covered() {
                let Queue { num, .. } = queue;
                (queue.place[0][num], queue.place[1][num]) = (place[0][lane], place[1][lane]);
                queue.size[num] = size[lane];
                queue.pixel[num] = (8 * index + lane) as u32;
                queue.num += 1;
            }
            if queue.num >= 8 {
                queue.look_up(ground, &mut colors[first..]);
            }
        }
        queue.look_up(ground, &mut colors[first..]);
    }
}

/// The colours of eight pixels.
#[inline]
fn look_up(ground: &Ground, place: [PixelLanes; 2], size: PixelLanes) -> [PixelLanes; 3] {
    let Ground { surface, material, .. } = *ground;
    let scale = surface.color_scale / FULL_F32;
    let found = trilinear::colors(surface, place, size);
    std::array::from_fn(|c| found[c] * material.diffuse[c] * scale)
}

impl Queue {
    /// Looks up the first eight pixels, or what there is, and moves the others up.
    fn look_up(&mut self, ground: &Ground, colors: &mut [[PixelLanes; 3]]) {
        // What is missing of eight is taken for the first, where the others' texels are.
        let lanes = |values: &[f32; 16]| {
            PixelLanes::new(std::array::from_fn(|lane| values[if lane < self.num { lane } else { 0 }]))
        };
        let place = [lanes(&self.place[0]), lanes(&self.place[1])];
        let found = look_up(ground, place, lanes(&self.size)).map(PixelLanes::to_array);
        for lane in 0..self.num.min(8) {
            let [pair, of_pair] = [self.pixel[lane] / 8, self.pixel[lane] % 8].map(|i| i as usize);
            for (color, found) in colors[pair].iter_mut().zip(&found) {
                color.as_mut_array()[of_pair] = found[lane];
            }
        }
        for values in self.place.iter_mut().chain([&mut self.size]) {
            values.copy_within(8.., 0);
        }
        self.pixel.copy_within(8.., 0);
        self.num = self.num.saturating_sub(8);
    }
}
