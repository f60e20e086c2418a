//! What the fuzz targets check, each a function of any bytes; a panic is a finding.
//!
//! The programs in `fuzz_targets` call these functions for the fuzzer, and the test `replay` calls
//! them without it.
#![forbid(unsafe_code)]

mod filters;
mod frames;
mod input;
mod loaders;

pub use filters::{footprint_ellipse, horizon, march, parallax, symmetry, tables, visible_sets};
pub use frames::{command_line, coverage, layers, outlines, render};
pub use loaders::{load_gltf, load_image, load_mtl, load_obj};

use arbitrary::{Arbitrary, Unstructured};

/// Reads an input from bytes and checks it; bytes that are too few are no input.
fn check<'a, T: Arbitrary<'a>>(bytes: &'a [u8], check: impl FnOnce(T)) {
    if bytes.len() >= T::size_hint(0).0
        && let Ok(input) = T::arbitrary_take_rest(Unstructured::new(bytes))
    {
        check(input);
    }
}

/// Fails the run with what an invariant says.
fn hold(checked: Result<(), String>) {
    if let Err(reason) = checked {
        panic!("{reason}");
    }
}
