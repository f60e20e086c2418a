//! The floating horizon: weights that add up, colours within the texels, records where rays are free.
#![no_main]

use basrelief::invariants::{horizon_weights, records_are_visible, within_texels};
use basrelief::{Filter, Settings};
use basrelief_fuzz::{Input, hold};

libfuzzer_sys::fuzz_target!(|input: Input| {
    let (surface, pixel) = (input.surface(), input.pixel());
    let settings = Settings { filter: Filter::Horizon, ..input.settings() };
    hold(within_texels(&surface, &pixel, &settings));
    hold(records_are_visible(&surface, &pixel, &settings));
    hold(horizon_weights(&input.maps(), &pixel, &settings));
});
