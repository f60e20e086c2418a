//! Which files a scene may read: regular files inside the scene's folder unless the caller allows
//! more.

use super::lines::Place;
use crate::error::{Error, Result};
use std::fs;
use std::path::{Path, PathBuf};

/// The folder that a scene's files must lie in.
#[derive(Clone, Debug)]
pub(super) struct Folder {
    /// Absolute and without links; `None`: a scene from memory, which may read nothing.
    root: Option<PathBuf>,
    allow_outside: bool,
}

impl Folder {
    /// The folder of the model.
    pub(super) fn of(obj: &Path, allow_outside: bool) -> Self {
        Self { root: fs::canonicalize(parent(obj)).ok(), allow_outside }
    }

    /// No folder at all: every file counts as missing.
    pub(super) fn none() -> Self {
        Self { root: None, allow_outside: false }
    }

    /// The absolute path without links of the file `name` that the line `at` asks for; `None` when
    /// it is missing.
    ///
    /// # Errors
    /// Says why what lies outside the folder, or is no regular file, is refused.
    pub(super) fn resolve(&self, name: &str, at: Place<'_>) -> Result<Option<PathBuf>> {
        self.find(name, at.path).map_err(|refused| match refused {
            Refused::Outside => at.refuse_limit(refused.reason(name), "allow_outside"),
            Refused::NotRegular => at.refuse(refused.reason(name)),
        })
    }

    /// The absolute path without links of the file `name` that the file `from` asks for; `None`
    /// when it is missing.
    pub(super) fn find(
        &self,
        name: &str,
        from: &Path,
    ) -> std::result::Result<Option<PathBuf>, Refused> {
        let Some(root) = &self.root else { return Ok(None) };
        let Ok(real) = fs::canonicalize(parent(from).join(name)) else { return Ok(None) };
        if !self.allow_outside && !real.starts_with(root) {
            return Err(Refused::Outside);
        }
        if !real.is_file() {
            return Err(Refused::NotRegular);
        }
        Ok(Some(real))
    }
}

/// Why a file may not be read.
#[derive(Clone, Copy, Debug)]
pub(super) enum Refused {
    Outside,
    NotRegular,
}

impl Refused {
    fn reason(self, name: &str) -> String {
        match self {
            Self::Outside => format!("'{name}' lies outside the scene's folder"),
            Self::NotRegular => format!("'{name}' is not a regular file"),
        }
    }

    /// The refusal of the file `from`, which asks for `name`.
    pub(super) fn of(self, from: &Path, name: &str) -> Error {
        match self {
            Self::Outside => Error::limit(from, self.reason(name), "allow_outside"),
            Self::NotRegular => Error::file(from, self.reason(name)),
        }
    }
}

fn parent(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
