//! What comes on top of baked light: what surfaces send out by themselves, and what they reflect.
//!
//! A reflection depends on the eye and cannot be baked. It is that of the mean normal, from the mip
//! levels around the hit, and of the base colour there: lights reach it unless the polygon faces
//! away, over whatever relief and meshes are in between.

use super::ground::{Ground, in_lanes};
use super::shade::{PAIRS_AT_ONCE, ShadeScratch, Shader};
use crate::filter::{Batch, Filtered};
use crate::raster::QuadBlock;
use crate::settings::{Filter, Trilinear};
use crate::simd::PixelLanes;
use glam::Vec3;
use std::ops::Range;

impl Shader<'_> {
    /// Adds to the colours of a block's pairs what is not baked.
    pub(super) fn reflect(
        &self,
        ground: &Ground,
        block: &QuadBlock,
        scratch: &mut ShadeScratch,
        colors: &mut [[PixelLanes; 3]],
    ) {
        if ground.material.is_matte() {
            let emissive = ground.material.emissive.to_array();
            for color in colors {
                color.iter_mut().zip(emissive).for_each(|(channel, more)| *channel += more);
            }
            return;
        }
        for first in (0..block.num_pairs()).step_by(PAIRS_AT_ONCE) {
            let pairs = first..block.num_pairs().min(first + PAIRS_AT_ONCE);
            self.reflect_pairs(ground, (block, pairs.clone()), scratch, &mut colors[pairs]);
        }
    }

    fn reflect_pairs(
        &self,
        ground: &Ground,
        (block, pairs): (&QuadBlock, Range<usize>),
        scratch: &mut ShadeScratch,
        colors: &mut [[PixelLanes; 3]],
    ) {
        let ShadeScratch { filter, footprints, lights, filtered } = scratch;
        let mips = Filter::Trilinear(Trilinear::default());
        self.footprints((ground.unlit, &mips.traits().rule), (block, pairs.clone()), footprints);
        lights.clear();
        self.list_lights((block, pairs.clone()), lights);
        filtered.resize(pairs.len(), Filtered::default());
        let batch = Batch { pixels: footprints, lights, curved: None, is_alone: false };
        self.count(mips.colors(ground.unlit, &batch, filter, filtered));
        // The lights come in the order in which they were listed.
        let mut lights = lights.iter();
        for (color, (pixels, filtered)) in colors.iter_mut().zip(footprints.iter().zip(&*filtered))
        {
            let mut lit = [Vec3::ZERO; 8];
            let diffuse = color.map(|channel| channel.to_array());
            for (lane, lights) in pixels.covered().zip(&mut lights) {
                let texel = filtered.lane(lane);
                let base = ground.color_of(ground.unlit.surface(), &texel);
                let on_top = self.reflected(ground.material, base, texel.normal.into(), lights);
                let diffuse = Vec3::from(diffuse.map(|channel| channel[lane]));
                lit[lane] = diffuse * on_top.diffuse_share + on_top.added;
            }
            *color = in_lanes(&lit);
        }
    }
}
