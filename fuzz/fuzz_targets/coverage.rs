//! Fuzzes [`basrelief_fuzz::coverage`].

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| basrelief_fuzz::coverage(bytes));
