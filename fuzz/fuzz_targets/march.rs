//! Fuzzes [`basrelief_fuzz::march`].

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| basrelief_fuzz::march(bytes));
