//! Everything that loading, saving, comparing or a wrong setting can be refused for.

use std::borrow::Cow;
use std::io;
use std::path::{Path, PathBuf};

/// An error of the system or of another crate.
type Cause = Box<dyn std::error::Error + Send + Sync>;

/// Why something was refused. Each text is one line that names the file, line, option or scene
/// part.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file cannot be read, decoded or written.
    #[error("{}: {}", place(path, *line), one_line(reason))]
    File {
        /// The file as the user named it.
        path: PathBuf,
        /// The line of a text file, counted from 1, if one is to blame.
        line: Option<usize>,
        /// What is wrong with it.
        reason: String,
        /// The error that it comes from, if there is one.
        source: Option<Cause>,
    },
    /// A file asks for more than the options allow.
    #[error("{}: {} ({option})", place(path, *line), one_line(reason))]
    Limit {
        /// The file as the user named it.
        path: PathBuf,
        /// The line of a text file, counted from 1, if one is to blame.
        line: Option<usize>,
        /// What the file asks for.
        reason: String,
        /// The field of the options, or the parameter, that allows more.
        option: &'static str,
    },
    /// A field of [`Settings`](crate::Settings) or of the load options is out of its range.
    #[error("{name}: {reason}")]
    Setting {
        /// The field's or option's name.
        name: &'static str,
        /// What is wrong with its value.
        reason: String,
    },
    /// A part of a [`Scene`](crate::Scene) made by hand is not valid.
    #[error("{}: {}", one_line(part), one_line(reason))]
    Scene {
        /// The part, such as `mesh 3 (floor)`.
        part: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A picture in memory is not valid, cannot be encoded, or cannot be compared with another.
    #[error("{what}: {reason}")]
    Picture {
        /// Which, such as `frame`.
        what: &'static str,
        /// What is wrong with it.
        reason: String,
        /// The error that it comes from, if there is one.
        source: Option<Cause>,
    },
}

impl Error {
    /// A refusal of the file `path`.
    pub fn file(path: impl Into<PathBuf>, reason: impl ToString) -> Self {
        Self::File { path: path.into(), line: None, reason: reason.to_string(), source: None }
    }

    /// A refusal of the file `path` for an error of the system or of another crate.
    pub fn caused(path: impl Into<PathBuf>, cause: impl Into<Cause>) -> Self {
        let cause = cause.into();
        Self::File { path: path.into(), line: None, reason: plain(&cause), source: Some(cause) }
    }

    /// A refusal of a file that asks for more than `option` allows.
    pub(crate) fn limit(
        path: impl Into<PathBuf>,
        reason: impl ToString,
        option: &'static str,
    ) -> Self {
        Self::Limit { path: path.into(), line: None, reason: reason.to_string(), option }
    }

    /// A refusal of one setting.
    pub fn setting(name: &'static str, reason: impl ToString) -> Self {
        Self::Setting { name, reason: reason.to_string() }
    }

    /// A refusal of one part of a scene.
    pub fn scene(part: impl ToString, reason: impl ToString) -> Self {
        Self::Scene { part: part.to_string(), reason: reason.to_string() }
    }

    /// A refusal of a picture in memory.
    pub(crate) fn picture(what: &'static str, reason: impl ToString) -> Self {
        Self::Picture { what, reason: reason.to_string(), source: None }
    }

    /// A refusal of a picture in memory for an error of another crate.
    pub(crate) fn picture_caused(what: &'static str, cause: impl Into<Cause>) -> Self {
        let cause = cause.into();
        Self::Picture { what, reason: plain(&cause), source: Some(cause) }
    }
}

/// `FILE` or `FILE:LINE`.
fn place(path: &Path, line: Option<usize>) -> String {
    let path = path.display().to_string();
    let path = one_line(&path);
    line.map_or_else(|| path.to_string(), |line| format!("{path}:{line}"))
}

/// A text with escapes for control characters: names in files may hold line breaks.
pub(crate) fn one_line(text: &str) -> Cow<'_, str> {
    if !text.contains(char::is_control) {
        return text.into();
    }
    let mut line = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if c.is_control() { line.extend(c.escape_debug()) } else { line.push(c) }
    }
    line.into()
}

/// One line, and the system's usual words without its error number.
fn plain(cause: &Cause) -> String {
    match cause.downcast_ref::<io::Error>().map(io::Error::kind) {
        Some(io::ErrorKind::NotFound) => "no such file".into(),
        Some(io::ErrorKind::PermissionDenied) => "permission denied".into(),
        _ => cause.to_string().replace('\n', " "),
    }
}

/// A result whose error is [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// Refuses a setting that is not within its range.
pub(crate) fn within<T: Copy + PartialOrd + std::fmt::Display>(
    name: &'static str,
    value: T,
    least: T,
    most: T,
) -> Result<()> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(Error::setting(name, format!("{value} is not within {least} to {most}")))
}
