//! Points that shine: what meshes hide of them from a block's pixels, and what they add to flat
//! pieces, whose suns and sky are baked.
//!
//! A point lights each place from another direction, so nothing of it is baked. The horizon lights the
//! texels of a relief with it as on curved meshes, by their horizons; what is flat is lit place by
//! place. Rays from the relief to the light tell which meshes are in its way.

use super::ground::{Ground, Swept};
use super::hidden_lights::HiddenLights;
use super::places::{FIRST, Places, RAYS, of_lane, places};
use super::shade::{PAIRS_AT_ONCE, ShadeScratch, Shader};
use super::shadows::edges;
use crate::filter::{Batch, Filtered};
use crate::light::FrameLanes;
use crate::light::exact::{LightRay, Occluders, Receiver};
use crate::raster::{LitLanes, QuadBlock};
use crate::relief::HeightField;
use crate::scene::Light;
use crate::shell::Outlined;
use crate::simd::{PixelLanes, set_bits};
use glam::Vec3;
use std::ops::Range;

impl Shader<'_> {
    /// Finds what meshes hide of points from a block's pixels, over a relief if there is one. What is
    /// curved has no `normal`, and no plane below which nothing hides.
    pub(super) fn hide_points(
        &self,
        (field, normal): (Option<&HeightField>, Vec3),
        block: &QuadBlock,
        hidden: &mut HiddenLights,
    ) {
        if !self.prepared.has_points() {
            return;
        }
        let occluders = self.prepared.occluders(self.scene);
        let pixels = block.pairs().map(|pair| {
            let lit = pair.lit()?;
            let LitLanes { normal, tangent_u, tangent_v, is_back, .. } = lit;
            let frame = FrameLanes::new(&normal, &[tangent_u, tangent_v], is_back);
            let places = places((self.scene, &pair), field, &lit, &frame.axes[2]);
            Some((places, frame.is_back.to_bitmask() as u8))
        });
        let Some(pixels) = pixels.collect::<Option<Vec<_>>>() else { return };
        let relief = pixels.iter().flat_map(|(places, _)| {
            set_bits(places.covered).map(|lane| of_lane(&places.relief, lane))
        });
        let Some((first, _)) = pixels.first() else { return };
        let Some(receiver) = Receiver::new(relief, normal, of_lane(&first.polygon, 0)) else {
            return;
        };
        for (light, hidden) in self.scene.lights.iter().zip(&mut hidden.lights) {
            let Light::Point { position, .. } = *light else { continue };
            if occluders.may_hide(&receiver, position) {
                let of = |(places, is_back): &(Places, u8)| {
                    hidden_part((occluders, self.outlined), position, places, *is_back)
                };
                *hidden = pixels.iter().map(of).collect();
            }
        }
    }

    /// What points show of a flat piece's pairs.
    pub(super) fn shine(
        &self,
        ground: &Ground,
        hidden: &HiddenLights,
        block: &QuadBlock,
        scratch: &mut ShadeScratch,
    ) -> Vec<[PixelLanes; 3]> {
        let points = self.scene.lights.iter().take(64).enumerate();
        let points = points.filter(|(_, light)| matches!(light, Light::Point { .. }));
        let lights = points.fold(0_u64, |lights, (i, _)| lights | 1 << i);
        let unlit = Ground { prepared: ground.diffuse, baked: None, ..*ground };
        let mut shown = Vec::with_capacity(block.num_pairs());
        let has_relief = unlit.prepared.field().is_some() && unlit.prepared.surface().has_normals();
        // More lights than bits are lit place by place.
        if has_relief && self.scene.lights.len() <= 64 {
            let points = Swept { lights, has_sky: false, sheen: None };
            self.swept(&unlit, (points, hidden), block, scratch, &mut shown);
        } else {
            for first in (0..block.num_pairs()).step_by(PAIRS_AT_ONCE) {
                let pairs = first..block.num_pairs().min(first + PAIRS_AT_ONCE);
                self.place_by_place(&unlit, hidden, (block, pairs), scratch, &mut shown);
            }
        }
        shown
    }

    /// Appends what pairs show of points where there is no relief.
    fn place_by_place(
        &self,
        ground: &Ground,
        hidden: &HiddenLights,
        (block, pairs): (&QuadBlock, Range<usize>),
        scratch: &mut ShadeScratch,
        colors: &mut Vec<[PixelLanes; 3]>,
    ) {
        let ShadeScratch { filter, footprints, lights, filtered, .. } = scratch;
        self.footprints((ground.prepared, &self.traits.rule), (block, pairs.clone()), footprints);
        lights.clear();
        self.list_lights((block, pairs.clone()), lights);
        hidden.dim(lights, (block, pairs.clone()));
        for lights in lights.iter_mut() {
            lights.occlude(Vec3::ZERO);
            lights.lights.retain(|light| light.is_point);
        }
        filtered.resize(pairs.len(), Filtered::default());
        let batch = Batch { pixels: footprints, lights, ..Batch::default() };
        self.count(self.settings.filter.colors(ground.prepared, &batch, filter, filtered));
        colors.extend(filtered.iter().map(|filtered| ground.tinted(&filtered.color)));
    }
}

/// The parts of pixels from which meshes hide a point.
fn hidden_part(
    (occluders, outlined): (&Occluders, Option<&Outlined>),
    light: Vec3,
    places: &Places,
    is_back: u8,
) -> PixelLanes {
    let mut nums = [0; 8];
    let count = |nums: &mut [usize; 8], lanes: u8, ray: usize| {
        let starts = places.start(ray);
        for lane in set_bits(lanes) {
            let from = of_lane(&starts, lane).as_dvec3();
            let way = light.as_dvec3() - from;
            let distance = way.length();
            let Some(direction) = way.try_normalize() else { continue };
            let reach = f64::from(places.reach.as_array()[lane]);
            let is_turned = is_back >> lane & 1 == 1;
            let ray = LightRay { from, direction, distance, reach, is_turned };
            nums[lane] += usize::from(occluders.hide(&ray, outlined));
        }
    };
    FIRST.into_iter().for_each(|ray| count(&mut nums, places.covered, ray));
    let is = |num: usize| (0..8).fold(0, |bits, i| bits | u8::from(nums[i] == num) << i);
    let edges = edges([is(0), is(FIRST.len())], places.covered);
    if edges != 0 {
        (0..RAYS).filter(|ray| !FIRST.contains(ray)).for_each(|ray| count(&mut nums, edges, ray));
    }
    PixelLanes::new(std::array::from_fn(|lane| {
        let num = if edges >> lane & 1 == 1 { RAYS } else { FIRST.len() };
        nums[lane] as f32 / num as f32
    }))
}
