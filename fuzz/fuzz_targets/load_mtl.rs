//! Any bytes as an MTL file: materials or an error of one line.
#![no_main]

use basrelief::load::load_mtl_bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Err(error) = load_mtl_bytes(bytes) {
        assert!(!error.to_string().contains('\n'), "more than one line: {error}");
    }
});
