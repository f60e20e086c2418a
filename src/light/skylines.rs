//! What each texel of a relief sees of the half space above it: how high the relief stands around it.
//!
//! The *skyline* of a texel is the sine of the elevation below which all is relief, by azimuth `f` around
//! the surface's normal. A texel keeps the first harmonics of it:
//!
//! ```text
//! s(f) = h0 + a1 cos f + b1 sin f + a2 cos 2f + b2 sin 2f + a3 cos 3f + b3 sin 3f
//! ```
//!
//! `h0` says how deep the texel lies, `a1` and `b1` to which side it is open, and `a2` and `b2` along which
//! line: a joint between stones is open along itself, and to neither side. They interpolate as they are, and
//! what they say of a direction takes no angle. Coarser levels have means.

use super::beams::TextureFrame;
use super::byte_levels::ByteLevels;
use super::texel_light::lit_parts;
use crate::scene::angle::cos_sin;
use crate::simd::{BETWEEN_SCALE, Between, Lanes, LineLanes, TexelLanes, as_signed, u32x8};
use crate::texture::{Rows, Surface};
use glam::Vec3;
use rayon::prelude::*;

/// Terms of a skyline.
pub(super) const NUM_TERMS: usize = 7;

/// The skylines of texels in lanes, by their terms.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Skyline<L>([L; NUM_TERMS]);

/// The skylines of a surface's texels, level by level.
#[derive(Clone, Debug)]
pub struct Skylines(ByteLevels);

/// What a byte's step is worth: they go from -1 to 1.
const STEP: f32 = 2.0 / 254.0;

/// The byte of 0.
const ZERO: f32 = 127.0;

/// Where the bytes of the terms lie: words, and first bits.
const PLACES: [(usize, u32); NUM_TERMS] =
    [(0, 0), (0, 8), (0, 16), (0, 24), (1, 0), (1, 8), (1, 16)];

/// Azimuths that skylines are told from, and heights of light in each.
const NUM_AZIMUTHS: usize = 12;
const NUM_HEIGHTS: usize = 12;

/// The words of a texel.
pub(super) const NUM_SKYLINE_WORDS: usize = 2;

/// Adds what one azimuth gives, with the sine there times its share of all the way round.
pub(super) fn add_harmonics(terms: &mut [f32; NUM_TERMS], [x, y]: [f32; 2], sine: f32) {
    let (c2, s2) = (x * x - y * y, 2.0 * x * y);
    let (c3, s3) = (x * c2 - y * s2, y * c2 + x * s2);
    terms[0] += sine;
    let others = [x, y, c2, s2, c3, s3];
    terms[1..].iter_mut().zip(others).for_each(|(term, of)| *term += 2.0 * sine * of);
}

/// Terms in words.
pub(super) fn packed(terms: [f32; NUM_TERMS]) -> [u32; NUM_SKYLINE_WORDS] {
    let byte = |c: f32| (c / STEP + ZERO + 0.5).clamp(0.0, 254.0) as u32;
    let mut words = [0; NUM_SKYLINE_WORDS];
    PLACES.iter().zip(terms).for_each(|(&(i, first), c)| words[i] |= byte(c) << first);
    words
}

impl Skylines {
    /// Finds those of a flat piece of a surface with relief.
    pub fn new(surface: &Surface, frame: &TextureFrame) -> Self {
        let texels = skylines(surface, frame).into_iter().map(packed).collect();
        Self(ByteLevels::new(texels, surface.base().size(), surface.wrap()))
    }

    /// Those of a level row by row, in two planes: along u, or along v where they are wanted turned.
    pub(crate) fn rows(&self, level: usize, is_turned: bool) -> &Rows {
        self.0.rows(level, is_turned)
    }
}

/// The skylines of a flat piece of a surface, texel by texel along u.
fn skylines(surface: &Surface, frame: &TextureFrame) -> Vec<[f32; NUM_TERMS]> {
    let [width, height] = surface.base().size();
    let mut skylines = vec![[0.0; NUM_TERMS]; width * height];
    for azimuth in 0..NUM_AZIMUTHS {
        let [cos, sin] = cos_sin(azimuth as f64 / NUM_AZIMUTHS as f64).map(|c| c as f32);
        // Light whose sines are evenly spaced: what of it does not get there lies below the skyline.
        let beams = (0..NUM_HEIGHTS).filter_map(|i| {
            let up = (i as f32 + 0.5) / NUM_HEIGHTS as f32;
            let across = (1.0 - up * up).sqrt();
            frame.beam(frame.world(Vec3::new(cos * across, sin * across, up)), Vec3::ONE)
        });
        let lit = lit_parts(surface, &beams.collect::<Vec<_>>());
        skylines.par_chunks_exact_mut(width).enumerate().for_each(|(y, texels)| {
            for (x, texel) in texels.iter_mut().enumerate() {
                let sine = 1.0 - lit(x, y);
                add_harmonics(texel, [cos, sin], sine / NUM_AZIMUTHS as f32);
            }
        });
    }
    skylines
}

impl Skyline<LineLanes> {
    /// That of a plane.
    pub(crate) const FLAT: Self = Self([LineLanes::ZERO; NUM_TERMS]);

    /// Those between texels of a run whose words start at a place.
    #[inline(always)]
    pub(crate) fn at(rows: &Rows, start: usize, between: &Between) -> Self {
        let words =
            [0, 1].map(|plane| between.words_at(rows.words(), start + plane * rows.stride()));
        Self(PLACES.map(|(i, first)| {
            between.bits_of(words[i], first, 0xff) * (STEP / BETWEEN_SCALE) - ZERO * STEP
        }))
    }
}

impl Skyline<TexelLanes> {
    /// That of a plane.
    pub(crate) const FLAT: Self = Self([TexelLanes::ZERO; NUM_TERMS]);

    /// Those of eight texels, by their words in both planes.
    #[inline(always)]
    pub(crate) fn unpack(words: [u32x8; 2]) -> Self {
        Self(PLACES.map(|(i, first)| {
            let byte = words[i] >> first & u32x8::splat(0xff);
            TexelLanes::from_i32x8(as_signed(byte)) * STEP - ZERO * STEP
        }))
    }
}

impl<L: Lanes> Skyline<L> {
    /// By its terms.
    #[cfg(test)]
    pub(super) fn new(terms: [L; NUM_TERMS]) -> Self {
        Self(terms)
    }

    /// Between this one and another.
    #[inline(always)]
    pub(crate) fn mix(&self, other: &Self, part: L) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + (other.0[i] - self.0[i]) * part))
    }

    /// By how far a unit direction lies above it: the sine of the angle, as a lobe of some width sees it.
    #[inline(always)]
    pub(super) fn above(&self, [x, y, z]: [L; 3], width: L) -> L {
        let [h0, a1, b1, a2, b2, a3, b3] = self.0;
        let one = L::splat(1.0);
        let square = x * x + y * y;
        let along = square.at_least(1e-8).sqrt();
        let inverse = one / along;
        let (c1, s1) = (x * inverse, y * inverse);
        let (c2, s2) = (c1 * c1 - s1 * s1, c1 * s1 + c1 * s1);
        let (c3, s3) = (c1 * c2 - s1 * s2, s1 * c2 + c1 * s2);
        // The wider a lobe is, and the steeper it goes up, the more azimuths it sees at once.
        let wide = width * width;
        let seen = |k: f32| square / (square + wide * L::splat(k * k)).at_least(1e-8);
        let sine = h0
            + (a1 * c1 + b1 * s1) * seen(1.0)
            + (a2 * c2 + b2 * s2) * seen(2.0)
            + (a3 * c3 + b3 * s3) * seen(3.0);
        let sine = sine.at_least(0.0).at_most(1.0);
        z * (one - sine * sine).sqrt() - along * sine
    }

    /// The middle of what is open, of about unit length.
    #[inline(always)]
    pub(super) fn middle(&self) -> [L; 3] {
        let [_, a1, b1, ..] = self.0;
        let none = L::splat(0.0);
        [none - a1, none - b1, L::splat(1.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::{HeightImage, SurfaceMaps};

    /// How far directions at some elevation and azimuths, in eighths of a turn, lie above a skyline.
    fn above(skyline: [f32; NUM_TERMS], sine: f32, eighths: [f32; 3]) -> [f32; 3] {
        let skyline = Skyline(skyline.map(TexelLanes::splat));
        eighths.map(|eighth| {
            let [cos, sin] = cos_sin(f64::from(eighth) / 8.0);
            let across = (1.0 - sine * sine).sqrt();
            let direction = [cos as f32 * across, sin as f32 * across, sine];
            let above = skyline.above(direction.map(TexelLanes::splat), TexelLanes::splat(0.01));
            above.to_array()[0]
        })
    }

    #[test]
    fn directions_lie_over_a_skyline_by_the_sine_of_the_angle() {
        // Even all round, 30 degrees high: at 30, 60 and 0 degrees.
        let even = [0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        for (sine, expected) in [(0.5, 0.0), (0.75_f32.sqrt(), 0.5), (0.0, -0.5)] {
            for found in above(even, sine, [0.0, 1.3, 5.1]) {
                assert!((found - expected).abs() < 1e-3, "{sine}: {found} {expected}");
            }
        }
        // Open along u: at 0 and 180 degrees it is low, at 90 as high as 60 degrees.
        let joint = [0.433, 0.0, 0.0, -0.433, 0.0, 0.0, 0.0];
        let [ahead, across, behind] = above(joint, 0.5, [0.0, 2.0, 4.0]);
        assert!(ahead > 0.49 && behind > 0.49 && (across + 0.5).abs() < 0.01, "{ahead} {across}");
        // The third harmonic has three sides.
        let [at_0, at_120, at_60] =
            above([0.3, 0.0, 0.0, 0.0, 0.0, 0.2, 0.0], 0.3, [0.0, 8.0 / 3.0, 4.0 / 3.0]);
        assert!((at_0 - at_120).abs() < 1e-3 && at_60 > at_0 + 0.3, "{at_0} {at_120} {at_60}");
    }

    #[test]
    fn a_groove_is_open_along_itself() {
        // A groove along u, 8 texels wide and 6 deep, in the middle of a plane.
        let size = 64_u32;
        let is_groove = |y: u32| (28..36).contains(&y);
        let height = HeightImage::from_fn(size, size, |_, y| if is_groove(y) { 0.0 } else { 1.0 });
        let maps = SurfaceMaps {
            height: Some(height),
            relief_depth: 6.0 / size as f32,
            ..SurfaceMaps::default()
        };
        let surface = Surface::new(maps).unwrap();
        let frame = TextureFrame { tangents: [Vec3::X, Vec3::NEG_Z], normal: Vec3::Y };
        let terms = skylines(&surface, &frame);
        let [bottom, top] = [32, 8].map(|y| terms[y * size as usize + 20]);
        // Walls stand 4 texels away to both sides, 6 high: a sine of 0.83. Along the groove there are none,
        // of which three harmonics tell most.
        let sine = |eighth: f32| -above(bottom, 0.0, [eighth; 3])[0];
        let sines = [0.0, 4.0, 2.0, 6.0].map(sine);
        assert!(sines[..2].iter().all(|sine| *sine < 0.35), "{sines:?}");
        assert!(sines[2..].iter().all(|sine| *sine > 0.7), "{sines:?}");
        assert!(top.iter().all(|term| term.abs() < 0.02), "{top:?}");
    }
}
