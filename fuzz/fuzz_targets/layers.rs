//! Fuzzes [`basrelief_fuzz::layers`].

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| basrelief_fuzz::layers(bytes));
