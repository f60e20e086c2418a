//! Pixels of one block by the elliptical weighted average.

use super::quads::{Ground, QuadShader};
use crate::filter::PixelFootprints;
use crate::filter::ewa::Scans;
use crate::raster::{QuadBlock, QuadPair};
use crate::settings::Lighting;
use crate::simd::PixelLanes;
use crate::texture::FULL_F32;

/// Pairs whose ellipses are found before their texels are read: one pair's steps wait for each other, those of several
/// do not.
const AT_ONCE: usize = 4;

impl QuadShader<'_> {
    /// Appends the colours of a block's pairs; helper lanes are 0.
    pub(super) fn ellipses(&self, ground: &Ground, block: &QuadBlock, colors: &mut Vec<[PixelLanes; 3]>) {
        let mut num_texels = 0;
        for first in (0..block.num_pairs()).step_by(AT_ONCE) {
            let indices = first..block.num_pairs().min(first + AT_ONCE);
            let mut scans: [Option<(Scans, QuadPair)>; AT_ONCE] = Default::default();
            for (slot, index) in scans.iter_mut().zip(indices) {
                let pair = block.pair(index);
                *slot = Some((self.scans(ground, &pair), pair));
            }
            for (scans, pair) in scans.iter().flatten() {
                colors.push(self.ellipse_colors(ground, scans, pair, &mut num_texels));
            }
        }
        self.count([num_texels; 2]);
    }

    /// The rows of texels that the ellipses of a pair take.
    #[inline]
    pub(super) fn scans(&self, ground: &Ground, pair: &QuadPair) -> Scans {
        let (place, differences) = self.hits(ground, pair);
        Scans::new(ground.surface, &PixelFootprints::new(&place, &differences, Default::default()), self.settings)
    }

    #[inline]
    fn ellipse_colors(&self, ground: &Ground, scans: &Scans, pair: &QuadPair, num_texels: &mut u64) -> [PixelLanes; 3] {
        let Ground { surface, material, .. } = *ground;
        let mut colors = [[0.0; 8]; 3];
        let mut set = |lane: usize, color: [f32; 3]| (0..3).for_each(|c| colors[c][lane] = color[c]);
        if self.settings.lighting == Lighting::Lit {
            for lane in pair.covered() {
                let (mean, num) = scans.mean(surface, lane);
                *num_texels += num;
                set(lane, self.lit(ground, pair, lane, &mean).into());
            }
            return colors.map(PixelLanes::new);
        }
        for lane in pair.covered() {
            let (color, num) = scans.color(surface, lane);
            *num_texels += num;
            set(lane, color);
        }
        let scale = surface.color_scale / FULL_F32;
        [0, 1, 2].map(|c| PixelLanes::new(colors[c]) * (material.diffuse[c] * scale))
    }
}
