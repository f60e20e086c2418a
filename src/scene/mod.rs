//! What is drawn: meshes, materials, a camera and lights. Plain data; the renderer checks it once,
//! at its border.

pub(crate) mod angle;
mod builtin;
mod camera;
mod cut_out;
mod light;
mod material;
mod mesh;
mod sky;
mod whole;

pub use builtin::builtin;
pub use camera::{Camera, Eye, Intrinsics, PoseAxes};
pub use cut_out::CutOut;
pub use light::Light;
pub use material::{Finish, Material, MaterialMaps};
pub use mesh::Mesh;
pub(crate) use mesh::{MAX_POSITION, MAX_REPEATS};
pub use sky::{Environment, Sky};
pub use whole::Scene;
