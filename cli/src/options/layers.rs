//! Options that ask for layers: numbers of every pixel for other programs.

use crate::refusal::Refusal;
use basrelief::Layer;
use clap::Args;
use std::path::{Path, PathBuf};

#[derive(Args)]
#[command(next_help_heading = "Layers")]
pub(crate) struct LayerOptions {
    /// Write numbers of every pixel's centre, for programs: depth, position, normal, uv, the same of
    /// the bare mesh (polygon-...), camera-position, camera-normal, albedo, object, material,
    /// triangle, several with commas, or all; to .exr (float; all that name this file together),
    /// .npy (one layer) or .png (16 bits; normals, albedo or names). Without --output no picture is
    /// drawn
    #[arg(long = "layer", value_name = "NAME=FILE", value_parser = LayerFile::parse)]
    files: Vec<LayerFile>,
    /// Write the names of objects and materials by their numbers in layers, as JSON
    #[arg(long, value_name = "FILE", requires = "files")]
    pub(crate) layer_names: Option<PathBuf>,
}

/// How a file holds layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LayerFormat {
    /// Any number of them, as channels of their names.
    Exr,
    /// An array of one.
    Npy,
    /// One whose numbers have a range, in 16 bits.
    Png,
}

/// A file of layers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct LayerFile {
    pub(crate) layers: Vec<Layer>,
    /// The file, or the pattern of the files of many frames.
    pub(crate) path: PathBuf,
    pub(crate) format: LayerFormat,
}

impl LayerFile {
    /// Whether surfaces must keep their normals.
    pub(crate) fn asks_for_normals(&self) -> bool {
        self.layers.iter().any(|layer| matches!(layer, Layer::Normal | Layer::CameraNormal))
    }

    /// From `depth=depth.npy`, `depth,object=both.exr` or `all=layers.exr`.
    fn parse(text: &str) -> Result<Self, String> {
        let (names, path) =
            text.split_once('=').ok_or("is not NAME=FILE such as depth=depth.exr")?;
        let layers = match names {
            "all" => Layer::ALL.to_vec(),
            names => names.split(',').map(layer).collect::<Result<_, _>>()?,
        };
        let path = PathBuf::from(path);
        let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
        let format = match ending.to_ascii_lowercase().as_str() {
            "exr" => LayerFormat::Exr,
            "npy" => LayerFormat::Npy,
            "png" => LayerFormat::Png,
            _ => return Err(format!("{} must end in .exr, .npy or .png", path.display())),
        };
        if let Some(layer) = layers.iter().find(|layer| !format.holds(**layer)) {
            return Err(format!(
                "{} has no range that .png could hold: use .exr or .npy",
                layer.name()
            ));
        }
        if layers.len() > 1 && format != LayerFormat::Exr {
            return Err(format!("{} holds one layer: use .exr for several", path.display()));
        }
        Ok(Self { layers, path, format })
    }
}

fn layer(name: &str) -> Result<Layer, String> {
    Layer::ALL.into_iter().find(|layer| layer.name() == name.trim()).ok_or_else(|| {
        let known: Vec<_> = Layer::ALL.iter().map(|layer| layer.name()).collect();
        format!("{name:?} is no layer: all, {}", known.join(", "))
    })
}

impl LayerFormat {
    fn holds(self, layer: Layer) -> bool {
        let has_range = layer.is_id()
            || matches!(
                layer,
                Layer::Normal | Layer::CameraNormal | Layer::PolygonNormal | Layer::Albedo
            );
        has_range || self != Self::Png
    }
}

impl LayerOptions {
    /// The files that are asked for, each once.
    ///
    /// # Errors
    /// Where two layers want the same file and it cannot hold both.
    pub(crate) fn files(&self) -> Result<Vec<LayerFile>, Refusal> {
        let mut files: Vec<LayerFile> = Vec::new();
        for file in &self.files {
            let Some(same) = files.iter_mut().find(|other| other.path == file.path) else {
                files.push(file.clone());
                continue;
            };
            if file.format != LayerFormat::Exr {
                return Err(twice(&file.path));
            }
            same.layers.extend_from_slice(&file.layers);
        }
        for file in &files {
            let is_twice = |(i, layer): (usize, &Layer)| file.layers[..i].contains(layer);
            if file.layers.iter().enumerate().any(is_twice) {
                return Err(twice(&file.path));
            }
        }
        Ok(files)
    }
}

fn twice(path: &Path) -> Refusal {
    format!("--layer: {} is named twice, or for one layer twice", path.display()).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(words: &[&str]) -> Result<Vec<LayerFile>, String> {
        let files: Result<_, _> = words.iter().map(|word| LayerFile::parse(word)).collect();
        let options = LayerOptions { files: files?, layer_names: None };
        options.files().map_err(|refusal| refusal.to_string())
    }

    #[test]
    fn layers_of_one_exr_come_together() {
        let found = files(&["depth=a.exr", "object=o.PNG", "uv,albedo=a.exr"]).unwrap();
        assert_eq!(found[0].layers, [Layer::Depth, Layer::Uv, Layer::Albedo]);
        assert_eq!((found.len(), found[1].format), (2, LayerFormat::Png));
        assert_eq!(files(&["all=a.exr"]).unwrap()[0].layers, Layer::ALL);
    }

    #[test]
    fn what_no_file_can_hold_is_refused() {
        for (words, reason) in [
            (&["depth"][..], "NAME=FILE"),
            (&["far=a.exr"], "is no layer"),
            (&["depth=a.jpg"], "must end in"),
            (&["depth=-"], "must end in"),
            (&["depth=a.png"], "no range"),
            (&["depth,uv=a.npy"], "holds one layer"),
            (&["depth=a.npy", "uv=a.npy"], "twice"),
            (&["depth=a.exr", "depth=a.exr"], "twice"),
            (&["depth,depth=a.exr"], "twice"),
        ] {
            let error = files(words).unwrap_err();
            assert!(error.contains(reason), "{words:?}: {error}");
        }
    }
}
