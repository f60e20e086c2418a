//! Hands a text file to tobj line by line, each cleaned first.
//!
//! Input: any reader. Output: a reader of cleaned lines that knows which line of the file it is at,
//! so that whatever tobj refuses can be named without reading the file twice. Lines that end in a
//! backslash are joined, byte-order marks and bytes that are not UTF-8 are replaced, and no line is
//! read past [`MAX_LINE_BYTES`].

use crate::error::{Error, Result};
use std::borrow::Cow;
use std::io::{self, BufRead, Read};
use std::path::{Path, PathBuf};

/// Longest line that is read: a polygon of a million corners fits, a binary file without line ends
/// does not fill memory.
const MAX_LINE_BYTES: usize = 32 << 20;

/// Where the OBJ's text comes from; it is read again only to find the line of an error.
pub(super) trait Source {
    fn path(&self) -> &Path;
    fn reader(&self) -> Result<Box<dyn BufRead + '_>>;
}

/// What a cleaner does with a line.
pub(super) trait Clean {
    /// Appends what tobj shall see of `text` to `out`, each line ended by `\n`; nothing leaves the
    /// line out.
    fn clean(&mut self, text: &str, at: Place<'_>, out: &mut String) -> Result<()>;
}

/// A line of a file, for messages.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place<'a> {
    pub(super) path: &'a Path,
    pub(super) line: usize,
}

impl Place<'_> {
    /// A refusal of this line.
    pub(super) fn refuse(self, reason: impl ToString) -> Error {
        Error::File {
            path: self.path.into(),
            line: Some(self.line),
            reason: reason.to_string(),
            source: None,
        }
    }

    /// A refusal of this line, which asks for more than `option` allows.
    pub(super) fn refuse_limit(self, reason: impl ToString, option: &'static str) -> Error {
        Error::Limit {
            path: self.path.into(),
            line: Some(self.line),
            reason: reason.to_string(),
            option,
        }
    }

    /// A one-line remark about this line.
    pub(super) fn remark(self, text: impl std::fmt::Display) -> String {
        format!("{}:{}: {text}", self.path.display(), self.line)
    }
}

/// A reader of cleaned lines.
pub(super) struct CleanLines<R, C> {
    inner: R,
    pub(super) cleaner: C,
    path: PathBuf,
    /// Lines read so far: the number of the last one.
    num_read: usize,
    raw: Vec<u8>,
    clean: String,
    consumed: usize,
    /// Why reading was stopped from our side; tobj only knows that it was.
    pub(super) failure: Option<Error>,
}

impl<R: BufRead, C: Clean> CleanLines<R, C> {
    pub(super) fn new(inner: R, path: &Path, cleaner: C) -> Self {
        let (raw, clean) = (Vec::new(), String::new());
        Self {
            inner,
            cleaner,
            path: path.into(),
            num_read: 0,
            raw,
            clean,
            consumed: 0,
            failure: None,
        }
    }

    /// The line that was handed out last.
    pub(super) fn place(&self) -> Place<'_> {
        Place { path: &self.path, line: self.num_read }
    }

    /// The cleaned text of the line that was read last.
    pub(super) fn text(&self) -> &str {
        &self.clean
    }

    /// Reads and cleans the next line; false at the end of the file.
    pub(super) fn advance(&mut self) -> Result<bool> {
        (self.consumed, self.num_read) = (0, self.num_read + 1);
        self.clean.clear();
        self.raw.clear();
        loop {
            if !self.read_physical_line()? {
                return Ok(false);
            }
            if self.raw.last() != Some(&b'\\') {
                break;
            }
            self.raw.pop();
            self.raw.push(b' ');
            self.num_read += 1;
        }
        // Checked first, which is many times faster than to look for what must be replaced.
        let text = std::str::from_utf8(&self.raw)
            .map_or_else(|_| String::from_utf8_lossy(&self.raw), Cow::Borrowed);
        let text = text.trim_start_matches('\u{feff}').trim();
        self.cleaner.clean(
            text,
            Place { path: &self.path, line: self.num_read },
            &mut self.clean,
        )?;
        Ok(true)
    }

    /// Appends one line of the file to `raw`, without its end; false when there was nothing to
    /// read.
    fn read_physical_line(&mut self) -> Result<bool> {
        let room = MAX_LINE_BYTES.saturating_sub(self.raw.len());
        let read = (&mut self.inner).take(room as u64).read_until(b'\n', &mut self.raw);
        let num = read.map_err(|reason| Error::caused(&self.path, reason))?;
        if num == room {
            return Err(self.place().refuse("the line is too long for a text file"));
        }
        while self.raw.last().is_some_and(|c| matches!(c, b'\n' | b'\r')) {
            self.raw.pop();
        }
        Ok(num > 0 || !self.raw.is_empty())
    }
}

impl<R: BufRead, C: Clean> BufRead for CleanLines<R, C> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        while self.consumed == self.clean.len() {
            match self.advance() {
                Ok(true) => {}
                Ok(false) => break,
                Err(failure) => {
                    self.failure = Some(failure);
                    return Err(io::Error::other("refused"));
                }
            }
        }
        Ok(&self.clean.as_bytes()[self.consumed.min(self.clean.len())..])
    }

    fn consume(&mut self, num: usize) {
        self.consumed += num;
    }
}

impl<R: BufRead, C: Clean> Read for CleanLines<R, C> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let num = self.fill_buf()?.read(buffer)?;
        self.consume(num);
        Ok(num)
    }
}
