//! What a mean of texels keeps: linear in the texture, the same for the same ellipse, untouched by flat relief, by shifts,
//! turns and mirrors, and bounded work.
#![no_main]

use basrelief::invariants::{
    flat_relief_hides_nothing, linear_in_texture, mirrored, same_for_same_ellipse, same_when_scaled, shifted, turned,
    work_is_bounded,
};
use basrelief::{Filter, Settings};
use basrelief_fuzz::{Input, hold};

libfuzzer_sys::fuzz_target!(|input: (Input, u16, [u8; 2])| {
    let (input, height, by) = input;
    let (maps, surface, pixel, settings) = (input.maps(), input.surface(), input.pixel(), input.settings());
    hold(same_for_same_ellipse(&surface, &pixel, &settings));
    hold(flat_relief_hides_nothing(&maps, height, &pixel, &settings));
    hold(work_is_bounded(&surface, &pixel, &settings));
    hold(linear_in_texture(&maps, &input.inverted(), &pixel, &settings));
    // Rounding decides which texels on the edge of an ellipse count, with a weight of exp(-2) of the middle's; which of two
    // equal heights hides the other may change a pixel by more.
    let (maps, pixel, near) =
        (input.even_maps(), input.near_pixel(), Settings { texel_budget: 0, lines: 64, ..settings });
    if matches!(near.filter, Filter::Bilinear | Filter::Ewa) {
        let tolerance = if near.filter == Filter::Bilinear { 2e-5 } else { 0.3 };
        hold(shifted(&maps, &pixel, &near, by.map(u32::from), tolerance));
        hold(turned(&maps, &pixel, &near, tolerance));
        hold(mirrored(&maps, &pixel, &near, tolerance));
    }
    hold(same_when_scaled(&maps, &pixel, &near, 0.3));
});
