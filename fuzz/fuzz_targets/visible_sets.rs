//! The paper's sets of texels: T, `T_vis`, two-ended rows, trace and resolve.
#![no_main]

use basrelief::invariants::visible_sets;
use basrelief_fuzz::{Input, hold};

libfuzzer_sys::fuzz_target!(|input: Input| {
    hold(visible_sets(&input.surface(), &input.pixel(), &input.settings()));
});
