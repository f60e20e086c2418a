//! Fuzzes [`basrelief_fuzz::parallax`].

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| basrelief_fuzz::parallax(bytes));
