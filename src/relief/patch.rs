//! Where rays cross the bilinear patch of a cell.

use crate::simd::RayLanes;

/// The heights, 0 to 1, at the corners of sixteen cells: (0,0), (1,0), (0,1), (1,1).
pub(super) type Corners = [RayLanes; 4];

/// Depth of the rays' first crossing with patches, from the depth on where they are at `place`
/// within the cell; more than 2 where there is none. `step` is how far they move in a whole depth.
///
/// With `tau` counted from there, `f(tau) = depth + tau - 1 + h = a tau^2 + b tau + c`, and the
/// crossing is the first `tau >= 0` with `f >= 0`.
#[inline(always)]
pub(super) fn crossing(
    [h00, h10, h01, h11]: Corners,
    depth: RayLanes,
    [x, y]: [RayLanes; 2],
    [dx, dy]: [RayLanes; 2],
) -> RayLanes {
    let (hx, hy, hxy) = (h10 - h00, h01 - h00, h00 - h10 - h01 + h11);
    let a = hxy * dx * dy;
    let b = RayLanes::ONE + hx * dx + hy * dy + hxy * (x * dy + y * dx);
    let c = depth - 1.0 + h00 + hx * x + hy * y + hxy * x * y;
    // A ray that is in the relief already has its hit where it is.
    c.simd_ge(RayLanes::ZERO).select(depth, depth + first_root(a, b, c))
}

/// The least root, 0 or more, of `a x^2 + b x + c` where `c < 0`; 2 where there is none.
#[inline(always)]
fn first_root(a: RayLanes, b: RayLanes, c: RayLanes) -> RayLanes {
    let discriminant = b * b - a * c * 4.0;
    // Both roots by the form that does not cancel; q has the sign of -b.
    let root = discriminant.fast_max(RayLanes::ZERO).sqrt();
    let q = (b + b.simd_ge(RayLanes::ZERO).select(root, -root)) * -0.5;
    let none = RayLanes::splat(2.0);
    let valid = |x: RayLanes| (x.simd_ge(RayLanes::ZERO) & x.simd_le(none)).select(x, none);
    let (r1, r2) = (valid(c / q), valid(q / a));
    discriminant.simd_ge(RayLanes::ZERO).select(r1.fast_min(r2), none)
}
