//! The finished picture: linear pixels, or their 8-bit sRGB encoding, and files of it.
//!
//! A file is encoded in memory, written under a temporary name in its own folder, flushed to the
//! disk and renamed: whoever looks finds the whole old file or the whole new one ([`write_whole`]).

mod develop;
mod encode;
mod format;
mod pixel;
mod png;
mod save;
mod tone;

pub(crate) use self::develop::Development;
pub use self::png::{Part, PngHead, write_png};
pub use format::Format;
pub use pixel::Pixel;
pub use save::{WholeFile, check_writable, write_whole};

use crate::settings::Region;
use crate::texture::srgb8_from_linear;
use rayon::prelude::*;

/// Pixels that a thread encodes at once.
const ROW: usize = 4096;

/// A picture, in linear light unless said otherwise (see [`Pixel`]); without a pixel by default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame<P = [f32; 4]> {
    /// Pixels a row.
    pub width: u32,
    /// Rows; row 0 is the top.
    pub height: u32,
    /// Row by row: linear RGB, premultiplied by the fourth component, the opacity, or what
    /// [`Pixel`] says.
    pub pixels: Vec<P>,
}

impl<P: Pixel> Frame<P> {
    /// A frame of one colour.
    pub fn filled(width: u32, height: u32, color: P) -> Self {
        Self { width, height, pixels: vec![color; width as usize * height as usize] }
    }

    /// Makes the frame so many pixels wide and high, for whoever overwrites them all: memory of the
    /// right size is kept as it is.
    pub(crate) fn fit(&mut self, [width, height]: [u32; 2]) {
        (self.width, self.height) = (width, height);
        let num_pixels = width as usize * height as usize;
        if self.pixels.len() != num_pixels {
            // `vec![0; n]` is zeroed lazily by the system, on the thread that first touches a page.
            self.pixels = vec![P::default(); num_pixels];
        }
    }

    /// Keeps a part of the frame, in place.
    ///
    /// # Panics
    /// If `region` does not lie within the frame.
    pub fn crop(&mut self, region: Region) {
        assert!(region.is_within(self.width, self.height), "the region must lie within the frame");
        let [x, y, width, stride] =
            [region.x, region.y, region.width, self.width].map(|v| v as usize);
        for row in 0..region.height as usize {
            let start = (y + row) * stride + x;
            self.pixels.copy_within(start..start + width, row * width);
        }
        self.pixels.truncate(width * region.height as usize);
        (self.width, self.height) = (region.width, region.height);
    }

    /// Whether no pixel lets anything through.
    pub fn is_opaque(&self) -> bool {
        self.pixels.iter().all(|pixel| pixel.to_linear()[3] >= 1.0)
    }

    /// 8-bit sRGB with straight opacity, row by row from the top.
    pub fn to_rgba8(&self) -> Vec<[u8; 4]> {
        let mut bytes = vec![[0; 4]; self.pixels.len()];
        let rows = bytes.par_chunks_mut(ROW).zip(self.pixels.par_chunks(ROW));
        rows.for_each(|(bytes, row)| P::rgba8_row(row, bytes));
        bytes
    }

    /// 8-bit sRGB over black, row by row from the top.
    pub fn to_rgb8(&self) -> Vec<[u8; 3]> {
        let over_black = |pixel: &P| {
            let [rgb @ .., _] = pixel.to_linear();
            rgb.map(srgb8_from_linear)
        };
        self.pixels.par_iter().map(over_black).collect()
    }

    /// 8-bit sRGB samples, row by row from the top: four a pixel with straight opacity, or three
    /// over black.
    pub fn to_bytes(&self, has_opacity: bool) -> Vec<u8> {
        if has_opacity { self.to_rgba8().into_flattened() } else { self.to_rgb8().into_flattened() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_format_holds_the_frame() {
        let mut frame = Frame::filled(3, 2, [0.2, 0.4, 0.6, 1.0]);
        for opacity in [1.0, 0.5] {
            frame.pixels[4] = [0.1, 0.2, 0.3, opacity];
            for format in [Format::Png, Format::Tga, Format::Tiff, Format::Bmp] {
                let read = image::load_from_memory_with_format(
                    &frame.encode(format).unwrap(),
                    format.of_image(),
                );
                let expected: Vec<u8> = frame.to_rgba8().into_iter().flatten().collect();
                assert_eq!(read.unwrap().to_rgba8().into_raw(), expected, "{format:?} {opacity}");
            }
        }
        let read =
            image::load_from_memory(&frame.encode(Format::Exr).unwrap()).unwrap().into_rgba32f();
        assert_eq!(read.into_raw(), frame.pixels.concat());
        let read =
            image::load_from_memory(&frame.encode(Format::Jpeg).unwrap()).unwrap().into_rgb8();
        assert!(
            read.get_pixel(0, 0).0.iter().zip(frame.to_rgb8()[0]).all(|(&a, b)| a.abs_diff(b) < 12)
        );
    }

    #[test]
    fn a_frame_of_bytes_is_the_same_file() {
        let mut linear = Frame::filled(5, 3, [0.2, 0.4, 0.6, 1.0]);
        for opacity in [1.0, 0.5] {
            linear.pixels[7] = [0.1, 0.2, 0.3, opacity];
            let bytes = Frame { width: 5, height: 3, pixels: linear.to_rgba8() };
            for format in [Format::Png, Format::Tga, Format::Tiff, Format::Bmp] {
                assert!(
                    bytes.encode(format).unwrap() == linear.encode(format).unwrap(),
                    "{format:?} {opacity}"
                );
            }
            let close = |(a, b): (&u8, &u8)| a.abs_diff(*b) <= u8::from(opacity < 1.0);
            assert!(
                bytes
                    .to_rgb8()
                    .as_flattened()
                    .iter()
                    .zip(linear.to_rgb8().as_flattened())
                    .all(close)
            );
            assert!(bytes.encode(Format::Exr).is_ok());
        }
    }

    #[test]
    fn wrong_number_of_pixels_is_refused() {
        let mut frame = Frame::filled(3, 2, [0.0; 4]);
        frame.pixels.pop();
        assert!(frame.encode(Format::Png).is_err());
        assert!(Frame::filled(0, 0, [0.0; 4]).encode(Format::Png).is_err());
    }
}
