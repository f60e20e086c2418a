//! A picture as it is looked at: sRGB-encoded values.

use crate::decode::{self, ImageLimits};
use crate::error::{Error, Result};
use crate::frame::Frame;
use crate::texture::srgb_from_linear;
use image::{ColorType, DynamicImage};
use rayon::prelude::*;
use std::path::Path;

/// sRGB-encoded RGB and straight opacity, all 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    width: u32,
    height: u32,
    pixels: Vec<[f32; 4]>,
}

impl Picture {
    /// Most pixels that [`open`](Self::open) takes, 4096 x 4096: two pictures can be compared
    /// within 1 GiB.
    pub const MAX_PIXELS: u64 = 1 << 24;

    /// A picture from rows of pixels, the top row first. Values are clamped to 0 to 1; NaN becomes
    /// 0.
    ///
    /// # Errors
    /// Says so when the number of pixels is not width times height, or 0.
    pub fn new(width: u32, height: u32, mut pixels: Vec<[f32; 4]>) -> Result<Self> {
        if pixels.len() as u64 != u64::from(width) * u64::from(height) || pixels.is_empty() {
            return Err(Error::picture(
                "picture",
                "the number of pixels must be width times height and above 0",
            ));
        }
        pixels.iter_mut().flatten().for_each(|value| *value = clamped(*value));
        Ok(Self { width, height, pixels })
    }

    /// Reads an image file: PNG, JPEG, TGA, TIFF, BMP, EXR or HDR. Float formats are taken as
    /// linear, others as sRGB.
    ///
    /// # Errors
    /// Names the file and why it cannot be read, or that it has more than
    /// [`MAX_PIXELS`](Self::MAX_PIXELS) pixels.
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        Self::open_within(path, Self::MAX_PIXELS)
    }

    /// As [`open`](Self::open), with another limit of the number of pixels; one takes 32 bytes
    /// while it is read.
    ///
    /// # Errors
    /// Names the file and why it cannot be read, or that it has more than `max_pixels` pixels.
    pub fn open_within(path: impl AsRef<Path>, max_pixels: u64) -> Result<Self> {
        let path = path.as_ref();
        Self::of_image(decode::image(path, limits(max_pixels))?)
    }

    /// Decodes an image file in memory; `name` is for messages, and its extension tells a TGA.
    pub(crate) fn from_bytes(bytes: &[u8], name: &Path, max_pixels: u64) -> Result<Self> {
        Self::of_image(decode::image_bytes(bytes, name, limits(max_pixels))?)
    }

    fn of_image(image: DynamicImage) -> Result<Self> {
        let (width, height) = (image.width(), image.height());
        let is_linear = matches!(image.color(), ColorType::Rgb32F | ColorType::Rgba32F);
        let pixels = image.into_rgba32f().into_raw().as_chunks().0.to_vec();
        if is_linear {
            let frame = Frame { width, height, pixels };
            return Ok(Self::from(&frame));
        }
        Self::new(width, height, pixels)
    }

    /// Pixels a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels, row by row from the top.
    pub fn pixels(&self) -> &[[f32; 4]] {
        &self.pixels
    }

    /// The pixels of a row; row 0 is the top.
    pub(super) fn row(&self, y: u32) -> &[[f32; 4]] {
        &self.pixels[y as usize * self.width as usize..][..self.width as usize]
    }
}

impl From<&Frame> for Picture {
    /// The frame without rounding to 8 bits; linear values above 1 are clamped, as they are in
    /// 8-bit files. Pixels that a frame made by hand lacks are transparent, and those that it has
    /// too many are left out.
    fn from(frame: &Frame) -> Self {
        let encode = |&[r, g, b, opacity]: &[f32; 4]| {
            let opacity = clamped(opacity);
            // Where nothing is seen there is no colour; the divisor only avoids 0 / 0.
            let divisor = if opacity > 0.0 { opacity } else { 1.0 };
            let [r, g, b] = [r, g, b].map(|c| srgb_from_linear(c / divisor));
            [r, g, b, opacity]
        };
        let mut pixels: Vec<_> = frame.pixels.par_iter().map(encode).collect();
        pixels.resize(frame.width as usize * frame.height as usize, [0.0; 4]);
        Self { width: frame.width, height: frame.height, pixels }
    }
}

/// Refuses pictures of different sizes.
pub(super) fn check_sizes(a: &Picture, b: &Picture) -> Result<()> {
    if (a.width(), a.height()) == (b.width(), b.height()) {
        return Ok(());
    }
    let sizes = format!("{}x{} and {}x{} pixels", a.width(), a.height(), b.width(), b.height());
    Err(Error::picture("pictures", format!("sizes differ: {sizes}")))
}

/// Whether a pixel takes part in a comparison.
pub(super) fn is_compared(a: [f32; 4], b: [f32; 4]) -> bool {
    a[3] >= 1.0 && b[3] >= 1.0
}

/// What an image of `texels` pixels may need. The widest sample format has 16 bytes a pixel.
fn limits(texels: u64) -> ImageLimits {
    ImageLimits { side: u32::MAX, texels, bytes: texels.saturating_mul(16).max(1 << 20) }
}

/// `value` within 0 to 1; NaN, which `f32::clamp` would keep, gives 0.
fn clamped(value: f32) -> f32 {
    if value > 0.0 { value.min(1.0) } else { 0.0 }
}
