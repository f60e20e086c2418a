//! Pixels of one block by the filters that take what lies around the hit for flat: trilinear and the elliptical weighted
//! average.

use super::quads::{Ground, QuadShader};
use super::queue::Queue;
use crate::filter::ewa::{self, Lines, takes_every_texel};
use crate::filter::{Filtered, PixelFootprints, bounded_place, trilinear};
use crate::raster::{QuadBlock, QuadPair};
use crate::settings::Lighting;
use crate::simd::PixelLanes;
use crate::texture::FULL_F32;

/// Pairs whose lines are found before their texels are read: a pair's steps wait for each other, those of several do not.
const LINES_AT_ONCE: usize = 4;

type Colors = Vec<[PixelLanes; 3]>;

impl QuadShader<'_> {
    /// Appends the colours of a block's pairs by the trilinear filter, unlit.
    pub(super) fn trilinear(&self, ground: &Ground, block: &QuadBlock, colors: &mut Colors) {
        let (first, mut index) = (colors.len(), 0);
        let mut queue = Queue::new();
        colors.resize(first + block.num_pairs(), [PixelLanes::ZERO; 3]);
        while index < block.num_pairs() || !queue.is_empty() {
            while index < block.num_pairs() && !queue.is_full() {
                let pair = block.pair(index);
                let (place, differences) = self.hits(ground, &pair);
                let [u, v] = bounded_place(place);
                queue.push(&pair, index, &[u, v, trilinear::longest_side(ground.surface, &differences)]);
                index += 1;
            }
            let colors = &mut colors[first..];
            queue.fill_up();
            trilinear::colors(ground.surface, queue.groups(), |group, found| {
                queue.hand_out(group, ground.tinted(&found), colors);
            });
            queue.advance();
        }
    }

    /// Appends the colours of a block's pairs by the elliptical weighted average.
    pub(super) fn ewa(&self, ground: &Ground, block: &QuadBlock, colors: &mut Colors) {
        if takes_every_texel(self.settings) {
            let mut num_texels = 0;
            colors.extend(block.pairs().map(|pair| {
                let (place, differences) = self.hits(ground, &pair);
                let mean = |lane: usize| {
                    let footprint = differences.footprint(&place, lane);
                    ewa::mean(ground.surface, &footprint, self.settings, self.is_lit())
                };
                self.means(ground, &pair, mean, &mut num_texels)
            }));
            self.count([num_texels; 2]);
        } else if self.is_lit() && ground.surface.has_normals {
            self.by_lines::<true>(ground, block, colors);
        } else {
            self.by_lines::<false>(ground, block, colors);
        }
    }

    fn by_lines<const HAS_NORMALS: bool>(&self, ground: &Ground, block: &QuadBlock, colors: &mut Colors) {
        let mut num_texels = 0;
        let mut found: [Option<(QuadPair, Lines)>; LINES_AT_ONCE] = Default::default();
        for first in (0..block.num_pairs()).step_by(LINES_AT_ONCE) {
            for (i, found) in found.iter_mut().enumerate() {
                let pair = (first + i < block.num_pairs()).then(|| block.pair(first + i));
                *found = pair.map(|pair| {
                    let (place, differences) = self.hits(ground, &pair);
                    let pixels = PixelFootprints::new(&place, &differences, Default::default());
                    (pair, Lines::new(ground.surface, &pixels, self.settings))
                });
            }
            for (pair, lines) in found.iter().flatten() {
                let mean = |lane: usize| lines.mean::<HAS_NORMALS>(ground.surface, lane);
                colors.push(self.means(ground, pair, mean, &mut num_texels));
            }
        }
        self.count([num_texels; 2]);
    }

    fn is_lit(&self) -> bool {
        self.settings.lighting == Lighting::Lit
    }

    /// The colours of a pair from its pixels' means; helper lanes are 0.
    #[inline(always)]
    fn means(
        &self,
        ground: &Ground,
        pair: &QuadPair,
        mean: impl Fn(usize) -> (Filtered, u64),
        num_texels: &mut u64,
    ) -> [PixelLanes; 3] {
        let mut colors = [[0.0; 8]; 3];
        let mut set = |lane: usize, color: [f32; 3]| (0..3).for_each(|c| colors[c][lane] = color[c]);
        if self.is_lit() {
            for lane in pair.covered() {
                let (mean, num) = mean(lane);
                *num_texels += num;
                set(lane, self.lit(ground, pair, lane, &mean).into());
            }
            return colors.map(PixelLanes::new);
        }
        for lane in pair.covered() {
            let (mean, num) = mean(lane);
            *num_texels += num;
            set(lane, mean.color);
        }
        ground.tinted(&colors.map(PixelLanes::new))
    }
}

impl Ground<'_> {
    /// Stored colours as the material shows them.
    #[inline(always)]
    fn tinted(&self, stored: &[PixelLanes; 3]) -> [PixelLanes; 3] {
        let scale = self.surface.color_scale / FULL_F32;
        std::array::from_fn(|c| stored[c] * self.material.diffuse[c] * scale)
    }
}
