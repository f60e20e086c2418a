//! Fuzzes [`basrelief_fuzz::render`].

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| basrelief_fuzz::render(bytes));
