//! The parts of the picture where the filters differ most.

use basrelief::Frame;
use basrelief::frame::Format;
use basrelief::texture::srgb_from_linear;

/// How many parts are shown.
const NUM: usize = 3;

/// A part of the picture, as every filter draws it.
pub(crate) struct Crop {
    /// Left, top, width and height in pixels.
    pub(crate) area: [usize; 4],
    pub(crate) truth_png: Vec<u8>,
    /// One for each trial.
    pub(crate) pngs: Vec<Vec<u8>>,
}

/// Chooses parts that do not overlap, those first in which the trials' frames lie furthest apart.
pub(crate) fn choose(truth: &Frame, frames: &[Frame]) -> Result<Vec<Crop>, basrelief::Error> {
    let [width, height] = [truth.width as usize, truth.height as usize];
    let side = |whole: usize| (whole / 8).max(8).min(whole);
    let areas = furthest_apart(
        &spread(frames, width * height),
        [width, height],
        [side(width), side(height)],
    );
    let cut_all = |area: [usize; 4]| {
        let png = |frame: &Frame| cut(frame, area).encode(Format::Png);
        let pngs: Result<_, _> = frames.iter().map(png).collect();
        Ok(Crop { area, truth_png: png(truth)?, pngs: pngs? })
    };
    areas.into_iter().map(cut_all).collect()
}

/// The variance of each pixel's luma over the frames, of sRGB-encoded values.
fn spread(frames: &[Frame], num_pixels: usize) -> Vec<f64> {
    let luma = |pixel: &[f32; 4]| {
        let [r, g, b] = [0, 1, 2].map(|i| f64::from(srgb_from_linear(pixel[i])));
        0.299 * r + 0.587 * g + 0.114 * b
    };
    let num = frames.len() as f64;
    let mut sums = vec![[0.0; 2]; num_pixels];
    for frame in frames {
        for ([sum, squares], pixel) in sums.iter_mut().zip(&frame.pixels) {
            let luma = luma(pixel);
            (*sum, *squares) = (*sum + luma, *squares + luma * luma);
        }
    }
    sums.into_iter().map(|[sum, squares]| (squares - sum * sum / num).max(0.0) / num).collect()
}

/// The areas of a size, on a grid of a quarter of it, with the greatest sums. None shares rows with
/// one before it, since what differs at a distance differs all along the skyline.
fn furthest_apart(
    spread: &[f64],
    [width, height]: [usize; 2],
    [w, h]: [usize; 2],
) -> Vec<[usize; 4]> {
    let rows = (0..=height - h).step_by((h / 4).max(1));
    let places =
        rows.flat_map(|y| (0..=width - w).step_by((w / 4).max(1)).map(move |x| [x, y, w, h]));
    let sum = |[x, y, ..]: [usize; 4]| {
        (y..y + h)
            .map(|row| spread[row * width + x..row * width + x + w].iter().sum::<f64>())
            .sum::<f64>()
    };
    let mut places: Vec<([usize; 4], f64)> = places.map(|area| (area, sum(area))).collect();
    places.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut chosen: Vec<[usize; 4]> = Vec::new();
    for (area, sum) in places {
        let is_free = chosen.iter().all(|other| area[1].abs_diff(other[1]) >= h);
        if chosen.len() < NUM && is_free && sum > 0.0 {
            chosen.push(area);
        }
    }
    chosen
}

fn cut(frame: &Frame, [x, y, w, h]: [usize; 4]) -> Frame {
    let row = |row: usize| &frame.pixels[row * frame.width as usize + x..][..w];
    Frame { width: w as u32, height: h as u32, pixels: (y..y + h).flat_map(row).copied().collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_where_frames_differ_and_do_not_overlap() {
        let plain = Frame::filled(64, 48, [0.5, 0.5, 0.5, 1.0]);
        let mut other = plain.clone();
        for y in 30..36 {
            for x in 40..48 {
                other.pixels[y * 64 + x] = [0.0, 0.0, 0.0, 1.0];
            }
        }
        let crops = choose(&plain, &[plain.clone(), other]).unwrap();
        let [x, y, w, h] = crops[0].area;
        assert!(x <= 40 && x + w >= 48 && y <= 30 && y + h >= 36, "{:?}", crops[0].area);
        for (i, a) in crops.iter().enumerate() {
            for b in &crops[..i] {
                assert!(a.area[1].abs_diff(b.area[1]) >= h);
            }
        }
    }

    #[test]
    fn equal_frames_have_no_parts_to_show() {
        let plain = Frame::filled(16, 8, [0.5, 0.5, 0.5, 1.0]);
        assert!(choose(&plain, &[plain.clone(), plain.clone()]).unwrap().is_empty());
    }
}
