//! A pyramid of greatest heights.
//!
//! A *node* of level k spans 2^k x 2^k cells, less at the far edges, and holds a height that no
//! relief in them reaches. (Maximum mipmaps: Tevs, Ihrke, Seidel 2008.)

use crate::simd::{RayLanes, as_unsigned_words, i32x16, pick, u32x16};
use crate::texture::FULL_F32;

/// Most levels: a vector of sixteen lanes holds what is known of each. Larger maps end with more
/// than one node.
const MOST_LEVELS: usize = 16;

/// The step of heights between two bytes: stored heights have seven bits more.
const STEP: f32 = 128.0 / FULL_F32;

/// Heights that no relief reaches, level after level.
#[derive(Clone, Debug)]
pub(super) struct Maxima {
    /// Of each node the greatest height in steps, rounded down: one more is above it. Bytes, so
    /// that most of a walk's look-ups stay in the second cache.
    steps: Vec<u8>,
    /// Of each level, where its nodes start, and how many make a row.
    starts: u32x16,
    widths: u32x16,
    num_levels: i32,
}

impl Maxima {
    /// The pyramid over so many columns and rows of cells, each with the greatest height in it.
    pub(super) fn new(size: [usize; 2], greatest: impl Fn(usize, usize) -> u16) -> Self {
        let [mut width, mut height] = size;
        let (mut starts, mut widths) = ([0; MOST_LEVELS], [0; MOST_LEVELS]);
        let mut steps: Vec<u8> =
            (0..width * height).map(|i| (greatest(i % width, i / width) >> 7) as u8).collect();
        let (mut first, mut num_levels) = (0, 0);
        loop {
            (starts[num_levels], widths[num_levels]) = (first as u32, width as u32);
            num_levels += 1;
            if [width, height] == [1, 1] || num_levels == MOST_LEVELS {
                break;
            }
            // Halve the sides, rounded up.
            let coarser = [width, height].map(|n| n.div_ceil(2));
            let start = steps.len();
            steps.resize(start + coarser[0] * coarser[1], 0);
            let (finer, nodes) = steps.split_at_mut(start);
            for (i, &cell) in finer[first..].iter().enumerate() {
                let node = &mut nodes[i / width / 2 * coarser[0] + i % width / 2];
                *node = (*node).max(cell);
            }
            first = start;
            [width, height] = coarser;
        }
        steps.shrink_to_fit();
        let num_levels = num_levels as i32;
        Self { steps, starts: u32x16::new(starts), widths: u32x16::new(widths), num_levels }
    }

    pub(super) fn num_levels(&self) -> i32 {
        self.num_levels
    }

    /// Heights, 0 to just above 1, that no relief reaches in the nodes that hold the given cells.
    #[inline(always)]
    pub(super) fn above(&self, level: i32x16, [x, y]: [i32x16; 2]) -> RayLanes {
        let level = as_unsigned_words(level);
        let [starts, widths] = [self.starts, self.widths].map(|of_levels| pick(of_levels, level));
        let [x, y] = [x, y].map(|cell| as_unsigned_words(cell).unbounded_shr(level));
        let places = (starts + y * widths + x).to_array();
        // Words and not bytes: those would be put into one vector one after the other.
        let step = |place: u32| f32::from(self.steps[place as usize]);
        RayLanes::new(places.map(step)) * STEP + STEP
    }

    /// [`Self::above`] of one node.
    #[inline(always)]
    pub(super) fn above_one(&self, level: i32, [x, y]: [i32; 2]) -> f32 {
        let [start, width] =
            [self.starts, self.widths].map(|of_levels| of_levels.as_array()[level as usize]);
        let [x, y] = [x, y].map(|cell| (cell >> level) as u32);
        f32::from(self.steps[(start + y * width + x) as usize]) * STEP + STEP
    }
}
