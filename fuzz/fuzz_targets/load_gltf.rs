//! Fuzzes [`basrelief_fuzz::load_gltf`].

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| basrelief_fuzz::load_gltf(bytes));
