//! Image files to samples, within limits.
//!
//! A file is opened only when it is a regular one, its head is checked against the limits before anything is allocated,
//! and a panic of its decoder is a refusal.

mod contain;
mod file;
mod gray_exr;
mod samples;

pub(crate) use contain::contain;
pub(crate) use file::{open_regular, plain};
pub(crate) use samples::{Channel, Samples};

use crate::error::{Error, Result};
use gray_exr::GrayExr;
use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::fs::File;
use std::io::{BufRead, BufReader, Seek};
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
    /// Whether the format has a single channel of light.
    pub(crate) fn is_gray_format(&self) -> bool {
        !self.color.has_color()
    }
}

/// Reads only the head of an image file.
pub(crate) fn probe(path: &Path, limits: ImageLimits) -> Result<ImageInfo> {
    run(path, || info(decoder(open(path, limits)?, path, limits)?.as_ref()))
}

/// Decodes an image file.
pub(crate) fn image(path: &Path, limits: ImageLimits) -> Result<DynamicImage> {
    run(path, || image_from(open(path, limits)?, path, limits))
}

/// Decodes an image file in memory; `path` serves for messages and for formats without a signature.
pub(crate) fn image_bytes(bytes: &[u8], path: &Path, limits: ImageLimits) -> Result<DynamicImage> {
    run(path, || image_from(std::io::Cursor::new(bytes), path, limits))
}

/// Decodes an image file to its samples.
pub(crate) fn decode(path: &Path, limits: ImageLimits) -> Result<Samples> {
    run(path, || samples(image_from(open(path, limits)?, path, limits)?))
}

/// Decodes an image in memory; `path` serves for messages and for formats without a signature.
pub(crate) fn decode_bytes(bytes: &[u8], path: &Path, limits: ImageLimits) -> Result<Samples> {
    run(path, || samples(image_from(std::io::Cursor::new(bytes), path, limits)?))
}

/// Runs a decoder; its panic is a refusal of the file.
fn run<T>(path: &Path, work: impl FnOnce() -> std::result::Result<T, String>) -> Result<T> {
    let result = contain(work).unwrap_or_else(|| Err("the image is damaged (its decoder gave up)".into()));
    result.map_err(|reason| Error::file(path, reason.replace('\n', " ")))
}

fn open(path: &Path, limits: ImageLimits) -> std::result::Result<BufReader<File>, String> {
    let file = open_regular(path).map_err(|error| match error {
        Error::File { reason, .. } => reason,
        other => other.to_string(),
    })?;
    // Some decoders read the whole file into memory first.
    match file.metadata() {
        Ok(data) if data.len() > limits.bytes => Err(format!("larger than the limit of {} MiB", limits.bytes >> 20)),
        _ => Ok(BufReader::new(file)),
    }
}

fn decoder<'a, R: BufRead + Seek + 'a>(
    reader: R,
    path: &Path,
    limits: ImageLimits,
) -> std::result::Result<Box<dyn ImageDecoder + 'a>, String> {
    let mut reader = ImageReader::new(reader).with_guessed_format().map_err(|e| e.to_string())?;
    if reader.format().is_none() {
        // TGA has no signature: its name is all there is.
        let format = ImageFormat::from_path(path).map_err(|_| "not an image of a known format")?;
        reader.set_format(format);
    }
    let mut within = Limits::default();
    (within.max_image_width, within.max_image_height) = (Some(limits.side), Some(limits.side));
    within.max_alloc = Some(limits.bytes);
    let mut decoder = boxed_decoder(reader, within.clone())?;
    let (width, height) = decoder.dimensions();
    if width == 0 || height == 0 {
        return Err("the image has no texels".into());
    }
    if width > limits.side || height > limits.side {
        return Err(format!("{width} x {height} texels: the limit is {} a side (max_image_side)", limits.side));
    }
    if u64::from(width) * u64::from(height) > limits.texels {
        return Err(format!("{width} x {height} is more than {} pixels (max_pixels)", limits.texels));
    }
    if decoder.total_bytes() > limits.bytes {
        let mib = limits.bytes >> 20;
        return Err(format!("{width} x {height} texels need more than {mib} MiB (max_image_mib)"));
    }
    decoder.set_limits(within).map_err(|e| e.to_string())?;
    Ok(decoder)
}

fn boxed_decoder<'a, R: BufRead + Seek + 'a>(
    mut reader: ImageReader<R>,
    limits: Limits,
) -> std::result::Result<Box<dyn ImageDecoder + 'a>, String> {
    if reader.format() == Some(ImageFormat::OpenExr) {
        match GrayExr::new(reader.into_inner()).map_err(|e| e.to_string())? {
            Ok(gray) => return Ok(Box::new(gray)),
            Err(file) => reader = ImageReader::with_format(file, ImageFormat::OpenExr),
        }
    }
    reader.limits(limits);
    Ok(Box::new(reader.into_decoder().map_err(|e| e.to_string())?))
}

fn info(decoder: &dyn ImageDecoder) -> std::result::Result<ImageInfo, String> {
    let (width, height) = decoder.dimensions();
    Ok(ImageInfo { size: [width, height], num_bytes: decoder.total_bytes(), color: decoder.color_type() })
}

fn image_from<R: BufRead + Seek>(
    reader: R,
    path: &Path,
    limits: ImageLimits,
) -> std::result::Result<DynamicImage, String> {
    DynamicImage::from_decoder(decoder(reader, path, limits)?).map_err(|e| e.to_string())
}

fn samples(image: DynamicImage) -> std::result::Result<Samples, String> {
    Samples::new(image).ok_or_else(|| "an image of an unknown sample format".into())
}
