//! Any bytes as an image: maps or an error of one line. A decoder's panic must not get out.
#![no_main]

use basrelief::load::load_image_bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Err(error) = load_image_bytes(bytes) {
        assert!(!error.to_string().contains('\n'), "more than one line: {error}");
    }
});
