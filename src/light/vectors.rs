//! Vectors of eight pixels.

use crate::simd::{Lanes, PixelLanes};

/// Three coordinates of eight pixels.
pub type Vectors = [PixelLanes; 3];

/// The vector product.
pub fn cross(a: &Vectors, b: &Vectors) -> Vectors {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The scalar product, of pixels or of a sweep's lines.
#[inline(always)]
pub(crate) fn dot<L: Lanes>(a: &[L; 3], b: &[L; 3]) -> L {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The world length of a repeat, by which relief goes down, from dP/du x dP/dv: the geometric mean
/// of both.
pub fn repeat_length(across: &Vectors) -> PixelLanes {
    dot(across, across).sqrt().sqrt()
}
