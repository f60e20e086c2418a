//! Eight pixels in the texture, and one.
//!
//! ```text
//!      eye
//!        \          base: where the view ray meets the polygon
//!  -------*------------------------------- polygon
//!          \  displacement ->|             D: from there along the texture down to the deepest relief
//!        ___*___      ___    |             hit: where the ray meets the relief, base + t D
//!  _____/       \____/   \___*________     deepest relief
//! ```

use super::differences::differences;
use super::rule::FootprintRule;
use crate::relief::{
    HeightField, MAX_SLOPE, ViewRays, bent, displacement, finite, march, march_all,
};
use crate::settings::Derivatives;
use crate::simd::{PixelLanes, set_bits};

/// Longest derivative that is kept, in texture repeats a pixel: a footprint of that length holds
/// the mean of all texels as well as a longer one does.
const MAX_LENGTH: f32 = 16.0;

/// Farthest place that is kept, in repeats: beyond, an f32 tells fewer than ten places a repeat
/// apart.
const FARTHEST: f32 = 1e6;

/// Vectors of pixels whose rays are marched together: so many that what is left to the last of them
/// is little.
const MARCHED_AT_ONCE: usize = 64;

/// A value along u and a value along v for each pixel, in texture repeats.
type Uv = [PixelLanes; 2];

/// Eight pixels in the texture: those of two 2x2 quads, lane `4 * quad + 2 * dy + dx`. All in
/// texture repeats, finite and bounded, so that filters need not check.
#[derive(Clone, Copy, Debug)]
pub struct Footprints {
    /// Where the view rays meet the polygon.
    pub base: Uv,
    /// Where they first meet the relief; the base place where no relief is traced.
    pub hit: Uv,
    /// `(du/dx, dv/dx)` a pixel.
    pub dx: Uv,
    /// `(du/dy, dv/dy)` a pixel.
    pub dy: Uv,
    /// How far the view rays move along the texture down to the deepest relief.
    pub displacement: Uv,
    /// A bit for each pixel that is to be filtered; the others are helper lanes.
    pub covered: u8,
}

/// One pixel in the texture, in texture repeats: a lane of [`Footprints`], and what a renderer with
/// derivatives of its own fills in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// Where the view ray meets the polygon, `(u, v)`.
    pub base: [f32; 2],
    /// Where it first meets the relief; filters that look for visible texels by themselves do not
    /// ask for it.
    pub hit: [f32; 2],
    /// `(du/dx, dv/dx)` a pixel.
    pub dx: [f32; 2],
    /// `(du/dy, dv/dy)` a pixel.
    pub dy: [f32; 2],
    /// How far the view ray moves along the texture down to the deepest relief.
    pub displacement: [f32; 2],
}

impl Footprints {
    /// The pixels of two quads with the texture coordinates `uv` and view rays `view` (see
    /// [`displacement`]), over the relief of `field` or over the bare polygon, by the rule of a
    /// filter.
    #[inline(always)]
    pub fn of_quads(
        uv: &Uv,
        view: &[PixelLanes; 3],
        field: Option<&HeightField>,
        rule: &FootprintRule,
        covered: u8,
    ) -> Self {
        if field.is_none() {
            // Nothing is moved: the hit is the base place, which is bounded once for both.
            let zero = [PixelLanes::ZERO; 2];
            let [dx, dy] = differences(uv, &zero, rule);
            return Self { base: *uv, hit: *uv, dx, dy, displacement: zero, covered }.bounded();
        }
        let (displacement, offset) = traced(uv, view, field, rule.is_traced);
        Self::with_offset(uv, displacement, &offset, rule, covered)
    }

    /// The pixels of two quads over the relief of `field`, the hits of whose view rays are left to
    /// [`Self::find_hits`].
    #[inline(always)]
    pub fn before_hits(uv: &Uv, view: &[PixelLanes; 3], field: &HeightField, covered: u8) -> Self {
        let none = [PixelLanes::ZERO; 2];
        let displacement = displacement(view, field.relief_depth);
        Self { base: *uv, hit: none, dx: none, dy: none, displacement, covered }
    }

    /// The pixels, before their hits, over a surface that is curved: see [`bent`] for `bend`.
    pub fn bent(self, view: &[PixelLanes; 3], bend: &[Uv; 3], field: &HeightField) -> Self {
        let displacement = bent(view, bend, field.relief_depth);
        Self { displacement, ..self }
    }

    /// Makes pixels [before their hits](Self::before_hits) what [`Self::of_quads`] makes: the more
    /// at once, the faster.
    pub fn find_hits(pixels: &mut [Self], field: &HeightField, rule: &FootprintRule) {
        for pixels in pixels.chunks_mut(MARCHED_AT_ONCE) {
            let mut depths = [PixelLanes::ZERO; MARCHED_AT_ONCE];
            let depths = &mut depths[..pixels.len()];
            // Only formula (3) asks where the rays of helper lanes go.
            let is_for_all = rule.derivatives == Derivatives::Relief;
            let rays = pixels.iter().map(|pixels| ViewRays {
                base: pixels.base,
                displacement: pixels.displacement,
                wanted: if is_for_all { u8::MAX } else { pixels.covered },
            });
            march_all(field, rays, depths);
            for (pixels, depth) in pixels.iter_mut().zip(depths) {
                let Self { base, displacement, covered, .. } = *pixels;
                let offset = [displacement[0] * *depth, displacement[1] * *depth];
                *pixels = Self::with_offset(&base, displacement, &offset, rule, covered);
            }
        }
    }

    /// The pixels of two quads, each moved by the relief's offset.
    #[inline(always)]
    fn with_offset(
        uv: &Uv,
        displacement: Uv,
        offset: &Uv,
        rule: &FootprintRule,
        covered: u8,
    ) -> Self {
        let [dx, dy] = differences(uv, offset, rule);
        let hit = [uv[0] + offset[0], uv[1] + offset[1]];
        Self { base: *uv, hit, dx, dy, displacement, covered }.bounded()
    }

    /// Up to eight pixels, all filtered. Any numbers are made finite and bounded.
    pub fn pack(pixels: &[Footprint]) -> Self {
        let lanes = |of: &dyn Fn(&Footprint) -> [f32; 2]| {
            [0, 1].map(|axis| {
                PixelLanes::new(std::array::from_fn(|lane| {
                    pixels.get(lane).map_or(0.0, |p| of(p)[axis])
                }))
            })
        };
        let [base, hit] = [lanes(&|p| p.base), lanes(&|p| p.hit)];
        let [dx, dy, displacement] =
            [lanes(&|p| p.dx), lanes(&|p| p.dy), lanes(&|p| p.displacement)];
        // Lanes without a pixel are 0, and nobody asks for them.
        let covered = if pixels.len() < 8 { (1 << pixels.len()) - 1 } else { u8::MAX };
        Self { base, hit, dx, dy, displacement, covered }.made_finite()
    }

    /// Samples of one pixel: rays of their own through `uv` along `view`, with the pixel's
    /// derivatives. `covered` has a bit for each ray that meets the surface; those whose hit is no
    /// place are left out.
    pub fn of_samples(
        (uv, view): (&Uv, &[PixelLanes; 3]),
        field: Option<&HeightField>,
        is_traced: bool,
        pixel: &Footprint,
        covered: u8,
    ) -> Self {
        let (displacement, offset) = traced(uv, view, field, is_traced);
        let hit = [uv[0] + offset[0], uv[1] + offset[1]];
        let is_place = hit.map(|c| c.abs().simd_lt(PixelLanes::splat(FARTHEST)));
        let covered = covered & (is_place[0] & is_place[1]).to_bitmask() as u8;
        // A ray alone has no neighbours to take differences from: the pixel's serve all.
        let [dx, dy] = [pixel.dx, pixel.dy].map(|derivative| derivative.map(PixelLanes::splat));
        Self { base: *uv, hit, dx, dy, displacement, covered }.bounded()
    }

    /// Samples of one pixel whose rays meet the relief at known places, with the pixel's
    /// derivatives.
    pub fn of_hits(hit: Uv, pixel: &Footprint, covered: u8) -> Self {
        let [dx, dy] = [pixel.dx, pixel.dy].map(|derivative| derivative.map(PixelLanes::splat));
        let displacement = [PixelLanes::ZERO; 2];
        Self { base: hit, hit, dx, dy, displacement, covered }.bounded()
    }

    /// One pixel in all lanes, of which the first is filtered. Any numbers are made finite and
    /// bounded.
    pub fn splat(footprint: &Footprint) -> Self {
        let Footprint { base, hit, dx, dy, displacement } = *footprint;
        let [base, hit, dx, dy, displacement] =
            [base, hit, dx, dy, displacement].map(|pair| pair.map(PixelLanes::splat));
        Self { base, hit, dx, dy, displacement, covered: 1 }.made_finite()
    }

    /// One of the pixels.
    pub fn lane(&self, lane: usize) -> Footprint {
        let at = |lanes: &Uv| lanes.map(|lanes| lanes.as_array()[lane]);
        Footprint {
            base: at(&self.base),
            hit: at(&self.hit),
            dx: at(&self.dx),
            dy: at(&self.dy),
            displacement: at(&self.displacement),
        }
    }

    /// The lanes that are filtered, in order.
    #[inline(always)]
    pub fn covered(&self) -> impl Iterator<Item = usize> + use<> {
        set_bits(self.covered)
    }

    /// [`Self::bounded`] for displacements of any numbers, too: those of a relief are bounded
    /// already.
    fn made_finite(self) -> Self {
        let most = PixelLanes::splat(MAX_SLOPE);
        let displacement = self.displacement.map(|d| finite(d).fast_max(-most).fast_min(most));
        Self { displacement, ..self }.bounded()
    }

    /// Places beyond 1e6 repeats become 0, derivatives are shortened to 16 repeats, and what is not
    /// a number becomes 0.
    #[inline(always)]
    fn bounded(self) -> Self {
        let is_short = |c: PixelLanes| c.abs().simd_le(PixelLanes::splat(MAX_LENGTH));
        let Self { dx, dy, .. } = self;
        // Long derivatives are rare: their division stays out of the common path.
        let all_short =
            (is_short(dx[0]) & is_short(dx[1]) & is_short(dy[0]) & is_short(dy[1])).all();
        let [dx, dy] =
            if all_short { [dx, dy] } else { [dx, dy].map(|d| in_registers(shortened(d))) };
        Self { base: bounded_place(self.base), hit: bounded_place(self.hit), dx, dy, ..self }
    }
}

impl Footprint {
    /// A pixel around `base` with derivatives `dx` and `dy`, seen along `displacement`; the hit is
    /// the base place.
    pub fn new(base: [f32; 2], dx: [f32; 2], dy: [f32; 2], displacement: [f32; 2]) -> Self {
        Self { base, hit: base, dx, dy, displacement }
    }

    /// The pixel made finite and bounded, as filters do with any numbers, NaN and infinity
    /// included.
    pub fn bounded(self) -> Self {
        Footprints::splat(&self).lane(0)
    }
}

/// The displacements of view rays, and how far each moves to where it first meets the relief, if
/// that is looked for.
#[inline(always)]
fn traced(
    uv: &Uv,
    view: &[PixelLanes; 3],
    field: Option<&HeightField>,
    is_traced: bool,
) -> (Uv, Uv) {
    let Some(field) = field else { return ([PixelLanes::ZERO; 2], [PixelLanes::ZERO; 2]) };
    let displacement = displacement(view, field.relief_depth);
    // The march is the dear part: filters that never ask for the hit go without.
    if !is_traced {
        return (displacement, [PixelLanes::ZERO; 2]);
    }
    let depth = march(field, uv, &displacement);
    (displacement, displacement.map(|displacement| displacement * depth))
}

/// The result of a call, which lies in memory, taken apart: where two ways meet, the other one then
/// keeps its vectors in registers.
#[inline(always)]
fn in_registers<T: Copy>([a, b]: [T; 2]) -> [T; 2] {
    [a, b]
}

/// Places, with 0 for a coordinate that is not within 1e6 repeats.
#[inline(always)]
fn bounded_place([u, v]: Uv) -> Uv {
    let bounded =
        |c: PixelLanes| c.abs().simd_le(PixelLanes::splat(FARTHEST)).select(c, PixelLanes::ZERO);
    [bounded(u), bounded(v)]
}

/// A derivative, shortened where it is longer than 16 repeats, and 0 for what is not a number.
#[cold]
#[inline(never)]
fn shortened(derivative: Uv) -> Uv {
    let [u, v] = derivative.map(finite);
    // Scale both parts alike, so that the direction stays.
    let longest = u.abs().fast_max(v.abs());
    let is_long = longest.simd_gt(PixelLanes::splat(MAX_LENGTH));
    let scale = is_long.select(PixelLanes::splat(MAX_LENGTH) / longest, PixelLanes::ONE);
    [u * scale, v * scale]
}
