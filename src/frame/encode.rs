//! Frames to image files.

use super::Frame;
use super::format::Format;
use super::pixel::Pixel;
use super::png::{Part, PngHead, write_png};
use super::save::write_whole;
use crate::error::{Error, Result};
use image::codecs::{bmp, jpeg, openexr, tga, tiff};
use image::{ExtendedColorType, ImageEncoder, ImageResult};
use std::io::Cursor;
use std::path::Path;

impl<P: Pixel> Frame<P> {
    /// The bytes of an image file.
    ///
    /// Formats of 8 bits hold sRGB: RGB where the frame is opaque everywhere, else RGBA with
    /// straight opacity; JPEG knows no opacity and holds the frame over black. EXR holds linear
    /// pixels.
    ///
    /// # Errors
    /// Says why when the format cannot hold the frame.
    pub fn encode(&self, format: Format) -> Result<Vec<u8>> {
        self.encode_part(format, None)
    }

    /// The bytes of an image file that, in PNG, says of what larger picture it is a part; other
    /// formats cannot.
    ///
    /// # Errors
    /// As [`Frame::encode`].
    pub fn encode_part(&self, format: Format, part: Option<Part>) -> Result<Vec<u8>> {
        if self.pixels.len() as u64 != u64::from(self.width) * u64::from(self.height)
            || self.pixels.is_empty()
        {
            return Err(Error::picture(
                "frame",
                "the number of pixels must be width times height and above 0",
            ));
        }
        encode(self, format, part)
    }

    /// Writes an image file in the format of its extension: png, jpg, jpeg, tga, tif, tiff, bmp or
    /// exr.
    ///
    /// # Errors
    /// Names the file when its extension is unknown or it cannot be written; an older file is then
    /// left as it was.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        write_whole(path, &self.encode(Format::of(path)?)?)
    }
}

/// The bytes of `frame` as a file, which in PNG says of what it is a part.
fn encode<P: Pixel>(frame: &Frame<P>, format: Format, part: Option<Part>) -> Result<Vec<u8>> {
    let has_opacity = format != Format::Jpeg && !frame.is_opaque();
    match format {
        Format::Exr => encode_linear(frame, has_opacity),
        Format::Png => {
            let mut file = Vec::new();
            let head = PngHead { width: frame.width, height: frame.height, has_opacity, part };
            return write_png(&mut file, &head, [Ok(frame.to_bytes(has_opacity))]).map(|()| file);
        }
        _ => encode_bytes(frame, format, has_opacity),
    }
    .map_err(|e| Error::picture_caused("frame", e))
}

fn encode_bytes<P: Pixel>(
    frame: &Frame<P>,
    format: Format,
    has_opacity: bool,
) -> ImageResult<Vec<u8>> {
    let color = if has_opacity { ExtendedColorType::Rgba8 } else { ExtendedColorType::Rgb8 };
    let pixels = frame.to_bytes(has_opacity);
    let mut file = Cursor::new(Vec::new());
    let (width, height) = (frame.width, frame.height);
    match format {
        Format::Jpeg => jpeg::JpegEncoder::new_with_quality(&mut file, 95)
            .write_image(&pixels, width, height, color),
        Format::Tga => tga::TgaEncoder::new(&mut file).write_image(&pixels, width, height, color),
        Format::Tiff => {
            tiff::TiffEncoder::new(&mut file).write_image(&pixels, width, height, color)
        }
        _ => bmp::BmpEncoder::new(&mut file).write_image(&pixels, width, height, color),
    }?;
    Ok(file.into_inner())
}

fn encode_linear<P: Pixel>(frame: &Frame<P>, has_opacity: bool) -> ImageResult<Vec<u8>> {
    let (color, num_channels) =
        if has_opacity { (ExtendedColorType::Rgba32F, 4) } else { (ExtendedColorType::Rgb32F, 3) };
    let pixels: Vec<u8> = frame
        .pixels
        .iter()
        .flat_map(|pixel| pixel.to_linear().into_iter().take(num_channels))
        .flat_map(f32::to_ne_bytes)
        .collect();
    let mut file = Cursor::new(Vec::new());
    openexr::OpenExrEncoder::new(&mut file).write_image(
        &pixels,
        frame.width,
        frame.height,
        color,
    )?;
    Ok(file.into_inner())
}
