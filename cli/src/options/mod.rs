//! The command line: options of each subcommand, and the values, files and names that stand for
//! them.

pub(crate) mod args;
pub(crate) mod bench;
pub(crate) mod choices;
pub(crate) mod compare;
pub(crate) mod filter;
pub(crate) mod frames;
pub(crate) mod inspect;
pub(crate) mod join;
pub(crate) mod layers;
pub(crate) mod render;
pub(crate) mod scene;
pub(crate) mod scene_file;
pub(crate) mod settings;
pub(crate) mod study;
pub(crate) mod threads;
#[cfg(feature = "viewer")]
pub(crate) mod viewer;

mod camera;
mod camera_list;
mod camera_path;
mod file_values;
mod shard;
mod values;
mod version;
