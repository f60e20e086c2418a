//! Fuzzes [`basrelief_fuzz::horizon`].

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| basrelief_fuzz::horizon(bytes));
