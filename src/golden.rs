//! Golden images: pictures in a repository that tests must draw again.
//!
//! ```
//! # let folder = tempfile::tempdir().unwrap();
//! # let golden = folder.path().join("gray.png");
//! use basrelief::Frame;
//! use basrelief::golden::{self, OnDifference, Thresholds};
//!
//! let frame = Frame::filled(32, 32, [0.2, 0.2, 0.2, 1.0]);
//! # frame.save(&golden)?;
//! // In a test: one in a thousand pixels may be off by more than two steps of 255.
//! let thresholds = Thresholds { tolerance: 2.0 / 255.0, share: 0.001 };
//! let accept = std::env::var_os("ACCEPT").is_some();
//! golden::check(&golden, &frame, thresholds, if accept { OnDifference::Accept } else { OnDifference::Fail })?;
//! # Ok::<(), basrelief::Error>(())
//! ```
//!
//! A picture that differs fails, and what was expected, what was drawn and where they differ is
//! written to a folder `failed` beside the golden image (best kept out of the repository). With
//! [`OnDifference::Accept`] it becomes the golden image instead. `basrelief compare --golden` does
//! the same for files.

use crate::error::{Error, Result};
use crate::frame::{Format, Frame, write_whole};
use crate::metrics::{self, Picture};
use std::fs;
use std::path::{Path, PathBuf};

/// How far a picture may be from its golden image. Default: not at all.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Thresholds {
    /// A pixel differs if its red, green, blue or opacity is off by more than this: sRGB-encoded, 0
    /// to 1.
    pub tolerance: f32,
    /// Share of the pixels that may differ, 0 to 1.
    pub share: f32,
}

/// What is done with a picture that is not its golden image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnDifference {
    /// It fails, and the folder `failed` shows how it differs.
    Fail,
    /// It becomes the golden image.
    Accept,
}

/// What became of a picture.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// It is the golden image, within the thresholds.
    Passed,
    /// It was not, and is the golden image now.
    Accepted,
    /// It is not; why, on one line.
    Failed(String),
}

/// Checks that `frame` is the golden image in the file `golden`, whose extension is that of a
/// [`Format`]. The frame is rounded as it would be in a file.
///
/// # Errors
/// Says how the pictures differ, or that there is no golden image yet, and where to look; or names
/// the file that cannot be read or written.
pub fn check(
    golden: impl AsRef<Path>,
    frame: &Frame,
    thresholds: Thresholds,
    on_difference: OnDifference,
) -> Result<()> {
    let golden = golden.as_ref();
    let actual = frame.encode(Format::of(golden)?)?;
    match judge(golden, &actual, thresholds, on_difference, Picture::MAX_PIXELS)? {
        Verdict::Failed(reason) => Err(Error::file(golden, reason)),
        Verdict::Passed | Verdict::Accepted => Ok(()),
    }
}

/// Checks that an image file, given as its bytes, is the golden image in the file `golden`. Neither
/// may have more than `max_pixels` pixels, of which each takes 32 bytes while it is read.
///
/// # Errors
/// Names the file that cannot be read or written, or that it has more than `max_pixels` pixels.
pub fn judge(
    golden: &Path,
    actual: &[u8],
    thresholds: Thresholds,
    on_difference: OnDifference,
    max_pixels: u64,
) -> Result<Verdict> {
    let evidence = Evidence::of(golden)?;
    let picture = Picture::from_bytes(actual, golden, max_pixels)?;
    let expected =
        if golden.exists() { Some(Picture::open_within(golden, max_pixels)?) } else { None };
    let reason = match &expected {
        Some(expected) => difference(expected, &picture, thresholds),
        None => Some("there is no golden image yet".into()),
    };
    let Some(reason) = reason else { return evidence.remove().map(|()| Verdict::Passed) };
    if on_difference == OnDifference::Accept {
        write_whole(golden, actual)?;
        return evidence.remove().map(|()| Verdict::Accepted);
    }
    evidence.write(golden, actual, expected.as_ref(), &picture)?;
    Ok(Verdict::Failed(format!("{reason}; see {}", evidence.folder.display())))
}

/// Why `actual` is not `expected`, if it is not.
fn difference(expected: &Picture, actual: &Picture, thresholds: Thresholds) -> Option<String> {
    let [size, other] = [expected, actual].map(|picture| (picture.width(), picture.height()));
    if size != other {
        return Some(format!(
            "{}x{} pixels were expected, {}x{} drawn",
            size.0, size.1, other.0, other.1
        ));
    }
    let Thresholds { tolerance, share } = thresholds;
    let errors = errors(expected, actual);
    let num = errors.iter().filter(|error| **error > tolerance).count();
    // A share of 0.01 lies below one in a hundred as f32, and means it all the same.
    if num as f64 <= f64::from(share) * 1.000_001 * errors.len() as f64 {
        return None;
    }
    let (at, largest) = errors
        .iter()
        .enumerate()
        .fold((0, 0.0), |a, (i, &error)| if error > a.1 { (i, error) } else { a });
    let (x, y) = (at % size.0 as usize, at / size.0 as usize);
    let percent = |part: f64| format!("{:.4}%", part * 100.0);
    let found = percent(num as f64 / errors.len() as f64);
    Some(format!(
        "{num} pixels ({found}) differ by more than {tolerance}, {} may; the largest error is {largest:.4} at x {x}, y {y}",
        percent(share.into())
    ))
}

/// The largest error of each pixel's four channels.
fn errors(a: &Picture, b: &Picture) -> Vec<f32> {
    let error = |(a, b): (&[f32; 4], &[f32; 4])| {
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    };
    a.pixels().iter().zip(b.pixels()).map(error).collect()
}

/// The files that show a failure.
struct Evidence {
    folder: PathBuf,
    expected: PathBuf,
    actual: PathBuf,
    difference: PathBuf,
}

impl Evidence {
    fn of(golden: &Path) -> Result<Self> {
        let (Some(stem), Some(extension)) = (golden.file_stem(), golden.extension()) else {
            return Err(Error::file(
                golden,
                "the name of a golden image must end in .png or another format",
            ));
        };
        let folder = golden.with_file_name("failed");
        let [stem, extension] = [stem, extension].map(|part| part.to_string_lossy());
        let file = |what: &str, extension: &str| folder.join(format!("{stem}.{what}.{extension}"));
        let [expected, actual] = ["expected", "actual"].map(|what| file(what, &extension));
        let difference = file("difference", "png");
        Ok(Self { folder, expected, actual, difference })
    }

    fn write(
        &self,
        golden: &Path,
        actual: &[u8],
        expected: Option<&Picture>,
        picture: &Picture,
    ) -> Result<()> {
        self.remove()?;
        fs::create_dir_all(&self.folder).map_err(|e| Error::caused(&self.folder, e))?;
        write_whole(&self.actual, actual)?;
        let Some(expected) = expected else { return Ok(()) };
        write_whole(&self.expected, &fs::read(golden).map_err(|e| Error::caused(golden, e))?)?;
        if (expected.width(), expected.height()) == (picture.width(), picture.height()) {
            self.write_difference(errors(expected, picture), picture)?;
        }
        Ok(())
    }

    /// A heat map of the errors, the largest in its brightest colour.
    fn write_difference(&self, errors: Vec<f32>, picture: &Picture) -> Result<()> {
        let largest = errors.iter().copied().fold(1.0 / 255.0, f32::max);
        let opaque = |value: f32| [value, value, value, 1.0];
        let errors = Picture::new(
            picture.width(),
            picture.height(),
            errors.into_iter().map(opaque).collect(),
        )?;
        let none = Picture::new(
            picture.width(),
            picture.height(),
            vec![opaque(0.0); errors.pixels().len()],
        )?;
        metrics::heat_map(&errors, &none, largest)?.save(&self.difference)
    }

    /// Removes what an earlier failure left.
    fn remove(&self) -> Result<()> {
        for file in [&self.expected, &self.actual, &self.difference] {
            match fs::remove_file(file) {
                Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
                    return Err(Error::caused(file, e));
                }
                _ => {}
            }
        }
        // Where other failures are left, it stays.
        let _ = fs::remove_dir(&self.folder);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(off: &[(usize, f32)]) -> Picture {
        let mut pixels = vec![[0.5, 0.5, 0.5, 1.0]; 100];
        off.iter().for_each(|&(at, by)| pixels[at][1] += by);
        Picture::new(10, 10, pixels).unwrap()
    }

    #[test]
    fn both_thresholds_count() {
        let expected = picture(&[]);
        let actual = picture(&[(3, 0.25), (42, -0.125)]);
        let differs =
            |tolerance, share| difference(&expected, &actual, Thresholds { tolerance, share });
        assert!(
            differs(0.25, 0.0).is_none()
                && differs(0.0, 0.02).is_none()
                && differs(0.2, 0.01).is_none()
        );
        for (tolerance, share) in [(0.0, 0.0), (0.24, 0.0), (0.0, 0.019), (0.1, 0.01)] {
            let reason = differs(tolerance, share).unwrap();
            assert!(reason.contains("x 3, y 0") && reason.contains("0.2500"), "{reason}");
        }
        let clear = Picture::new(10, 10, vec![[0.5, 0.5, 0.5, 0.5]; 100]).unwrap();
        assert!(difference(&expected, &clear, Thresholds { tolerance: 0.4, share: 0.0 }).is_some());
    }
}
