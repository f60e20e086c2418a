//! Decoded samples to the maps of a surface.
//!
//! Samples keep their precision: 8 and 16 bit and float each have a path of their own to the 16
//! bits that are stored. Colours of integer formats are sRGB and become linear; floats are linear
//! already. Heights and normals are linear. The first row of a file is the top of the picture; ours
//! is the bottom, so rows are turned over.

use crate::texture::{ColorImage, GrayImage, NormalImage, linear_from_srgb};
use glam::Vec3;
use image::DynamicImage;
use rayon::prelude::*;

/// Which channel of an image serves as the height (`-imfchan`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Channel {
    Red,
    Green,
    Blue,
    /// The alpha channel; 1 everywhere in an image without one.
    Matte,
    /// Rec. 709 luma of the stored values.
    Luma,
}

enum Values {
    Bits8(Vec<u8>),
    Bits16(Vec<u16>),
    Float(Vec<f32>),
}

/// A decoded image, as its file has it: top row first.
pub(crate) struct Samples {
    width: usize,
    height: usize,
    num_channels: usize,
    values: Values,
}

impl Samples {
    /// The samples of an image in any of the formats that files come in.
    pub(crate) fn new(image: DynamicImage) -> Option<Self> {
        use DynamicImage as D;
        let (width, height) = (image.width() as usize, image.height() as usize);
        let num_channels = usize::from(image.color().channel_count());
        let values = match image {
            D::ImageLuma8(i) => Values::Bits8(i.into_raw()),
            D::ImageLumaA8(i) => Values::Bits8(i.into_raw()),
            D::ImageRgb8(i) => Values::Bits8(i.into_raw()),
            D::ImageRgba8(i) => Values::Bits8(i.into_raw()),
            D::ImageLuma16(i) => Values::Bits16(i.into_raw()),
            D::ImageLumaA16(i) => Values::Bits16(i.into_raw()),
            D::ImageRgb16(i) => Values::Bits16(i.into_raw()),
            D::ImageRgba16(i) => Values::Bits16(i.into_raw()),
            D::ImageRgb32F(i) => Values::Float(i.into_raw()),
            D::ImageRgba32F(i) => Values::Float(i.into_raw()),
            _ => return None,
        };
        Some(Self { width, height, num_channels, values })
    }

    /// The image's texels, bottom row first, each made from its channels (0 to 1 but for floats).
    fn map<T: Send + Copy + Default>(&self, make: impl Fn(&[f32]) -> T + Sync) -> Vec<T> {
        match &self.values {
            Values::Bits8(v) => self.map_values(v, |c| f32::from(c) / 255.0, make),
            Values::Bits16(v) => self.map_values(v, |c| f32::from(c) / 65535.0, make),
            Values::Float(v) => self.map_values(v, |c| if c.is_nan() { 0.0 } else { c }, make),
        }
    }

    fn map_values<S: Copy + Sync, U: Copy + Default, T: Send + Copy + Default>(
        &self,
        values: &[S],
        read: impl Fn(S) -> U + Sync,
        make: impl Fn(&[U]) -> T + Sync,
    ) -> Vec<T> {
        let mut texels = vec![T::default(); self.width * self.height];
        let stride = self.width * self.num_channels;
        texels
            .par_chunks_exact_mut(self.width)
            .rev()
            .zip(values.par_chunks_exact(stride))
            .for_each(|(row, values)| {
                for (texel, values) in row.iter_mut().zip(values.chunks_exact(self.num_channels)) {
                    let mut channels = [U::default(); 4];
                    channels
                        .iter_mut()
                        .zip(values)
                        .for_each(|(channel, &value)| *channel = read(value));
                    *texel = make(&channels[..self.num_channels]);
                }
            });
        texels
    }

    fn has_color(&self) -> bool {
        self.num_channels >= 3
    }

    /// Whether the picture is gray, up to what a JPEG blurs: at most one texel in 200 is coloured.
    pub(crate) fn is_gray(&self) -> bool {
        // A gray JPEG stored as RGB strays by a few of 255 steps where its chroma was rounded.
        const MOST_SPREAD: f32 = 8.5 / 255.0;
        if !self.has_color() {
            return true;
        }
        let colored = self.map(|c| u8::from(spread(c) > MOST_SPREAD));
        let num_colored: usize = colored.par_iter().map(|&c| usize::from(c)).sum();
        num_colored * 200 <= colored.len()
    }

    /// Linear colour.
    pub(crate) fn color(&self) -> ColorImage {
        let (width, height) = (self.width as u32, self.height as u32);
        let (texels, scale) = match &self.values {
            Values::Bits8(v) => {
                let table: Vec<u16> = (0..=255).map(|c| linear_bits(c as f32 / 255.0)).collect();
                (self.map_values(v, |c| table[usize::from(c)], rgb), 1.0)
            }
            Values::Bits16(v) => {
                let table: Vec<u16> =
                    (0..65536).into_par_iter().map(|c| linear_bits(c as f32 / 65535.0)).collect();
                (self.map_values(v, |c| table[usize::from(c)], rgb), 1.0)
            }
            Values::Float(v) => self.float_color(v),
        };
        ColorImage { width, height, texels, scale }
    }

    fn float_color(&self, values: &[f32]) -> (Vec<[u16; 3]>, f32) {
        // The largest scale that a surface takes; brighter light is cut there.
        const MOST: f32 = 1e6;
        let bounded = |c: f32| if c > 0.0 { c.min(MOST) } else { 0.0 };
        let is_light =
            |i: usize| self.num_channels % 2 == 1 || i % self.num_channels != self.num_channels - 1;
        let light = values.par_iter().enumerate().filter(|(i, _)| is_light(*i));
        let brightest = light.map(|(_, &c)| bounded(c)).reduce(|| 0.0, f32::max);
        let scale = if brightest > 1e-6 { brightest } else { 1.0 };
        let texels = self.map_values(
            values,
            |c| ((bounded(c) / scale).min(1.0) * 65535.0 + 0.5) as u16,
            rgb,
        );
        (texels, scale)
    }

    /// Linear light, top row first, in as many digits as the file has.
    pub(crate) fn light(&self) -> Vec<Vec3> {
        let is_float = matches!(self.values, Values::Float(_));
        let linear = |c: f32| if is_float { c.clamp(0.0, 1e6) } else { linear_from_srgb(c) };
        let mut texels = self.map(|c| match *c {
            [r, g, b, ..] => [r, g, b].map(linear),
            _ => [linear(c[0]); 3],
        });
        texels.chunks_exact_mut(self.width).for_each(<[_]>::reverse);
        texels.reverse();
        texels.into_iter().map(Vec3::from).collect()
    }

    /// Numbers `base + gain * c`, kept within 0 to 1, of one channel as it is stored.
    pub(crate) fn gray(&self, channel: Option<Channel>, [base, gain]: [f32; 2]) -> GrayImage {
        let value = |c: &[f32]| match (channel, c) {
            (Some(Channel::Matte), [.., alpha]) if c.len().is_multiple_of(2) => *alpha,
            (Some(Channel::Matte), _) => 1.0,
            (Some(Channel::Green), [_, green, _, ..]) => *green,
            (Some(Channel::Blue), [_, _, blue, ..]) => *blue,
            (Some(Channel::Red), _) => c[0],
            // Equal channels are taken as they are: weights would round.
            (_, [r, g, b, ..]) if r != g || g != b => 0.2126 * r + 0.7152 * g + 0.0722 * b,
            _ => c[0],
        };
        let texels =
            self.map(|c| ((base + gain * value(c)).clamp(0.0, 1.0) * 65535.0 + 0.5) as u16);
        GrayImage { width: self.width as u32, height: self.height as u32, texels }
    }

    /// Normals; `strength` multiplies x and y, and `green` (1 or -1) y.
    pub(crate) fn normal(&self, strength: f32, green: f32) -> NormalImage {
        let texels = self.map(|c| {
            let [x, y, z] = [c[0], c[c.len().min(2) - 1], c[c.len().min(3) - 1]]
                .map(|c| c.clamp(0.0, 1.0) * 2.0 - 1.0);
            let n = [x * strength, y * strength * green, z];
            // Only a strengthened normal may need shortening to fit.
            let longest = n.iter().fold(1.0_f32, |most, c| most.max(c.abs()));
            n.map(|c| (c / longest * 32767.0).round() as i16)
        });
        NormalImage { width: self.width as u32, height: self.height as u32, texels }
    }
}

fn spread(c: &[f32]) -> f32 {
    c[0].max(c[1]).max(c[2]) - c[0].min(c[1]).min(c[2])
}

fn linear_bits(encoded: f32) -> u16 {
    (linear_from_srgb(encoded) * 65535.0 + 0.5) as u16
}

/// Red, green and blue of a gray or coloured texel, with or without alpha.
fn rgb(c: &[u16]) -> [u16; 3] {
    if c.len() >= 3 { [c[0], c[1], c[2]] } else { [c[0]; 3] }
}
