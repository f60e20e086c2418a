//! Pictures of all directions.

use super::options::LoadOptions;
use crate::decode;
use crate::error::{Error, Result};
use crate::scene::Environment;
use std::path::Path;

/// Bytes of a texel that is decoded and kept: a sample of up to 16 bytes, and three floats.
const BYTES: u64 = 28;

/// Reads an equirectangular picture, such as Radiance HDR or EXR, as a sky; `turn_degrees` turns it
/// about up, counter-clockwise seen from above. Integer formats are taken for sRGB. Light beyond
/// 1e6 is cut there, below 0 it is none. The limits of images in `options` hold for it, too.
///
/// # Errors
/// Names the file and what is wrong with it, or the limit that refuses it.
pub fn environment(path: &Path, turn_degrees: f32, options: &LoadOptions) -> Result<Environment> {
    let limits = options.image_limits();
    let [width, height] = decode::probe(path, limits)?.size;
    let mib = (u64::from(width) * u64::from(height) * BYTES) >> 20;
    if mib > u64::from(options.max_image_mib) {
        let reason = format!("{width} x {height} texels need about {mib} MiB");
        return Err(Error::limit(path, reason, "max_image_mib"));
    }
    let texels = decode::samples(path, limits)?.light();
    Environment::new(width as usize, height as usize, texels, turn_degrees)
}
