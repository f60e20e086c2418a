//! What the files of a model say, of whatever format, before images are read.

use super::images::Images;
use super::plan::Plan;
use crate::scene::{Camera, Light, Material, Mesh};

/// What the files of a model say.
pub(super) struct Model {
    pub(super) meshes: Vec<Mesh>,
    /// Without surfaces, and what those are made from.
    pub(super) materials: Vec<(Material, Option<Plan>)>,
    /// Images that are no files.
    pub(super) images: Images,
    pub(super) camera: Option<Camera>,
    pub(super) lights: Vec<Light>,
    pub(super) choices: Vec<String>,
    pub(super) warnings: Vec<String>,
}
