//! Where results go: files that appear whole, or stdout.

use crate::refusal::Refusal;
use basrelief::frame::{Format, WholeFile, check_writable};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The temporary file of what is being written. Held while such a file is made or gets its name.
static UNFINISHED: Mutex<Option<PathBuf>> = Mutex::new(None);

/// On an interrupt, removes the file that is being written, so that nothing half-written stays
/// behind, and ends the program.
pub(crate) fn clean_up_on_interrupt() {
    let end = || {
        let unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
        // It may have no name any more.
        let _ = unfinished.as_ref().map(std::fs::remove_file);
        std::process::exit(130);
    };
    // Without a handler an interrupt ends the program all the same.
    let _ = ctrlc::set_handler(end);
}

/// Whether a path stands for stdout.
pub(crate) fn is_stdout(path: &Path) -> bool {
    path == Path::new("-")
}

/// The format of an image at `path`, which can be written: checked before the work.
pub(crate) fn image_format(path: &Path) -> Result<Format, Refusal> {
    if is_stdout(path) {
        return Ok(Format::Png);
    }
    let format = Format::of(path)?;
    check(path)?;
    Ok(format)
}

/// Checks before the work that a file can be written.
pub(crate) fn check(path: &Path) -> Result<(), Refusal> {
    if is_stdout(path) {
        return Ok(());
    }
    // The check, too, makes a temporary file.
    let _unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    Ok(check_writable(path)?)
}

/// Writes a whole file, or stdout.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Refusal> {
    let name = if is_stdout(path) { "stdout".into() } else { path.display().to_string() };
    write_by(path, |sink| {
        sink.write_all(bytes).map_err(|e| format!("{name}: cannot be written: {e}").into())
    })
}

/// Writes a whole file, or stdout, as `write` does to its sink.
pub(crate) fn write_by(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> Result<(), Refusal>,
) -> Result<(), Refusal> {
    if is_stdout(path) {
        let mut stdout = io::stdout().lock();
        write(&mut stdout)?;
        return stdout.flush().map_err(|e| format!("stdout: cannot be written: {e}").into());
    }
    let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    let mut file = WholeFile::create(path)?;
    *unfinished = file.temporary_path().map(Into::into);
    drop(unfinished);
    let written = write(&mut file);
    let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    *unfinished = None;
    written?;
    Ok(file.finish()?)
}

/// Prints text to stdout. A pipe that is closed, as by `head`, has read what it wanted.
pub(crate) fn print(text: &[u8]) -> Result<(), Refusal> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text).and_then(|()| stdout.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => {
            Err(format!("stdout: cannot be written: {e}").into())
        }
        _ => Ok(()),
    }
}
