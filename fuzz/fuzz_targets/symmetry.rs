//! Fuzzes [`basrelief_fuzz::symmetry`].

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| basrelief_fuzz::symmetry(bytes));
