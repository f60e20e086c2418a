//! A texture of a size of its own: for numbers of a material that its surface's texels do not hold.

use super::wrap::{Wrap, near_origin, wrap_index};
use super::{ColorImage, GrayImage, box_taps};
use crate::error::{Error, Result};
use rayon::prelude::*;

/// Most places that a long footprint is read at.
const MOST_PROBES: f32 = 8.0;

/// A gray or coloured texture of any size, linear, with mip levels: what a material's metal,
/// roughness, occlusion and emission are multiplied with. 2 bytes a texel and channel, and a third
/// more for the levels.
#[derive(Clone, Debug)]
pub struct Texture {
    /// The finest first; the last holds one texel.
    levels: Vec<Mip>,
    /// 1 or 3.
    num_channels: usize,
    wrap: Wrap,
    /// What a stored 65535 stands for.
    scale: f32,
}

/// A level of a texture: channels side by side, bottom row first.
#[derive(Clone, Debug)]
struct Mip {
    size: [usize; 2],
    values: Vec<u16>,
}

impl Texture {
    /// Of one number a texel, 0 to 1.
    ///
    /// # Errors
    /// Says so when the image's size is zero, above 32768, or not that of its texels.
    pub fn gray(image: GrayImage, wrap: Wrap) -> Result<Self> {
        Self::new([image.width, image.height], image.texels, 1, (wrap, 1.0))
    }

    /// Of linear RGB, 0 to the image's scale.
    ///
    /// # Errors
    /// As [`Self::gray`], and for a scale that is not within 0 to 1e6.
    pub fn color(image: ColorImage, wrap: Wrap) -> Result<Self> {
        let values = image.texels.into_flattened();
        Self::new([image.width, image.height], values, 3, (wrap, image.scale))
    }

    /// Of what is there of a surface, for [`CutOut`](crate::CutOut): opacity from 0 to 1 that is there
    /// where it is at least `threshold`. On the finest level 0.5 is the edge, and coarser levels hold
    /// the share of their texels that is there.
    ///
    /// # Errors
    /// As [`Self::gray`].
    pub fn opacity(mut image: GrayImage, wrap: Wrap, threshold: f32) -> Result<Self> {
        // Steeper than the opacity, so that means of few texels are nearly shares, too.
        const STEEP: f32 = 4.0;
        let is_there = |opacity: u16| f32::from(opacity) >= threshold * 65535.0;
        let shares =
            image.texels.iter().map(|opacity| u16::from(is_there(*opacity)) * u16::MAX).collect();
        for texel in &mut image.texels {
            let share = 0.5 + (f32::from(*texel) / 65535.0 - threshold) * STEEP;
            *texel = (share.clamp(0.0, 1.0) * 65535.0).ceil() as u16;
        }
        let finest = image.texels;
        let size = [image.width, image.height];
        let mut texture = Self::new(size, shares, 1, (wrap, 1.0))?;
        texture.levels[0].values = finest;
        Ok(texture)
    }

    fn new(
        size: [u32; 2],
        values: Vec<u16>,
        num_channels: usize,
        (wrap, scale): (Wrap, f32),
    ) -> Result<Self> {
        let refuse = |reason: String| Err(Error::scene("texture", reason));
        if !(scale > 0.0 && scale <= 1e6) {
            return refuse(format!("scale {scale} must be above 0 and at most 1e6"));
        }
        let [width, height] = size.map(|n| n as usize);
        let is_valid = size.iter().all(|n| (1..=32768).contains(n));
        if !is_valid || width * height * num_channels != values.len() {
            let num = values.len() / num_channels;
            return refuse(format!("it says {width} x {height} texels and has {num}"));
        }
        let mut levels = vec![Mip { size: [width, height], values }];
        while let Some(finer) = levels.last().filter(|level| level.size != [1, 1]) {
            levels.push(finer.halved(num_channels));
        }
        Ok(Self { levels, num_channels, wrap, scale })
    }

    /// Texels along u and v.
    pub fn size(&self) -> [usize; 2] {
        self.levels[0].size
    }

    /// Bytes that the texels take.
    pub fn num_bytes(&self) -> usize {
        self.levels.iter().map(|level| 2 * level.values.len()).sum()
    }

    /// Linear RGB at a place in repeats, interpolated between texels; a gray one has equal channels.
    pub fn at(&self, place: [f32; 2]) -> [f32; 3] {
        self.bilinear(0, near_origin(place, self.wrap))
    }

    /// The mean around a place, over a pixel whose neighbours lie at `dx` and `dy` from it, all in
    /// repeats: as textures are read where nothing hides texels, along the longer side by up to
    /// eight look-ups.
    pub(crate) fn over(&self, place: [f32; 2], [dx, dy]: [[f32; 2]; 2]) -> [f32; 3] {
        let (long, [most, least]) = match [self.length(dx), self.length(dy)] {
            [x, y] if x >= y => (dx, [x, y]),
            [x, y] => (dy, [y, x]),
        };
        // Also where a length is not a number.
        let num = (most / least.max(1.0)).ceil().clamp(1.0, MOST_PROBES);
        let (level, part) = self.level_of(least.max(most / MOST_PROBES));
        let mut sum = [0.0; 3];
        for i in 0..num as usize {
            let along = (i as f32 + 0.5) / num - 0.5;
            let probe = [0, 1].map(|c| place[c] + long[c] * along);
            let probe = near_origin(probe, self.wrap);
            let fine = self.bilinear(level, probe);
            let coarse = self.bilinear((level + 1).min(self.levels.len() - 1), probe);
            (0..3).for_each(|c| sum[c] += fine[c] + (coarse[c] - fine[c]) * part);
        }
        sum.map(|sum| sum / num)
    }

    /// How many of the finest texels a way in repeats is long.
    pub(crate) fn length(&self, way: [f32; 2]) -> f32 {
        let [x, y] = [0, 1].map(|i| way[i] * self.size()[i] as f32);
        (x * x + y * y).sqrt()
    }

    /// The level whose texels are not wider than so many of the finest, and how far it is from
    /// there to the next.
    fn level_of(&self, mut width: f32) -> (usize, f32) {
        let mut level = 0;
        while width >= 2.0 && level + 1 < self.levels.len() {
            width *= 0.5;
            level += 1;
        }
        (level, (width - 1.0).clamp(0.0, 1.0))
    }

    fn bilinear(&self, level: usize, place: [f32; 2]) -> [f32; 3] {
        let Mip { size, values } = &self.levels[level];
        let [(x, fx), (y, fy)] = [0, 1].map(|i| {
            let place = place[i] * size[i] as f32 - 0.5;
            let first = place.floor();
            ([first, first + 1.0].map(|c| self.fold(c as i32, size[i])), place - first)
        });
        let unit = self.scale / 65535.0;
        std::array::from_fn(|c| {
            let channel = c.min(self.num_channels - 1);
            let at = |i: usize, j: usize| {
                f32::from(values[(y[j] * size[0] + x[i]) * self.num_channels + channel])
            };
            let [low, high] = [0, 1].map(|j| at(0, j) + (at(1, j) - at(0, j)) * fx);
            (low + (high - low) * fy) * unit
        })
    }

    /// The texel of a place in an endless row of period `n`.
    fn fold(&self, i: i32, n: usize) -> usize {
        if self.wrap == Wrap::Mirror {
            // Stored once, and not with its mirror image.
            let i = wrap_index(Wrap::Mirror, i, 2 * n);
            return i.min(2 * n - 1 - i);
        }
        wrap_index(self.wrap, i, n)
    }
}

impl Mip {
    /// Half the size, each texel the mean over the area that it covers.
    fn halved(&self, num_channels: usize) -> Self {
        let [w, h] = self.size;
        let size = self.size.map(|n| (n / 2).max(1));
        let columns: Vec<_> = (0..size[0]).map(|x| box_taps(x, w, size[0])).collect();
        let mut values = vec![0; size[0] * size[1] * num_channels];
        values.par_chunks_exact_mut(size[0] * num_channels).enumerate().for_each(|(y, row)| {
            let rows = box_taps(y, h, size[1]);
            for (to, columns) in row.chunks_exact_mut(num_channels).zip(&columns) {
                for (c, to) in to.iter_mut().enumerate() {
                    let mut sum = 0.0;
                    for (j, wy) in &rows {
                        for (i, wx) in columns {
                            sum += wx * wy * f32::from(self.values[(j * w + i) * num_channels + c]);
                        }
                    }
                    *to = (sum + 0.5) as u16;
                }
            }
        });
        Self { size, values }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(width: u32, height: u32, wrap: Wrap) -> Texture {
        let image = GrayImage::from_fn(width, height, |x, _| x as f32 / (width - 1) as f32);
        Texture::gray(image, wrap).expect("a valid image")
    }

    #[test]
    fn texels_lie_at_their_centres_and_wrap() {
        let texture = ramp(4, 3, Wrap::Repeat);
        let at = |u: f32| texture.at([u, 0.4])[0];
        assert!((at(0.125) - 0.0).abs() < 1e-4 && (at(0.375) - 1.0 / 3.0).abs() < 1e-4);
        assert!((at(0.25) - 1.0 / 6.0).abs() < 1e-4 && (at(1.0) - 0.5).abs() < 1e-4);
        assert_eq!(at(0.25), at(7.25), "it repeats");
        assert!((ramp(4, 3, Wrap::Mirror).at([1.3, 0.0])[0] - at(0.7)).abs() < 1e-4);
        assert_eq!(ramp(4, 3, Wrap::Clamp).at([9.0, 0.0])[0], 1.0);
    }

    #[test]
    fn wide_footprints_see_the_mean() {
        for size in [[16, 16], [13, 7], [1, 9]] {
            let image = GrayImage::from_fn(size[0], size[1], |x, y| ((x + 3 * y) % 5) as f32 / 4.0);
            let mean = image.texels.iter().map(|t| f32::from(*t)).sum::<f32>()
                / (65535.0 * image.texels.len() as f32);
            let texture = Texture::gray(image, Wrap::Repeat).expect("a valid image");
            let found = texture.over([0.2, 0.8], [[60.0, 0.0], [0.0, 40.0]]);
            assert!((found[0] - mean).abs() < 2e-4, "{size:?}: {found:?} {mean}");
            let near = texture.over([0.2, 0.8], [[1e-3, 0.0], [0.0, 1e-3]]);
            assert_eq!(near, texture.at([0.2, 0.8]));
        }
    }

    #[test]
    fn levels_of_opacity_hold_the_share_that_is_there() {
        // Thin blades: one column in five, of uneven opacity, on what is nearly there.
        let blade =
            |x: u32, y: u32| if x.is_multiple_of(5) { 0.6 + 0.2 * (y % 3) as f32 } else { 0.45 };
        let image = GrayImage::from_fn(160, 64, blade);
        let texture = Texture::opacity(image, Wrap::Repeat, 0.5).expect("valid");
        for level in &texture.levels[1..] {
            let sum: f32 = level.values.iter().map(|value| f32::from(*value)).sum();
            let share = sum / (65535.0 * level.values.len() as f32);
            assert!((share - 0.2).abs() < 1e-3, "{:?}: {share}", level.size);
        }
        let near = [0.0, 1.0].map(|x| texture.at([(x + 0.5) / 160.0, 0.5 / 64.0])[0]);
        assert!(near[0] > 0.5 && near[1] < 0.5, "{near:?}");
    }

    #[test]
    fn images_that_are_wrong_are_refused() {
        let image = GrayImage { width: 2, height: 2, texels: vec![0; 3] };
        assert!(Texture::gray(image, Wrap::Repeat).is_err());
        let image = ColorImage { width: 1, height: 1, texels: vec![[0; 3]], scale: 0.0 };
        assert!(Texture::color(image, Wrap::Repeat).is_err());
    }
}
