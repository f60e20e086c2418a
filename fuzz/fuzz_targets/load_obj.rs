//! Any bytes as an OBJ file: a valid scene or an error of one line.
#![no_main]

use basrelief::load::{LoadOptions, load_obj_bytes};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    match load_obj_bytes(bytes, &LoadOptions::default()) {
        Ok(loaded) => loaded.scene.validate().expect("a loaded scene is valid"),
        Err(error) => assert!(!error.to_string().contains('\n'), "more than one line: {error}"),
    }
});
