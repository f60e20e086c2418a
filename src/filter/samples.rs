//! Where the rays of a pixel go.

use crate::simd::PixelLanes;

/// Offsets of a pixel's samples from its centre, in pixels.
#[derive(Clone, Debug)]
pub struct SampleOffsets {
    /// Eight samples at a time: x, y, and how many of them there are.
    pub groups: Vec<([PixelLanes; 2], usize)>,
    /// Whether each ray is lit by rays of its own, from its hit; else as the pixel's centre is, as
    /// shaders do.
    pub is_lit_apart: bool,
}

impl SampleOffsets {
    /// Offsets in lanes.
    pub(super) fn new(offsets: &[[f32; 2]], is_lit_apart: bool) -> Self {
        let lanes = |group: &[[f32; 2]], i: usize| {
            PixelLanes::new(std::array::from_fn(|lane| {
                group.get(lane).map_or(0.0, |offset| offset[i])
            }))
        };
        let groups =
            offsets.chunks(8).map(|group| ([0, 1].map(|i| lanes(group, i)), group.len())).collect();
        Self { groups, is_lit_apart }
    }
}
