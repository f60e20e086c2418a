//! Any bytes as a file.

use basrelief::Error;
use basrelief::load::{
    LoadOptions, load_gltf_bytes, load_image_bytes, load_mtl_bytes, load_obj_bytes,
};

/// Any bytes as an OBJ file: a valid scene or an error of one line.
pub fn load_obj(bytes: &[u8]) {
    match load_obj_bytes(bytes, &LoadOptions::default()) {
        Ok(loaded) => loaded.scene.validate().expect("a loaded scene is valid"),
        Err(error) => is_one_line(&error),
    }
}

/// Any bytes as a glTF or GLB file: a valid scene or an error of one line. The number of bytes
/// says whether normal maps are read.
pub fn load_gltf(bytes: &[u8]) {
    let options = LoadOptions {
        keep_normals: bytes.len() % 4 != 1,
        max_image_side: 256,
        max_image_mib: 16,
        max_triangles: 100_000,
        ..LoadOptions::default()
    };
    match load_gltf_bytes(bytes, &options) {
        Ok(loaded) => loaded.scene.validate().expect("a loaded scene is valid"),
        Err(error) => is_one_line(&error),
    }
}

/// Any bytes as an MTL file: materials or an error of one line.
pub fn load_mtl(bytes: &[u8]) {
    if let Err(error) = load_mtl_bytes(bytes) {
        is_one_line(&error);
    }
}

/// Any bytes as an image: maps or an error of one line. A decoder's panic must not get out.
pub fn load_image(bytes: &[u8]) {
    if let Err(error) = load_image_bytes(bytes) {
        is_one_line(&error);
    }
}

fn is_one_line(error: &Error) {
    assert!(!error.to_string().contains('\n'), "more than one line: {error}");
}
