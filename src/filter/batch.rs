//! What goes into a filter and what comes out of it.

use crate::footprint::Footprints;
use crate::light::{Curved, LocalLights};
use crate::simd::PixelLanes;
use crate::texture::Texel;
use glam::Vec3;

/// Pixels of one surface that are filtered together. Neighbours on the screen may share work.
#[derive(Clone, Copy, Debug, Default)]
pub struct Batch<'a> {
    /// The pixels, eight a vector.
    pub pixels: &'a [Footprints],
    /// Under lights, those of each covered pixel, in order; else empty.
    pub lights: &'a [LocalLights],
    /// Of a curved surface whose relief hides light from itself, the lights of each vector.
    pub curved: Option<&'a Curved<'a>>,
    /// Of a surface that bends, how much the displacements of each vector's pixels grow with the depth
    /// ([`bow`](crate::relief::bow)); else empty. Filters that take rays for straight do not ask.
    pub bows: &'a [[PixelLanes; 2]],
    /// Of a surface that shows highlights, the unit direction to the eye at each covered pixel, in the
    /// frame of the texture and in order; else empty.
    pub to_eyes: &'a [Vec3],
    /// Whether the horizon sweeps each pixel by itself, and cuts its kernel finely enough for its
    /// weights to be exact to 1e-4. Pictures need not that, and are drawn many times as fast without.
    pub is_alone: bool,
}

/// The means of eight pixels' texels, in the units that the surface stores; see [`Texel`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Filtered {
    /// Linear RGB. Of a filter that [asks for lights](super::Traits::asks_for_lights), times what a
    /// white surface there would show of them.
    pub color: [PixelLanes; 3],
    /// Mean normals in the frame of the texture; only made under lights.
    pub normal: [PixelLanes; 3],
}

/// What filtering took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Texels whose visibility was tested, or that were read; rows of sixteen lines for the
    /// horizon.
    pub num_tested: u64,
    /// Texels that were averaged.
    pub num_averaged: u64,
}

/// What a pixel reads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LevelChoice {
    /// The mip level, 0 the finest.
    pub level: usize,
    /// The share of the next coarser one, 0 to 1.
    pub blend: f32,
    /// The share of the colour that the tables of the far field give instead, 0 to 1.
    pub far_share: f32,
}

impl Batch<'_> {
    /// Whether there are lights.
    pub fn is_lit(&self) -> bool {
        !self.lights.is_empty()
    }

    /// The covered pixels: the number of the vector, the vector, and the lane.
    pub fn covered(&self) -> impl Iterator<Item = (usize, &Footprints, usize)> {
        let pixels = self.pixels.iter().enumerate();
        pixels.flat_map(|(vector, pixels)| pixels.covered().map(move |lane| (vector, pixels, lane)))
    }
}

impl Filtered {
    /// One of the pixels.
    pub fn lane(&self, lane: usize) -> Texel {
        let at = |lanes: &[PixelLanes; 3]| lanes.map(|lanes| lanes.as_array()[lane]);
        Texel { color: at(&self.color), normal: at(&self.normal) }
    }

    /// Writes one of the pixels, number by number.
    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, texel: &Texel) {
        for c in 0..3 {
            self.color[c].as_mut_array()[lane] = texel.color[c];
            self.normal[c].as_mut_array()[lane] = texel.normal[c];
        }
    }
}

impl std::ops::AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.num_tested += other.num_tested;
        self.num_averaged += other.num_averaged;
    }
}

/// Filters the covered pixels one by one.
pub(super) fn each_covered(
    batch: &Batch,
    out: &mut [Filtered],
    mut filter: impl FnMut(&Footprints, usize) -> Texel,
) {
    batch.covered().for_each(|(vector, pixels, lane)| out[vector].set(lane, &filter(pixels, lane)));
}
