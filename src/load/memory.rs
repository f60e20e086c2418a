//! The loaders on bytes in memory, for fuzzing: what a hostile file reaches, without the file
//! system.

use super::assemble::{Loaded, load_from, put_together};
use super::files::Folder;
use super::gltf;
use super::lines::Source;
use super::mtl::MtlFiles;
use super::options::LoadOptions;
use crate::decode::{self, ImageLimits};
use crate::error::Result;
use std::io::BufRead;
use std::path::Path;

/// Reads an OBJ file from memory; the files that it names count as missing.
///
/// # Errors
/// As [`load`](super::load()).
#[doc(hidden)]
pub fn load_obj_bytes(bytes: &[u8], options: &LoadOptions) -> Result<Loaded> {
    load_from(&ObjBytes(bytes), &Folder::none(), options, &|_| ())
}

/// Reads a glTF or GLB file from memory; the files that it names count as missing.
///
/// # Errors
/// As [`load`](super::load()).
#[doc(hidden)]
pub fn load_gltf_bytes(bytes: &[u8], options: &LoadOptions) -> Result<Loaded> {
    options.check()?;
    put_together(gltf::read_bytes(bytes, &Folder::none(), options)?, options, &|_| ())
}

/// Reads an MTL file from memory with all its texture lines, and returns its warnings.
///
/// # Errors
/// Names the line that is wrong.
#[doc(hidden)]
pub fn load_mtl_bytes(bytes: &[u8]) -> Result<Vec<String>> {
    let mut files = MtlFiles::new(Path::new("scene.obj"), &Folder::none());
    files.read_text(bytes, Path::new("scene.mtl"))?;
    Ok(files.warnings)
}

/// Decodes an image from memory and makes every kind of map from it; a TGA when it has no other
/// format's signature.
///
/// # Errors
/// Says what is wrong with the image, or that it exceeds 1024 texels a side or 16 MiB.
#[doc(hidden)]
pub fn load_image_bytes(bytes: &[u8]) -> Result<()> {
    let limits = ImageLimits { side: 1024, texels: u64::MAX, bytes: 16 << 20 };
    let samples = decode::samples_bytes(bytes, Path::new("image.tga"), limits)?;
    let _ = (
        samples.color(),
        samples.gray(None, [0.0, 1.0]),
        samples.normal(1.0, 1.0),
        samples.is_gray(),
    );
    Ok(())
}

struct ObjBytes<'a>(&'a [u8]);

impl Source for ObjBytes<'_> {
    fn path(&self) -> &Path {
        Path::new("scene.obj")
    }
    fn reader(&self) -> Result<Box<dyn BufRead + '_>> {
        Ok(Box::new(self.0))
    }
}
