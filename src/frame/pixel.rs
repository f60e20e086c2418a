//! What a frame keeps of a pixel.

use crate::texture::{linear_from_srgb8, srgb8_from_linear, srgb8_of_four};

/// A pixel of a [`Frame`](super::Frame): `[f32; 4]` is linear RGB, premultiplied by the fourth
/// component, the opacity; `[u8; 4]` is 8-bit sRGB with straight opacity, in a quarter of the
/// memory.
pub trait Pixel: Copy + Default + Send + Sync + private::Sealed {
    /// Whether pixels are those of a picture, to look at; else they are light.
    const IS_PICTURE: bool;

    /// Sets a row from pixels in linear light, premultiplied by their opacity.
    fn set_row(row: &mut [Self], linear: &[[f32; 4]]);

    /// Sets `bytes` to a row in 8-bit sRGB with straight opacity.
    fn rgba8_row(row: &[Self], bytes: &mut [[u8; 4]]);

    /// The pixel in linear light, premultiplied by its opacity.
    fn to_linear(self) -> [f32; 4];
}

mod private {
    pub trait Sealed {}
    impl Sealed for [f32; 4] {}
    impl Sealed for [u8; 4] {}
}

impl Pixel for [f32; 4] {
    const IS_PICTURE: bool = false;

    #[inline]
    fn set_row(row: &mut [Self], linear: &[[f32; 4]]) {
        row.copy_from_slice(linear);
    }

    fn rgba8_row(row: &[Self], bytes: &mut [[u8; 4]]) {
        Pixel::set_row(bytes, row);
    }

    fn to_linear(self) -> [f32; 4] {
        self
    }
}

impl Pixel for [u8; 4] {
    const IS_PICTURE: bool = true;

    fn set_row(row: &mut [Self], linear: &[[f32; 4]]) {
        let ((fours, last), (from, last_from)) =
            (row.as_chunks_mut::<4>(), linear.as_chunks::<4>());
        for (four, linear) in fours.iter_mut().zip(from) {
            if linear.iter().all(|pixel| pixel[3] == 1.0) {
                four.as_flattened_mut().copy_from_slice(&srgb8_of_four(linear));
            } else if linear.iter().all(|pixel| pixel[3] == 0.0) {
                *four = [[0; 4]; 4];
            } else {
                *four = linear.map(rgba8);
            }
        }
        last.iter_mut().zip(last_from).for_each(|(pixel, linear)| *pixel = rgba8(*linear));
    }

    fn rgba8_row(row: &[Self], bytes: &mut [[u8; 4]]) {
        bytes.copy_from_slice(row);
    }

    fn to_linear(self) -> [f32; 4] {
        let [rgb @ .., opacity] = self;
        let opacity = f32::from(opacity) / 255.0;
        let [r, g, b] = rgb.map(|byte| linear_from_srgb8(byte) * opacity);
        [r, g, b, opacity]
    }
}

fn rgba8([r, g, b, opacity]: [f32; 4]) -> [u8; 4] {
    if opacity > 0.0 {
        let opacity = opacity.min(1.0);
        let [r, g, b] = [r, g, b].map(|c| srgb8_from_linear(c / opacity));
        [r, g, b, (opacity * 255.0 + 0.5) as u8]
    } else {
        [0; 4]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opacity_is_straight_in_bytes() {
        assert_eq!(rgba8([0.25, 0.0, 0.5, 0.5]), [188, 0, 255, 128]);
        assert_eq!(rgba8([0.0; 4]), [0; 4]);
        assert_eq!(rgba8([f32::NAN, 2.0, -1.0, 1.0]), [0, 255, 0, 255]);
        assert_eq!(rgba8([1.0, 1.0, 1.0, f32::NAN]), [0; 4]);
    }

    #[test]
    fn a_row_is_its_pixels() {
        let numbers =
            [f32::NAN, -1.0, 0.0, 1e-9, 1.2e-4, 1.6e-4, 0.2, 0.5, 0.999, 1.0, 3.0, f32::INFINITY];
        for first in 0..numbers.len() {
            let color = |i: usize| [0, 1, 2].map(|c| numbers[(first + 5 * i + c) % numbers.len()]);
            let row: Vec<[f32; 4]> = (0..11)
                .map(|i| {
                    let [r, g, b] = color(i);
                    [r, g, b, if i > 5 { [1.0, 0.25, 0.0, f32::NAN][(first + i) % 4] } else { 1.0 }]
                })
                .collect();
            let mut bytes = vec![[7; 4]; row.len()];
            Pixel::set_row(&mut bytes, &row);
            assert_eq!(bytes, row.iter().map(|pixel| rgba8(*pixel)).collect::<Vec<_>>());
        }
    }
}
