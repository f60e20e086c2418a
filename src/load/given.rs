//! What the caller says of materials, with absolute paths.

use super::options::{LoadOptions, MaterialOptions};
use crate::decode::open_regular;
use crate::error::{Error, Result};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// What the caller says of all materials, and of single ones by name.
pub(super) struct Given<'a> {
    of_all: MaterialOptions,
    of_one: BTreeMap<&'a str, MaterialOptions>,
}

impl<'a> Given<'a> {
    /// Looks for the files that the caller names.
    ///
    /// # Errors
    /// Names a file that is missing or refused.
    pub(super) fn new(options: &'a LoadOptions) -> Result<Self> {
        let of_all = with_real_paths(&options.all)?;
        let of_one = options.materials.iter();
        let of_one =
            of_one.map(|(name, own)| Ok((name.as_str(), with_real_paths(own)?.or(&of_all))));
        let of_one = of_one.collect::<Result<_>>()?;
        Ok(Self { of_all, of_one })
    }

    /// What is said of the material of a name.
    pub(super) fn of(&self, name: &str) -> &MaterialOptions {
        self.of_one.get(name).unwrap_or(&self.of_all)
    }
}

/// A line for each file that the caller names.
pub(super) fn choices(options: &LoadOptions) -> Vec<String> {
    let of_one = options.materials.iter();
    let of_one = of_one.map(|(name, own)| (format!("material {name}"), own));
    let all = std::iter::once(("every material".into(), &options.all)).chain(of_one);
    let line = |whose: &String, what, path: &Option<PathBuf>| {
        path.as_ref().map(|path| format!("{whose}: {what} from {}", path.display()))
    };
    all.flat_map(|(whose, given): (String, _)| {
        [
            ("colour", &given.albedo),
            ("height", &given.height),
            ("normals", &given.normal),
            ("metal", &given.metallic_map),
            ("roughness", &given.roughness_map),
            ("occlusion", &given.occlusion_map),
            ("emission", &given.emissive_map),
        ]
        .map(|(what, path)| line(&whose, what, path))
    })
    .flatten()
    .collect()
}

/// `given` with its files' absolute paths.
fn with_real_paths(given: &MaterialOptions) -> Result<MaterialOptions> {
    let mut real = given.clone();
    for path in real.files_mut().into_iter().flatten() {
        *path = real_path(path)?;
    }
    Ok(real)
}

/// The path of a file that the caller named.
fn real_path(path: &Path) -> Result<PathBuf> {
    open_regular(path)?;
    fs::canonicalize(path).map_err(|error| Error::caused(path, error))
}
