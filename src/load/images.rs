//! Where images lie: in files, or in the bytes of the model itself.

use crate::decode::{self, ImageInfo, ImageLimits, Samples};
use crate::error::Result;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Images of a model that are no files, by the names that messages have for them.
#[derive(Debug, Default)]
pub(super) struct Images {
    embedded: BTreeMap<PathBuf, Vec<u8>>,
}

impl Images {
    pub(super) fn add(&mut self, name: PathBuf, bytes: Vec<u8>) {
        self.embedded.insert(name, bytes);
    }

    pub(super) fn has(&self, name: &Path) -> bool {
        self.embedded.contains_key(name)
    }

    /// Reads only the head of an image.
    pub(super) fn probe(&self, path: &Path, limits: ImageLimits) -> Result<ImageInfo> {
        match self.embedded.get(path) {
            Some(bytes) => decode::probe_bytes(bytes, path, limits),
            None => decode::probe(path, limits),
        }
    }

    /// Decodes an image.
    pub(super) fn samples(&self, path: &Path, limits: ImageLimits) -> Result<Samples> {
        match self.embedded.get(path) {
            Some(bytes) => decode::samples_bytes(bytes, path, limits),
            None => decode::samples(path, limits),
        }
    }
}
