//! The colours of a block of quads: footprints, filter, light.

use super::bows::find_bows;
use super::curved_lights::CurvedLights;
use super::exact::Exact;
use super::ground::{Ground, in_lanes, of_hits, pixel_center};
use super::hidden_lights::HiddenLights;
use super::mapped::Glow;
use super::outlines::Outlines;
use super::prepared::PreparedScene;
use super::rims::Rims;
use crate::filter::{
    Batch, Filtered, Prepared, Reads, SampleOffsets, Samples, Scratch, Traits, Work,
};
use crate::footprint::{FootprintRule, Footprints};
use crate::light::LocalLights;
use crate::light::exact::ExactLight;
use crate::raster::{Pool, QuadBlock, QuadPair};
use crate::scene::Scene;
use crate::settings::{Lighting, Settings};
use crate::shell::Outlined;
use crate::simd::PixelLanes;
use glam::Vec3;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Most pairs of quads whose footprints are made at once: they stay in the first cache, and are a
/// whole number of the horizon's patches.
pub(super) const PAIRS_AT_ONCE: usize = 64;

/// Groups of eight samples whose rays are filtered at once, for each pixel of a pair: as many
/// footprints as those of pairs.
const GROUPS_AT_ONCE: usize = PAIRS_AT_ONCE / 8;

type Colors = Vec<[PixelLanes; 3]>;

/// Shades quads of a frame.
pub(crate) struct Shader<'a> {
    pub(super) scene: &'a Scene,
    pub(super) settings: &'a Settings,
    pub(super) prepared: &'a PreparedScene,
    pub(crate) traits: Traits,
    /// Where rays go, where there are many a pixel.
    samples: Option<SampleOffsets>,
    /// What lights each sample by itself, where that is asked for.
    exact: Option<ExactLight<'a>>,
    /// Where rays end on curved meshes; `None` where all reliefs are taken for flat.
    outlines: Option<&'a Outlines<'a>>,
    /// The meshes that throw the shadow of their relief.
    pub(super) outlined: Option<&'a Outlined<'a>>,
    /// Whether any mesh has colours of its own.
    has_tints: bool,
    pool: &'a Pool<ShadeScratch>,
    num_texels: [AtomicU64; 2],
}

/// Buffers of shading, kept between blocks.
#[derive(Debug, Default)]
pub(crate) struct ShadeScratch {
    pub(super) filter: Scratch,
    pub(super) footprints: Vec<Footprints>,
    pub(super) lights: Vec<LocalLights>,
    pub(super) filtered: Vec<Filtered>,
    bows: Vec<[PixelLanes; 2]>,
}

impl<'a> Shader<'a> {
    pub(crate) fn new(
        scene: &'a Scene,
        settings: &'a Settings,
        prepared: &'a PreparedScene,
        outlines: Option<&'a Outlines<'a>>,
        pool: &'a Pool<ShadeScratch>,
    ) -> Self {
        let traits = settings.filter.traits();
        let is_exact = settings.lighting == Lighting::Lit
            && traits.samples.is_some_and(|samples| samples.is_exact);
        let outlined = outlines.and_then(Outlines::outlined);
        let occluders = || prepared.occluders(scene);
        let exact = is_exact.then(|| ExactLight { scene, occluders: occluders(), outlined });
        let samples = traits.samples.map(Samples::offsets);
        Self {
            scene,
            settings,
            prepared,
            traits,
            samples,
            exact,
            outlines,
            outlined,
            has_tints: scene.meshes.iter().any(|mesh| !mesh.colors.is_empty()),
            pool,
            num_texels: Default::default(),
        }
    }

    /// What filtering took so far.
    pub(super) fn work(&self) -> Work {
        // Relaxed is enough: the counts are read when all tiles are done.
        let [num_tested, num_averaged] =
            self.num_texels.each_ref().map(|num| num.load(Ordering::Relaxed));
        Work { num_tested, num_averaged }
    }

    /// Appends the linear colours of a block's pairs; those of helper lanes are anything.
    pub(crate) fn shade(&self, block: &QuadBlock, colors: &mut Colors) {
        let material = &self.scene.materials[block.material];
        let index = [block.material, block.group];
        let ground = self.prepared.ground(self.scene, self.settings, index);
        let mut scratch = self.pool.take();
        if let (Some(samples), Some(light)) = (&self.samples, &self.exact) {
            let (filter, is_traced) = (&self.settings.filter, self.traits.rule.is_traced);
            let outlines = self.outlines;
            let exact = Exact { light, samples, filter, is_traced, material, ground, outlines };
            return colors.extend(block.pairs().map(|pair| {
                let mut color = [exact.colors(&pair, &mut scratch.filter)];
                tint(std::iter::once(pair), &mut color);
                color[0]
            }));
        }
        let Some(ground) = ground else {
            return self.plain(block, material, colors);
        };
        let start = colors.len();
        let num_lights = if ground.is_lit { self.scene.lights.len() } else { 0 };
        let mut hidden = HiddenLights::none(num_lights);
        // What only sends out light sends out its colour.
        let is_glowing = material.base_color == Vec3::ZERO;
        let field = ground.prepared.field();
        if let Some(swept) = ground.swept {
            self.hide_on_curved(field, block, &mut hidden);
            self.hide_points((field, Vec3::ZERO), block, &mut hidden);
            self.swept(&ground, (swept, &hidden), block, &mut scratch, colors);
        } else if ground.asks_for_lights() {
            let hidden = self.hidden_by_place(field, block);
            let ground = Ground { hidden: hidden.as_ref(), ..ground };
            self.textured(&ground, block, &mut scratch, colors);
        } else {
            self.textured(&ground, block, &mut scratch, colors);
        }
        let colors = &mut colors[start..];
        // What points show of flat pieces is not seen through what lies above its colour yet.
        let mut of_points = Vec::new();
        if let Some(lit) = ground.baked {
            self.shadow((&ground, &lit), block, &mut scratch, &mut hidden, colors);
            if self.prepared.has_points() {
                self.hide_points((field, lit.normal), block, &mut hidden);
                of_points = self.shine(&ground, &hidden, block, &mut scratch);
            }
        }
        if self.has_tints && !is_glowing {
            tint(block.pairs(), colors);
            tint(block.pairs(), &mut of_points);
        }
        if ground.baked.is_some() || ground.swept.is_some() {
            self.reflect((&ground, &hidden), block, &mut scratch, (colors, of_points));
        }
        if let Some(glow) = ground.glow {
            self.glow(&ground, glow, block, &mut scratch, colors);
        }
        if self.has_tints && is_glowing {
            tint(block.pairs(), colors);
        }
    }

    /// Adds what a surface sends out by a texture.
    fn glow(
        &self,
        ground: &Ground,
        Glow { material, prepared }: &Glow,
        block: &QuadBlock,
        scratch: &mut ShadeScratch,
        colors: &mut [[PixelLanes; 3]],
    ) {
        let unlit = Ground { is_lit: false, swept: None, baked: None, glow: None, ..*ground };
        let mut sent = Vec::with_capacity(colors.len());
        let sending = Ground { material, prepared, unlit: prepared, diffuse: prepared, ..unlit };
        self.textured(&sending, block, scratch, &mut sent);
        for (color, sent) in colors.iter_mut().zip(&sent) {
            (0..3).for_each(|c| color[c] += sent[c]);
        }
    }

    /// Pixels of a material with a texture.
    pub(super) fn textured(
        &self,
        ground: &Ground,
        block: &QuadBlock,
        scratch: &mut ShadeScratch,
        colors: &mut Colors,
    ) {
        if let Some(samples) = &self.samples {
            return colors
                .extend(block.pairs().map(|pair| self.sampled(ground, &pair, samples, scratch)));
        }
        for first in (0..block.num_pairs()).step_by(PAIRS_AT_ONCE) {
            let end = block.num_pairs().min(first + PAIRS_AT_ONCE);
            self.filtered(ground, (block, first..end), scratch, colors);
        }
    }

    /// Pixels by a filter that takes a footprint for a pixel.
    fn filtered(
        &self,
        ground: &Ground,
        (block, pairs): (&QuadBlock, Range<usize>),
        scratch: &mut ShadeScratch,
        colors: &mut Colors,
    ) {
        let ShadeScratch { filter, footprints, lights, filtered, bows } = scratch;
        lights.clear();
        // Find where the pixels lie in the texture.
        let with = (ground.prepared, &self.traits.rule);
        self.footprints(with, (block, pairs.clone()), footprints);
        if ground.asks_for_lights() {
            self.list_lights((block, pairs.clone()), lights);
            if let Some(hidden) = ground.hidden {
                hidden.dim(lights, (block, pairs.clone()));
            }
            ground.occlude(footprints, lights);
        }
        // Filter all pairs at once, so that pixels near each other can share work.
        // Whatever an earlier block left stays: each covered pixel is written, others are not looked at.
        filtered.resize(pairs.len(), Filtered::default());
        let curved_lights = ground.swept.map(|swept| {
            let mut lights = CurvedLights::new(
                (self.scene, self.prepared),
                (swept, ground.prepared.surface().relief_depth()),
                block,
                pairs.clone(),
            );
            lights.occlude(ground, footprints);
            lights
        });
        bows.clear();
        if let (Reads::Seen { .. }, Some(field)) = (self.traits.reads, ground.prepared.field()) {
            find_bows(field, (block, pairs.clone()), footprints, bows);
        }
        let outlines = self.outlines.filter(|_| !bows.is_empty() && !ground.asks_for_lights());
        let rims = outlines.map(|outlines| {
            let pairs = (block, pairs.clone());
            Rims::take_off((outlines, ground), pairs, (&mut *footprints, bows))
        });
        let curved = curved_lights.as_ref().map(CurvedLights::all);
        let curved = curved.as_ref();
        let batch = Batch { pixels: footprints, lights, curved, bows, ..Batch::default() };
        self.count(self.settings.filter.colors(ground.prepared, &batch, filter, filtered));
        if let Some(rims) = rims {
            rims.draw(pairs.start, footprints, curved_lights.as_ref(), filtered);
        }
        if ground.asks_for_lights() {
            // Light the means; the lights come in the order in which they were listed.
            let mut lights = lights.iter();
            colors.extend(footprints.iter().zip(filtered.iter()).map(|(pixels, filtered)| {
                let mut colors = [Vec3::ZERO; 8];
                for (lane, lights) in pixels.covered().zip(&mut lights) {
                    let pixel = pixels.lane(lane);
                    colors[lane] = self.lit(ground, (&filtered.lane(lane), &pixel), Some(lights));
                }
                in_lanes(&colors)
            }));
        } else {
            colors.extend(filtered.iter().map(|filtered| ground.tinted(&filtered.color)));
        }
    }

    /// The footprints of pairs of a block, by a rule.
    pub(crate) fn footprints(
        &self,
        (prepared, rule): (&Prepared, &FootprintRule),
        (block, pairs): (&QuadBlock, Range<usize>),
        footprints: &mut Vec<Footprints>,
    ) {
        let field = prepared.field();
        footprints.clear();
        if let Some(field) = field.filter(|_| rule.is_traced) {
            footprints.extend(pairs.map(|index| {
                let (pair, view) = (block.pair(index), block.pair(index).view());
                let pixels = Footprints::before_hits(&pair.uv, &view, field, pair.covered_bits());
                match pair.bend() {
                    Some(bend) => pixels.bent(&view, &bend, field),
                    None => pixels,
                }
            }));
            return Footprints::find_hits(footprints, field, rule);
        }
        footprints.extend(pairs.map(|index| {
            let pair = block.pair(index);
            // Where there is no relief, the view changes nothing and is not computed.
            let view = if field.is_some() { pair.view() } else { [PixelLanes::ZERO; 3] };
            let pixels = Footprints::of_quads(&pair.uv, &view, field, rule, pair.covered_bits());
            match (pair.bend(), field) {
                (Some(bend), Some(field)) => pixels.bent(&view, &bend, field),
                _ => pixels,
            }
        }));
    }

    /// Pixels that are means over samples of the screen, each with a ray of its own and shaded on
    /// its own.
    fn sampled(
        &self,
        ground: &Ground,
        pair: &QuadPair,
        samples: &SampleOffsets,
        scratch: &mut ShadeScratch,
    ) -> [PixelLanes; 3] {
        let (mut sums, mut nums) = ([Vec3::ZERO; 8], [0.0; 8]);
        for groups in samples.groups.chunks(GROUPS_AT_ONCE) {
            self.cast(ground, pair, groups, scratch);
            let ShadeScratch { filter, footprints, lights, filtered, .. } = &mut *scratch;
            ground.occlude(footprints, lights);
            filtered.resize(footprints.len(), Filtered::default());
            let batch = Batch { pixels: footprints, lights, ..Batch::default() };
            self.count(self.settings.filter.colors(ground.prepared, &batch, filter, filtered));
            // Sum up what the samples see, one by one in their order, so that the bits are always
            // equal.
            let mut lights = lights.iter();
            let mut found = footprints.iter().zip(filtered.iter());
            for lane in pair.covered() {
                for (rays, filtered) in found.by_ref().take(groups.len()) {
                    for i in rays.covered() {
                        let (texel, ray) = (filtered.lane(i), rays.lane(i));
                        sums[lane] += self.lit(ground, (&texel, &ray), lights.next());
                        nums[lane] += 1.0;
                    }
                }
            }
        }
        // A pixel none of whose rays meets the surface is black and not NaN.
        in_lanes(&std::array::from_fn(|lane| sums[lane] / f32::max(nums[lane], 1.0)))
    }

    /// The rays of groups of samples and, under lights, what shines on each: of one covered pixel
    /// of a pair after the other. Lights are those at the pixel's centre, as shaders have them.
    fn cast(
        &self,
        ground: &Ground,
        pair: &QuadPair,
        groups: &[([PixelLanes; 2], usize)],
        scratch: &mut ShadeScratch,
    ) {
        let ShadeScratch { footprints, lights, .. } = scratch;
        footprints.clear();
        lights.clear();
        let none = [PixelLanes::ZERO; 3];
        // All samples share their pixel's derivatives, those of the flat polygon.
        let pixels =
            Footprints::of_quads(&pair.uv, &none, None, &FootprintRule::FLAT, pair.covered_bits());
        // Only the truth follows rays over curved surfaces; to others all is flat.
        let is_exact = self.traits.samples.is_some_and(|samples| samples.is_exact);
        let outlines = self.outlines.filter(|_| is_exact);
        for lane in pair.covered() {
            let [center_x, center_y] = pixel_center(pair, lane);
            for &([dx, dy], num_samples) in groups {
                let (x, y) = (dx + center_x, dy + center_y);
                let planes = pair.planes[lane / 4];
                let hits = outlines.and_then(|all| ground.hits(all, planes, ([x, y], num_samples)));
                let rays = match hits {
                    Some(hits) => of_hits(&hits, &pixels.lane(lane)),
                    None => ground.rays(
                        planes,
                        ([x, y], num_samples),
                        (&pixels.lane(lane), self.traits.rule.is_traced),
                    ),
                };
                if ground.asks_for_lights() {
                    let center = [center_x, center_y];
                    lights
                        .extend(rays.covered().filter_map(|_| self.lights_at(pair, lane, center)));
                }
                footprints.push(rays);
            }
        }
    }

    pub(super) fn count(&self, work: Work) {
        self.num_texels[0].fetch_add(work.num_tested, Ordering::Relaxed);
        self.num_texels[1].fetch_add(work.num_averaged, Ordering::Relaxed);
    }
}

/// Multiplies colours by those of the meshes.
fn tint<'a>(pairs: impl Iterator<Item = QuadPair<'a>>, colors: &mut [[PixelLanes; 3]]) {
    for (color, pair) in colors.iter_mut().zip(pairs) {
        if let Some(tint) = pair.tint() {
            *color = std::array::from_fn(|c| color[c] * tint[c]);
        }
    }
}
