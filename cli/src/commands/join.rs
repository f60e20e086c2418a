//! `basrelief join`: parts of a picture to the whole, row by row.
//!
//! Parts are PNG files that say where they lie. They are opened when the rows reach them and closed
//! after their last row, so memory holds a row of the picture, and as many files are open as parts
//! lie side by side.

use crate::options::join::JoinOptions;
use crate::output;
use crate::refusal::Refusal;
use basrelief::frame::{Format, Part, PngHead, write_png};
use basrelief::{Error, Region};
use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

type Reader = png::Reader<BufReader<File>>;

/// A part whose head has been read.
struct Piece {
    path: PathBuf,
    part: Part,
    has_opacity: bool,
}

/// Joins the parts that the options name.
pub(crate) fn run(options: &JoinOptions) -> Result<ExitCode, Refusal> {
    if output::image_format(&options.output)? != Format::Png {
        return Err(Refusal::file(&options.output, "the name must end in .png"));
    }
    let mut pieces =
        options.parts.iter().map(|path| Piece::of(path)).collect::<Result<Vec<_>, _>>()?;
    pieces.sort_by_key(|piece| (piece.part.region.y, piece.part.region.x));
    let [width, height] = check(&pieces)?;
    // As in a picture drawn at once: where no part needs opacity, the whole does not.
    let has_opacity = pieces.iter().any(|piece| piece.has_opacity);
    let head = PngHead { width, height, has_opacity, part: None };
    let mut rows = Rows { pieces: &pieces, open: Vec::new(), next: 0, has_opacity };
    output::write_by(&options.output, |sink| {
        let sink = BufWriter::with_capacity(1 << 20, sink);
        write_png(sink, &head, (0..height).map(|y| rows.row(y))).map_err(|e| match e {
            Error::Picture { reason, .. } => Refusal::file(&options.output, reason),
            e => e.into(),
        })
    })?;
    Ok(ExitCode::SUCCESS)
}

/// The size of the picture that the sorted pieces cover, each pixel once.
fn check(pieces: &[Piece]) -> Result<[u32; 2], Refusal> {
    let first = &pieces[0];
    let [width, height] = first.part.whole;
    if let Some(other) = pieces.iter().find(|piece| piece.part.whole != first.part.whole) {
        let [other_width, other_height] = other.part.whole;
        let (a, b) = (first.path.display(), other.path.display());
        return Err(format!(
            "{a} is a part of {width}x{height} pixels, {b} of {other_width}x{other_height}"
        )
        .into());
    }
    // How far down each column is covered, as runs that end at a column: the next piece must begin
    // there.
    let mut covered: Vec<(u32, u32)> = vec![(width, 0)];
    for Piece { part, path, .. } in pieces {
        let Region { x, y, width, height } = part.region;
        let (mut start, mut after) = (0, Vec::with_capacity(covered.len() + 2));
        for &(end, down) in &covered {
            let (from, to) = (start.max(x), end.min(x + width));
            if from < to && down > y {
                return Err(Refusal::file(
                    path,
                    format_args!("overlaps another part at x {from}, y {y}"),
                ));
            }
            if from < to && down < y {
                return Err(format!("no part covers x {from}, y {down}").into());
            }
            if from < to {
                after.extend([(from, down), (to, y + height), (end, down)]);
            } else {
                after.push((end, down));
            }
            start = end;
        }
        covered.clear();
        let mut start = 0;
        for (end, down) in after {
            match covered.last_mut() {
                _ if end <= start => continue,
                Some(last) if last.1 == down => last.0 = end,
                _ => covered.push((end, down)),
            }
            start = end;
        }
    }
    let mut start = 0;
    for (end, down) in covered {
        if down < height {
            return Err(format!("no part covers x {start}, y {down}").into());
        }
        start = end;
    }
    Ok([width, height])
}

impl Piece {
    fn of(path: &Path) -> Result<Self, Refusal> {
        let refuse = |reason: &str| Err(Refusal::file(path, reason));
        let reader = open(path).map_err(|reason| Refusal::file(path, reason))?;
        let info = reader.info();
        let has_opacity = match (info.color_type, info.bit_depth, info.interlaced) {
            (png::ColorType::Rgb, png::BitDepth::Eight, false) => false,
            (png::ColorType::Rgba, png::BitDepth::Eight, false) => true,
            _ => {
                return refuse(
                    "is not a part that --region drew: its pixels are stored in another way",
                );
            }
        };
        let chunks =
            info.uncompressed_latin1_text.iter().map(|chunk| (&*chunk.keyword, &*chunk.text));
        match Part::of_chunks([info.width, info.height], chunks) {
            Some(part) => Ok(Self { path: path.into(), part, has_opacity }),
            None => refuse("is not a part that --region drew: it does not say where it lies"),
        }
    }
}

fn open(path: &Path) -> Result<Reader, String> {
    // A pipe would block, and be empty when it is read again.
    if !std::fs::metadata(path).map_err(|e| e.to_string())?.is_file() {
        return Err("is not a file".into());
    }
    let file = File::open(path).map_err(|e| e.to_string())?;
    let mut bytes = BufReader::new(file);
    // Parts may be drawn in any format.
    if !bytes.fill_buf().map_err(|e| e.to_string())?.starts_with(b"\x89PNG") {
        return Err("is not a PNG file, and only those say where they lie".into());
    }
    png::Decoder::new(bytes).read_info().map_err(|e| e.to_string())
}

/// The rows of the whole picture.
struct Rows<'a> {
    pieces: &'a [Piece],
    open: Vec<(&'a Piece, Reader)>,
    /// The next piece to open.
    next: usize,
    has_opacity: bool,
}

impl Rows<'_> {
    /// Row `y`, one row after another.
    fn row(&mut self, y: u32) -> basrelief::Result<Vec<u8>> {
        self.open.retain(|(piece, _)| piece.part.region.y + piece.part.region.height > y);
        while let Some(piece) = self.pieces.get(self.next).filter(|piece| piece.part.region.y == y)
        {
            let reader = open(&piece.path).map_err(|reason| Error::file(&piece.path, reason))?;
            self.open.push((piece, reader));
            self.next += 1;
        }
        self.open.sort_by_key(|(piece, _)| piece.part.region.x);
        let mut row = Vec::new();
        for (piece, reader) in &mut self.open {
            let samples = reader.next_row().map_err(|e| Error::file(&piece.path, e))?;
            let samples = samples.ok_or_else(|| Error::file(&piece.path, "has too few rows"))?;
            match (piece.has_opacity, self.has_opacity) {
                (false, true) => row.extend(
                    samples.data().as_chunks().0.iter().flat_map(|&[r, g, b]| [r, g, b, 255]),
                ),
                _ => row.extend_from_slice(samples.data()),
            }
        }
        Ok(row)
    }
}
