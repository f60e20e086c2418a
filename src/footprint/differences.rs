//! The derivatives of the texture coordinates of a pixel, from its 2x2 quad.
//!
//! Formula (2) takes differences of the undisplaced coordinates, formula (3) of the displaced ones,
//! with the offsets (m, r) at (x, y), (n, o) at (x+1, y) and (p, s) at (x, y+1):
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
//! Where the neighbour's ray passes an outline of the relief and hits another part of it, formula
//! (3) is the way from one part to the other, and says nothing of the surface at the hit. The paper
//! does not speak of this. A rule with a `max_stretch` therefore takes formula (2) for a difference
//! that (3) makes many times longer.

use super::rule::FootprintRule;
use crate::relief::finite;
use crate::settings::{Derivatives, Formulas};
use crate::simd::{PixelLanes, in_quads};

/// `(d/dx, d/dy)` of u and v for eight pixels.
type Pair = [[PixelLanes; 2]; 2];

/// Formula (2) or (3), as meant or as printed, in each quad of `uv` with the relief's `offset`, in
/// repeats a pixel: `(du/dx, dv/dx)` and `(du/dy, dv/dy)`. They may be infinite or NaN.
///
/// For formula (3) as meant under a `max_stretch`, a jump of the relief between two pixels (a
/// difference more than that many times as long as that of (2), in texture repeats) is not taken
/// for the slope of a surface: there stands that of (2).
#[inline(always)]
pub fn differences(uv: &[PixelLanes; 2], offset: &[PixelLanes; 2], rule: &FootprintRule) -> Pair {
    if rule.formulas == Formulas::Printed {
        // The printed formulas are there to be looked at, not to be fast: they go lane by lane.
        // Taken apart: the result of a call lies in memory, and that of the other ways would, too.
        let [[a, b], [c, d]] = letter_by_letter(uv, offset, rule);
        return [[a, b], [c, d]];
    }
    let flat = || of_quads(*uv);
    if rule.derivatives == Derivatives::Flat {
        return flat();
    }
    let displaced = of_quads([uv[0] + offset[0], uv[1] + offset[1]]);
    if rule.max_stretch == 0.0 {
        return displaced;
    }
    // Compare squares of lengths, which need no roots.
    let most = rule.max_stretch * rule.max_stretch;
    let [dx, dy] = flat();
    [without_jump(displaced[0], dx, most), without_jump(displaced[1], dy, most)]
}

/// The differences of two numbers.
#[inline(always)]
fn of_quads([u, v]: [PixelLanes; 2]) -> Pair {
    let ([ux, uy], [vx, vy]) = (in_quads(u), in_quads(v));
    [[ux, vx], [uy, vy]]
}

/// A derivative of formula (3), or that of (2) where the square of its length is more than `most`
/// times larger.
fn without_jump(displaced: [PixelLanes; 2], flat: [PixelLanes; 2], most: f32) -> [PixelLanes; 2] {
    let squared = |[u, v]: [PixelLanes; 2]| u * u + v * v;
    // Made finite first: a NaN would compare as no jump, and stay.
    let [displaced, flat] = [displaced, flat].map(|derivative| derivative.map(finite));
    let is_jump = squared(displaced).simd_gt(squared(flat) * most);
    [0, 1].map(|axis| is_jump.select(flat[axis], displaced[axis]))
}

/// The differences lane by lane.
#[inline(never)]
fn letter_by_letter(uv: &[PixelLanes; 2], offset: &[PixelLanes; 2], rule: &FootprintRule) -> Pair {
    let [u, v, m, r] = [uv[0], uv[1], offset[0], offset[1]].map(PixelLanes::to_array);
    let mut result = [[0.0_f32; 8]; 4];
    for lane in 0..8 {
        // The quad's pixel at the low end of this lane's row and column.
        let (row, column) = (lane & !1, lane & !2);
        let at = |i: usize| Corner { u: u[i], v: v[i], du: m[i], dv: r[i] };
        // Each call gives one axis; what stands for the other neighbour is not looked at.
        let [dudx, dvdx, _, _] = at_pixel(at(row), at(row + 1), at(row), rule);
        let [_, _, dudy, dvdy] = at_pixel(at(column), at(column), at(column + 2), rule);
        [dudx, dvdx, dudy, dvdy]
            .into_iter()
            .zip(&mut result)
            .for_each(|(d, lanes)| lanes[lane] = d);
    }
    let [dudx, dvdx, dudy, dvdy] = result.map(PixelLanes::new);
    [[dudx, dvdx], [dudy, dvdy]]
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
pub fn at_pixel(here: Corner, right: Corner, below: Corner, rule: &FootprintRule) -> [f32; 4] {
    match (rule.derivatives, rule.formulas) {
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
