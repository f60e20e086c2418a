//! What each texel of a relief sees of the half space above it, as one cone.
//!
//! ```text
//! o = 1/pi int V l dl
//! ```
//!
//! over all directions, with V where nothing of the relief is in the way. Of a cone of half angle `t`
//! that is `sin^2 t` times the axis, so `o` says both; on a plane it is the normal, and a place deep in a
//! joint has a short one. Coarser levels have means.

use super::beams::TextureFrame;
use super::byte_levels::ByteLevels;
use super::texel_light::openings;
use crate::simd::{BETWEEN_SCALE, Between, LineLanes, TexelLanes, u32x8};
use crate::texture::{Rows, Surface};

/// The openings of a surface's texels, level by level.
#[derive(Clone, Debug)]
pub struct Openings(ByteLevels);

/// What a byte's step is worth: they go from -1 to 1.
const STEP: f32 = 2.0 / 254.0;

/// The byte of 0.
const ZERO: f32 = 127.0;

impl Openings {
    /// Finds those of a flat piece of a surface with relief.
    pub fn new(surface: &Surface, frame: &TextureFrame) -> Self {
        let byte = |c: f32| (c / STEP + ZERO + 0.5).clamp(0.0, 254.0) as u8;
        let word = |[x, y, z]: [f32; 3]| [u32::from_le_bytes([byte(x), byte(y), byte(z), 0])];
        let texels = openings(surface, frame).into_iter().map(word).collect();
        Self(ByteLevels::new(texels, surface.base().size(), surface.wrap()))
    }

    /// Those of a level row by row: along u, or along v where they are wanted turned.
    pub(crate) fn rows(&self, level: usize, is_turned: bool) -> &Rows {
        self.0.rows(level, is_turned)
    }
}

/// Openings between texels of a run that starts at a word.
#[inline(always)]
pub(crate) fn openings_at(rows: &Rows, start: usize, between: &Between) -> [LineLanes; 3] {
    let words = between.words_at(rows.words(), start);
    [0, 8, 16]
        .map(|first| between.bits_of(words, first, 0xff) * (STEP / BETWEEN_SCALE) - ZERO * STEP)
}

/// Openings of eight words.
#[inline(always)]
pub(crate) fn unpack_openings(words: u32x8) -> [TexelLanes; 3] {
    [0_u32, 8, 16].map(|first| {
        let byte = words >> first & u32x8::splat(0xff);
        TexelLanes::from_i32x8(crate::simd::as_signed(byte)) * STEP - ZERO * STEP
    })
}
