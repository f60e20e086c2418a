//! One picture: drawn and written whole, or band by band where it is large.

use crate::progress::Progress;
use crate::refusal::Refusal;
use crate::timing::{Took, draw_timed};
use crate::{output, stats};
use basrelief::frame::{Format, Part, PngHead, write_png};
use basrelief::{DrawnPixel, Frame, Region, Renderer, Settings};
use std::io::BufWriter;
use std::path::Path;

/// Pixels of a picture from which on it is drawn in bands: 64 MiB as a frame, 256 MiB in linear
/// light.
const LARGE: u64 = 1 << 24;
/// Pixels of a band: 16 MiB as a frame, and many tiles for every thread.
const BAND: u32 = 1 << 22;
/// Most pixels of a picture that is drawn whole: 1 GiB as a frame, 4 GiB in linear light.
const MAX_WHOLE: u64 = 1 << 28;

/// The settings that the renderer of a picture is made with: of one that is drawn in bands, those
/// of the first.
pub(crate) fn first_settings(settings: &Settings, way: Way) -> Settings {
    let Region { width, height, .. } = settings.drawn();
    let first = Region { height: band_height(width).min(height), ..settings.drawn() };
    Settings {
        region: if way == Way::Bands { Some(first) } else { settings.region },
        ..settings.clone()
    }
}

/// Rows of a band: whole tiles of the usual size, so that few pixels are drawn for two bands.
fn band_height(width: u32) -> u32 {
    ((BAND / width) & !31).max(32)
}

/// How a picture is drawn.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Way {
    /// In memory, in any format.
    Whole(Format),
    /// In bands, each written before the next is drawn, as PNG.
    Bands,
}

impl Way {
    /// How a picture of this size and format is drawn.
    ///
    /// # Errors
    /// Says so where the picture is too large for its format, or to be drawn more than once.
    pub(crate) fn of(
        settings: &Settings,
        format: Format,
        is_repeated: bool,
    ) -> Result<Self, Refusal> {
        let Region { width, height, .. } = settings.drawn();
        let num_pixels = u64::from(width) * u64::from(height);
        let in_bands = format == Format::Png && !is_repeated;
        match num_pixels {
            num if num > LARGE && in_bands => Ok(Self::Bands),
            num if num > MAX_WHOLE => Err(format!(
                "--size: {width}x{height} is more than {MAX_WHOLE} pixels: only .png without --repeat can hold that"
            )
            .into()),
            _ => Ok(Self::Whole(format)),
        }
    }
}

/// Draws the picture of `settings`, with which the renderer was made, into the file `path`: once,
/// or once to warm up and then as often as it is to be measured.
pub(crate) fn draw(
    renderer: &mut Renderer,
    settings: &Settings,
    path: &Path,
    (way, repeat): (Way, Option<u32>),
    progress: &Progress,
) -> Result<Vec<Took>, Refusal> {
    let (took, bytes) = match way {
        Way::Bands => return Ok(vec![draw_bands(renderer, settings, path, progress)?]),
        // Linear light is asked for.
        Way::Whole(format @ Format::Exr) => {
            draw_whole::<[f32; 4]>(renderer, settings, (format, |_| ()), repeat, progress)?
        }
        // The frame over black.
        Way::Whole(format @ Format::Jpeg) => {
            let tone = |frame: &mut Frame| frame.apply_tone(settings.tone);
            draw_whole(renderer, settings, (format, tone), repeat, progress)?
        }
        Way::Whole(format) => {
            draw_whole::<[u8; 4]>(renderer, settings, (format, |_| ()), repeat, progress)?
        }
    };
    output::write(path, &bytes).map(|()| took)
}

fn draw_whole<P: DrawnPixel>(
    renderer: &mut Renderer,
    settings: &Settings,
    (format, finish): (Format, impl Fn(&mut Frame<P>)),
    repeat: Option<u32>,
    progress: &Progress,
) -> Result<(Vec<Took>, Vec<u8>), Refusal> {
    let mut frame = Frame::<P>::default();
    let mut took = vec![draw_timed(renderer, &mut frame)];
    if let Some(num) = repeat {
        took.clear();
        for i in 1..=num {
            progress.stage(format!("drawing frame {i} of {num}"));
            took.push(draw_timed(renderer, &mut frame));
        }
    }
    finish(&mut frame);
    let bytes = frame.encode_part(format, part(settings))?;
    Ok((took, bytes))
}

/// What the picture of `settings` is a part of, if it is.
fn part(settings: &Settings) -> Option<Part> {
    settings.region.map(|region| Part { region, whole: [settings.width, settings.height] })
}

fn draw_bands(
    renderer: &mut Renderer,
    settings: &Settings,
    path: &Path,
    progress: &Progress,
) -> Result<Took, Refusal> {
    let drawn = settings.drawn();
    // Over an opaque background every pixel is opaque; over another, what follows below is not
    // known yet.
    let has_opacity = renderer.scene().background[3] < 1.0;
    let (width, height, part) = (drawn.width, drawn.height, part(settings));
    let head = PngHead { width, height, has_opacity, part };
    let num_rows = band_height(width);
    let (mut took, mut frame) = (Took::default(), Frame::<[u8; 4]>::default());
    let bands = (0..height).step_by(num_rows as usize).map(|y| {
        progress.stage(format!("drawing row {y} of {height}"));
        let band = Region { y: drawn.y + y, height: num_rows.min(height - y), ..drawn };
        renderer.set_region(Some(band))?;
        let (ms, stats) = draw_timed(renderer, &mut frame);
        took.0 += ms;
        stats::add(&mut took.1, &stats);
        Ok(frame.to_bytes(has_opacity))
    });
    output::write_by(path, |sink| {
        let sink = BufWriter::with_capacity(1 << 20, sink);
        write_png(sink, &head, bands).map_err(|e| Refusal::file(path, Refusal::from(e)))
    })?;
    Ok(took)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn way(width: u32, height: u32, format: Format, is_repeated: bool) -> Result<Way, Refusal> {
        Way::of(&Settings { width, height, ..Settings::default() }, format, is_repeated)
    }

    #[test]
    fn only_large_png_pictures_are_drawn_in_bands() {
        assert!(way(4096, 4096, Format::Png, false) == Ok(Way::Whole(Format::Png)));
        assert!(way(4097, 4096, Format::Png, false) == Ok(Way::Bands));
        assert!(way(32768, 32768, Format::Png, false) == Ok(Way::Bands));
        assert!(way(8192, 8192, Format::Exr, false) == Ok(Way::Whole(Format::Exr)));
        assert!(
            way(32768, 32768, Format::Exr, false)
                .is_err_and(|refusal| refusal.to_string().contains("--size"))
        );
        assert!(way(32768, 32768, Format::Png, true).is_err());
        let region = Some(Region { x: 9, y: 9, width: 90, height: 90 });
        let settings = Settings { width: 32768, height: 32768, region, ..Settings::default() };
        assert!(Way::of(&settings, Format::Tiff, true) == Ok(Way::Whole(Format::Tiff)));
    }
}
