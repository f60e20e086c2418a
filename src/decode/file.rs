//! Regular files, opened without waiting for a pipe.

use crate::error::{Error, Result};
use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Opens a regular file; devices, pipes and folders are refused before they are opened, since a pipe would block.
pub(crate) fn open_regular(path: &Path) -> Result<File> {
    let refuse = |reason: io::Error| Error::file(path, plain(&reason));
    let check = |kind: fs::Metadata| {
        if kind.is_file() { Ok(()) } else { Err(Error::file(path, "not a regular file")) }
    };
    check(fs::metadata(path).map_err(refuse)?)?;
    let file = File::open(path).map_err(refuse)?;
    check(file.metadata().map_err(refuse)?)?;
    Ok(file)
}

/// The system's words without its error number.
pub(crate) fn plain(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "no such file".into(),
        io::ErrorKind::PermissionDenied => "permission denied".into(),
        _ => error.to_string(),
    }
}
