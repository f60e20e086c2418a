//! OBJ, MTL, glTF and images to a validated scene.
//!
//! `lines` cleans the text for tobj, `obj` and `mtl` read it, `plan` decides which image serves as
//! what; `gltf` does all of that for glTF. `decode` and `surfaces` make the textures, and `assemble`
//! puts the scene together. Files
//! are not trusted: every limit is a field of [`LoadOptions`], and a panic of a decoder becomes an
//! error.

mod assemble;
mod environment;
mod files;
mod given;
mod gltf;
mod images;
mod lines;
mod memory;
mod model;
mod models;
mod mtl;
mod normals;
mod obj;
mod options;
mod plan;
mod stage;
mod surfaces;

pub use assemble::{Loaded, load, load_reporting};
pub use environment::environment;
pub use gltf::is_gltf;
#[doc(hidden)]
pub use memory::{load_gltf_bytes, load_image_bytes, load_mtl_bytes, load_obj_bytes};
pub use options::{HeightSense, LoadOptions, MaterialOptions, NormalY};
pub use stage::LoadStage;
