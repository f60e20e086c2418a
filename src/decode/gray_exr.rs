//! EXR files of one channel, as height maps are often saved; `image` reads only those of red, green
//! and blue.

use exr::image::read::specific_channels::ReadSpecificChannel;
use exr::math::Vec2;
use exr::meta::attribute::Text;
use exr::prelude::{ReadChannels, ReadLayers, read};
use image::error::{DecodingError, ImageFormatHint};
use image::{ColorType, ImageDecoder, ImageError, ImageFormat, ImageResult};
use std::io::{BufRead, Seek};

/// Decodes a gray EXR to three equal channels.
pub(super) struct GrayExr<R> {
    reader: R,
    channel: Text,
    /// What the picture shows, and where the stored pixels begin in it.
    size: Vec2<usize>,
    offset: Vec2<i32>,
}

impl<R: BufRead + Seek> GrayExr<R> {
    /// The file's luminance, or its only channel; gives the reader back, at its start, where the
    /// file has neither.
    pub(super) fn new(mut reader: R) -> std::io::Result<Result<Self, R>> {
        let found = exr::block::read(&mut reader, false).ok().and_then(|file| {
            file.headers().iter().filter(|header| !header.deep).find_map(|header| {
                let names: Vec<_> =
                    header.channels.list.iter().map(|channel| &channel.name).collect();
                let name = names
                    .iter()
                    .find(|name| **name == &Text::from("Y"))
                    .or(names.first().filter(|_| names.len() == 1))?;
                let window = header.shared_attributes.display_window;
                let offset = header.own_attributes.layer_position - window.position;
                Some(((*name).clone(), window.size, offset))
            })
        });
        reader.rewind()?;
        Ok(match found {
            Some((channel, size, offset)) => Ok(Self { reader, channel, size, offset }),
            None => Err(reader),
        })
    }
}

impl<R: BufRead + Seek> ImageDecoder for GrayExr<R> {
    fn dimensions(&self) -> (u32, u32) {
        let [width, height] =
            [self.size.x(), self.size.y()].map(|n| u32::try_from(n).unwrap_or(u32::MAX));
        (width, height)
    }

    fn color_type(&self) -> ColorType {
        ColorType::Rgb32F
    }

    fn read_image(self, bytes: &mut [u8]) -> ImageResult<()> {
        let Self { reader, channel, size, offset } = self;
        let is_inside = move |place: Vec2<i32>| {
            (0..size.x() as i32).contains(&place.x()) && (0..size.y() as i32).contains(&place.y())
        };
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .specific_channels()
            .required(channel)
            .collect_pixels(
                move |_, _| vec![0.0_f32; size.area()],
                move |values, place, (value,): (f32,)| {
                    let place = place.to_i32() + offset;
                    if is_inside(place) {
                        values[place.y() as usize * size.x() + place.x() as usize] = value;
                    }
                },
            )
            .first_valid_layer()
            .all_attributes()
            .from_buffered(reader)
            .map_err(|error| {
                ImageError::Decoding(DecodingError::new(
                    ImageFormatHint::Exact(ImageFormat::OpenExr),
                    error,
                ))
            })?;
        let values = image.layer_data.channel_data.pixels;
        for (pixel, value) in bytes.chunks_exact_mut(12).zip(values) {
            pixel
                .chunks_exact_mut(4)
                .for_each(|channel| channel.copy_from_slice(&value.to_ne_bytes()));
        }
        Ok(())
    }

    fn read_image_boxed(self: Box<Self>, bytes: &mut [u8]) -> ImageResult<()> {
        (*self).read_image(bytes)
    }
}
