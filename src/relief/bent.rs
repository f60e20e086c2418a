//! View rays over a surface that bends: as filters see them, straight or bowed over the texture.

use super::displacement::{displacement, stretch};
use crate::simd::{PixelLanes, in_quads};

/// Depth for which bent rays are right, of that which they get to: about as deep as relief is seen.
pub const SEEN_DEPTH: f32 = 0.55;

/// Depths, of that which a ray gets to, that tell how it bows: most relief is seen between them.
const BOW_DEPTHS: [f32; 2] = [0.3, 0.9];

/// Least depth, 0 to 1, that a ray is taken to get to.
const LEAST_REACH: f32 = 0.1;

/// Depth, 0 to 1, at which rays that rise again have hardly got into the relief.
const NO_REACH: f32 = 1.0 / 30.0;

/// The displacement over a surface that bends: `bend` says how the ray's way changes per repeat along u
/// and along v that it has moved, by how much its `gamma` grows, and half of what moves it on along u
/// and along v.
///
/// ```text
///   eye o__
///          --__
///   ___-----___--__          after L lengths of itself the ray w = (alpha, beta) is at the depth d:
///   polygon     --_ --__     d = gamma L + (bend . w) L^2 / 2, so
///                  --_  --   L = 2 d / (gamma + sqrt(gamma^2 + 2 d (bend . w))),
///                            and has moved by u = L w + L^2 turn w
/// ```
///
/// A displacement is linear in the depth, and so can be right at one: at [`SEEN_DEPTH`] of the depth
/// that the ray gets to, which at an outline is less than the relief's: there it rises again.
pub fn bent(
    view: &[PixelLanes; 3],
    bend: &[[PixelLanes; 2]; 3],
    relief_depth: f32,
) -> [PixelLanes; 2] {
    bent_for(reach(view, bend, relief_depth) * SEEN_DEPTH, view, bend, relief_depth)
}

/// The depth, 0 to 1, at which `gamma^2 + 2 d (bend . w)` is 0; 1 where the ray gets deeper.
fn reach(
    [alpha, beta, gamma]: &[PixelLanes; 3],
    [grown, ..]: &[[PixelLanes; 2]; 3],
    relief_depth: f32,
) -> PixelLanes {
    let grown = along_ray([alpha, beta], grown);
    let reach = *gamma * *gamma / (grown * (-2.0 * relief_depth));
    let rises = reach.simd_ge(PixelLanes::ZERO) & reach.simd_lt(PixelLanes::ONE);
    rises.select(reach.fast_max(PixelLanes::splat(LEAST_REACH)), PixelLanes::ONE)
}

/// How much a number grows along a ray, by how it grows per repeat: `bend . w`.
fn along_ray([alpha, beta]: [&PixelLanes; 2], growth: &[PixelLanes; 2]) -> PixelLanes {
    growth[0] * *alpha + growth[1] * *beta
}

/// Bits of the pixels of two quads that see rays rise again which have hardly got into the relief: at
/// outlines. What such a pixel sees lies far apart, and no displacement tells where.
pub fn are_at_outline(
    [alpha, beta, gamma]: &[PixelLanes; 3],
    [grown, ..]: &[[PixelLanes; 2]; 3],
    relief_depth: f32,
) -> u8 {
    let [dx, dy] = in_quads(*gamma);
    let least = (*gamma - dx.abs() - dy.abs()).fast_max(PixelLanes::ZERO);
    let grown = along_ray([alpha, beta], grown);
    (least * least).simd_lt(grown * (-2.0 * NO_REACH * relief_depth)).to_bitmask() as u8
}

/// The displacement, [`bent`] where the surface bends.
pub fn displacement_over(
    view: &[PixelLanes; 3],
    bend: Option<&[[PixelLanes; 2]; 3]>,
    relief_depth: f32,
) -> [PixelLanes; 2] {
    match bend {
        Some(bend) => bent(view, bend, relief_depth),
        None => displacement(view, relief_depth),
    }
}

/// How much a [`bent`] displacement grows with the depth for which it is right, over all of it; and by
/// how much it is greater where that is [`SEEN_DEPTH`] of the relief, and not of what the ray gets to.
pub fn bow(
    view: &[PixelLanes; 3],
    bend: &[[PixelLanes; 2]; 3],
    relief_depth: f32,
) -> [[PixelLanes; 2]; 2] {
    let reach = reach(view, bend, relief_depth);
    let [near, far] = BOW_DEPTHS.map(|depth| bent_for(reach * depth, view, bend, relief_depth));
    let inverse = PixelLanes::splat(1.0 / (BOW_DEPTHS[1] - BOW_DEPTHS[0])) / reach;
    let bow = [0, 1].map(|i| (far[i] - near[i]) * inverse);
    let deeper = (PixelLanes::ONE - reach) * SEEN_DEPTH;
    [bow, bow.map(|bow| bow * deeper)]
}

/// The displacement that is right for a depth, 0 to 1.
fn bent_for(
    depth: PixelLanes,
    view: &[PixelLanes; 3],
    [gamma, along_u, along_v]: &[[PixelLanes; 2]; 3],
    relief_depth: f32,
) -> [PixelLanes; 2] {
    let [alpha, beta, _] = *view;
    let straight = displacement(view, relief_depth);
    let length = stretch(view, relief_depth);
    // The share of gamma^2 that the bend takes or gives. Rays that pass above it bend the most.
    let grown = along_ray([&alpha, &beta], gamma) * length * length;
    let left = PixelLanes::ONE + grown * depth * (2.0 / relief_depth);
    let farther = PixelLanes::splat(2.0) / (left.fast_max(PixelLanes::ZERO).sqrt() + 1.0);
    let once = [straight[0] * farther, straight[1] * farther];
    let twice = length * farther * depth;
    let turned = [along_u, along_v].map(|of| (of[0] * once[0] + of[1] * once[1]) * twice);
    // Where it would turn it by half of its way, it is not known by so little.
    let square = |[u, v]: [PixelLanes; 2]| u * u + v * v;
    let most = (square(once) * 0.25 / square(turned).fast_max(PixelLanes::splat(1e-30))).sqrt();
    let part = most.fast_min(PixelLanes::ONE);
    [0, 1].map(|i| {
        let bent = once[i] + turned[i] * part;
        bent.is_finite().select(bent, straight[i])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rays that come down on a cylinder whose axis is along v, and how far they move around it.
    #[test]
    fn rays_go_around_a_cylinder() {
        let relief_depth = 0.06_f32;
        for (radius, slope) in [(1.0, 1.0), (1.0, 0.7), (0.7, 1.5), (-1.0, 1.0)] {
            let (radius, slope): (f64, f64) = (radius, slope);
            let around = |depth: f64| {
                // Where x^2 + (R - m x)^2 = (R - d)^2.
                let (a, b) = (1.0 + slope * slope, radius * slope);
                let c = 2.0 * radius * depth - depth * depth;
                let x = (b - radius.signum() * (b * b - a * c).sqrt()) / a;
                radius * (x / (radius - slope * x)).atan()
            };
            let lanes = |numbers: [f64; 3]| numbers.map(|c| PixelLanes::splat(c as f32));
            let view = lanes([1.0, 0.0, slope]);
            let grown = lanes([-1.0 / radius, slope / radius, 0.0]);
            let none = PixelLanes::ZERO;
            let bend = [[grown[0], none], [grown[1], none], [none; 2]];
            let straight = displacement(&view, relief_depth);
            let found = bent(&view, &bend, relief_depth)[0].to_array()[0];
            let [[bow, _], [more, _]] = bow(&view, &bend, relief_depth);
            let (bow, found) = (bow.to_array()[0], found + more.to_array()[0]);
            let straight = f64::from(straight[0].to_array()[0]);
            for depth in [0.2, 0.55, 0.9] {
                let exact = around(depth * f64::from(relief_depth)) / depth;
                let bowed = f64::from(found + bow * (depth as f32 - SEEN_DEPTH));
                let (bowed, flat) = ((bowed - exact).abs(), (straight - exact).abs());
                assert!(bowed < 0.2 * flat, "{radius} {slope} {depth}: {bowed} of {flat}");
            }
        }
    }

    #[test]
    fn flat_surfaces_leave_rays_straight() {
        let view = [0.3, -0.7, 0.2].map(PixelLanes::splat);
        let (straight, bend) = (displacement(&view, 0.05), [[PixelLanes::ZERO; 2]; 3]);
        assert_eq!(bent(&view, &bend, 0.05), straight);
        assert_eq!(bow(&view, &bend, 0.05), [[PixelLanes::ZERO; 2]; 2]);
    }
}
