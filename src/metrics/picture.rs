//! A picture as it is looked at: sRGB-encoded values.

use crate::error::{Error, Result};
use crate::frame::Frame;
use crate::texture::srgb_from_linear;
use image::{ColorType, ImageReader, Limits};
use rayon::prelude::*;
use std::path::Path;

/// sRGB-encoded RGB and straight opacity, all 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    width: u32,
    height: u32,
    pixels: Vec<[f32; 4]>,
}

/// Most pixels of a picture that is opened: 1 GiB as [`Picture`].
const MAX_PIXELS: u64 = 1 << 26;

impl Picture {
    /// A picture from rows of pixels, the top row first. Values are clamped to 0 to 1; NaN becomes 0.
    ///
    /// # Errors
    /// Says so when the number of pixels is not width times height, or 0.
    pub fn new(width: u32, height: u32, mut pixels: Vec<[f32; 4]>) -> Result<Self> {
        if pixels.len() as u64 != u64::from(width) * u64::from(height) || pixels.is_empty() {
            return Err(Error::scene("picture", "the number of pixels must be width times height and above 0"));
        }
        pixels.iter_mut().flatten().for_each(|value| *value = clamped(*value));
        Ok(Self { width, height, pixels })
    }

    /// Reads an image file: PNG, JPEG, TGA, TIFF, BMP, EXR or HDR. Float formats are taken as linear, others as sRGB.
    ///
    /// # Errors
    /// Names the file and why it cannot be read.
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        read(path).map_err(|reason| Error::file(path, reason))
    }

    /// Pixels a row.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels, row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &[[f32; 4]] {
        &self.pixels
    }

    /// The pixels of a row; row 0 is the top.
    pub(super) fn row(&self, y: u32) -> &[[f32; 4]] {
        &self.pixels[y as usize * self.width as usize..][..self.width as usize]
    }
}

impl From<&Frame> for Picture {
    /// The frame without rounding to 8 bits; linear values above 1 are clamped, as they are in 8-bit files.
    fn from(frame: &Frame) -> Self {
        let encode = |&[r, g, b, opacity]: &[f32; 4]| {
            let opacity = clamped(opacity);
            // Where nothing is seen there is no colour; the divisor only avoids 0 / 0.
            let divisor = if opacity > 0.0 { opacity } else { 1.0 };
            let [r, g, b] = [r, g, b].map(|c| srgb_from_linear(c / divisor));
            [r, g, b, opacity]
        };
        Self { width: frame.width, height: frame.height, pixels: frame.pixels.par_iter().map(encode).collect() }
    }
}

/// `value` within 0 to 1; NaN, which `f32::clamp` would keep, gives 0.
fn clamped(value: f32) -> f32 {
    if value > 0.0 { value.min(1.0) } else { 0.0 }
}

/// A result whose error is said of a file.
type Reason<T> = std::result::Result<T, String>;

fn text(error: impl ToString) -> String {
    error.to_string()
}

fn read(path: &Path) -> Reason<Picture> {
    // A pipe would block, and a device need not end.
    if std::fs::metadata(path).map_err(text)?.is_file() {
        // Decoders may panic on hostile files.
        std::panic::catch_unwind(|| decode(path)).unwrap_or_else(|_| Err("the decoder failed".into()))
    } else {
        Err("is not a file".into())
    }
}

fn decode(path: &Path) -> Reason<Picture> {
    let open = || ImageReader::open(path)?.with_guessed_format();
    let (width, height) = open().map_err(text)?.into_dimensions().map_err(text)?;
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(format!("{width}x{height} is more than {MAX_PIXELS} pixels"));
    }
    let mut reader = open().map_err(text)?;
    reader.limits(Limits::default());
    let image = reader.decode().map_err(text)?;
    let is_linear = matches!(image.color(), ColorType::Rgb32F | ColorType::Rgba32F);
    let pixels = image.into_rgba32f().into_raw().as_chunks().0.to_vec();
    if is_linear {
        let frame = Frame { width, height, pixels };
        return Ok(Picture::from(&frame));
    }
    Picture::new(width, height, pixels).map_err(text)
}
