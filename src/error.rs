//! Everything that loading, saving or a wrong setting can be refused for.

use std::path::PathBuf;

/// Why something was refused. Each text is one line that names the file, line, option or scene part.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file cannot be read, decoded or written.
    #[error("{}: {reason}", path.display())]
    File {
        /// The file as the user named it.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// A line of a text file is wrong.
    #[error("{}:{line}: {reason}", path.display())]
    Line {
        /// The file as the user named it.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
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
    #[error("{part}: {reason}")]
    Scene {
        /// The part, such as `mesh 3 (floor)`.
        part: String,
        /// What is wrong with it.
        reason: String,
    },
}

impl Error {
    /// A refusal of the file `path`.
    pub fn file(path: impl Into<PathBuf>, reason: impl ToString) -> Self {
        Self::File { path: path.into(), reason: reason.to_string() }
    }

    /// A refusal of one setting.
    pub fn setting(name: &'static str, reason: impl ToString) -> Self {
        Self::Setting { name, reason: reason.to_string() }
    }

    /// A refusal of one part of a scene.
    pub fn scene(part: impl ToString, reason: impl ToString) -> Self {
        Self::Scene { part: part.to_string(), reason: reason.to_string() }
    }
}

/// A result whose error is [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// Refuses a setting that is not within its range.
pub(crate) fn within<T: Copy + PartialOrd + std::fmt::Display>(name: &'static str, value: T, least: T, most: T) -> Result<()> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(Error::setting(name, format!("{value} is not within {least} to {most}")))
}
