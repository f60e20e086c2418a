//! What is seen of a relief from afar: tables of the seen colour for a set of directions.
//!
//! Averaging heights into mip levels loses the occlusion finer than a texel of the level. So for large footprints not
//! what is there is prefiltered, but what is *seen*: for a displacement `D` (texels down to the deepest relief), the image
//! `P_D(b)` of the colour seen over the base coordinate `b` is an ordinary texture, and its mip levels are right. A table
//! holds `P_D` at coarse levels for lengths of `D` in geometric steps times azimuths, addressed by the place on the mean
//! depth plane, `q = b + mean D`, so that neighbouring directions line up. A pixel is the elliptical weighted average of
//! formula (2) over the blend of the four nearest directions. Its cost does not depend on the distance.
//!
//! A table texel is one word: the square roots of red, green and blue in 11, 11 and 10 bits.

mod build;
mod encode;
mod sample;

use crate::settings::Settings;
use crate::texture::{Surface, Wrap};
use encode::FarImage;

/// Texels of a table's finest level at the most: the larger the maps, the coarser the level that tables begin on.
const MOST_TEXELS: usize = 128 * 128;

/// Lengths of `D`, in texture repeats times the relief depth, that tables are made for: slopes from gentle to grazing. A
/// gentler one hides too little to matter in a large footprint; a steeper one takes the last table.
const SLOPES: [f32; 2] = [0.25, 32.0];

/// Tables of the seen colour of one surface.
#[derive(Clone, Debug)]
pub struct FarField {
    /// The mip level of the tables' finest level.
    first_level: usize,
    /// Lengths of `D` in base texels, from the shortest, as [`pseudo_log`] values: the first and the step.
    lengths: [f32; 2],
    num_lengths: usize,
    num_azimuths: usize,
    /// Mean depth of the surface, 0 to 1.
    mean_depth: f32,
    /// By length, then azimuth.
    images: Vec<FarImage>,
    /// How many mip levels finer a sweep must be than its lines ask for, by length.
    level_bias: Vec<usize>,
}

impl FarField {
    /// Builds the tables within the memory that the settings grant; `None` for a surface without relief, with edges that
    /// do not repeat, or too small to need tables.
    #[must_use]
    pub fn new(surface: &Surface, settings: &Settings) -> Option<Self> {
        let first_level = surface.levels.iter().position(|level| level.width * level.height <= MOST_TEXELS)?;
        if surface.relief_depth == 0.0 || surface.wrap == Wrap::Clamp || first_level == 0 {
            return None;
        }
        let [num_lengths, num_azimuths] = grid(surface, first_level, settings);
        let texels = surface.texels_per_repeat(0);
        let unit = surface.relief_depth * texels[0].max(texels[1]);
        let [first, last] = SLOPES.map(|slope| pseudo_log(slope * unit));
        let step = (last - first) / (num_lengths - 1) as f32;
        let mut far = Self {
            first_level,
            lengths: [first, step],
            num_lengths,
            num_azimuths,
            mean_depth: build::mean_depth(surface),
            images: Vec::new(),
            level_bias: Vec::new(),
        };
        far.images = build::images(surface, &far);
        far.level_bias = build::level_bias(surface, &far);
        Some(far)
    }

    /// Bytes that the tables take.
    #[must_use]
    pub fn num_bytes(&self) -> usize {
        self.images.iter().map(FarImage::num_bytes).sum()
    }

    /// How many mip levels finer than its lines ask for a sweep must be for its displacement (base texels), because the
    /// level would lose what hides behind ridges finer than its texels.
    #[must_use]
    pub fn level_bias(&self, displacement: [f32; 2]) -> usize {
        let [du, dv] = displacement;
        let place = (pseudo_log((du * du + dv * dv).sqrt()) - self.lengths[0]) / self.lengths[1];
        self.level_bias[(place + 0.5).clamp(0.0, (self.num_lengths - 1) as f32) as usize]
    }

    /// The displacement of a table, in base texels.
    fn displacement(&self, length: usize, azimuth: usize) -> [f32; 2] {
        let size = pseudo_exp(self.lengths[0] + self.lengths[1] * length as f32);
        let [x, y] = diamond_direction(4.0 * azimuth as f32 / self.num_azimuths as f32);
        [x * size, y * size]
    }

    /// The four nearest tables and their shares.
    fn neighbours(&self, [du, dv]: [f32; 2]) -> [(usize, f32); 4] {
        let length = (pseudo_log((du * du + dv * dv).sqrt()) - self.lengths[0]) / self.lengths[1];
        let length = length.clamp(0.0, (self.num_lengths - 1) as f32);
        let near = (length as usize).min(self.num_lengths - 2);
        let along = length - near as f32;
        let azimuth = diamond_angle(du, dv) * (self.num_azimuths as f32 * 0.25);
        let (left, across) = (azimuth as usize % self.num_azimuths, azimuth - azimuth.floor());
        let right = (left + 1) % self.num_azimuths;
        let at = |length: usize, azimuth: usize| length * self.num_azimuths + azimuth;
        [
            (at(near, left), (1.0 - along) * (1.0 - across)),
            (at(near, right), (1.0 - along) * across),
            (at(near + 1, left), along * (1.0 - across)),
            (at(near + 1, right), along * across),
        ]
    }
}

/// How many lengths and azimuths fit into the memory: about twice as many azimuths.
fn grid(surface: &Surface, first_level: usize, settings: &Settings) -> [usize; 2] {
    let words: usize = surface.levels[first_level..].iter().map(|l| FarImage::num_words(l.width, l.height)).sum();
    let num = (settings.far_field_mib as usize * (1 << 20) / (words * 4)).clamp(16, 12 * 32);
    let num_azimuths = (((2 * num) as f32).sqrt() as usize / 4 * 4).max(8);
    [(num / num_azimuths).max(2), num_azimuths]
}

/// The binary logarithm, linear between powers of two: the same bits on every machine.
fn pseudo_log(x: f32) -> f32 {
    let bits = x.max(f32::MIN_POSITIVE).to_bits();
    ((bits >> 23) as i32 - 127) as f32 + (f32::from_bits(bits & 0x007f_ffff | 0x3f80_0000) - 1.0)
}

/// The inverse of [`pseudo_log`].
fn pseudo_exp(y: f32) -> f32 {
    let whole = y.floor();
    f32::from_bits(((whole as i32 + 127) as u32) << 23) * (1.0 + y - whole)
}

/// The angle of a direction as a number from 0 to 4 that grows evenly along the diamond `|x| + |y| = 1`.
fn diamond_angle(x: f32, y: f32) -> f32 {
    let part = y / (x.abs() + y.abs()).max(f32::MIN_POSITIVE);
    let angle = if x < 0.0 {
        2.0 - part
    } else if part < 0.0 {
        4.0 + part
    } else {
        part
    };
    if angle < 4.0 { angle } else { 0.0 }
}

/// The unit vector of a [`diamond_angle`].
fn diamond_direction(angle: f32) -> [f32; 2] {
    let y = if angle < 1.0 {
        angle
    } else if angle < 3.0 {
        2.0 - angle
    } else {
        angle - 4.0
    };
    let x = (1.0 - y.abs()) * if (1.0..3.0).contains(&angle) { -1.0 } else { 1.0 };
    let length = (x * x + y * y).sqrt();
    [x / length, y / length]
}
