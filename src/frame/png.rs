//! PNG row by row from the top, so that a picture may be larger than memory: the one way in which
//! this crate writes PNG.
//!
//! In: rows of 8-bit sRGB samples in bands of any height. Out: the same bytes however the rows are
//! split into bands. A picture that is a part of a larger one says so in a text chunk,
//! `basrelief-region`, as `x,y,width,height of width x height`: [`Part`].

use crate::error::{Error, Result};
use crate::settings::Region;
use std::fmt;
use std::io::Write;
use std::str::FromStr;

/// Keyword of the text chunk.
const KEYWORD: &str = "basrelief-region";

/// Where a picture lies in a larger one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its pixels in the larger picture.
    pub region: Region,
    /// Width and height of the larger picture in pixels.
    pub whole: [u32; 2],
}

impl Part {
    /// What the text chunks of a PNG file, keywords and texts, say of it; `None` where they say
    /// nothing, or nothing that fits its size.
    pub fn of_chunks<'a>(
        [width, height]: [u32; 2],
        chunks: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Option<Self> {
        let (_, text) = chunks.into_iter().find(|(keyword, _)| *keyword == KEYWORD)?;
        let part: Self = text.parse().ok()?;
        ((part.region.width, part.region.height) == (width, height)).then_some(part)
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Region { x, y, width, height } = self.region;
        write!(f, "{x},{y},{width},{height} of {}x{}", self.whole[0], self.whole[1])
    }
}

impl FromStr for Part {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let numbers: Option<Vec<u32>> =
            text.replacen(" of ", ",", 1).split([',', 'x']).map(|n| n.parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[x, y, width, height, of_width, of_height]) => {
                let region = Region { x, y, width, height };
                let part = Self { region, whole: [of_width, of_height] };
                // Spelt in one way only, so that nothing else is taken for it.
                if region.is_within(of_width, of_height) && part.to_string() == text {
                    Some(part)
                } else {
                    None
                }
            }
            _ => None,
        }
        .ok_or_else(|| Error::picture("part", format!("{text:?} is not X,Y,W,H of WxH")))
    }
}

/// What a PNG file says before its pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PngHead {
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Whether a pixel has a fourth sample, its straight opacity.
    pub has_opacity: bool,
    /// Where it lies in a larger picture, if it is a part of one.
    pub part: Option<Part>,
}

/// Writes a PNG file: `bands` are rows of 8-bit sRGB samples from the top, three or four a pixel.
///
/// # Errors
/// The first error of `bands`; or why `sink` does not take the file, or that the bands are not as
/// many rows as the head says.
pub fn write_png(
    sink: impl Write,
    head: &PngHead,
    bands: impl IntoIterator<Item = Result<Vec<u8>>>,
) -> Result<()> {
    let refuse = |e: png::EncodingError| match e {
        png::EncodingError::IoError(e) => Error::Picture {
            what: "PNG",
            reason: format!("cannot be written: {e}"),
            source: Some(e.into()),
        },
        e => Error::picture_caused("PNG", e),
    };
    let mut encoder = png::Encoder::new(sink, head.width, head.height);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_color(if head.has_opacity { png::ColorType::Rgba } else { png::ColorType::Rgb });
    encoder.set_compression(png::Compression::Fast);
    if let Some(part) = &head.part {
        encoder.add_text_chunk(KEYWORD.into(), part.to_string()).map_err(refuse)?;
    }
    let mut writer = encoder.write_header().map_err(refuse)?;
    let mut stream = writer.stream_writer().map_err(refuse)?;
    for band in bands {
        stream.write_all(&band?).map_err(|e| refuse(e.into()))?;
    }
    stream.finish().map_err(refuse)?;
    writer.finish().map_err(refuse)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encode(head: &PngHead, bytes: &[u8], rows: usize) -> Result<Vec<u8>> {
        let mut file = Vec::new();
        let stride = head.width as usize * if head.has_opacity { 4 } else { 3 };
        write_png(&mut file, head, bytes.chunks(stride * rows).map(|band| Ok(band.to_vec())))
            .map(|()| file)
    }

    #[test]
    fn bands_do_not_show() {
        let part =
            Part { region: Region { x: 2, y: 3, width: 301, height: 97 }, whole: [1000, 500] };
        for (has_opacity, part) in [(false, None), (true, Some(part))] {
            let head = PngHead { width: 301, height: 97, has_opacity, part };
            let bytes: Vec<u8> = (0..301 * 97 * if has_opacity { 4 } else { 3_u32 })
                .map(|i| (i.wrapping_mul(i) / 5_000 + i / 300) as u8)
                .collect();
            let whole = encode(&head, &bytes, 97).unwrap();
            assert!([1, 8, 50].iter().all(|&rows| encode(&head, &bytes, rows).unwrap() == whole));
            let mut reader = png::Decoder::new(std::io::Cursor::new(&whole)).read_info().unwrap();
            let info = reader.info();
            let chunks =
                info.uncompressed_latin1_text.iter().map(|chunk| (&*chunk.keyword, &*chunk.text));
            assert_eq!(Part::of_chunks([info.width, info.height], chunks), part);
            let mut read = vec![0; bytes.len()];
            reader.next_frame(&mut read).unwrap();
            assert!(read == bytes);
        }
    }

    #[test]
    fn wrong_number_of_rows_is_refused() {
        let head = PngHead { width: 5, height: 4, has_opacity: false, part: None };
        assert!(encode(&head, &[0; 60], 1).is_ok());
        assert!(encode(&head, &[0; 45], 1).is_err());
    }

    #[test]
    fn parts_are_read_as_they_are_written() {
        let part = Part { region: Region { x: 1, y: 2, width: 3, height: 4 }, whole: [50, 60] };
        assert_eq!(part.to_string().parse::<Part>().unwrap(), part);
        for bad in [
            "",
            "1,2,3,4",
            "1,2,3,4 of 3x9",
            "1,2,3,4 of 50,60",
            "+1,2,3,4 of 50x60",
            "1,2,0,4 of 50x60",
        ] {
            assert!(bad.parse::<Part>().is_err(), "{bad}");
        }
    }
}
