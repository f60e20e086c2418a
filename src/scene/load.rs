//! OBJ, MTL and images to a validated scene.

use super::Scene;
use crate::error::{Error, Result};
use crate::texture::Wrap;
use std::path::{Path, PathBuf};

/// Which end of a height map's range is high.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HeightSense {
    /// White lies on the polygon.
    #[default]
    WhiteHigh,
    /// White is deepest (a depth map).
    WhiteDeep,
}

/// Where a normal map's green points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NormalY {
    /// Upwards in the image, as OpenGL, glTF and Blender have it.
    #[default]
    Up,
    /// Downwards in the image, as DirectX and Unreal have it.
    Down,
}

/// How [`load`] reads a scene. `None` leaves the choice to the material files.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// Colour map for every material with texture coordinates, in place of its own.
    pub albedo: Option<PathBuf>,
    /// Height map for every material with texture coordinates, in place of its own.
    pub height: Option<PathBuf>,
    /// Normal map for every material with texture coordinates, in place of its own.
    pub normal: Option<PathBuf>,
    /// Which end of the height maps is high. Default: white.
    pub height_sense: HeightSense,
    /// Relief depth in texture repeats, 0 to 1; `None`: `-bm` of the height map in the MTL, else 0.05.
    pub relief_depth: Option<f32>,
    /// Where the normal maps' green points. Default: up.
    pub normal_y: NormalY,
    /// What lies beyond a texture's edges; `None`: clamp where the MTL says `-clamp on`, else repeat.
    pub wrap: Option<Wrap>,
    /// Whether surfaces keep normals, which only lighting needs. Default: `false`.
    pub keep_normals: bool,
}

/// A scene and what its reader should know of how it was read.
#[derive(Clone, Debug, Default)]
pub struct Loaded {
    /// The scene. Its camera frames the bounding box.
    pub scene: Scene,
    /// What was chosen, such as which image serves as the height map: one line each.
    pub choices: Vec<String>,
    /// What was not supported or missing: one line each.
    pub warnings: Vec<String>,
}

/// Reads an OBJ file with its MTL files and images.
///
/// # Errors
/// Names the file, and the line where one is wrong.
pub fn load(obj: &Path, options: &LoadOptions) -> Result<Loaded> {
    let _ = options;
    Err(Error::file(obj, "not yet"))
}
