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

/// Slopes that tables are made for, from gentle to grazing. A gentler one hides too little to matter in a large footprint;
/// a steeper one takes the last table.
const SLOPES: [f32; 2] = [0.25, 28.0];

/// Lengths of `D` that tables are made for, in geometric steps over [`SLOPES`].
const NUM_LENGTHS: usize = 12;

/// Most azimuths of a length, and most tables: more cost more time to build than they gain.
const MOST_AZIMUTHS: usize = 72;
const MOST_TABLES: usize = 400;

/// Tables of the seen colour of one surface.
#[derive(Clone, Debug)]
pub struct FarField {
    /// The mip level of the tables' finest level.
    first_level: usize,
    /// Lengths of `D` in base texels as [`pseudo_log`] values: the first and the step.
    lengths: [f32; 2],
    /// Where each length's tables begin in `images`, and where the last's end.
    starts: Vec<usize>,
    /// Mean depth of the surface, 0 to 1.
    mean_depth: f32,
    /// By length, then azimuth: the longer the displacement, the more azimuths.
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
        let starts = table_starts(surface, first_level, settings);
        let texels = surface.texels_per_repeat(0);
        let unit = surface.relief_depth * texels[0].max(texels[1]);
        let [first, last] = SLOPES.map(|slope| pseudo_log(slope * unit));
        let mut far = Self {
            first_level,
            lengths: [first, (last - first) / (NUM_LENGTHS - 1) as f32],
            starts,
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
        self.level_bias[(self.place_of_length(displacement) + 0.5) as usize]
    }

    /// Where a displacement's length lies among the tables', 0 to the last.
    fn place_of_length(&self, [du, dv]: [f32; 2]) -> f32 {
        let place = (pseudo_log((du * du + dv * dv).sqrt()) - self.lengths[0]) / self.lengths[1];
        place.clamp(0.0, (NUM_LENGTHS - 1) as f32)
    }

    fn num_azimuths(&self, length: usize) -> usize {
        self.starts[length + 1] - self.starts[length]
    }

    /// The displacement of a table, in base texels.
    fn displacement(&self, length: usize, azimuth: usize) -> [f32; 2] {
        let size = pseudo_exp(self.lengths[0] + self.lengths[1] * length as f32);
        let [x, y] = diamond_direction(4.0 * azimuth as f32 / self.num_azimuths(length) as f32);
        [x * size, y * size]
    }

    /// The four nearest tables and their shares.
    fn neighbours(&self, displacement: [f32; 2]) -> [(usize, f32); 4] {
        let length = self.place_of_length(displacement);
        let near = (length as usize).min(NUM_LENGTHS - 2);
        let along = length - near as f32;
        let ([a, b], [c, d]) = (self.pair(near, displacement), self.pair(near + 1, displacement));
        [(a.0, a.1 * (1.0 - along)), (b.0, b.1 * (1.0 - along)), (c.0, c.1 * along), (d.0, d.1 * along)]
    }

    /// The two nearest tables of a length and their shares.
    fn pair(&self, length: usize, [du, dv]: [f32; 2]) -> [(usize, f32); 2] {
        let num = self.num_azimuths(length);
        let azimuth = diamond_angle(du, dv) * (num as f32 * 0.25);
        let (left, part) = (azimuth as usize % num, azimuth - azimuth.floor());
        [(self.starts[length] + left, 1.0 - part), (self.starts[length] + (left + 1) % num, part)]
    }
}

/// Where each length's tables begin: as many azimuths as the memory allows, in proportion to the length, since an error
/// in azimuth moves what lies above or below the mean depth by that much across the view.
fn table_starts(surface: &Surface, first_level: usize, settings: &Settings) -> Vec<usize> {
    let words: usize = surface.levels[first_level..].iter().map(|l| FarImage::num_words(l.width, l.height)).sum();
    let num = (settings.far_field_mib as usize * (1 << 20) / (words * 4)).min(MOST_TABLES);
    let azimuths = |scale: f32| {
        let ratio = SLOPES[1] / SLOPES[0];
        let growth =
            |i: usize| (pseudo_exp(pseudo_log(ratio) * (i as f32 / (NUM_LENGTHS - 1) as f32)) * scale) as usize;
        (0..NUM_LENGTHS).map(|i| (growth(i) / 4 * 4).clamp(16, MOST_AZIMUTHS)).collect::<Vec<_>>()
    };
    let scales = (0..400).map(|i| 0.05 * i as f32).rev();
    let fitting = scales.map(azimuths).find(|azimuths| azimuths.iter().sum::<usize>() <= num);
    let fitting = fitting.unwrap_or_else(|| vec![4; NUM_LENGTHS]);
    std::iter::once(0)
        .chain(fitting.iter().scan(0, |sum, num| {
            *sum += num;
            Some(*sum)
        }))
        .collect()
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
