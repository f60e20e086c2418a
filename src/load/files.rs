//! Which files a scene may read: regular files inside the scene's folder unless the caller allows
//! more.

use super::lines::Place;
use crate::error::Result;
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
    /// The folder of the OBJ file.
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
        let Some(root) = &self.root else { return Ok(None) };
        let Ok(real) = fs::canonicalize(parent(at.path).join(name)) else { return Ok(None) };
        if !self.allow_outside && !real.starts_with(root) {
            return Err(at.refuse_limit(
                format!("'{name}' lies outside the scene's folder"),
                "allow_outside",
            ));
        }
        if !real.is_file() {
            return Err(at.refuse(format!("'{name}' is not a regular file")));
        }
        Ok(Some(real))
    }
}

fn parent(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
