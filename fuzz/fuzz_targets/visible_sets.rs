//! Fuzzes [`basrelief_fuzz::visible_sets`].

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| basrelief_fuzz::visible_sets(bytes));
