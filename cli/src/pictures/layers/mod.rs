//! Files of layers.

mod exr;
mod names;
mod npy;
mod png16;

pub(crate) use names::names;

use crate::options::layers::{LayerFile, LayerFormat};
use crate::output;
use crate::refusal::Refusal;
use basrelief::layers::Values;
use basrelief::{Layer, Layers, Renderer, Settings};
use std::path::{Path, PathBuf};

/// Draws the layers of what the renderer shows now, and writes the files, named by `path_of` their
/// patterns.
pub(crate) fn draw(
    renderer: &mut Renderer,
    files: &[LayerFile],
    path_of: &dyn Fn(&Path) -> PathBuf,
) -> Result<(), Refusal> {
    let asked: Vec<Layer> = files.iter().flat_map(|file| file.layers.iter().copied()).collect();
    let layers = renderer.render_layers(&asked);
    // The first file comes last: where there is no picture, it says that all of a frame is there.
    for file in files.iter().rev() {
        let path = path_of(&file.path);
        let bytes = encode(&layers, file, renderer.settings())
            .map_err(|reason| Refusal::file(&path, reason))?;
        output::write(&path, &bytes)?;
    }
    Ok(())
}

fn encode(layers: &Layers, file: &LayerFile, settings: &Settings) -> Result<Vec<u8>, String> {
    let size = [layers.width, layers.height];
    let of_file = || {
        let is_asked = |layer: &Layer| file.layers.contains(layer);
        layers.all.iter().filter(move |(layer, _)| is_asked(layer))
    };
    match file.format {
        LayerFormat::Exr => {
            exr::encode(settings, of_file().map(|(layer, values)| (*layer, values)))
        }
        LayerFormat::Npy => one(of_file(), |layer, values| npy::encode(size, layer, values)),
        LayerFormat::Png => one(of_file(), |layer, values| png16::encode(size, layer, values)),
    }
}

/// The bytes of the only layer of a file.
fn one<'a>(
    mut layers: impl Iterator<Item = &'a (Layer, Values)>,
    encode: impl Fn(Layer, &Values) -> Result<Vec<u8>, String>,
) -> Result<Vec<u8>, String> {
    layers.next().map_or(Ok(Vec::new()), |(layer, values)| encode(*layer, values))
}
