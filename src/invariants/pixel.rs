//! A pixel in texture space, and what must hold of its ellipse and colour.

use super::{Checked, ensure};
use crate::filter::{self, Differences, Ellipse, Footprint, RECONSTRUCTION, TexelSet, ewa, horizon, isotropic};
use crate::relief::{MAX_SLOPE, finite};
use crate::settings::{Filter, Formulas, Settings};
use crate::simd::PixelLanes;
use crate::texture::{FULL, Surface};

/// How far a mean may lie outside its texels: sums of thousands of weights in f32, divided.
const ROUNDING: f64 = 4e-6;

/// A pixel as a filter sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// Where it lies in the texture and how far it reaches, in repeats.
    pub footprint: Footprint,
    /// How far its view ray moves along the texture down to the deepest relief, in repeats.
    pub displacement: [f32; 2],
}

impl Pixel {
    /// A pixel from any numbers, made finite and bounded as the renderer does: place and displacement in repeats, `dx` and
    /// `dy` the derivatives of the texture coordinates in repeats a pixel.
    #[must_use]
    pub fn new(center: [f32; 2], dx: [f32; 2], dy: [f32; 2], displacement: [f32; 2]) -> Self {
        let [center, dx, dy, displacement] = [center, dx, dy, displacement].map(|v| v.map(PixelLanes::splat));
        let differences = Differences { dx, dy };
        let bounded = |d: PixelLanes| finite(d).to_array()[0].clamp(-MAX_SLOPE, MAX_SLOPE);
        Self { footprint: differences.footprint(&center, 0), displacement: displacement.map(bounded) }
    }
}

/// The pixel's ellipse, its centre and the displacement in texels of the base level.
pub(super) fn on_base_level(surface: &Surface, pixel: &Pixel, settings: &Settings) -> (Ellipse, [[f32; 2]; 2]) {
    let texels = surface.texels_per_repeat(0);
    let ellipse = Ellipse::new(&pixel.footprint, texels, Formulas::Meant);
    let scaled = [pixel.footprint.center, pixel.displacement].map(|p| [p[0] * texels[0], p[1] * texels[1]]);
    (ellipse.widened(settings.max_anisotropy, Formulas::Meant), scaled)
}

/// The pixel's colour by the filter of the settings, in near field; 1 is the surface's `color_scale`. The filters that know no footprint take the texels at its
/// centre; `Parallax` and `Truth`, which are means over the screen, count as `Bilinear`.
#[must_use]
pub fn filtered(surface: &Surface, pixel: &Pixel, settings: &Settings) -> [f32; 3] {
    let Pixel { footprint, displacement } = pixel;
    let mean = match settings.filter {
        Filter::Nearest => isotropic::nearest(surface, footprint.center),
        Filter::Trilinear => {
            isotropic::trilinear(surface, footprint.center, isotropic::longest_side(surface, footprint))
        }
        Filter::Ewa => ewa::shown(surface, footprint, settings),
        Filter::Visible => {
            filter::ellipse_mean(surface, footprint, Some(*displacement), settings, &mut TexelSet::default()).0
        }
        Filter::Horizon => horizon::visible_mean(surface, footprint, *displacement, settings, None).0,
        Filter::Bilinear | Filter::Parallax | Filter::Truth => isotropic::bilinear(surface, 0, footprint.center),
    };
    mean.color.map(|c| c / FULL as f32)
}

/// The ellipse of any derivatives is finite, its axes are above 0 and within the bounds, and no longer than the footprint
/// and the reconstruction kernel together make them.
///
/// # Errors
/// Says what broke.
pub fn ellipse_is_bounded(pixel: &Pixel, texels: [f32; 2], max_anisotropy: f32) -> Checked {
    let Footprint { dx, dy, .. } = pixel.footprint;
    let ellipse = Ellipse::new(&pixel.footprint, texels, Formulas::Meant).widened(max_anisotropy, Formulas::Meant);
    let Ellipse { a, b, c, f } = ellipse;
    let [short, long] = ellipse.squared_axes();
    ensure([a, b, c, f, short, long].iter().all(|x| x.is_finite()), || format!("not finite: {ellipse:?}"))?;
    ensure(a > 0.0 && c > 0.0 && f > 0.0 && long > 0.0, || format!("no area: {ellipse:?}"))?;
    ensure(ellipse.area() > 0.0 && ellipse.half_height() > 0.0, || format!("no extent: {ellipse:?}"))?;
    // The longer axis is at most the root of the sum of all squares.
    let sum = [dx, dy].iter().map(|[u, v]| (u * texels[0]).powi(2) + (v * texels[1]).powi(2)).sum::<f32>();
    ensure(long <= (sum + 2.0 * RECONSTRUCTION) * 1.001, || {
        format!("{long} is longer than the footprint: {ellipse:?}")
    })?;
    // Where the axes are further apart than f32 tells, the shorter is known from F alone.
    let ratio = long / (f / long).sqrt().max(f32::MIN_POSITIVE) / long.sqrt();
    ensure(ratio <= max_anisotropy * 1.001, || format!("anisotropy {ratio} above {max_anisotropy}: {ellipse:?}"))
}

/// The colour is finite and lies within the least and greatest texel, up to 4e-6 of the range for rounding: so a constant
/// texture gives its constant.
///
/// # Errors
/// Says what broke.
pub fn within_texels(surface: &Surface, pixel: &Pixel, settings: &Settings) -> Checked {
    let base = &surface.levels[0];
    let (mut least, mut most) = ([f64::INFINITY; 3], [0.0_f64; 3]);
    for (x, y) in (0..base.height as i32).flat_map(|y| (0..base.width as i32).map(move |x| (x, y))) {
        let color = crate::reference::color(base, [x, y]);
        (0..3).for_each(|i| (least[i], most[i]) = (least[i].min(color[i]), most[i].max(color[i])));
    }
    let color = filtered(surface, pixel, settings);
    let is_within = |i: usize| {
        let c = f64::from(color[i]);
        c >= least[i] - ROUNDING && c <= most[i] + ROUNDING
    };
    ensure((0..3).all(is_within), || format!("{color:?} is not within {least:?} to {most:?}"))
}

/// A limit of the anisotropy above what the footprint has changes nothing, to the bit.
///
/// # Errors
/// Says what broke.
pub fn anisotropy_limit_only_limits(surface: &Surface, pixel: &Pixel, settings: &Settings) -> Checked {
    let limit = settings.max_anisotropy;
    let is_below = (0..surface.levels.len()).all(|level| {
        let texels = surface.texels_per_repeat(level);
        let [short, long] = Ellipse::new(&pixel.footprint, texels, Formulas::Meant).squared_axes();
        long < 0.99 * limit * limit * short
    });
    let with = |max_anisotropy| filtered(surface, pixel, &Settings { max_anisotropy, ..settings.clone() });
    let (a, b) = (with(limit), with((limit * 64.0).min(1e6)));
    ensure(!is_below || a == b, || format!("{a:?} with {limit}, {b:?} with a higher limit"))
}

/// The work of one pixel is bounded, whatever its footprint: `Visible` tests at most the texel budget's texels, or a million
/// where it is 0, up to an edge's, and takes no more than it tested; `Ewa` reads at most those of the rows of equal length
/// that hold as many. The coarsest level is one texel.
///
/// # Errors
/// Says what broke.
pub fn work_is_bounded(surface: &Surface, pixel: &Pixel, settings: &Settings) -> Checked {
    let Pixel { footprint, displacement } = pixel;
    let most = if settings.texel_budget == 0 { filter::MAX_TEXELS as u64 } else { u64::from(settings.texel_budget) };
    let (index, ellipse) = filter::level_within_budget(surface, footprint, settings);
    for hidden_by in [None, Some(*displacement)] {
        let (_, [tested, taken]) =
            filter::ellipse_mean(surface, footprint, hidden_by, settings, &mut TexelSet::default());
        // Texel centres in an ellipse are as many as its area holds, give or take those of its edge.
        let edge = (8.0 * ellipse.squared_axes()[1].sqrt()) as u64 + 8;
        let is_coarsest = index + 1 == surface.levels.len();
        ensure(taken <= tested && (is_coarsest || tested <= most + edge), || {
            format!("{tested} texels tested, {taken} taken, of a budget of {most} at level {index}")
        })?;
    }
    // An ellipse cut at 1.5 has 2.25 times the area, rows of equal length hold 4 / pi of it, vectors end on both sides.
    let (_, read) = ewa::mean(surface, footprint, settings, true);
    let edge = 40 * (ellipse.squared_axes()[1].sqrt() as u64 + 8);
    ensure(index + 1 == surface.levels.len() || read <= 3 * most + edge, || format!("{read} texels read of {most}"))
}
