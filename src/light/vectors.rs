//! Vectors of eight pixels.

use crate::simd::PixelLanes;

/// Three coordinates of eight pixels.
pub type Vectors = [PixelLanes; 3];

/// The vector product.
pub fn cross(a: &Vectors, b: &Vectors) -> Vectors {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The scalar product.
pub(super) fn dot(a: &Vectors, b: &Vectors) -> PixelLanes {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The world length of a repeat, by which relief goes down, from dP/du x dP/dv: the geometric mean
/// of both.
pub fn repeat_length(across: &Vectors) -> PixelLanes {
    dot(across, across).sqrt().sqrt()
}
