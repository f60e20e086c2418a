//! Regular files, opened without waiting for a pipe.

use crate::error::{Error, Result};
use std::fs::{self, File};
use std::path::Path;

/// Opens a regular file; devices, pipes and folders are refused before they are opened, since a
/// pipe would block.
pub(crate) fn open_regular(path: &Path) -> Result<File> {
    let check = |kind: fs::Metadata| {
        if kind.is_file() { Ok(()) } else { Err(Error::file(path, "not a regular file")) }
    };
    check(fs::metadata(path).map_err(|e| Error::caused(path, e))?)?;
    let file = File::open(path).map_err(|e| Error::caused(path, e))?;
    check(file.metadata().map_err(|e| Error::caused(path, e))?)?;
    Ok(file)
}
