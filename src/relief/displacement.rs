//! How far a view ray goes, and moves along the texture, on its way down through the relief.

use crate::simd::PixelLanes;

/// Steepest view slope: rays closer to the surface than one unit of depth in 64 along it are traced
/// at that slope, so that the length of any walk over the relief is bounded.
pub const MAX_SLOPE: f32 = 64.0;

/// Depth, 0 to 1, for which bent rays are right: about as deep as relief is seen at an outline. A torus
/// and a sphere of cobbles at 640x360 have 40.2 and 41.1 dB for 0.3, 41.2 and 41.5 for 0.5, 41.5 and
/// 40.7 for 0.7, and 38.7 and 39.3 where rays are straight.
pub const SEEN_DEPTH: f32 = 0.55;

/// Depths that tell how a ray bows: those between which most relief is seen.
const BOW_DEPTHS: [f32; 2] = [0.3, 0.9];

/// How far the view ray moves along the texture, in repeats, down to the deepest relief.
///
/// A surface seen from behind shows its relief just as deep on its other side.
pub fn displacement(view: &[PixelLanes; 3], relief_depth: f32) -> [PixelLanes; 2] {
    let [alpha, beta, _] = *view;
    let stretch = stretch(view, relief_depth);
    [finite(alpha * stretch), finite(beta * stretch)]
}

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
/// A displacement is linear in the depth, and so can be right at one: [`SEEN_DEPTH`].
pub fn bent(
    straight: &[PixelLanes; 2],
    view: &[PixelLanes; 3],
    bend: &[[PixelLanes; 2]; 3],
    relief_depth: f32,
) -> [PixelLanes; 2] {
    bent_for(SEEN_DEPTH, straight, view, bend, relief_depth)
}

/// How much a [bent](bent) displacement grows with the depth for which it is right: over all of it.
pub fn bow(
    straight: &[PixelLanes; 2],
    view: &[PixelLanes; 3],
    bend: &[[PixelLanes; 2]; 3],
    relief_depth: f32,
) -> [PixelLanes; 2] {
    let [near, far] = BOW_DEPTHS.map(|depth| bent_for(depth, straight, view, bend, relief_depth));
    let inverse = 1.0 / (BOW_DEPTHS[1] - BOW_DEPTHS[0]);
    [0, 1].map(|i| (far[i] - near[i]) * inverse)
}

fn bent_for(
    depth: f32,
    straight: &[PixelLanes; 2],
    view: &[PixelLanes; 3],
    [gamma, along_u, along_v]: &[[PixelLanes; 2]; 3],
    relief_depth: f32,
) -> [PixelLanes; 2] {
    let [alpha, beta, _] = *view;
    let length = stretch(view, relief_depth);
    // The share of gamma^2 that the bend takes or gives. Rays that pass above it bend the most.
    let grown = (gamma[0] * alpha + gamma[1] * beta) * length * length;
    let left = PixelLanes::ONE + grown * (2.0 * depth / relief_depth);
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

/// How far the view ray goes on behind the polygon down to the deepest relief, in lengths of its
/// way from the eye to the polygon.
///
/// ```text
///   eye o
///       |\
///   w   | \  ray R: gamma repeats down on its way to the polygon
///       |  \
///   ----+---b----------------  polygon
///            \
///             q  hit at depth t: t S repeats further down, which is t S / gamma of R
/// ```
///
/// So the hit is at `eye + R (1 + t S / gamma)`, and, since the distance along the view is linear
/// on a ray, `w (1 + t S / gamma)` far away. Rays that are traced at [`MAX_SLOPE`] have the
/// `gamma` of that slope: the hit is then where the view ray is over the same place of the texture.
pub fn stretch(view: &[PixelLanes; 3], relief_depth: f32) -> PixelLanes {
    let [alpha, beta, gamma] = *view;
    let along = (alpha * alpha + beta * beta).sqrt();
    // A ray along the surface has gamma 0; the least value keeps the division finite where the ray
    // is 0 altogether.
    let gamma = gamma.abs().max(along * (1.0 / MAX_SLOPE)).max(PixelLanes::splat(1e-30));
    PixelLanes::splat(relief_depth) / gamma
}

/// The lanes, with 0 in place of what is not a finite number.
pub fn finite(lanes: PixelLanes) -> PixelLanes {
    lanes.is_finite().select(lanes, PixelLanes::ZERO)
}
