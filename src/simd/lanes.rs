//! Lane types and the few helpers on them.

use wide::f32x4;
pub use wide::{f32x8, f32x16, f64x8, i16x32, i32x8, i32x16, u32x8, u32x16};

/// Eight pixels: two 2x2 quads, lane `4 * quad + 2 * dy + dx`.
pub type PixelLanes = f32x8;

/// Sixteen view rays.
pub type RayLanes = f32x16;

/// The name of the instruction set that the lanes were built for.
pub const LEVEL: &str = if cfg!(target_feature = "avx512f") {
    "avx512"
} else if cfg!(all(target_feature = "avx2", target_feature = "fma")) {
    "avx2+fma"
} else if cfg!(target_feature = "avx2") {
    "avx2"
} else if cfg!(target_feature = "avx") {
    "avx"
} else if cfg!(target_feature = "sse4.1") {
    "sse4.1"
} else if cfg!(target_feature = "sse2") {
    "sse2"
} else if cfg!(target_feature = "neon") {
    "neon"
} else {
    "scalar"
};

/// Eight texels.
pub type TexelLanes = f32x8;

/// A value of sixteen neighbouring lines of a sweep.
pub type LineLanes = f32x16;

/// Numbers in lanes, for what is computed in eight of them and in sixteen.
pub trait Lanes:
    Copy
    + std::ops::Add<Output = Self>
    + std::ops::Sub<Output = Self>
    + std::ops::Mul<Output = Self>
    + std::ops::Div<Output = Self>
{
    /// The same number in all lanes.
    fn splat(number: f32) -> Self;
    /// Square roots.
    fn sqrt(self) -> Self;
    /// Those numbers that are above a bound, and the bound.
    fn at_least(self, bound: f32) -> Self;
    /// Those numbers that are below a bound, and the bound.
    fn at_most(self, bound: f32) -> Self;
}

macro_rules! numbers_in {
    ($lanes:ty) => {
        impl Lanes for $lanes {
            #[inline(always)]
            fn splat(number: f32) -> Self {
                <$lanes>::splat(number)
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                <$lanes>::sqrt(self)
            }

            #[inline(always)]
            fn at_least(self, bound: f32) -> Self {
                self.fast_max(<$lanes>::splat(bound))
            }

            #[inline(always)]
            fn at_most(self, bound: f32) -> Self {
                self.fast_min(<$lanes>::splat(bound))
            }
        }
    };
}

numbers_in!(f32x8);
numbers_in!(f32x16);

/// The sum of the lanes, in one fixed order on every machine.
pub fn sum(lanes: f32x8) -> f32 {
    let [a, b, c, d, e, f, g, h] = lanes.to_array();
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// [`sum`] of each of four vectors.
#[inline(always)]
pub fn sums(vectors: [f32x8; 4]) -> [f32; 4] {
    let halves: [[f32x4; 2]; 4] = wide::bytemuck::cast(vectors);
    let [a, b, c, d] = f32x4::transpose(halves.map(|[near, far]| near + far));
    ((a + c) + (b + d)).to_array()
}

/// All bits of the lanes whose bit is set.
#[inline(always)]
pub fn bits(bits: u8) -> u32x8 {
    let of_lanes = u32x8::new([1, 2, 4, 8, 16, 32, 64, 128]);
    (u32x8::splat(u32::from(bits)) & of_lanes).simd_eq(of_lanes)
}

/// The lanes whose bit is set, in order.
#[inline(always)]
pub fn set_bits(left: impl Into<u32>) -> impl Iterator<Item = usize> {
    let mut left = left.into();
    std::iter::from_fn(move || {
        let lane = left.trailing_zeros() as usize;
        left &= left.wrapping_sub(1);
        (lane < 32).then_some(lane)
    })
}

/// [`bits`] as a mask of numbers.
#[inline(always)]
pub fn bits_mask(mask: u8) -> f32x8 {
    wide::bytemuck::cast(bits(mask))
}

/// The lower sixteen bits of each lane as a number.
pub fn low_half(words: u32x8) -> f32x8 {
    f32x8::from_i32x8(as_signed(words & u32x8::splat(0xffff)))
}

/// The upper sixteen bits of each lane as a number.
pub fn high_half(words: u32x8) -> f32x8 {
    f32x8::from_i32x8(as_signed(words >> 16_u32))
}

/// The columns of eight neighbouring texels, the first at `x`.
#[inline(always)]
pub fn lane_columns(x: i32) -> f32x8 {
    lane_indices() + x as f32
}

/// The number of each of eight lanes.
#[inline(always)]
pub fn lane_indices() -> f32x8 {
    f32x8::new([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
}

/// The number of each of sixteen lanes.
#[inline(always)]
pub fn line_indices() -> LineLanes {
    LineLanes::new(std::array::from_fn(|i| i as f32))
}

/// [`low_half`] of sixteen words.
#[inline(always)]
pub fn low_halves(words: u32x16) -> f32x16 {
    f32x16::from_i32x16(wide::bytemuck::cast(words & u32x16::splat(0xffff)))
}

/// [`high_half`] of sixteen words.
#[inline(always)]
pub fn high_halves(words: u32x16) -> f32x16 {
    f32x16::from_i32x16(wide::bytemuck::cast(words >> 16_u32))
}

/// `exp(-x)` for `0 <= x <= 4.5`, off by less than 1e-5: an eighth of x by Taylor's series, then
/// three squarings.
pub fn exp_negative(x: f32x8) -> f32x8 {
    let y = x * -0.125;
    let e = ((((y * (1.0 / 120.0) + 1.0 / 24.0) * y + 1.0 / 6.0) * y + 0.5) * y + 1.0) * y + 1.0;
    let e2 = e * e;
    let e4 = e2 * e2;
    e4 * e4
}

/// Of the words from `start` on, those with the given numbers and the ones after them. Numbers
/// ascend from 0 or 1, each at most 2 more than the one before.
#[inline(always)]
pub fn pick_words(words: &[u32], start: usize, numbers: i32x16) -> [u32x16; 2] {
    debug_assert!(
        (0..=1).contains(&numbers.as_array()[0]) && (0..31).contains(&numbers.as_array()[15]),
        "{numbers:?}"
    );
    if cfg!(target_feature = "avx512f") {
        let run = |start: usize| {
            let lanes: &[u32; 16] =
                words[start..start + 16].try_into().expect("a slice of sixteen");
            u32x16::new(*lanes)
        };
        let runs = [run(start), run(start + 16)];
        let numbers: u32x16 = wide::bytemuck::cast(numbers);
        [numbers, numbers + u32x16::splat(1)]
            .map(|numbers| wide::ShuffleExt::shuffle(runs, numbers))
    } else {
        // Eight at a time: each half lies within sixteen words of its own.
        let halves: [i32x8; 2] = wide::bytemuck::cast(numbers);
        let [[a, b], [c, d]] = halves.map(|numbers| {
            let first = numbers.as_array()[0];
            let run = |start: usize| {
                let lanes: &[u32; 8] =
                    words[start..start + 8].try_into().expect("a slice of eight");
                u32x8::new(*lanes)
            };
            let start = start + first as usize;
            let runs = [run(start), run(start + 8)];
            [0, 1].map(|next| pick_eight(runs, numbers - i32x8::splat(first - next)))
        });
        [wide::bytemuck::cast([a, c]), wide::bytemuck::cast([b, d])]
    }
}

/// Of sixteen words in a row, those with the given numbers, 0 to 15, by a selection of two: faster
/// than what shuffles of two vectors are made of.
#[inline(always)]
fn pick_eight(words: [u32x8; 2], numbers: i32x8) -> u32x8 {
    let is_second: i32x8 = numbers.simd_gt(i32x8::splat(7));
    let numbers = as_unsigned(numbers) & u32x8::splat(7);
    let [first, second] = words.map(|words| as_signed(words.shuffle(numbers)));
    as_unsigned(is_second.select(second, first))
}

/// Whether [`pick`] is a few instructions.
pub const HAS_SHUFFLE: bool = cfg!(target_feature = "avx2");

/// Of sixteen words, those with the given numbers, 0 to 15.
#[inline(always)]
pub fn pick(run: u32x16, numbers: u32x16) -> u32x16 {
    if cfg!(target_feature = "avx512f") {
        run.shuffle(numbers)
    } else {
        let run = halves(run);
        join_words(halves(numbers).map(|numbers| pick_eight(run, as_signed(numbers))))
    }
}

/// Of the 64-bit words at eight places, the lower halves and then the upper ones.
#[inline(always)]
pub fn gather(words: &[u64], places: u32x8) -> u32x16 {
    let found = places.as_array().map(|place| words[place as usize]);
    if HAS_SHUFFLE {
        let numbers = u32x16::new(std::array::from_fn(|lane| (lane % 8 * 2 + lane / 8) as u32));
        pick(wide::bytemuck::cast(wide::u64x8::new(found)), numbers)
    } else {
        join_words([0, 32].map(|from| u32x8::new(found.map(|word| (word >> from) as u32))))
    }
}

/// The lanes in the order of the given numbers, 0 to 7.
#[inline(always)]
pub fn permute(values: f32x8, numbers: [u32; 8]) -> f32x8 {
    let words: i32x8 = wide::bytemuck::cast(values);
    lanes(words.shuffle(u32x8::new(numbers)))
}

/// The differences along the row and along the column of each 2x2 quad, lane `4 * quad + 2 * dy + dx`.
#[inline(always)]
pub fn in_quads(values: f32x8) -> [f32x8; 2] {
    let ends = |high, low| permute(values, high) - permute(values, low);
    [
        ends([1, 1, 3, 3, 5, 5, 7, 7], [0, 0, 2, 2, 4, 4, 6, 6]),
        ends([2, 3, 2, 3, 6, 7, 6, 7], [0, 1, 0, 1, 4, 5, 4, 5]),
    ]
}

/// The same bits as signed numbers.
pub fn as_signed(words: u32x8) -> i32x8 {
    wide::bytemuck::cast(words)
}

/// The same bits as unsigned numbers.
pub fn as_unsigned(words: i32x8) -> u32x8 {
    wide::bytemuck::cast(words)
}

/// The bits of sixteen lanes.
#[inline(always)]
pub fn words(lanes: f32x16) -> u32x16 {
    wide::bytemuck::cast(lanes)
}

/// Sixteen lanes of those bits.
#[inline(always)]
pub fn from_words(words: u32x16) -> f32x16 {
    wide::bytemuck::cast(words)
}

/// The lanes of a comparison, all bits or none, as a mask of whole numbers.
pub fn mask(comparison: f32x8) -> i32x8 {
    wide::bytemuck::cast(comparison)
}

/// A mask of whole numbers as the lanes of a comparison.
pub fn lanes(mask: i32x8) -> f32x8 {
    wide::bytemuck::cast(mask)
}

/// [`as_signed`] of sixteen words.
#[inline(always)]
pub fn as_signed_words(words: u32x16) -> i32x16 {
    wide::bytemuck::cast(words)
}

/// [`as_unsigned`] of sixteen words.
#[inline(always)]
pub fn as_unsigned_words(words: i32x16) -> u32x16 {
    wide::bytemuck::cast(words)
}

/// [`mask`] of sixteen lanes.
#[inline(always)]
pub fn as_ray_mask(comparison: f32x16) -> i32x16 {
    wide::bytemuck::cast(comparison)
}

/// [`lanes`] of sixteen lanes.
#[inline(always)]
pub fn ray_lanes(mask: i32x16) -> f32x16 {
    wide::bytemuck::cast(mask)
}

/// All bits of those of sixteen lanes whose bit is set.
#[inline(always)]
pub fn lane_mask(bits: u32) -> i32x16 {
    let of_lanes = u32x16::new(std::array::from_fn(|lane| 1 << lane));
    as_signed_words((u32x16::splat(bits) & of_lanes).simd_eq(of_lanes))
}

/// The four values of each pixel of two quads, whose lanes the vectors are, value by value.
#[inline(always)]
pub fn quads_by_pixel(values: [f32x8; 4]) -> [[[f32; 4]; 4]; 2] {
    let values: [[f32x4; 2]; 4] = wide::bytemuck::cast(values);
    [0, 1].map(|quad| wide::bytemuck::cast(f32x4::transpose(values.map(|halves| halves[quad]))))
}

/// The sum of the lanes of each of eight vectors, in one fixed order on every machine.
#[inline(always)]
pub fn sums_of_eight(vectors: [f32x16; 8]) -> f32x8 {
    let [a, b, c, d, e, f, g, h] =
        f32x8::transpose(vectors.map(split).map(|[near, far]| near + far));
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// Both halves of sixteen words, the lower one of each first, as signed numbers.
#[inline(always)]
pub fn as_pairs(words: u32x16) -> i16x32 {
    wide::bytemuck::cast(words)
}

/// Sixteen lanes of two vectors of eight.
pub fn join(halves: [f32x8; 2]) -> f32x16 {
    wide::bytemuck::cast(halves)
}

/// The two vectors of eight that sixteen lanes are.
pub fn split(lanes: f32x16) -> [f32x8; 2] {
    wide::bytemuck::cast(lanes)
}

/// Sixteen words of two vectors of eight.
pub fn join_words(halves: [u32x8; 2]) -> u32x16 {
    wide::bytemuck::cast(halves)
}

/// The two vectors of eight that sixteen words are.
pub fn halves(words: u32x16) -> [u32x8; 2] {
    wide::bytemuck::cast(words)
}
