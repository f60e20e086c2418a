//! Pixels of one block that wait for their look-ups.
//!
//! Of the eight pixels of a pair of quads, small triangles cover one or two. What is seen of a block is therefore lined up
//! in groups of eight before it is looked up in the texture, unless it is all of a pair.

use crate::raster::QuadPair;
use crate::simd::PixelLanes;

/// Most groups that are looked up at once.
const AT_ONCE: usize = 8;

/// What the look-ups need to know of eight pixels: u, v and the footprint's size.
type Group = [PixelLanes; 3];

/// The pixels, group after group.
pub(super) struct Queue {
    groups: [Group; AT_ONCE + 1],
    /// Of each pixel, the pair of the block times 8 plus the lane.
    pixels: [[u32; 8]; AT_ONCE + 1],
    num: usize,
}

impl Queue {
    /// An empty queue.
    pub(super) fn new() -> Self {
        Self { groups: [[PixelLanes::ZERO; 3]; AT_ONCE + 1], pixels: Default::default(), num: 0 }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.num == 0
    }

    /// Whether there are as many as are looked up at once.
    pub(super) fn is_full(&self) -> bool {
        self.num >= 8 * AT_ONCE
    }

    /// Lines up the pixels of a pair that are seen.
    #[inline(always)]
    pub(super) fn push(&mut self, pair: &QuadPair, index: usize, group: &Group) {
        let numbers = std::array::from_fn(|lane| (8 * index + lane) as u32);
        if self.num.is_multiple_of(8) && pair.is_whole() {
            (self.groups[self.num / 8], self.pixels[self.num / 8]) = (*group, numbers);
            self.num += 8;
            return;
        }
        for lane in pair.covered() {
            let to = &mut self.groups[self.num / 8];
            for (to, from) in to.iter_mut().zip(group) {
                to.as_mut_array()[self.num % 8] = from.as_array()[lane];
            }
            self.pixels[self.num / 8][self.num % 8] = numbers[lane];
            self.num += 1;
        }
    }

    /// Looks up the groups that are whole, or the last one, and moves what is left to the front.
    #[inline(always)]
    pub(super) fn look_up(
        &mut self,
        colors: &mut [[PixelLanes; 3]],
        look_up: impl FnOnce(&[Group], &mut [[PixelLanes; 3]; AT_ONCE]),
    ) {
        let num_groups = (self.num / 8).max(1);
        if self.num < 8 {
            // What is missing is taken for the first, where the others' texels are.
            for lanes in &mut self.groups[0] {
                let first = lanes.as_array()[0];
                lanes.as_mut_array()[self.num..].fill(first);
            }
        }
        let mut found = [[PixelLanes::ZERO; 3]; AT_ONCE];
        look_up(&self.groups[..num_groups], &mut found);
        for (group, (found, pixels)) in found.iter().zip(&self.pixels).enumerate().take(num_groups) {
            let num = (self.num - 8 * group).min(8);
            if num == 8 && pixels[0].is_multiple_of(8) && pixels[7] == pixels[0] + 7 {
                colors[pixels[0] as usize / 8] = *found;
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
