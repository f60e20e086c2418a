//! What comes on top of baked light: what surfaces send out by themselves, and what they reflect.
//!
//! A reflection depends on the eye and cannot be baked. What can is how much texels reflect of
//! light that comes straight, times the part of them that suns reach. The horizon sweeps these with
//! their normals, and takes a sun's lobe around the normal of each line and bin: the mean is of
//! highlights. The half vector is the same for all normals of a pixel, so Fresnel's factor comes
//! once.
//!
//! The sky is reflected by each texel as far as the relief opens to it. Other filters, and surfaces
//! without relief, take the mean normal from the mip levels around the hit for all of it, over whatever
//! relief is in between. Other meshes hide nothing.

use super::gloss::PieceGloss;
use super::ground::{Ground, in_lanes};
use super::hidden_lights::HiddenLights;
use super::highlights::SweptGloss;
use super::shade::{PAIRS_AT_ONCE, ShadeScratch, Shader};
use crate::filter::{Batch, Filtered, Scratch};
use crate::footprint::Footprints;
use crate::light::reflection::Fresnel;
use crate::light::{LocalLights, SeenGloss};
use crate::raster::QuadBlock;
use crate::scene::Finish;
use crate::settings::{Filter, Trilinear};
use crate::simd::PixelLanes;
use crate::texture::{FULL_F32, Texel};
use glam::Vec3;
use std::ops::Range;

impl Shader<'_> {
    /// Adds to the colours of a block's pairs what is not baked. `below` is what else they show of their
    /// diffuse layer, if anything.
    pub(super) fn reflect(
        &self,
        (ground, hidden): (&Ground, &HiddenLights),
        block: &QuadBlock,
        scratch: &mut ShadeScratch,
        (colors, mut below): (&mut [[PixelLanes; 3]], Vec<[PixelLanes; 3]>),
    ) {
        if ground.material.is_matte() {
            let emissive = ground.emissive().to_array();
            for color in colors.iter_mut() {
                color.iter_mut().zip(emissive).for_each(|(channel, more)| *channel += more);
            }
            return add(colors, &below);
        }
        below.resize(colors.len(), [PixelLanes::ZERO; 3]);
        // What the horizon shows of a layer's texels is seen through what lies above each of them already.
        let is_layered =
            matches!(self.settings.filter, Filter::Horizon(_)) && ground.is_seen_through();
        if !is_layered {
            add(&mut below, colors);
            colors.fill([PixelLanes::ZERO; 3]);
        }
        let swept = self.swept_gloss(ground, hidden, block, scratch);
        let swept = swept.as_ref();
        for first in (0..block.num_pairs()).step_by(PAIRS_AT_ONCE) {
            let pairs = first..block.num_pairs().min(first + PAIRS_AT_ONCE);
            let colors = &mut colors[pairs.clone()];
            let below = &below[pairs.clone()];
            self.reflect_pairs((ground, hidden, swept), (block, pairs), scratch, (colors, below));
        }
    }

    fn reflect_pairs(
        &self,
        (ground, hidden, swept): (&Ground, &HiddenLights, Option<&SweptGloss>),
        (block, pairs): (&QuadBlock, Range<usize>),
        scratch: &mut ShadeScratch,
        (colors, below): (&mut [[PixelLanes; 3]], &[[PixelLanes; 3]]),
    ) {
        let ShadeScratch { filter, footprints, lights, filtered, .. } = scratch;
        let surface = ground.unlit.surface();
        let mips = Filter::Trilinear(Trilinear::default());
        self.footprints((ground.unlit, &mips.traits().rule), (block, pairs.clone()), footprints);
        lights.clear();
        self.list_lights((block, pairs.clone()), lights);
        filtered.resize(pairs.len(), Filtered::default());
        let batch = Batch { pixels: footprints, lights, ..Batch::default() };
        self.count(mips.colors(ground.unlit, &batch, filter, filtered));
        hidden.dim(lights, (block, pairs.clone()));
        ground.occlude(footprints, lights);
        let places = footprints.iter().zip(&*filtered).flat_map(|(pixels, filtered)| {
            pixels.covered().map(|lane| (pixels.lane(lane), filtered.lane(lane)))
        });
        let places: Vec<_> = places.map(|(pixel, texel)| (ground.finish(&pixel), texel)).collect();
        let first = pairs.start;
        let mut seen =
            self.seen_gloss(ground, (block, pairs), (lights, &places), (filter, footprints));
        if let Some(swept) = swept {
            seen.resize(lights.len(), SeenGloss::default());
            swept.add_to(&mut seen, footprints, first);
        }
        // With a texture of metal the colours are those of the diffuse layer already.
        let has_layer = ground.material.maps.metallic.is_some();
        let dielectric = if has_layer { 1.0 } else { 1.0 - ground.material.metallic };
        // The lights come in the order in which they were listed.
        let mut each = lights.iter().zip(places).enumerate();
        for ((color, below), pixels) in colors.iter_mut().zip(below).zip(&*footprints) {
            let mut lit = [Vec3::ZERO; 8];
            let [shown, below] = [&*color, below].map(|of| of.map(PixelLanes::to_array));
            let lane_of = |of: &[[f32; 8]; 3], lane: usize| Vec3::from(of.map(|c| c[lane]));
            for (lane, (i, (lights, (finish, texel)))) in pixels.covered().zip(&mut each) {
                let base = ground.color_of(surface, &texel);
                let seen = seen.get(i).copied().unwrap_or_default();
                let on_top = self.reflected((&finish, base), texel.normal.into(), lights, seen);
                let passed = lane_of(&below, lane) * (on_top.passed * dielectric);
                lit[lane] = passed + lane_of(&shown, lane) * dielectric + on_top.added;
            }
            *color = in_lanes(&lit);
        }
    }

    /// What the covered pixels of some pairs reflect, texel by texel, where it is the horizon that
    /// draws; else nothing.
    fn seen_gloss(
        &self,
        ground: &Ground,
        (block, pairs): (&QuadBlock, Range<usize>),
        (lights, places): (&[LocalLights], &[(Finish, Texel)]),
        (scratch, footprints): (&mut Scratch, &mut Vec<Footprints>),
    ) -> Vec<SeenGloss> {
        let filter = &self.settings.filter;
        let gloss = ground.baked.map_or(&[][..], |piece| piece.gloss);
        if gloss.is_empty() || !matches!(filter, Filter::Horizon(_)) {
            return Vec::new();
        }
        let to_eyes: Vec<_> = lights.iter().map(|lights| lights.to_eye).collect();
        let mut sums = vec![SeenGloss::default(); lights.len()];
        let mut found = vec![Filtered::default(); pairs.len()];
        // All have the same relief.
        self.footprints((ground.unlit, &filter.traits().rule), (block, pairs), footprints);
        for PieceGloss { sun, straight, prepared: gloss } in gloss {
            let batch = Batch { pixels: footprints, to_eyes: &to_eyes, ..Batch::default() };
            self.count(filter.colors(gloss, &batch, scratch, &mut found));
            let scale = gloss.surface().color_scale() / FULL_F32;
            let seen = footprints.iter().zip(&found);
            let seen = seen.flat_map(|(pixels, found)| pixels.covered().map(|i| found.lane(i)));
            for (((sum, seen), lights), (finish, _)) in
                sums.iter_mut().zip(seen).zip(lights).zip(places)
            {
                let seen = Vec3::from(seen.color) * scale;
                if let Some(sun) = sun {
                    let fresnel =
                        Fresnel { straight: *straight, ..Fresnel::new(finish, Vec3::ONE) };
                    sum.color += seen * lights.shown(*sun, &fresnel);
                    sum.has_suns = true;
                } else {
                    sum.color += seen * lights.occlusion;
                    sum.has_sky = true;
                }
            }
        }
        sums
    }
}

/// Adds colours to others.
fn add(to: &mut [[PixelLanes; 3]], colors: &[[PixelLanes; 3]]) {
    for (to, color) in to.iter_mut().zip(colors) {
        (0..3).for_each(|c| to[c] += color[c]);
    }
}
