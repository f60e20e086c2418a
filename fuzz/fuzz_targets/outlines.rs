//! Fuzzes [`basrelief_fuzz::outlines`].

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| basrelief_fuzz::outlines(bytes));
