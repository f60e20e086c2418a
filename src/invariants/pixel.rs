//! A pixel in texture space, and what must hold of its ellipse and colour.

use super::check::{Checked, ensure};
use crate::filter::visible::{self, TexelSet};
use crate::filter::{Prepared, ewa};
use crate::footprint::levels::{MAX_TEXELS, within_budget};
use crate::footprint::{Ellipse, Footprint};
use crate::settings::{Ewa, Filter, Formulas, RECONSTRUCTION, Visible};
use crate::texture::Surface;

/// How far a mean may lie outside its texels: sums of thousands of weights in f32, divided.
const ROUNDING: f64 = 4e-6;

/// The pixel's ellipse, its centre and the displacement in texels of the base level.
pub(super) fn on_base_level(
    surface: &Surface,
    pixel: &Footprint,
    max_anisotropy: f32,
) -> (Ellipse, [[f32; 2]; 2]) {
    let base = surface.base();
    let ellipse = Ellipse::new(pixel, base.texels_per_repeat(), Formulas::Meant);
    let scaled = [pixel.base, pixel.displacement].map(|p| base.in_texels(p));
    (ellipse.widened(max_anisotropy, Formulas::Meant), scaled)
}

/// The pixel's colour by a filter, in near field; 1 is the surface's colour scale.
pub fn filtered(surface: &Surface, pixel: &Footprint, filter: &Filter) -> [f32; 3] {
    let prepared = Prepared::new(surface.clone()).without_far_field();
    prepared.colors(filter, &[*pixel])[0].map(|c| c / surface.color_scale())
}

/// The ellipse of any derivatives is finite, its axes are above 0 and within the bounds, and no
/// longer than the footprint and the reconstruction kernel together make them.
///
/// # Errors
/// Says what broke.
pub fn ellipse_is_bounded(pixel: &Footprint, texels: [f32; 2], max_anisotropy: f32) -> Checked {
    let Footprint { dx, dy, .. } = *pixel;
    let ellipse =
        Ellipse::new(pixel, texels, Formulas::Meant).widened(max_anisotropy, Formulas::Meant);
    let Ellipse { a, b, c, f } = ellipse;
    let [short, long] = ellipse.squared_axes();
    ensure([a, b, c, f, short, long].iter().all(|x| x.is_finite()), || {
        format!("not finite: {ellipse:?}")
    })?;
    ensure(a > 0.0 && c > 0.0 && f > 0.0 && long > 0.0, || format!("no area: {ellipse:?}"))?;
    ensure(ellipse.area() > 0.0 && ellipse.half_height() > 0.0, || {
        format!("no extent: {ellipse:?}")
    })?;
    // The longer axis is at most the root of the sum of all squares.
    let sum = [dx, dy]
        .iter()
        .map(|[u, v]| (u * texels[0]).powi(2) + (v * texels[1]).powi(2))
        .sum::<f32>();
    ensure(long <= (sum + 2.0 * RECONSTRUCTION) * 1.001, || {
        format!("{long} is longer than the footprint: {ellipse:?}")
    })?;
    // Where the axes are further apart than f32 tells, the shorter is known from F alone.
    let ratio = long / (f / long).sqrt().max(f32::MIN_POSITIVE) / long.sqrt();
    ensure(ratio <= max_anisotropy * 1.001, || {
        format!("anisotropy {ratio} above {max_anisotropy}: {ellipse:?}")
    })
}

/// The colour is finite and lies within the least and greatest texel, up to 4e-6 of the range for
/// rounding: so a constant texture gives its constant.
///
/// # Errors
/// Says what broke.
pub fn within_texels(surface: &Surface, pixel: &Footprint, filter: &Filter) -> Checked {
    let (least, most) = texel_range(surface);
    let color = filtered(surface, pixel, filter);
    let is_within = |i: usize| {
        let c = f64::from(color[i]);
        c >= least[i] - ROUNDING && c <= most[i] + ROUNDING
    };
    ensure((0..3).all(is_within), || format!("{color:?} is not within {least:?} to {most:?}"))
}

/// The least and the greatest texel of the base level, channel by channel.
pub(super) fn texel_range(surface: &Surface) -> ([f64; 3], [f64; 3]) {
    let base = surface.base();
    let [width, height] = base.size().map(|n| n as i32);
    let (mut least, mut most) = ([f64::INFINITY; 3], [0.0_f64; 3]);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let color = crate::reference::color(base, [x, y]);
        (0..3).for_each(|i| (least[i], most[i]) = (least[i].min(color[i]), most[i].max(color[i])));
    }
    (least, most)
}

/// A limit of the anisotropy above what the footprint has changes nothing, to the bit.
///
/// # Errors
/// Says what broke.
pub fn anisotropy_limit_only_limits(
    surface: &Surface,
    pixel: &Footprint,
    limit: f32,
    filter: impl Fn(f32) -> Filter,
) -> Checked {
    let is_below = surface.levels().iter().all(|level| {
        let [short, long] =
            Ellipse::new(pixel, level.texels_per_repeat(), Formulas::Meant).squared_axes();
        long < 0.99 * limit * limit * short
    });
    let with = |limit| filtered(surface, pixel, &filter(limit));
    let (a, b) = (with(limit), with((limit * 64.0).min(1e6)));
    ensure(!is_below || a == b, || format!("{a:?} with {limit}, {b:?} with a higher limit"))
}

/// The work of one pixel is bounded, whatever its footprint: `Visible` tests at most the texel
/// budget's texels, or a million where it is 0, up to an edge's, and takes no more than it tested;
/// `Ewa` reads at most those of the rows of equal length that hold as many. The coarsest level is
/// one texel.
///
/// # Errors
/// Says what broke.
pub fn work_is_bounded(
    surface: &Surface,
    pixel: &Footprint,
    visible: &Visible,
    ewa: &Ewa,
) -> Checked {
    let most = |budget: u32| if budget == 0 { MAX_TEXELS as u64 } else { u64::from(budget) };
    let (index, ellipse) = within_budget(surface, pixel, &visible::ellipse_rule(visible));
    for displacement in [[0.0; 2], pixel.displacement] {
        let pixel = Footprint { displacement, ..*pixel };
        let (_, work) = visible::mean(surface, &pixel, visible, &mut TexelSet::default());
        let [tested, taken] = [work.num_tested, work.num_averaged];
        let most = most(visible.texel_budget);
        // Texel centres in an ellipse are as many as its area holds, give or take those of its
        // edge.
        let edge = (8.0 * ellipse.squared_axes()[1].sqrt()) as u64 + 8;
        let is_coarsest = index + 1 == surface.levels().len();
        ensure(taken <= tested && (is_coarsest || tested <= most + edge), || {
            format!("{tested} texels tested, {taken} taken, of a budget of {most} at level {index}")
        })?;
    }
    // An ellipse cut at 1.5 has 2.25 times the area, rows of equal length hold 4 / pi of it,
    // vectors end on both sides.
    let (_, read) = ewa::mean(surface, pixel, ewa, true);
    let (most, edge) = (most(ewa.texel_budget), 40 * (ellipse.squared_axes()[1].sqrt() as u64 + 8));
    ensure(index + 1 == surface.levels().len() || read <= 3 * most + edge, || {
        format!("{read} texels read of {most}")
    })
}
