//! Pixels that wait for their look-ups.
//!
//! Of the eight pixels of a pair of quads, small triangles cover one or two. Covered pixels are
//! therefore packed into groups of eight before they are looked up in the texture, unless all of a
//! pair are covered:
//!
//! ```text
//! pairs     [x . . . . . . .] [. x x . . . . .] [x x x x x x x x]
//! groups    [0 9 10 _ _ _ _ _]                  [16 17 18 ... 23]     numbers: 8 * pair + lane
//! ```

use super::batch::{Batch, Filtered};
use crate::footprint::Footprints;
use crate::simd::PixelLanes;

/// Most groups that are looked up at once: their steps overlap, and eight fit the first cache with
/// the texels they read.
pub(super) const AT_ONCE: usize = 8;

/// Looks up the colours of a batch's pixels in groups of eight. `of_pixels` says what a look-up
/// needs to know of eight pixels, such as u, v and the footprint's size; `look_up` hands out the
/// colours of a queue's groups.
#[inline(always)]
pub(super) fn look_up_all<const N: usize>(
    batch: &Batch,
    out: &mut [Filtered],
    of_pixels: impl Fn(&Footprints) -> [PixelLanes; N],
    look_up: impl Fn(&Queue<N>, &mut [Filtered]),
) {
    let mut pixels = batch.pixels.iter().enumerate();
    let mut queue = Queue::new();
    loop {
        // Line up covered pixels until as many wait as are looked up at once.
        while let Some((index, pixels)) = if queue.is_full() { None } else { pixels.next() } {
            queue.push(pixels.covered, index, of_pixels(pixels));
        }
        if queue.is_empty() {
            return;
        }
        // Look up the whole groups; one that is not waits for more, unless it is all that is left.
        queue.fill_up();
        look_up(&queue, out);
        queue.advance();
    }
}

/// The pixels, group after group.
pub(super) struct Queue<const N: usize> {
    groups: [[PixelLanes; N]; AT_ONCE + 1],
    /// Of each pixel, the number of the pair times 8 plus the lane.
    pixels: [[u32; 8]; AT_ONCE + 1],
    num: usize,
}

impl<const N: usize> Queue<N> {
    /// An empty queue.
    fn new() -> Self {
        Self { groups: [[PixelLanes::ZERO; N]; AT_ONCE + 1], pixels: Default::default(), num: 0 }
    }

    fn is_empty(&self) -> bool {
        self.num == 0
    }

    /// Whether there are as many as are looked up at once.
    fn is_full(&self) -> bool {
        self.num >= 8 * AT_ONCE
    }

    /// Lines up the covered pixels of a pair.
    #[inline(always)]
    fn push(&mut self, covered: u8, index: usize, group: [PixelLanes; N]) {
        if self.num.is_multiple_of(8) && covered == u8::MAX {
            // A whole pair at a group's beginning stays as it is: no lane is moved.
            let numbers = std::array::from_fn(|lane| (8 * index + lane) as u32);
            (self.groups[self.num / 8], self.pixels[self.num / 8]) = (group, numbers);
            self.num += 8;
        } else {
            // A copy for the call: what is passed by its address is kept in memory.
            self.push_covered(covered, index, &group.map(|lanes| lanes));
        }
    }

    #[inline(never)]
    fn push_covered(&mut self, mut covered: u8, index: usize, group: &[PixelLanes; N]) {
        while covered != 0 {
            let lane = covered.trailing_zeros() as usize;
            covered &= covered - 1;
            // The last pair may run over into the one group that is there beyond those looked up.
            let to = &mut self.groups[self.num / 8];
            for (to, from) in to.iter_mut().zip(group) {
                to.as_mut_array()[self.num % 8] = from.as_array()[lane];
            }
            self.pixels[self.num / 8][self.num % 8] = (8 * index + lane) as u32;
            self.num += 1;
        }
    }

    /// Fills the empty lanes of a lone group with copies of its first pixel, so that they read
    /// texels that are needed anyway.
    fn fill_up(&mut self) {
        if self.num < 8 {
            for lanes in &mut self.groups[0] {
                let first = lanes.as_array()[0];
                lanes.as_mut_array()[self.num..].fill(first);
            }
        }
    }

    /// The groups that are whole, or the last one.
    pub(super) fn groups(&self) -> &[[PixelLanes; N]] {
        &self.groups[..self.num_whole()]
    }

    /// Hands out the colours of one of [`Self::groups`] to the pairs.
    #[inline(always)]
    pub(super) fn hand_out(
        &self,
        group: usize,
        [red, green, blue]: [PixelLanes; 3],
        out: &mut [Filtered],
    ) {
        let pixels = &self.pixels[group];
        if pixels[0].is_multiple_of(8) && pixels[7] == pixels[0] + 7 {
            // All eight are one pair's: no lane is moved.
            out[pixels[0] as usize / 8].color = [red, green, blue];
        } else {
            let num = (self.num - 8 * group).min(8);
            scatter(&pixels[..num], &[red, green, blue], out);
        }
    }

    /// Leaves out the groups that were handed out.
    fn advance(&mut self) {
        let num_groups = self.num_whole();
        (self.groups[0], self.pixels[0]) = (self.groups[num_groups], self.pixels[num_groups]);
        self.num = self.num.saturating_sub(8 * num_groups);
    }

    fn num_whole(&self) -> usize {
        (self.num / 8).max(1)
    }
}

#[inline(never)]
fn scatter(pixels: &[u32], found: &[PixelLanes; 3], out: &mut [Filtered]) {
    for (lane, pixel) in pixels.iter().enumerate() {
        let color = &mut out[*pixel as usize / 8].color;
        (0..3)
            .for_each(|c| color[c].as_mut_array()[*pixel as usize % 8] = found[c].as_array()[lane]);
    }
}
