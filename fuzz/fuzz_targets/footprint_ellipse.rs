//! Any derivatives: the ellipse is finite and bounded, the colour finite and within the texels.
#![no_main]

use basrelief::invariants::{anisotropy_limit_only_limits, ellipse_is_bounded, within_texels};
use basrelief_fuzz::{Input, hold};

libfuzzer_sys::fuzz_target!(|input: Input| {
    let (surface, pixel, settings) = (input.surface(), input.pixel(), input.settings());
    hold(ellipse_is_bounded(&pixel, surface.texels_per_repeat(0), settings.max_anisotropy));
    hold(anisotropy_limit_only_limits(&surface, &pixel, &settings));
    hold(within_texels(&surface, &pixel, &settings));
});
