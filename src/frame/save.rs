//! Files that are there as a whole or not at all.
//!
//! A temporary file is locked while its writer lives, so that one that a killed writer left behind
//! is known by its lock being free, and the next check of the same folder removes it.

use crate::error::{Error, Result};
use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// What the names of temporary files begin and end with.
const TEMPORARY: [&str; 2] = [".basrelief-", ".tmp"];

/// Writes `bytes` to the file `path`, replacing what was there in one step: see [`WholeFile`].
///
/// # Errors
/// Names the file when it cannot be written; an older file is then left as it was.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut file = WholeFile::create(path)?;
    file.write_all(bytes).map_err(|e| unwritable(path, e))?;
    file.finish()
}

/// A file that appears under its name when it is finished, and not before: at any moment, even if
/// the process is killed or the disk fills up, the name stands for the whole old or the whole new
/// file.
///
/// A link is followed; the permissions of an older file are kept. Devices and pipes are written to
/// directly. Dropped without [`WholeFile::finish`], it leaves nothing behind.
#[derive(Debug)]
pub struct WholeFile {
    path: PathBuf,
    sink: Sink,
}

#[derive(Debug)]
enum Sink {
    Temporary { file: NamedTempFile, target: PathBuf, permissions: Option<Permissions> },
    Stream(File),
}

impl WholeFile {
    /// Opens a temporary file beside `path`.
    ///
    /// # Errors
    /// Names the file and what is in the way.
    pub fn create(path: &Path) -> Result<Self> {
        let sink = match Place::of(path)? {
            Place::Stream => OpenOptions::new().write(true).open(path).map(Sink::Stream),
            Place::File { target, permissions } => {
                temporary_beside(&target).map(|file| Sink::Temporary { file, target, permissions })
            }
        };
        Ok(Self { path: path.into(), sink: sink.map_err(|e| unwritable(path, e))? })
    }

    /// Where the bytes lie until the file is finished; `None` for devices and pipes.
    pub fn temporary_path(&self) -> Option<&Path> {
        match &self.sink {
            Sink::Temporary { file, .. } => Some(file.path()),
            Sink::Stream(_) => None,
        }
    }

    /// Flushes the file to the disk and gives it its name.
    ///
    /// # Errors
    /// Names the file when that fails; an older file is then left as it was.
    pub fn finish(self) -> Result<()> {
        let Self { path, sink } = self;
        let finish = |file: NamedTempFile, target: &Path, permissions: Option<Permissions>| {
            permissions
                .map_or(Ok(()), |permissions| fs::set_permissions(file.path(), permissions))?;
            file.as_file().sync_all()?;
            file.persist(target)?;
            flush_folder(target)
        };
        match sink {
            Sink::Temporary { file, target, permissions } => finish(file, &target, permissions),
            Sink::Stream(mut stream) => stream.flush(),
        }
        .map_err(|e| unwritable(&path, e))
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.sink {
            // Its own writer would name the temporary file in an error.
            Sink::Temporary { file, .. } => file.as_file_mut().write(bytes),
            Sink::Stream(stream) => stream.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.sink {
            Sink::Temporary { file, .. } => file.as_file_mut().flush(),
            Sink::Stream(stream) => stream.flush(),
        }
    }
}

fn unwritable(path: &Path, error: io::Error) -> Error {
    let reason = format!("cannot be written: {error}");
    Error::File { path: path.into(), line: None, reason, source: Some(error.into()) }
}

/// Checks, before the work, that [`write_whole`] could write the file `path`: its folder exists and
/// takes files. Removes from the folder what writers that were killed left there.
///
/// # Errors
/// Names the file and what is in the way.
pub fn check_writable(path: &Path) -> Result<()> {
    match Place::of(path)? {
        Place::Stream => Ok(()),
        Place::File { target, .. } => {
            remove_abandoned(folder(&target));
            temporary_beside(&target).map(drop).map_err(|e| unwritable(path, e))
        }
    }
}

/// Where bytes for a path end up.
enum Place {
    /// A file that is there (links followed), with its permissions, or one to be made.
    File { target: PathBuf, permissions: Option<Permissions> },
    /// A device or pipe.
    Stream,
}

impl Place {
    fn of(path: &Path) -> Result<Self> {
        let refuse = |reason: &str| Err(Error::file(path, reason));
        if path.file_name().is_none() {
            return refuse("names no file");
        }
        if !folder(path).is_dir() {
            return refuse("its folder does not exist");
        }
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => refuse("is a folder"),
            Ok(found) if !found.is_file() => Ok(Self::Stream),
            Ok(found) if found.permissions().readonly() => refuse("is write-protected"),
            Ok(found) => {
                let target = fs::canonicalize(path).map_err(|e| Error::caused(path, e))?;
                Ok(Self::File { target, permissions: Some(found.permissions()) })
            }
            Err(_) if path.is_symlink() => refuse("is a link to a file that cannot be found"),
            Err(_) => Ok(Self::File { target: path.into(), permissions: None }),
        }
    }
}

fn folder(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A temporary file in the target's folder, locked.
fn temporary_beside(target: &Path) -> io::Result<NamedTempFile> {
    let mut name = tempfile::Builder::new();
    name.prefix(TEMPORARY[0]).suffix(TEMPORARY[1]);
    // The crate's own choice, readable by the owner alone, is for secrets; the user's mask shall
    // decide.
    #[cfg(unix)]
    name.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    loop {
        // Its message names the temporary file, of which the user knows nothing: keep the kind
        // only.
        let file = name.tempfile_in(folder(target)).map_err(|e| io::Error::from(e.kind()))?;
        // Where files cannot be locked, none is ever taken for abandoned.
        let _ = file.as_file().lock();
        // Another process may have taken it for abandoned in the moment before it was locked.
        if file.path().exists() {
            return Ok(file);
        }
    }
}

/// Removes temporary files whose writers are gone. What cannot be removed stays.
fn remove_abandoned(folder: &Path) {
    let is_temporary = |name: &str| name.starts_with(TEMPORARY[0]) && name.ends_with(TEMPORARY[1]);
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| entry.file_name().to_str().is_some_and(is_temporary)) {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        // Held until the file is removed, so that a writer that has just made it sees that it is
        // gone.
        let lock = if is_file { File::open(entry.path()).ok() } else { None };
        if lock.as_ref().is_some_and(|file| file.try_lock().is_ok()) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Makes the new name last through a power failure, where folders can be flushed.
fn flush_folder(target: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(folder(target))?.sync_all() } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        fs::read_dir(folder)
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect()
    }

    #[test]
    fn file_is_replaced_and_nothing_else_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        for bytes in [&b"old"[..], b"new and longer"] {
            check_writable(&path).unwrap();
            write_whole(&path, bytes).unwrap();
            assert_eq!(fs::read(&path).unwrap(), bytes);
            assert_eq!(names(folder.path()), ["a.png"]);
        }
    }

    #[test]
    fn what_cannot_be_a_file_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("missing/a.png");
        for (path, reason) in
            [(missing.as_path(), "folder does not exist"), (folder.path(), "is a folder")]
        {
            let text = check_writable(path).unwrap_err().to_string();
            assert!(text.contains(reason) && text.contains(&path.display().to_string()), "{text}");
            assert_eq!(write_whole(path, b"x").unwrap_err().to_string(), text);
        }
    }

    #[test]
    fn what_killed_writers_left_is_removed_and_what_living_ones_write_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let living = temporary_beside(&path).unwrap();
        fs::write(folder.path().join(".basrelief-abc.tmp"), "half an image").unwrap();
        fs::write(folder.path().join(".basrelief-abc.png"), "the user's own").unwrap();
        check_writable(&path).unwrap();
        let mut found = names(folder.path());
        found.sort();
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(
            living.path().exists() && found.contains(&".basrelief-abc.png".into()),
            "{found:?}"
        );
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_permissions_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let [file, link] = ["file", "link"].map(|name| folder.path().join(name));
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, Permissions::from_mode(0o640)).unwrap();
        symlink(&file, &link).unwrap();
        write_whole(&link, b"new").unwrap();
        assert!(link.is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn full_disk_is_an_error() {
        let text = write_whole(Path::new("/dev/full"), b"x").unwrap_err().to_string();
        assert!(text.starts_with("/dev/full: cannot be written"), "{text}");
    }
}
