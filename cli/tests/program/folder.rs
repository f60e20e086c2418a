//! The program in a folder of its own.

use basrelief::Frame;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

const QUAD: &str =
    "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

/// A folder with `quad.obj`, in which the program runs.
pub(crate) struct Folder(TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        folder.put("quad.obj", QUAD);
        folder
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn put(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    pub(crate) fn put_image(&self, name: &str, color: [f32; 4]) {
        Frame::filled(16, 12, color).save(self.path(name)).unwrap();
    }

    pub(crate) fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_basrelief"));
        command.args(line.split_whitespace()).current_dir(self.0.path());
        command
    }

    pub(crate) fn run(&self, line: &str) -> Output {
        self.command(line).output().unwrap()
    }

    /// Names and contents of all files.
    pub(crate) fn contents(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let paths = fs::read_dir(self.0.path()).unwrap().map(|entry| entry.unwrap().path());
        let mut files: Vec<_> = paths
            .filter(|path| path.is_file())
            .map(|p| (p.clone(), fs::read(&p).unwrap()))
            .collect();
        files.sort();
        files
    }

    /// Runs the program and checks that it ends well.
    pub(crate) fn succeeds(&self, line: &str) -> Output {
        let output = self.run(line);
        assert!(output.status.success(), "{line}: {}", text(&output.stderr));
        output
    }

    /// Checks that the program refuses: exit code 2, one line with `words` on stderr, nothing
    /// printed or written.
    pub(crate) fn refuses(&self, line: &str, words: &[&str]) {
        let before = self.contents();
        let output = self.run(line);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}: {message}");
        assert!(
            message.starts_with("basrelief: ") && message.lines().count() == 1,
            "{line}: {message}"
        );
        assert!(
            words.iter().all(|word| message.contains(word)),
            "{line}: {message} lacks one of {words:?}"
        );
        assert!(output.stdout.is_empty(), "{line} prints");
        assert!(self.contents() == before, "{line} writes");
    }
}

/// Says that a test cannot look at what it is about; past the harness, which shows only what failed
/// tests print.
pub(crate) fn skipped(why: &str) {
    std::io::stderr().write_all(format!("skipped: {why}\n").as_bytes()).unwrap();
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

pub(crate) fn json(bytes: &[u8]) -> serde_json::Value {
    serde_json::from_slice(bytes).unwrap()
}

pub(crate) fn size_of_image(path: &Path) -> (u32, u32) {
    image::image_dimensions(path).unwrap()
}
