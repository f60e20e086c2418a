//! Pixels of one block by filters that take the footprint for a square: those that are seen, eight at a time.
//!
//! Of the eight pixels of a pair of quads, small triangles cover one or two. What is seen of a block is therefore lined up
//! before it is looked up in the texture, unless it is all of a pair.

use super::quads::{Ground, QuadShader};
use crate::filter;
use crate::filter::trilinear::{self, AT_ONCE, Group};
use crate::raster::{QuadBlock, QuadPair};
use crate::simd::PixelLanes;
use crate::texture::FULL_F32;

/// Pixels that wait for their look-ups, group after group.
struct Queue {
    groups: [Group; AT_ONCE + 1],
    /// Of each pixel, the pair of the block times 8 plus the lane.
    pixels: [[u32; 8]; AT_ONCE + 1],
    /// Pixels that wait.
    num: usize,
}

impl QuadShader<'_> {
    /// Appends the colours of a block's pairs by the trilinear filter, unlit.
    pub(super) fn trilinear(&self, ground: &Ground, block: &QuadBlock, colors: &mut Vec<[PixelLanes; 3]>) {
        let first = colors.len();
        let mut queue = Queue { groups: Default::default(), pixels: Default::default(), num: 0 };
        colors.resize(first + block.num_pairs(), [PixelLanes::ZERO; 3]);
        let mut index = 0;
        while index < block.num_pairs() || queue.num > 0 {
            while index < block.num_pairs() && queue.num < 8 * AT_ONCE {
                let pair = block.pair(index);
                let (place, differences) = self.hits(ground, &pair);
                let size = trilinear::longest_side(ground.surface, &differences);
                queue.push(&pair, index as u32, &Group { place: filter::bounded_place(place), size });
                index += 1;
            }
            queue.look_up(ground, &mut colors[first..]);
        }
    }
}

impl Queue {
    /// Lines up the pixels of a pair that are seen.
    #[inline(always)]
    fn push(&mut self, pair: &QuadPair, index: u32, group: &Group) {
        let numbers = std::array::from_fn(|lane| 8 * index + lane as u32);
        if self.num % 8 == 0 && pair.is_whole() {
            (self.groups[self.num / 8], self.pixels[self.num / 8]) = (*group, numbers);
            self.num += 8;
            return;
        }
        for lane in pair.covered() {
            let (to, at) = (&mut self.groups[self.num / 8], self.num % 8);
            to.place[0].as_mut_array()[at] = group.place[0].as_array()[lane];
            to.place[1].as_mut_array()[at] = group.place[1].as_array()[lane];
            to.size.as_mut_array()[at] = group.size.as_array()[lane];
            self.pixels[self.num / 8][at] = numbers[lane];
            self.num += 1;
        }
    }

    /// Looks up the groups that are whole, or the last one, and moves what is left to the front.
    fn look_up(&mut self, ground: &Ground, colors: &mut [[PixelLanes; 3]]) {
        let Ground { surface, material, .. } = *ground;
        let num_groups = (self.num / 8).max(1);
        let mut found = [[PixelLanes::ZERO; 3]; AT_ONCE];
        trilinear::colors(surface, &self.groups[..num_groups], &mut found);
        let scale = surface.color_scale / FULL_F32;
        for (group, (found, pixels)) in found.iter().zip(&self.pixels).enumerate().take(num_groups) {
            let found = [0, 1, 2].map(|c| found[c] * material.diffuse[c] * scale);
            let num = (self.num - 8 * group).min(8);
            if num == 8 && pixels[0] % 8 == 0 && pixels[7] == pixels[0] + 7 {
                colors[pixels[0] as usize / 8] = found;
                continue;
            }
            for (lane, pixel) in pixels.iter().enumerate().take(num) {
                let color = &mut colors[*pixel as usize / 8];
                (0..3).for_each(|c| color[c].as_mut_array()[*pixel as usize % 8] = found[c].as_array()[lane]);
            }
        }
        (self.groups[0], self.pixels[0]) = (self.groups[num_groups], self.pixels[num_groups]);
        self.num = self.num.saturating_sub(8 * num_groups);
    }
}
