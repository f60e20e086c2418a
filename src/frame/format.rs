//! The image formats that a frame is written in.

use crate::error::{Error, Result};
use std::path::Path;

/// A file format that a [`Frame`](super::Frame) can be written in.
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
        let extension =
            path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        Ok(match extension.as_str() {
            "png" => Self::Png,
            "jpg" | "jpeg" => Self::Jpeg,
            "tga" => Self::Tga,
            "tif" | "tiff" => Self::Tiff,
            "bmp" => Self::Bmp,
            "exr" => Self::Exr,
            _ => {
                return Err(Error::file(
                    path,
                    "the name must end in .png, .jpg, .tga, .tiff, .bmp or .exr",
                ));
            }
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
