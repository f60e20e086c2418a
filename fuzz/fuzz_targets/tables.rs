//! Fuzzes [`basrelief_fuzz::tables`].

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| basrelief_fuzz::tables(bytes));
