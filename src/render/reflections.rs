//! What comes on top of baked light: what surfaces send out by themselves, and what they reflect.
//!
//! A reflection depends on the eye and cannot be baked. What can is how much texels reflect of
//! light that comes straight, times the part of them that suns reach. The horizon sweeps these with
//! their normals, and takes a sun's lobe around the normal of each line and bin: the mean is of
//! highlights. The half vector is the same for all normals of a pixel, so Fresnel's factor comes
//! once.
//!
//! The sky is reflected by the mean normal that is seen. Other filters take the mean normal from
//! the mip levels around the hit for all of it, over whatever relief is in between. Other meshes
//! hide nothing.

use super::ground::{Ground, in_lanes};
use super::hidden_lights::HiddenLights;
use super::shade::{PAIRS_AT_ONCE, ShadeScratch, Shader};
use crate::filter::{Batch, Filtered, Prepared};
use crate::light::reflection::Fresnel;
use crate::raster::QuadBlock;
use crate::settings::{Filter, Trilinear};
use crate::simd::PixelLanes;
use crate::texture::FULL_F32;
use glam::Vec3;
use std::ops::Range;

impl Shader<'_> {
    /// Adds to the colours of a block's pairs what is not baked.
    pub(super) fn reflect(
        &self,
        ground: &Ground,
        hidden: &HiddenLights,
        block: &QuadBlock,
        scratch: &mut ShadeScratch,
        colors: &mut [[PixelLanes; 3]],
    ) {
        if ground.material.is_matte() {
            let emissive = ground.emissive().to_array();
            for color in colors {
                color.iter_mut().zip(emissive).for_each(|(channel, more)| *channel += more);
            }
            return;
        }
        for first in (0..block.num_pairs()).step_by(PAIRS_AT_ONCE) {
            let pairs = first..block.num_pairs().min(first + PAIRS_AT_ONCE);
            let colors = &mut colors[pairs.clone()];
            self.reflect_pairs((ground, hidden), (block, pairs), scratch, colors);
        }
    }

    fn reflect_pairs(
        &self,
        (ground, hidden): (&Ground, &HiddenLights),
        (block, pairs): (&QuadBlock, Range<usize>),
        scratch: &mut ShadeScratch,
        colors: &mut [[PixelLanes; 3]],
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
        let gloss = self.gloss(ground).inspect(|(gloss, horizon)| {
            let mean = mean_base(ground);
            let glossy = lights
                .iter()
                .zip(&places)
                .map(|(lights, (finish, _))| lights.glossy(finish, &Fresnel::new(finish, mean)));
            let glossy: Vec<_> = glossy.collect();
            self.footprints((gloss, &horizon.traits().rule), (block, pairs), footprints);
            let batch = Batch { pixels: footprints, lights: &glossy, ..Batch::default() };
            self.count(horizon.colors(gloss, &batch, filter, filtered));
        });
        // With a texture of metal the colours are those of the diffuse layer already.
        let has_layer = ground.material.maps.metallic.is_some();
        let dielectric = if has_layer { 1.0 } else { 1.0 - ground.material.metallic };
        // The lights come in the order in which they were listed.
        let mut each = lights.iter().zip(places);
        for (color, (pixels, filtered)) in colors.iter_mut().zip(footprints.iter().zip(&*filtered))
        {
            let mut lit = [Vec3::ZERO; 8];
            let diffuse = color.map(|channel| channel.to_array());
            for (lane, (lights, (finish, texel))) in pixels.covered().zip(&mut each) {
                let seen = filtered.lane(lane);
                let base = ground.color_of(surface, &texel);
                let highlights = gloss.map(|(gloss, _)| {
                    Vec3::from(seen.color) * (gloss.surface().color_scale() / FULL_F32)
                });
                let normal = seen.normal.into();
                let on_top = self.reflected((&finish, base), normal, lights, highlights);
                let diffuse = Vec3::from(diffuse.map(|channel| channel[lane]));
                lit[lane] = diffuse * (on_top.passed * dielectric) + on_top.added;
            }
            *color = in_lanes(&lit);
        }
    }

    /// What highlights are made of, where it is the horizon that draws.
    fn gloss<'a>(&self, ground: &Ground<'a>) -> Option<(&'a Prepared, &Filter)> {
        let filter = &self.settings.filter;
        let gloss = ground.baked?.gloss?;
        matches!(filter, Filter::Horizon(_)).then_some((gloss, filter))
    }
}

/// The mean base colour of a surface.
fn mean_base(ground: &Ground) -> Vec3 {
    let surface = ground.unlit.surface();
    let coarsest = &surface.levels()[surface.last_level()];
    ground.color_of(surface, &coarsest.texel(0, 0))
}
