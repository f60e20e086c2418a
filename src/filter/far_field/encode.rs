//! One table: the image seen in one direction, with its coarser levels, in one word a texel.

use crate::simd::{LineLanes, as_signed_words, u32x8, u32x16};
use crate::texture::{Wrap, box_taps, wrap_index};

/// Neighbouring texels that are one load: a row repeats so many beyond its end.
pub(super) const RUN: usize = 8;

/// The image seen in one direction.
#[derive(Clone, Debug)]
pub(super) struct FarImage {
    levels: Vec<FarLevel>,
    /// What its greatest number stands for, of the surface's scale.
    pub(super) scale: f32,
}

/// One of its levels.
#[derive(Clone, Debug)]
pub(super) struct FarLevel {
    width: usize,
    height: usize,
    words: Vec<u32>,
}

impl FarImage {
    /// Words of a level of that size.
    pub(super) fn num_words([width, height]: [usize; 2]) -> usize {
        (width + RUN) * height
    }

    /// An image and its coarser levels from linear colours (0 to `scale` of the surface's), row by
    /// row.
    pub(super) fn new(size: [usize; 2], colors: Vec<[f32; 3]>, scale: f32) -> Self {
        let (mut size, mut colors) = (size, colors);
        let mut levels = Vec::new();
        loop {
            levels.push(FarLevel::new(size, &colors, 1.0 / scale));
            if size == [1, 1] {
                return Self { levels, scale };
            }
            (size, colors) = halve(size, &colors);
        }
    }

    /// One of the levels, the finest first.
    pub(super) fn level(&self, level: usize) -> &FarLevel {
        &self.levels[level]
    }
}

impl FarLevel {
    fn new([width, height]: [usize; 2], colors: &[[f32; 3]], unit: f32) -> Self {
        let texel =
            move |x: usize, y: usize| encode(colors[y * width + x % width].map(|c| c * unit));
        let row = |y: usize| (0..width + RUN).map(move |x| texel(x, y));
        Self { width, height, words: (0..height).flat_map(row).collect() }
    }

    /// Where the run that begins at a column and row of the endless pattern starts.
    #[inline(always)]
    pub(super) fn start_at(&self, x: i32, y: i32) -> usize {
        let [x, y] =
            [(x, self.width), (y, self.height)].map(|(i, n)| wrap_index(Wrap::Repeat, i, n));
        y * (self.width + RUN) + x
    }

    /// The texels of a run.
    #[inline(always)]
    pub(super) fn run(&self, start: usize) -> u32x8 {
        let run: &[u32; RUN] = self.words[start..start + RUN].try_into().expect("a whole run");
        u32x8::new(*run)
    }
}

fn encode(color: [f32; 3]) -> u32 {
    // Equal steps of a root are finer where colours are dark, and so are the eye's. Clamped and
    // rounded, values fit their bits.
    let [r, g, b] = color.map(|c| c.clamp(0.0, 1.0).sqrt());
    (r * 2047.0 + 0.5) as u32
        | ((g * 2047.0 + 0.5) as u32) << 11
        | ((b * 1023.0 + 0.5) as u32) << 22
}

/// Sixteen texels as linear red, green and blue, in units of 1/2047^2 and 1/1023^2 of the
/// surface's scale.
#[inline(always)]
pub(super) fn decode(words: u32x16) -> [LineLanes; 3] {
    let part = |bits: u32x16| {
        let root = LineLanes::from_i32x16(as_signed_words(bits));
        root * root
    };
    [
        part(words & u32x16::splat(2047)),
        part(words >> 11_u32 & u32x16::splat(2047)),
        part(words >> 22_u32),
    ]
}

/// What a decoded 1 stands for, by channel.
pub(super) const UNITS: [f32; 3] =
    [1.0 / (2047.0 * 2047.0), 1.0 / (2047.0 * 2047.0), 1.0 / (1023.0 * 1023.0)];

/// Half the size, each texel the mean of the area that it covers.
fn halve([w, h]: [usize; 2], colors: &[[f32; 3]]) -> ([usize; 2], Vec<[f32; 3]>) {
    let to = [w, h].map(|n| (n / 2).max(1));
    let columns: Vec<_> = (0..to[0]).map(|x| box_taps(x, w, to[0])).collect();
    let mut halved = Vec::with_capacity(to[0] * to[1]);
    for y in 0..to[1] {
        let rows = box_taps(y, h, to[1]);
        for columns in &columns {
            let mut sum = [0.0; 3];
            for &(j, wy) in &rows {
                for &(i, wx) in columns {
                    (0..3).for_each(|c| sum[c] += wx * wy * colors[j * w + i][c]);
                }
            }
            halved.push(sum);
        }
    }
    (to, halved)
}
