//! What hides the light of any direction from each texel of a relief: for curved surfaces, which
//! light meets in all directions.
//!
//! For each of [`NUM_AZIMUTHS`] directions along the texture a texel keeps its *horizon*: how high
//! light must come in to reach it. Whether a sun reaches the texel is a comparison, so the edge of a
//! shadow is as sharp as the texels, whatever the sun's height.
//!
//! A height is `c = t / (1 + t)`, with `t` the tangent of light's elevation in the texture's own
//! lengths: 0 along the surface, 1 straight down. A byte holds its root, which is finer where light
//! grazes and shadows are long. Horizons come from sweeps along light whose heights' roots are evenly
//! spaced ([`LitParts`]): what of them reaches the texel lies above its horizon.
//!
//! The sky comes from all directions, and is taken for linear in the direction over the half space
//! that a place sees: `L(l) = c0 + c.l`. Then a texel shows `c0 t0 + c.t` of it, with
//!
//! ```text
//! t0 = 1/pi int max(0, n.l) V dl        t = 1/pi int max(0, n.l) V l dl
//! ```
//!
//! which are four numbers of the texel, summed over its horizons. What is glossy reflects a part of the sky
//! alone, and is asked where that lies over the [skyline](super::skylines).

use super::byte_levels::ByteLevels;
use super::skylines::{NUM_SKYLINE_WORDS, NUM_TERMS, add_harmonics, packed};
use crate::relief::directions::diamond_direction;
use crate::relief::{LitParts, MAX_SLOPE, RowScratch};
use crate::texture::{Level, Rows, Surface};
use rayon::prelude::*;

/// Directions along the texture, evenly spaced as [diamond angles](crate::relief::directions). Measured,
/// a lit torus at 640x360: 16 of them 38.8 dB, 24 39.6, 32 39.9.
pub const NUM_AZIMUTHS: usize = 32;

/// Heights of light that horizons are found by; twice as many tell nothing more.
const NUM_HEIGHTS: usize = 32;

/// The plane of each texel's normal, x, y and z from -1 to 1, and `t0`.
pub const NORMAL_PLANE: usize = NUM_AZIMUTHS / 4;

/// The plane of `t`: x and y from -1 to 1, z from 0.
pub const SKY_PLANE: usize = NORMAL_PLANE + 1;

/// The first plane of the skylines, where there are any.
pub const SKYLINE_PLANE: usize = SKY_PLANE + 1;

/// Words of a texel: four horizons each, then those two, then those of its skyline.
const NUM_WORDS: usize = SKYLINE_PLANE;
const NUM_WORDS_OF_GLOSSY: usize = SKYLINE_PLANE + NUM_SKYLINE_WORDS;

/// The horizons of a surface's texels, level by level.
#[derive(Clone, Debug)]
pub struct Horizons(ByteLevels);

impl Horizons {
    /// Finds the horizons of a surface with relief.
    pub fn new(surface: &Surface) -> Self {
        Self::in_words::<NUM_WORDS>(surface)
    }

    /// And its skylines.
    pub fn with_skylines(surface: &Surface) -> Self {
        Self::in_words::<NUM_WORDS_OF_GLOSSY>(surface)
    }

    fn in_words<const N: usize>(surface: &Surface) -> Self {
        let level = surface.base();
        let size = level.size();
        let mut texels = vec![[0; N]; size[0] * size[1]];
        for azimuth in 0..NUM_AZIMUTHS {
            let lit = LitHeights::new(level, azimuth, surface.relief_depth());
            let (word, shift) = (azimuth / 4, azimuth % 4 * 8);
            texels.par_chunks_exact_mut(size[0]).enumerate().for_each(|(y, texels)| {
                for (x, texel) in texels.iter_mut().enumerate() {
                    let horizon = 1.0 - lit.at(x, y) * (1.0 / NUM_HEIGHTS as f32);
                    texel[word] |= byte(horizon) << shift;
                }
            });
        }
        let sky = SkySums::new();
        texels.par_chunks_exact_mut(size[0]).enumerate().for_each(|(y, texels)| {
            for (x, texel) in texels.iter_mut().enumerate() {
                let normal = level.texel(x as i32, y as i32).normal;
                [texel[NORMAL_PLANE], texel[SKY_PLANE]] = sky.words(texel, normal);
                if N > SKYLINE_PLANE {
                    let skyline = sky.skyline(texel);
                    texel[SKYLINE_PLANE..].copy_from_slice(&skyline);
                }
            }
        });
        Self(ByteLevels::new(texels, size, surface.wrap()))
    }

    /// The words of a texel of the finest level.
    pub fn texel(&self, x: i32, y: i32) -> Vec<u32> {
        let rows = self.rows(0, false);
        let start = rows.start_at(x, y);
        (0..rows.num_planes()).map(|plane| rows.words()[start + plane * rows.stride()]).collect()
    }

    /// The words of a level row by row: along u, or along v where they are wanted turned.
    pub(crate) fn rows(&self, level: usize, is_turned: bool) -> &Rows {
        self.0.rows(level, is_turned)
    }
}

fn byte(c: f32) -> u32 {
    (c * 255.0 + 0.5).clamp(0.0, 255.0) as u32
}

/// How many of the heights of light from an azimuth reach each texel: in rows along u, and in rows
/// along v. Light of one azimuth is swept along the same rows at all heights, unless rounding
/// decides.
struct LitHeights {
    size: [usize; 2],
    sums: [Vec<f32>; 2],
}

impl LitHeights {
    fn new(level: &Level, azimuth: usize, relief_depth: f32) -> Self {
        let mut all = Self { size: level.size(), sums: [Vec::new(), Vec::new()] };
        let [x, y] = direction(azimuth);
        for i in 0..NUM_HEIGHTS {
            let root = (i as f32 + 0.5) / NUM_HEIGHTS as f32;
            let height = (root * root).max(1.0 / (1.0 + MAX_SLOPE));
            let reach = -relief_depth * (1.0 - height) / height;
            all.add(&LitParts::new(level, [x * reach, y * reach], relief_depth));
        }
        all
    }

    fn add(&mut self, lit: &LitParts) {
        let [width, height] = self.size;
        let sums = &mut self.sums[usize::from(lit.is_turned)];
        sums.resize(width * height, 0.0);
        let length = if lit.is_turned { height } else { width };
        sums.par_chunks_exact_mut(length).enumerate().for_each_init(
            Default::default,
            |(scratch, parts): &mut (RowScratch, Vec<f32>), (row, sums)| {
                lit.row(row, scratch, parts);
                sums.iter_mut().zip(parts).for_each(|(sum, part)| *sum += *part);
            },
        );
    }

    fn at(&self, x: usize, y: usize) -> f32 {
        let [width, height] = self.size;
        let [along_u, along_v] = &self.sums;
        let of = |sums: &[f32], i: usize| sums.get(i).copied().unwrap_or(0.0);
        of(along_u, y * width + x) + of(along_v, x * height + y)
    }
}

/// The unit direction of an azimuth.
fn direction(azimuth: usize) -> [f32; 2] {
    diamond_direction(azimuth as f32 * (4.0 / NUM_AZIMUTHS as f32))
}

/// What a texel shows of the sky, azimuth by azimuth.
struct SkySums {
    /// The direction of each, and its share of all the way round.
    azimuths: [([f32; 2], f32); NUM_AZIMUTHS],
    /// For each byte of a horizon the integrals above it, over the solid angle of all azimuths and
    /// over pi, of the elevation's `cos`, `sin`, `cos^2`, `sin cos` and `sin^2`.
    above: Vec<[f32; 5]>,
}

impl SkySums {
    fn new() -> Self {
        let directions: [[f32; 2]; NUM_AZIMUTHS] = std::array::from_fn(direction);
        // Chords stand for angles; together they are all the way round.
        let chord = |i: usize| {
            let [a, b] = [i, i + 1].map(|i| directions[i % NUM_AZIMUTHS]);
            ((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])).sqrt()
        };
        let all: f32 = (0..NUM_AZIMUTHS).map(chord).sum();
        let azimuths = std::array::from_fn(|i| {
            let share = (chord(i) + chord((i + NUM_AZIMUTHS - 1) % NUM_AZIMUTHS)) * 0.5 / all;
            (directions[i], share)
        });
        // From straight up down to each horizon.
        const STEPS: usize = 16;
        let mut above = vec![[0.0; 5]; 256];
        let mut sums = [0.0_f64; 5];
        for i in (0..255).rev() {
            for step in 0..STEPS {
                let c = |part: f64| {
                    let root = (i as f64 + 1.0 - part / STEPS as f64) / 255.0;
                    let c = root * root;
                    let inverse = 1.0 / (c * c + (1.0 - c) * (1.0 - c)).sqrt();
                    [(1.0 - c) * inverse, c * inverse]
                };
                let (from, to) = (c(step as f64 + 1.0), c(step as f64));
                let [cos, sin] = c(step as f64 + 0.5);
                // A solid angle is azimuth times sine; of all azimuths 2 pi, over pi.
                let share = 2.0 * (to[1] - from[1]);
                let of = [cos, sin, cos * cos, sin * cos, sin * sin];
                sums.iter_mut().zip(of).for_each(|(sum, of)| *sum += share * of);
            }
            above[i] = sums.map(|sum| sum as f32);
        }
        Self { azimuths, above }
    }

    /// The horizons of a texel, with their azimuths' directions and shares.
    fn horizons<'a>(
        &'a self,
        texel: &'a [u32],
    ) -> impl Iterator<Item = (usize, &'a ([f32; 2], f32))> {
        self.azimuths
            .iter()
            .enumerate()
            .map(|(i, azimuth)| ((texel[i / 4] >> (i % 4 * 8) & 0xff) as usize, azimuth))
    }

    fn words(&self, texel: &[u32], [nx, ny, nz]: [f32; 3]) -> [u32; 2] {
        let mut sums = [0.0_f32; 4];
        for (horizon, ([x, y], share)) in self.horizons(texel) {
            let [c, s, cc, sc, ss] = self.above[horizon];
            // n.l is `a cos + nz sin`.
            let a = nx * x + ny * y;
            let level = a * cc + nz * sc;
            let of = [a * c + nz * s, level * x, level * y, a * sc + nz * ss];
            sums.iter_mut().zip(of).for_each(|(sum, of)| *sum += of * share);
        }
        let word = |bytes: [f32; 4]| u32::from_le_bytes(bytes.map(|c| byte(c) as u8));
        let signed = |c: f32| c * 0.5 + 0.5;
        [
            word([signed(nx), signed(ny), signed(nz), sums[0]]),
            word([signed(sums[1]), signed(sums[2]), sums[3], 0.0]),
        ]
    }

    fn skyline(&self, texel: &[u32]) -> [u32; NUM_SKYLINE_WORDS] {
        let mut terms = [0.0; NUM_TERMS];
        for (horizon, (direction, share)) in self.horizons(texel) {
            let root = horizon as f32 / 255.0;
            let c = root * root;
            let sine = c / (c * c + (1.0 - c) * (1.0 - c)).sqrt();
            add_harmonics(&mut terms, *direction, sine * share);
        }
        packed(terms)
    }
}
