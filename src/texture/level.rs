//! One level of a pyramid: packed texels, once with rows along u and once with rows along v.
//!
//! A texel is two words, `red | green << 16` and `blue | height << 16`, each 0 to [`FULL`] in
//! linear light or height, and, where normals are kept, a third word (see [`pack_normal`]).

use super::rows::Rows;
use crate::simd::{TexelLanes, as_signed, u32x8};

/// What a packed colour's `color_scale`, or a height on the polygon, is stored as. Fifteen of the
/// sixteen bits: then the difference of two texels is a signed 16-bit number, and lanes interpolate
/// two channels of a texel at once.
pub const FULL: u32 = 32767;

/// [`FULL`] as a number.
pub(crate) const FULL_F32: f32 = FULL as f32;

/// One texel, or the mean of several, in the units that a [`Surface`](super::Surface) stores.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Texel {
    /// Linear RGB: [`FULL`] stands for the surface's colour scale.
    pub color: [f32; 3],
    /// Normal in the frame of the texture: x along u, y along v, z off the surface; a mean is
    /// shorter than one where normals differ.
    pub normal: [f32; 3],
}

impl Texel {
    /// The normal of a surface without relief.
    pub const UP: [f32; 3] = [0.0, 0.0, 1.0];

    /// This where `t` is 0, the other where it is 1.
    pub fn lerp(&self, other: &Self, t: f32) -> Self {
        let mix = |a: [f32; 3], b: [f32; 3]| std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t);
        Self { color: mix(self.color, other.color), normal: mix(self.normal, other.normal) }
    }
}

/// One level of a [`Surface`](super::Surface)'s pyramid. Columns and rows are those of the endless
/// pattern: any number stands for a texel, by the surface's [`Wrap`](super::Wrap).
#[derive(Clone, Debug)]
pub struct Level {
    texels_per_repeat: [f32; 2],
    /// Rows along u, and the same texels with rows along v.
    rows: [Rows; 2],
}

impl Level {
    /// A level from its rows along u, of a pattern that spans so many repeats of the texture.
    pub(super) fn new(rows: Rows, num_repeats: u32) -> Self {
        let share = 1.0 / num_repeats as f32;
        let texels_per_repeat = [rows.width(), rows.height()].map(|n| n as f32 * share);
        let turned = rows.turned();
        Self { texels_per_repeat, rows: [rows, turned] }
    }

    /// The same level with every texel in one packed colour.
    pub(super) fn in_color(&self, color: [u32; 3]) -> Self {
        Self { rows: self.rows.each_ref().map(|rows| rows.in_color(color)), ..*self }
    }

    /// Texels that are stored along u and along v before the pattern wraps: two repeats of a
    /// mirrored texture, else one.
    pub fn size(&self) -> [usize; 2] {
        [self.rows[0].width(), self.rows[0].height()]
    }

    /// Texels per texture repeat along u and v.
    #[inline(always)]
    pub fn texels_per_repeat(&self) -> [f32; 2] {
        self.texels_per_repeat
    }

    /// The texels row by row: along u, or along v where they are wanted turned.
    #[inline(always)]
    pub(crate) fn rows(&self, is_turned: bool) -> &Rows {
        &self.rows[usize::from(is_turned)]
    }

    /// A place in repeats as one in texels, whose centres lie at halves.
    #[inline(always)]
    pub(crate) fn in_texels(&self, place: [f32; 2]) -> [f32; 2] {
        [place[0] * self.texels_per_repeat[0], place[1] * self.texels_per_repeat[1]]
    }

    /// Whether texels have a normal of their own.
    pub(crate) fn has_normals(&self) -> bool {
        self.rows[0].has_normals()
    }

    /// The texel at a column and row; without normals of its own a surface is flat.
    pub fn texel(&self, x: i32, y: i32) -> Texel {
        let [red_green, blue_height, normal] = self.rows[0].packed(x, y);
        let color = [red_green & 0xffff, red_green >> 16, blue_height & 0xffff].map(|c| c as f32);
        Texel { color, normal: if self.has_normals() { unpack_normal(normal) } else { Texel::UP } }
    }

    /// The height, 0 to 1, at a column and row; 1 lies on the polygon.
    pub fn height_at(&self, x: i32, y: i32) -> f32 {
        (self.rows[0].packed(x, y)[1] >> 16) as f32 * (1.0 / FULL_F32)
    }

    /// Bytes that the level takes.
    pub(crate) fn num_bytes(&self) -> usize {
        self.rows.iter().map(Rows::num_bytes).sum()
    }
}

/// A normal (components -1 to 1, length at most 1) in one word: x and y in 11 bits, z in 10.
pub(crate) fn pack_normal(n: [f32; 3]) -> u32 {
    let unit = |c: f32, most: f32| ((c.clamp(-1.0, 1.0) * 0.5 + 0.5) * most + 0.5) as u32;
    unit(n[0], 2046.0) | unit(n[1], 2046.0) << 11 | unit(n[2], 1022.0) << 22
}

/// The inverse of [`pack_normal`].
pub(crate) fn unpack_normal(word: u32) -> [f32; 3] {
    let signed = |bits: u32, half: f32| (bits as f32 - half) / half;
    [signed(word & 2047, 1023.0), signed(word >> 11 & 2047, 1023.0), signed(word >> 22, 511.0)]
}

/// [`unpack_normal`] of eight words.
pub(crate) fn unpack_normals(words: u32x8) -> [TexelLanes; 3] {
    let number = |bits: u32x8| TexelLanes::from_i32x8(as_signed(bits));
    let [x, y, z] =
        [words & u32x8::splat(2047), words >> 11_u32 & u32x8::splat(2047), words >> 22_u32]
            .map(number);
    [x * (1.0 / 1023.0) - 1.0, y * (1.0 / 1023.0) - 1.0, z * (1.0 / 511.0) - 1.0]
}
