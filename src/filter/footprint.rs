//! A pixel's footprint in the texture: where it is and how far it reaches, from its 2x2 quad.
//!
//! Formula (2) takes differences of the undisplaced coordinates, formula (3) of the displaced ones, with the offsets
//! (m, r) at (x, y), (n, o) at (x+1, y) and (p, s) at (x, y+1):
//!
//! ```text
//! meant    du/dx = (u(x+1,y) + n) - (u(x,y) + m)    dv/dx = (v(x+1,y) + o) - (v(x,y) + r)
//!          du/dy = (u(x,y+1) + p) - (u(x,y) + m)    dv/dy = (v(x,y+1) + s) - (v(x,y) + r)
//! printed  du/dx =  u(x+1,y) + n  -  u(x,y) + m     dv/dx =  v(x+1,y) + o  -  u(x,y) + m
//!          du/dy =  u(x,y+1) + p  -  v(x,y) + r     dv/dy =  v(x,y+1) + s  -  v(x,y) + r
//! (2) printed          u(x+1,y) - u(x,y)                    v(x+1,y) - u(x,y)
//!                      u(x,y+1) - u(x,y)                    v(x,y+1) - u(x,y)
//! ```
//!
//! The x-difference is taken in the pixel's row of the quad and the y-difference in its column.
//!
//! Where the neighbour's ray passes an outline of the relief and hits another part of it, formula (3) is the way from one
//! part to the other, and says nothing of the surface at the hit. The paper does not speak of this. [`differences_for`] the
//! filter `Visible` therefore takes formula (2) for a difference that (3) makes many times longer.

use crate::relief::finite;
use crate::settings::{Derivatives, Filter, Formulas, Settings};
use crate::simd::{PixelLanes, permute};

/// Longest derivative that is kept, in texture repeats a pixel: a footprint of that length holds the mean of all texels
/// as well as a longer one does.
const MAX_LENGTH: f32 = 16.0;

/// The derivatives of the texture coordinates of eight pixels, in repeats a pixel; they may be infinite or NaN.
#[derive(Clone, Copy, Debug)]
pub struct Differences {
    /// `(du/dx, dv/dx)`.
    pub dx: [PixelLanes; 2],
    /// `(du/dy, dv/dy)`.
    pub dy: [PixelLanes; 2],
}

/// One pixel's place and derivatives in the texture, in repeats.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// The middle, `(u, v)`.
    pub center: [f32; 2],
    /// `(du/dx, dv/dx)`.
    pub dx: [f32; 2],
    /// `(du/dy, dv/dy)`.
    pub dy: [f32; 2],
}

/// The places of eight pixels, with 0 for a coordinate that is not within 1e6 repeats.
#[must_use]
#[inline]
pub fn bounded_place(place: [PixelLanes; 2]) -> [PixelLanes; 2] {
    place.map(|c| c.abs().simd_le(PixelLanes::splat(1e6)).select(c, PixelLanes::ZERO))
}

/// A derivative of eight pixels, shortened where it is longer than 16 repeats, and 0 for what is not a number.
#[cold]
#[inline(never)]
fn shortened(derivative: [PixelLanes; 2]) -> [PixelLanes; 2] {
    let [u, v] = derivative.map(finite);
    let longest = u.abs().fast_max(v.abs());
    let is_long = longest.simd_gt(PixelLanes::splat(MAX_LENGTH));
    let scale = is_long.select(PixelLanes::splat(MAX_LENGTH) / longest, PixelLanes::ONE);
    [u * scale, v * scale]
}

/// Formula (2) or (3), as meant or as printed, in each quad of `uv` with the relief's `offset`.
#[must_use]
#[inline(always)]
pub fn differences(uv: &[PixelLanes; 2], offset: &[PixelLanes; 2], which: (Derivatives, Formulas)) -> Differences {
    let (derivatives, formulas) = which;
    if formulas == Formulas::Meant {
        let place = |axis: usize| match derivatives {
            Derivatives::Flat => uv[axis],
            Derivatives::Relief => uv[axis] + offset[axis],
        };
        let [u, v] = [place(0), place(1)];
        // The quad's pixels at the high and the low ends of each lane's row and column.
        let dx = |c: PixelLanes| permute(c, [1, 1, 3, 3, 5, 5, 7, 7]) - permute(c, [0, 0, 2, 2, 4, 4, 6, 6]);
        let dy = |c: PixelLanes| permute(c, [2, 3, 2, 3, 6, 7, 6, 7]) - permute(c, [0, 1, 0, 1, 4, 5, 4, 5]);
        return Differences { dx: [dx(u), dx(v)], dy: [dy(u), dy(v)] };
    }
    letter_by_letter(uv, offset, which)
}

/// The differences lane by lane.
#[inline(never)]
fn letter_by_letter(uv: &[PixelLanes; 2], offset: &[PixelLanes; 2], which: (Derivatives, Formulas)) -> Differences {
    let [u, v, m, r] = [uv[0], uv[1], offset[0], offset[1]].map(PixelLanes::to_array);
    let mut result = [[0.0_f32; 8]; 4];
    for lane in 0..8 {
        // The quad's pixel at the low end of this lane's row and column.
        let (row, column) = (lane & !1, lane & !2);
        let at = |i: usize| Corner { u: u[i], v: v[i], du: m[i], dv: r[i] };
        let [dudx, dvdx, _, _] = at_pixel(at(row), at(row + 1), at(row), which);
        let [_, _, dudy, dvdy] = at_pixel(at(column), at(column), at(column + 2), which);
        [dudx, dvdx, dudy, dvdy].into_iter().zip(&mut result).for_each(|(d, lanes)| lanes[lane] = d);
    }
    let [dudx, dvdx, dudy, dvdy] = result.map(PixelLanes::new);
    Differences { dx: [dudx, dvdx], dy: [dudy, dvdy] }
}

/// The differences that the footprints of a filter are made of: formula (2) or (3) by the settings. For `Visible` and
/// formula (3) as meant, a jump of the relief between two pixels (a difference more than `max_stretch` times as long as
/// that of (2), in texture repeats) is not taken for the slope of a surface: there stands the difference of (2).
#[must_use]
#[inline(always)]
pub fn differences_for(uv: &[PixelLanes; 2], offset: &[PixelLanes; 2], settings: &Settings) -> Differences {
    let which = (settings.derivatives, settings.formulas);
    let displaced = differences(uv, offset, which);
    let is_bounded = settings.filter == Filter::Visible && settings.max_stretch > 0.0;
    if !is_bounded || which != (Derivatives::Relief, Formulas::Meant) {
        return displaced;
    }
    let flat = differences(uv, offset, (Derivatives::Flat, Formulas::Meant));
    let without_jump = |displaced: [PixelLanes; 2], flat: [PixelLanes; 2]| {
        let squared = |[u, v]: [PixelLanes; 2]| u * u + v * v;
        let [displaced, flat] = [displaced, flat].map(|derivative| derivative.map(finite));
        let is_jump = squared(displaced).simd_gt(squared(flat) * (settings.max_stretch * settings.max_stretch));
        [0, 1].map(|axis| is_jump.select(flat[axis], displaced[axis]))
    };
    Differences { dx: without_jump(displaced.dx, flat.dx), dy: without_jump(displaced.dy, flat.dy) }
}

/// Coordinates and relief offset of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// Undisplaced u.
    pub u: f32,
    /// Undisplaced v.
    pub v: f32,
    /// Offset of u by the relief (the paper's m, n, p).
    pub du: f32,
    /// Offset of v by the relief (the paper's r, o, s).
    pub dv: f32,
}

/// `[du/dx, dv/dx, du/dy, dv/dy]` of the pixel `here` from its neighbours `right` and `below`.
#[must_use]
pub fn at_pixel(here: Corner, right: Corner, below: Corner, which: (Derivatives, Formulas)) -> [f32; 4] {
    match which {
        (Derivatives::Flat, Formulas::Meant) => {
            [right.u - here.u, right.v - here.v, below.u - here.u, below.v - here.v]
        }
        (Derivatives::Flat, Formulas::Printed) => {
            [right.u - here.u, right.v - here.u, below.u - here.u, below.v - here.u]
        }
        (Derivatives::Relief, Formulas::Meant) => [
            (right.u + right.du) - (here.u + here.du),
            (right.v + right.dv) - (here.v + here.dv),
            (below.u + below.du) - (here.u + here.du),
            (below.v + below.dv) - (here.v + here.dv),
        ],
        (Derivatives::Relief, Formulas::Printed) => [
            right.u + right.du - here.u + here.du,
            right.v + right.dv - here.u + here.du,
            below.u + below.du - here.v + here.dv,
            below.v + below.dv - here.v + here.dv,
        ],
    }
}

impl Differences {
    /// The derivatives, shortened where they are longer than 16 repeats, and 0 for what is not a number.
    #[inline(always)]
    pub(super) fn shortened(&self) -> Self {
        let Self { dx, dy } = *self;
        let is_short = |c: PixelLanes| c.abs().simd_le(PixelLanes::splat(MAX_LENGTH));
        // Few are longer, so that what it takes is worth a branch.
        if (is_short(dx[0]) & is_short(dx[1]) & is_short(dy[0]) & is_short(dy[1])).all() {
            *self
        } else {
            Self { dx: shortened(dx), dy: shortened(dy) }
        }
    }

    /// The footprint of one lane around `center`; derivatives beyond 16 repeats are shortened, and 0 for what is not a number.
    #[must_use]
    pub fn footprint(&self, center: &[PixelLanes; 2], lane: usize) -> Footprint {
        let at = |lanes: &[PixelLanes; 2]| lanes.map(|l| l.as_array()[lane]);
        let bounded = |derivative: [f32; 2]| {
            let [u, v] = derivative.map(|c| if c.is_finite() { c } else { 0.0 });
            let longest = u.abs().max(v.abs());
            let scale = if longest > MAX_LENGTH { MAX_LENGTH / longest } else { 1.0 };
            [u * scale, v * scale]
        };
        let center = at(center).map(|c| if c.abs() <= 1e6 { c } else { 0.0 });
        Footprint { center, dx: bounded(at(&self.dx)), dy: bounded(at(&self.dy)) }
    }
}
