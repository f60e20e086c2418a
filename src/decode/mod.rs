//! Image files to samples, within limits.
//!
//! A file is opened only when it is a regular one, its head is checked against the limits before
//! anything is allocated, and a panic of its decoder is a refusal.

mod contain;
mod file;
mod gray_exr;
mod samples;

pub(crate) use contain::contain;
pub(crate) use file::open_regular;
pub(crate) use samples::{Channel, Samples};

use crate::error::{Error, Result};
use gray_exr::GrayExr;
use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::io::{BufRead, BufReader, Cursor, Seek};
use std::path::Path;

/// What one image may need.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ImageLimits {
    /// Texels a side.
    pub(crate) side: u32,
    /// Texels in all.
    pub(crate) texels: u64,
    /// Bytes while it is decoded.
    pub(crate) bytes: u64,
}

/// What the head of an image file says.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ImageInfo {
    pub(crate) size: [u32; 2],
    pub(crate) num_bytes: u64,
    color: ColorType,
}

impl ImageInfo {
    /// Whether texels have an opacity.
    pub(crate) fn has_opacity(&self) -> bool {
        self.color.has_alpha()
    }

    /// Whether the format has a single channel of light.
    pub(crate) fn is_gray_format(&self) -> bool {
        !self.color.has_color()
    }
}

/// Bytes of a file, wherever they lie: one type for all, so that every decoder is compiled once.
type Bytes<'a> = Box<dyn Source + 'a>;

trait Source: BufRead + Seek {}

impl<R: BufRead + Seek> Source for R {}

/// Reads only the head of an image file.
pub(crate) fn probe(path: &Path, limits: ImageLimits) -> Result<ImageInfo> {
    contained(path, || head(open(path, limits)?, path, limits))
}

/// Reads only the head of an image file in memory, as [`image_bytes`] does.
pub(crate) fn probe_bytes(bytes: &[u8], path: &Path, limits: ImageLimits) -> Result<ImageInfo> {
    contained(path, || head(Box::new(Cursor::new(bytes)), path, limits))
}

fn head(reader: Bytes, path: &Path, limits: ImageLimits) -> Result<ImageInfo> {
    let decoder = decoder(reader, path, limits)?;
    let (width, height) = decoder.dimensions();
    Ok(ImageInfo {
        size: [width, height],
        num_bytes: decoder.total_bytes(),
        color: decoder.color_type(),
    })
}

/// Decodes an image file.
pub(crate) fn image(path: &Path, limits: ImageLimits) -> Result<DynamicImage> {
    contained(path, || decode(open(path, limits)?, path, limits))
}

/// Decodes an image file in memory; `path` serves for messages and for formats without a signature.
pub(crate) fn image_bytes(bytes: &[u8], path: &Path, limits: ImageLimits) -> Result<DynamicImage> {
    contained(path, || decode(Box::new(Cursor::new(bytes)), path, limits))
}

/// Decodes an image file to its samples.
pub(crate) fn samples(path: &Path, limits: ImageLimits) -> Result<Samples> {
    samples_of(image(path, limits)?, path)
}

/// Decodes an image file in memory to its samples, as [`image_bytes`] does.
pub(crate) fn samples_bytes(bytes: &[u8], path: &Path, limits: ImageLimits) -> Result<Samples> {
    samples_of(image_bytes(bytes, path, limits)?, path)
}

fn samples_of(image: DynamicImage, path: &Path) -> Result<Samples> {
    Samples::new(image).ok_or_else(|| Error::file(path, "an image of an unknown sample format"))
}

/// Runs a decoder; its panic is a refusal of the file.
fn contained<T>(path: &Path, work: impl FnOnce() -> Result<T>) -> Result<T> {
    contain(work)
        .unwrap_or_else(|| Err(Error::file(path, "the image is damaged (its decoder gave up)")))
}

fn open(path: &Path, limits: ImageLimits) -> Result<Bytes<'static>> {
    let file = open_regular(path)?;
    // Some decoders read the whole file into memory first.
    if file.metadata().is_ok_and(|data| data.len() > limits.bytes) {
        return Err(Error::file(
            path,
            format!("larger than the limit of {} MiB", limits.bytes >> 20),
        ));
    }
    Ok(Box::new(BufReader::new(file)))
}

fn decode(reader: Bytes, path: &Path, limits: ImageLimits) -> Result<DynamicImage> {
    DynamicImage::from_decoder(decoder(reader, path, limits)?).map_err(|e| Error::caused(path, e))
}

/// The decoder of an image whose head is within the limits.
fn decoder<'a>(
    reader: Bytes<'a>,
    path: &Path,
    limits: ImageLimits,
) -> Result<Box<dyn ImageDecoder + 'a>> {
    let mut within = Limits::default();
    (within.max_image_width, within.max_image_height) = (Some(limits.side), Some(limits.side));
    within.max_alloc = Some(limits.bytes);
    let mut decoder = decoder_of_format(reader, path, within.clone())?;
    let (width, height) = decoder.dimensions();
    let too_large = |reason: String, option| {
        Err(Error::limit(path, format!("{width} x {height} {reason}"), option))
    };
    if width == 0 || height == 0 {
        return Err(Error::file(path, "the image has no texels"));
    }
    if width > limits.side || height > limits.side {
        return too_large(format!("texels: the limit is {} a side", limits.side), "max_image_side");
    }
    if u64::from(width) * u64::from(height) > limits.texels {
        return too_large(format!("is more than {} pixels", limits.texels), "max_pixels");
    }
    if decoder.total_bytes() > limits.bytes {
        return too_large(
            format!("texels need more than {} MiB", limits.bytes >> 20),
            "max_image_mib",
        );
    }
    decoder.set_limits(within).map_err(|e| Error::caused(path, e))?;
    Ok(decoder)
}

fn decoder_of_format<'a>(
    reader: Bytes<'a>,
    path: &Path,
    limits: Limits,
) -> Result<Box<dyn ImageDecoder + 'a>> {
    let mut reader =
        ImageReader::new(reader).with_guessed_format().map_err(|e| Error::caused(path, e))?;
    if reader.format().is_none() {
        // TGA has no signature: its name is all there is.
        let format = ImageFormat::from_path(path)
            .map_err(|_| Error::file(path, "not an image of a known format"))?;
        reader.set_format(format);
    }
    if reader.format() == Some(ImageFormat::OpenExr) {
        match GrayExr::new(reader.into_inner()).map_err(|e| Error::caused(path, e))? {
            Ok(gray) => return Ok(Box::new(gray)),
            Err(file) => reader = ImageReader::with_format(file, ImageFormat::OpenExr),
        }
    }
    reader.limits(limits);
    Ok(Box::new(reader.into_decoder().map_err(|e| Error::caused(path, e))?))
}
