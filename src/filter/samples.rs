//! Where the rays of a pixel go.

use super::{parallax, truth};
use crate::simd::PixelLanes;

/// The rays of a pixel that is a mean over many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Samples {
    /// How many.
    pub num: u32,
    /// Whether each is lit by rays of its own, from its hit, and drawn from the filter kernel; else
    /// they are spread evenly over the pixel, and lit as its centre is, as shaders do.
    pub is_exact: bool,
}

/// Offsets of a pixel's samples from its centre, in pixels.
#[derive(Clone, Debug)]
pub struct SampleOffsets {
    /// Eight samples at a time: x, y, and how many of them there are.
    pub groups: Vec<([PixelLanes; 2], usize)>,
}

impl Samples {
    /// Where they go.
    pub fn offsets(self) -> SampleOffsets {
        let offsets =
            if self.is_exact { truth::offsets(self.num) } else { parallax::offsets(self.num) };
        let lanes = |group: &[[f32; 2]], i: usize| {
            PixelLanes::new(std::array::from_fn(|lane| {
                group.get(lane).map_or(0.0, |offset| offset[i])
            }))
        };
        let groups =
            offsets.chunks(8).map(|group| ([0, 1].map(|i| lanes(group, i)), group.len())).collect();
        SampleOffsets { groups }
    }
}
