//! Where results go: files written whole, or stdout.

use super::Refusal;
use basrelief::frame::{Format, check_writable, write_whole};
use std::io::Write;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Held while a file is written.
static WRITING: Mutex<()> = Mutex::new(());

/// On an interrupt, lets a write in progress finish, so that no temporary file stays behind, and ends the program.
pub(super) fn finish_writing_on_interrupt() {
    let end = || {
        let _writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
        std::process::exit(130);
    };
    // Without a handler an interrupt ends the program all the same.
    let _ = ctrlc::set_handler(end);
}

/// Whether a path stands for stdout.
pub(super) fn is_stdout(path: &Path) -> bool {
    path == Path::new("-")
}

/// The format of an image at `path`, which can be written: checked before the work.
pub(super) fn image_format(path: &Path) -> Result<Format, Refusal> {
    if is_stdout(path) {
        return Ok(Format::Png);
    }
    let format = Format::of(path).map_err(|e| e.to_string())?;
    check(path)?;
    Ok(format)
}

/// Checks before the work that a file can be written.
pub(super) fn check(path: &Path) -> Result<(), Refusal> {
    if is_stdout(path) {
        return Ok(());
    }
    // The check, too, makes a temporary file.
    let _writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    check_writable(path).map_err(|e| e.to_string())
}

/// Writes a whole file, or stdout.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), Refusal> {
    if is_stdout(path) {
        return print(bytes);
    }
    let _writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    write_whole(path, bytes).map_err(|e| e.to_string())
}

/// Writes to stdout.
pub(super) fn print(bytes: &[u8]) -> Result<(), Refusal> {
    let mut stdout = std::io::stdout().lock();
    stdout.write_all(bytes).and_then(|()| stdout.flush()).map_err(|e| format!("stdout: cannot be written: {e}"))
}
