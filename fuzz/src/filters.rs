//! A small texture, a pixel and settings: what holds of every filter.

use crate::input::Input;
use crate::{check, hold};
use basrelief::invariants::{
    anisotropy_limit_only_limits, ellipse_is_bounded, flat_relief_hides_nothing, horizon_weights, linear_in_texture,
    march_finds_first_hit, mirrored, records_are_visible, same_for_same_ellipse, same_when_scaled, shifted, turned,
    within_texels, work_is_bounded,
};
use basrelief::{Filter, Settings, invariants};

/// Any derivatives: the ellipse is finite and bounded, the colour finite and within the texels.
pub fn footprint_ellipse(bytes: &[u8]) {
    check(bytes, |input: Input| {
        let (surface, pixel, settings) = (input.surface(), input.pixel(), input.settings());
        let texels_per_repeat = surface.texels_per_repeat(0);
        hold(ellipse_is_bounded(&pixel, texels_per_repeat, settings.max_anisotropy));
        hold(anisotropy_limit_only_limits(&surface, &pixel, &settings));
        hold(within_texels(&surface, &pixel, &settings));
    });
}

/// The paper's sets of texels: T, `T_vis`, two-ended rows, trace and resolve.
pub fn visible_sets(bytes: &[u8]) {
    check(bytes, |input: Input| {
        hold(invariants::visible_sets(&input.surface(), &input.pixel(), &input.settings()));
    });
}

/// The floating horizon: weights that add up, colours within the texels, records where rays are
/// free.
pub fn horizon(bytes: &[u8]) {
    check(bytes, |input: Input| {
        let (surface, pixel) = (input.surface(), input.pixel());
        let settings = Settings { filter: Filter::Horizon, ..input.settings() };
        hold(within_texels(&surface, &pixel, &settings));
        hold(records_are_visible(&surface, &pixel, &settings));
        hold(horizon_weights(&input.maps(), &pixel, &settings));
    });
}

/// The march finds the first hit that a dense march finds.
pub fn march(bytes: &[u8]) {
    check(bytes, |input: Input| hold(march_finds_first_hit(&input.surface(), &input.pixel())));
}

/// What a mean of texels keeps: linear in the texture, the same for the same ellipse, untouched by
/// flat relief, by shifts, turns and mirrors, and bounded work.
pub fn symmetry(bytes: &[u8]) {
    check(bytes, |(input, height, by): (Input, u16, [u8; 2])| {
        let (maps, surface) = (input.maps(), input.surface());
        let (pixel, settings) = (input.pixel(), input.settings());
        hold(same_for_same_ellipse(&surface, &pixel, &settings));
        hold(flat_relief_hides_nothing(&maps, height, &pixel, &settings));
        hold(work_is_bounded(&surface, &pixel, &settings));
        hold(linear_in_texture(&maps, &input.inverted(), &pixel, &settings));
        // Rounding decides which texels on the edge of an ellipse count, with a weight of exp(-2)
        // of the middle's; which of two equal heights hides the other may change a pixel by more.
        let (maps, pixel) = (input.even_maps(), input.near_pixel());
        let near = Settings { texel_budget: 0, lines: 64, ..settings };
        if matches!(near.filter, Filter::Bilinear | Filter::Ewa) {
            let tolerance = if near.filter == Filter::Bilinear { 2e-5 } else { 0.3 };
            hold(shifted(&maps, &pixel, &near, by.map(u32::from), tolerance));
            hold(turned(&maps, &pixel, &near, tolerance));
            hold(mirrored(&maps, &pixel, &near, tolerance));
        }
        hold(same_when_scaled(&maps, &pixel, &near, 0.3));
    });
}
