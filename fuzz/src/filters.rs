//! A small texture, a pixel and a filter: what holds of every filter.

use crate::input::Input;
use crate::{check, hold};
use basrelief::invariants::{
    Footprint, anisotropy_limit_only_limits, ellipse_is_bounded, flat_relief_hides_nothing,
    flat_tables_give_the_mean, horizon_weights, linear_in_texture, march_finds_first_hit, mirrored,
    records_are_visible, same_for_same_ellipse, same_when_scaled, shifted,
    steps_find_the_references_hit, tables_give_texels_in_any_order, turned, within_texels,
    work_is_bounded,
};
use basrelief::texture::Surface;
use basrelief::{Ewa, Filter, Horizon, invariants};

/// Any derivatives: the ellipse is finite and bounded, the colour finite and within the texels.
pub fn footprint_ellipse(bytes: &[u8]) {
    check(bytes, |input: Input| {
        let (surface, pixel, limit) = (input.surface(), input.pixel(), input.max_anisotropy());
        hold(ellipse_is_bounded(&pixel, surface.base().texels_per_repeat(), limit));
        hold(anisotropy_limit_only_limits(&surface, &pixel, limit, |limit| {
            input.filter_limited(limit)
        }));
        hold(within_texels(&surface, &pixel, &input.filter()));
    });
}

/// The paper's sets of texels: T, `T_vis`, two-ended rows, trace and resolve.
pub fn visible_sets(bytes: &[u8]) {
    check(bytes, |input: Input| {
        hold(invariants::visible_sets(&input.surface(), &input.pixel(), &input.visible()));
    });
}

/// The floating horizon: weights that add up, colours within the texels, records where rays are
/// free.
pub fn horizon(bytes: &[u8]) {
    check(bytes, |input: Input| {
        let (surface, pixel, horizon) = (input.surface(), input.pixel(), input.horizon());
        hold(within_texels(&surface, &pixel, &Filter::Horizon(horizon)));
        hold(records_are_visible(&surface, &pixel, horizon.max_anisotropy));
        hold(horizon_weights(&input.maps(), &pixel, &horizon));
    });
}

/// The march finds the first hit that a dense march finds.
pub fn march(bytes: &[u8]) {
    check(bytes, |input: Input| hold(march_finds_first_hit(&input.surface(), &input.pixel())));
}

/// Common practice in lanes finds what one ray in f64 does.
pub fn parallax(bytes: &[u8]) {
    check(bytes, |(input, samples): (Input, u8)| {
        let samples = [1, 4, 64][usize::from(samples % 3)];
        hold(steps_find_the_references_hit(&input.surface(), &input.pixel(), samples));
    });
}

/// Tables of the far field: colours within the texels, the same in any order, the mean where
/// nothing hides.
pub fn tables(bytes: &[u8]) {
    check(bytes, |(input, others, height): (Input, [Input; 2], u16)| {
        let surface = |height| Surface::new(input.large_maps(height)).expect("valid maps");
        let pixels = [input.pixel(), input.far_pixel(), others[0].far_pixel(), others[1].pixel()];
        hold(tables_give_texels_in_any_order(&surface(None), &pixels, &input.horizon()));
        // Many repeats wide, whatever the view.
        let Footprint { base, displacement, .. } = input.near_pixel();
        let wide = Footprint::new(base, [2.5, 0.4], [-0.6, 2.2], displacement).bounded();
        hold(flat_tables_give_the_mean(&surface(Some(height)), &wide, &input.horizon()));
    });
}

/// What a mean of texels keeps: linear in the texture, the same for the same ellipse, untouched by
/// flat relief, by shifts, turns and mirrors, and bounded work.
pub fn symmetry(bytes: &[u8]) {
    check(bytes, |(input, height, by): (Input, u16, [u8; 2])| {
        let (maps, surface) = (input.maps(), input.surface());
        let (pixel, filter, visible) = (input.pixel(), input.filter(), input.visible());
        hold(same_for_same_ellipse(&surface, &pixel, &filter));
        hold(flat_relief_hides_nothing(&maps, height, &pixel, &visible));
        hold(work_is_bounded(&surface, &pixel, &visible, &input.ewa()));
        hold(linear_in_texture(&maps, &input.inverted(), &pixel, &filter));
        // Rounding decides which texels on the edge of an ellipse count, with a weight of exp(-2)
        // of the middle's; which of two equal heights hides the other may change a pixel by more.
        let (maps, pixel) = (input.even_maps(), input.near_pixel());
        let near = match filter {
            Filter::Bilinear => Some((filter, 2e-5)),
            Filter::Ewa(ewa) => Some((Filter::Ewa(Ewa { texel_budget: 0, ..ewa }), 0.3)),
            _ => None,
        };
        if let Some((near, tolerance)) = near {
            hold(shifted(&maps, &pixel, &near, by.map(u32::from), tolerance));
            hold(turned(&maps, &pixel, &near, tolerance));
            hold(mirrored(&maps, &pixel, &near, tolerance));
        }
        hold(same_when_scaled(&maps, &pixel, &Horizon { lines: 64, ..input.horizon() }, 0.3));
    });
}
