//! Image formats and their encoders.

use super::png::{Part, PngHead, write_png};
use super::{Frame, Pixel};
use crate::error::{Error, Result};
use image::codecs::{bmp, jpeg, openexr, tga, tiff};
use image::{ExtendedColorType, ImageEncoder, ImageResult};
use std::io::Cursor;
use std::path::Path;

/// A file format that a [`Frame`] can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// 8 bits, sRGB, lossless, opacity.
    Png,
    /// 8 bits, sRGB, lossy (quality 95), no opacity.
    Jpeg,
    /// 8 bits, sRGB, lossless, opacity.
    Tga,
    /// 8 bits, sRGB, lossless, opacity.
    Tiff,
    /// 8 bits, sRGB, lossless, opacity.
    Bmp,
    /// 32-bit float, linear, premultiplied opacity.
    Exr,
}

impl Format {
    /// The format of a file, by the extension of its name.
    ///
    /// # Errors
    /// Names the file and the extensions that are known.
    pub fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        Ok(match extension.as_str() {
            "png" => Self::Png,
            "jpg" | "jpeg" => Self::Jpeg,
            "tga" => Self::Tga,
            "tif" | "tiff" => Self::Tiff,
            "bmp" => Self::Bmp,
            "exr" => Self::Exr,
            _ => return Err(Error::file(path, "the name must end in .png, .jpg, .tga, .tiff, .bmp or .exr")),
        })
    }

    #[cfg(test)]
    pub(super) fn of_image(self) -> image::ImageFormat {
        use image::ImageFormat;
        [
            (Self::Png, ImageFormat::Png),
            (Self::Jpeg, ImageFormat::Jpeg),
            (Self::Tga, ImageFormat::Tga),
            (Self::Tiff, ImageFormat::Tiff),
            (Self::Bmp, ImageFormat::Bmp),
            (Self::Exr, ImageFormat::OpenExr),
        ]
        .into_iter()
        .find_map(|(format, of_image)| (format == self).then_some(of_image))
        .unwrap()
    }
}

/// The bytes of `frame` as a file, which in PNG says of what it is a part.
pub(super) fn encode<P: Pixel>(frame: &Frame<P>, format: Format, part: Option<Part>) -> Result<Vec<u8>> {
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

fn encode_bytes<P: Pixel>(frame: &Frame<P>, format: Format, has_opacity: bool) -> ImageResult<Vec<u8>> {
    let color = if has_opacity { ExtendedColorType::Rgba8 } else { ExtendedColorType::Rgb8 };
    let pixels = frame.to_bytes(has_opacity);
    let mut file = Cursor::new(Vec::new());
    let (width, height) = (frame.width, frame.height);
    match format {
        Format::Jpeg => jpeg::JpegEncoder::new_with_quality(&mut file, 95).write_image(&pixels, width, height, color),
        Format::Tga => tga::TgaEncoder::new(&mut file).write_image(&pixels, width, height, color),
        Format::Tiff => tiff::TiffEncoder::new(&mut file).write_image(&pixels, width, height, color),
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
    openexr::OpenExrEncoder::new(&mut file).write_image(&pixels, frame.width, frame.height, color)?;
    Ok(file.into_inner())
}
