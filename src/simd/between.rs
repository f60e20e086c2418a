//! Interpolation between the packed texels of a run, eight or sixteen places at a time.

use super::lanes::{
    as_unsigned, as_unsigned_words, f32x8, f32x16, i16x32, i32x16, join, pick_words, u32x8, u32x16,
};
use wide::{i16x16, u16x32};

/// Interpolates between packed texels, both 16-bit halves of a word at once; halves must be below
/// 32768.
#[derive(Clone, Copy, Debug)]
pub struct Blend(i16x16);

impl Blend {
    /// For a place between near (0) and far (just under 1), per lane.
    pub fn new(part: f32x8) -> Self {
        let part = as_unsigned((part * 32767.0).fast_trunc_int());
        Self(wide::bytemuck::cast(part | part << 16_u32))
    }

    /// The words between `near` and `far`, each half within those of the two.
    pub fn mix(self, [near, far]: [u32x8; 2]) -> u32x8 {
        let (near, far): (i16x16, i16x16) = (wide::bytemuck::cast(near), wide::bytemuck::cast(far));
        wide::bytemuck::cast(near + (far - near).mul_scale_round(self.0))
    }
}

/// Where sixteen lines lie between the texels of a run of 32 words, for both halves of a word; halves
/// must be below 32768.
///
/// A line's value is the dot product of its two neighbours with their shares, in whole numbers:
/// with AVX-512 one selection from the run, one product and one conversion for sixteen lines.
#[derive(Clone, Copy, Debug)]
pub struct Between {
    /// The texel before each line.
    cells: i32x16,
    /// The shares of the texel before and of the one after, each 0 to 32767 and that together.
    shares: u32x16,
}

/// What [`Between`] makes of a half of 1.
pub const BETWEEN_SCALE: f32 = 32767.0;

impl Between {
    /// All before the first texel.
    pub const NONE: Self = Self { cells: i32x16::ZERO, shares: u32x16::ZERO };

    /// For places in texels from the run's first, 0 to just under 31, that ascend by at most 2.
    #[inline(always)]
    pub fn new(places: f32x16) -> Self {
        let places = (places * 32768.0).fast_trunc_int();
        let part = as_unsigned_words(places & i32x16::splat(0x7fff));
        // 32767 - part, then part.
        let shares = (part | part << 16_u32) ^ u32x16::splat(0x7fff);
        Self { cells: places >> 15_i32, shares }
    }

    /// The lower and the upper halves of the words from `start` on at the places, in units of
    /// 1 / [`BETWEEN_SCALE`].
    #[inline(always)]
    pub fn halves_at(&self, words: &[u32], start: usize) -> [f32x16; 2] {
        if cfg!(target_feature = "avx512bw") {
            let run: &[u32; 32] = words[start..start + 32].try_into().expect("a slice of 32");
            let run: [u16x32; 2] = wide::bytemuck::cast(*run);
            // Neighbours are two halves apart.
            let cells = as_unsigned_words(self.cells) << 1_u32;
            let low = (cells | cells << 16_u32) + u32x16::splat(0x0002_0000);
            let high = low + u32x16::splat(0x0001_0001);
            [low, high].map(|numbers| {
                let numbers: u16x32 = wide::bytemuck::cast(numbers);
                self.sum(wide::bytemuck::cast(wide::ShuffleExt::shuffle(run, numbers)))
            })
        } else {
            let [near, far] = pick_words(words, start, self.cells);
            let low = near & u32x16::splat(0xffff) | far << 16_u32;
            let high = near >> 16_u32 | far & u32x16::splat(0xffff_0000);
            [self.sum(low), self.sum(high)]
        }
    }

    /// Some bits of words picked by [`Self::words_at`], at most 15 of them, at the places, in units of
    /// 1 / [`BETWEEN_SCALE`].
    #[inline(always)]
    pub fn bits_of(&self, words: [u32x16; 2], first: u32, mask: u32) -> f32x16 {
        let [near, far] = words.map(|words| (words >> first) & u32x16::splat(mask));
        self.sum(near | far << 16_u32)
    }

    /// Both neighbours by their shares.
    #[inline(always)]
    fn sum(&self, neighbours: u32x16) -> f32x16 {
        if cfg!(target_feature = "avx512bw") {
            let neighbours: i16x32 = wide::bytemuck::cast(neighbours);
            f32x16::from_i32x16(neighbours.dot(wide::bytemuck::cast(self.shares)))
        } else {
            let [neighbours, shares]: [[i16x16; 2]; 2] =
                [wide::bytemuck::cast(neighbours), wide::bytemuck::cast(self.shares)];
            join([0, 1].map(|i| f32x8::from_i32x8(neighbours[i].dot(shares[i]))))
        }
    }

    /// Between the numbers before (`near`) and after (`far`) each line.
    #[inline(always)]
    pub fn mix(&self, near: f32x16, far: f32x16) -> f32x16 {
        let part = f32x16::from_i32x16(wide::bytemuck::cast(self.shares >> 16_u32));
        near + (far - near) * (part * (1.0 / 32767.0))
    }

    /// [`pick_words`] of the texels before and after.
    #[inline(always)]
    pub fn words_at(&self, words: &[u32], start: usize) -> [u32x16; 2] {
        pick_words(words, start, self.cells)
    }
}
