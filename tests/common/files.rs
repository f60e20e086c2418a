//! A folder of files for a test to load, and the options to load them with.

use basrelief::load::LoadOptions;
use image::DynamicImage;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

pub struct Files {
    pub folder: TempDir,
    pub options: LoadOptions,
}

impl Files {
    pub fn empty(options: LoadOptions) -> Self {
        Self { folder: tempfile::tempdir().expect("a folder"), options }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.with_folders(name), bytes).expect("written");
    }

    pub fn image(&self, name: &str, image: impl Into<DynamicImage>) {
        image.into().save(self.with_folders(name)).expect("saved");
    }

    /// The path of a file whose folders are there.
    fn with_folders(&self, name: &str) -> PathBuf {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        path
    }
}
