//! The march finds the first hit that a dense march finds.
#![no_main]

use basrelief::invariants::march_finds_first_hit;
use basrelief_fuzz::{Input, hold};

libfuzzer_sys::fuzz_target!(|input: Input| {
    hold(march_finds_first_hit(&input.surface(), &input.pixel()));
});
