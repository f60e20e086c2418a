//! Which of eight snapped triangles can be seen: lanes are triangles.
//!
//! The orientation is the sign of `area = (b - a) x (c - a)`, y down: positive is clockwise as
//! displayed, which is the back. Products of snapped differences stay below 2^52, where f64 is
//! exact.

use super::projection::Projection;
use super::samples::{offset_bounds, sample_offsets};
use crate::settings::Settings;
use crate::simd::{f64x8, i32x8};

/// Corners of eight triangles in 1/256 pixel.
pub(super) type CornerLanes = [[i32x8; 2]; 3];

/// What culling needs to know of the frame.
pub(super) struct Culler {
    offsets: &'static [[i32; 2]],
    /// Least and largest sample offset along both axes.
    offset_bounds: [i32; 2],
    size: [i32; 2],
    culls_back_faces: bool,
}

/// What is left of eight triangles.
pub(super) struct Kept {
    /// A bit for each lane that may hold a sample of the frame.
    pub(super) lanes: u32,
    /// A bit for each lane seen from behind, whose second and third corners stay; those of the
    /// others swap places, so that every area is positive.
    pub(super) is_back: u32,
}

impl Culler {
    pub(super) fn new(projection: &Projection, settings: &Settings) -> Self {
        Self {
            offsets: sample_offsets(settings.msaa),
            offset_bounds: offset_bounds(settings.msaa),
            size: [projection.width as i32, projection.height as i32],
            culls_back_faces: settings.cull_back_faces,
        }
    }

    /// The triangles that are not culled: not without area, not from behind (if that matters), with
    /// a pixel of the frame that has a sample in the bounding box, and, where that box is of at
    /// most two pixels a side, with a sample inside.
    #[inline(always)]
    pub(super) fn keep(&self, corners: &CornerLanes) -> Kept {
        let area = twice_area(corners);
        let is_back = area.simd_gt(f64x8::ZERO).to_bitmask();
        let mut lanes = area.simd_lt(f64x8::ZERO).to_bitmask();
        if !self.culls_back_faces {
            lanes |= is_back;
        }
        let [a, b, c] = *corners;
        let [least, most] = self.offset_bounds;
        let min = [0, 1].map(|i| a[i].min(b[i]).min(c[i]));
        let mut is_beyond = i32x8::ZERO;
        let mut is_large = i32x8::ZERO;
        for i in 0..2 {
            let max = a[i].max(b[i]).max(c[i]);
            let first = (min[i] + i32x8::splat(255 - most)) >> 8_u32;
            let last = (max - i32x8::splat(least)) >> 8_u32;
            is_beyond |= first.simd_gt(last) | last | i32x8::splat(self.size[i] - 1).simd_lt(first);
            is_large |= (last - first).simd_gt(i32x8::splat(1));
        }
        lanes &= !is_beyond.to_bitmask();
        let is_large = is_large.to_bitmask();
        if lanes & !is_large != 0 {
            lanes &= is_large | self.holds_sample(corners, is_back, min);
        }
        Kept { lanes, is_back }
    }

    /// For triangles of at most two pixels a side: a bit for each with a sample inside or on an
    /// edge.
    #[inline(always)]
    fn holds_sample(&self, [a, b, c]: &CornerLanes, is_back: u32, min: [i32x8; 2]) -> u32 {
        let mut holds = 0;
        let p = [a, b, c];
        // An edge function is positive inside where the area is negative: `E = (p.y - q.y) dx +
        // (q.x - p.x) dy`, negated.
        let slopes: [[i32x8; 2]; 3] = std::array::from_fn(|i| {
            let (p, q) = (p[i], p[(i + 1) % 3]);
            [q[1] - p[1], p[0] - q[0]]
        });
        for offset in self.offsets {
            let first: [i32x8; 2] = std::array::from_fn(|i| {
                let pixel = (min[i] + i32x8::splat(255 - offset[i])) >> 8_u32;
                (pixel << 8_u32) + i32x8::splat(offset[i])
            });
            let edges: [i32x8; 3] = std::array::from_fn(|i| {
                let [along_x, along_y] = slopes[i];
                along_x * (first[0] - p[i][0]) + along_y * (first[1] - p[i][1])
            });
            for [x, y] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
                let at = |i: usize| edges[i] + ((slopes[i][0] * x + slopes[i][1] * y) << 8_u32);
                let (front, back) = ((at(0), at(1), at(2)), (-at(0), -at(1), -at(2)));
                let is_outside = [
                    (front.0 | front.1 | front.2).to_bitmask(),
                    (back.0 | back.1 | back.2).to_bitmask(),
                ];
                holds |= (!is_outside[0] & !is_back) | (!is_outside[1] & is_back);
            }
        }
        holds & 0xff
    }
}

/// Positive where the corners run clockwise as displayed.
#[inline(always)]
pub(super) fn twice_area([a, b, c]: &CornerLanes) -> f64x8 {
    let to = |p: &[i32x8; 2], axis: usize| f64x8::from_i32x8(p[axis] - a[axis]);
    to(b, 0) * to(c, 1) - to(b, 1) * to(c, 0)
}
