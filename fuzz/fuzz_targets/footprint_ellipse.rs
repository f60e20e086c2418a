//! Fuzzes [`basrelief_fuzz::footprint_ellipse`].

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| basrelief_fuzz::footprint_ellipse(bytes));
