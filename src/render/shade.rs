//! The colours of a block of quads: footprints, filter, light.

use super::prepared::{Ground, PreparedScene};
use crate::filter::{Batch, Filtered, Prepared, SampleOffsets, Scratch, Traits, Work};
use crate::footprint::{Footprint, FootprintRule, Footprints};
use crate::light::{LocalLights, SurfacePoint};
use crate::raster::{AttributePlanes, LitPlanes, Plane, Pool, QuadBlock, QuadPair};
use crate::scene::{Material, Scene};
use crate::settings::{Lighting, Settings};
use crate::simd::PixelLanes;
use crate::texture::{FULL_F32, Texel};
use glam::Vec3;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Most pairs of quads whose footprints are made at once: they stay in the first cache, and are a
/// whole number of the horizon's patches.
const PAIRS_AT_ONCE: usize = 64;

/// Groups of eight samples whose rays are filtered at once, for each pixel of a pair: as many
/// footprints as those of pairs.
const GROUPS_AT_ONCE: usize = PAIRS_AT_ONCE / 8;

type Colors = Vec<[PixelLanes; 3]>;

/// Shades quads of a frame.
pub(crate) struct Shader<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
    prepared: &'a PreparedScene,
    traits: Traits,
    pool: &'a Pool<ShadeScratch>,
    num_texels: [AtomicU64; 2],
}

/// Buffers of shading, kept between blocks.
#[derive(Debug, Default)]
pub(crate) struct ShadeScratch {
    filter: Scratch,
    footprints: Vec<Footprints>,
    lights: Vec<LocalLights>,
    filtered: Vec<Filtered>,
}

impl<'a> Shader<'a> {
    pub(crate) fn new(
        scene: &'a Scene,
        settings: &'a Settings,
        prepared: &'a PreparedScene,
        pool: &'a Pool<ShadeScratch>,
    ) -> Self {
        let traits = settings.filter.traits();
        Self { scene, settings, prepared, traits, pool, num_texels: Default::default() }
    }

    /// What filtering took so far.
    pub(super) fn work(&self) -> Work {
        // Relaxed is enough: the counts are read when all tiles are done.
        let [num_tested, num_averaged] =
            self.num_texels.each_ref().map(|num| num.load(Ordering::Relaxed));
        Work { num_tested, num_averaged }
    }

    /// Appends the linear colours of a block's pairs; those of helper lanes are anything.
    pub(super) fn shade(&self, block: &QuadBlock, colors: &mut Colors) {
        let index = [block.material, block.group];
        let Some(ground) = self.prepared.ground(self.scene, self.settings, index) else {
            let material = &self.scene.materials[block.material];
            return colors.extend(block.pairs().map(|pair| self.plain(&pair, material)));
        };
        let mut scratch = self.pool.take();
        if let Some(samples) = &self.traits.samples {
            return colors.extend(
                block.pairs().map(|pair| self.sampled(&ground, &pair, samples, &mut scratch)),
            );
        }
        for first in (0..block.num_pairs()).step_by(PAIRS_AT_ONCE) {
            let end = block.num_pairs().min(first + PAIRS_AT_ONCE);
            self.filtered(&ground, (block, first..end), &mut scratch, colors);
        }
    }

    /// Pixels of a material without a texture.
    fn plain(&self, pair: &QuadPair, material: &Material) -> [PixelLanes; 3] {
        let mut colors = [Vec3::ZERO; 8];
        // Helper lanes stay black: nothing adds them to a pixel.
        for lane in pair.covered() {
            colors[lane] = match self.lights_at(pair, lane, pixel_center(pair, lane)) {
                Some(lights) => {
                    // Nothing bends the normal here: it is z in the surface's own frame.
                    material.diffuse * lights.diffuse(Vec3::Z, &self.scene.sky)
                        + lights.specular(Vec3::Z, material)
                }
                None => material.diffuse,
            };
        }
        in_lanes(&colors)
    }

    /// Pixels by a filter that takes a footprint for a pixel.
    fn filtered(
        &self,
        ground: &Ground,
        (block, pairs): (&QuadBlock, Range<usize>),
        scratch: &mut ShadeScratch,
        colors: &mut Colors,
    ) {
        let ShadeScratch { filter, footprints, lights, filtered } = scratch;
        lights.clear();
        // Find where the pixels lie in the texture.
        self.footprints(ground.prepared, (block, pairs.clone()), footprints);
        // List the lights of covered pixels alone, pair by pair and lane by lane.
        if ground.is_lit {
            let pairs = pairs.clone().map(|index| block.pair(index));
            lights.extend(pairs.flat_map(|pair| {
                pair.covered()
                    .filter_map(move |lane| self.lights_at(&pair, lane, pixel_center(&pair, lane)))
            }));
        }
        // Filter all pairs at once, so that pixels near each other can share work.
        // Whatever an earlier block left stays: each covered pixel is written, others are not looked at.
        filtered.resize(pairs.len(), Filtered::default());
        let batch = Batch { pixels: footprints, lights, is_alone: false };
        self.count(self.settings.filter.colors(ground.prepared, &batch, filter, filtered));
        if ground.is_lit {
            // Light the means; the lights come in the order in which they were listed.
            let mut lights = lights.iter();
            colors.extend(footprints.iter().zip(filtered.iter()).map(|(pixels, filtered)| {
                let mut colors = [Vec3::ZERO; 8];
                for (lane, lights) in pixels.covered().zip(&mut lights) {
                    colors[lane] = self.lit(ground, &filtered.lane(lane), Some(lights));
                }
                in_lanes(&colors)
            }));
        } else {
            colors.extend(filtered.iter().map(|filtered| ground.tinted(&filtered.color)));
        }
    }

    /// The footprints of pairs of a block, as the filter wants them.
    pub(crate) fn footprints(
        &self,
        prepared: &Prepared,
        (block, pairs): (&QuadBlock, Range<usize>),
        footprints: &mut Vec<Footprints>,
    ) {
        let field = prepared.field();
        footprints.clear();
        if let Some(field) = field.filter(|_| self.traits.rule.is_traced) {
            footprints.extend(pairs.map(|index| {
                let pair = block.pair(index);
                Footprints::before_hits(&pair.uv, &pair.view(), field, pair.covered_bits())
            }));
            return Footprints::find_hits(footprints, field, &self.traits.rule);
        }
        footprints.extend(pairs.map(|index| {
            let pair = block.pair(index);
            // Where there is no relief, the view changes nothing and is not computed.
            let view = if field.is_some() { pair.view() } else { [PixelLanes::ZERO; 3] };
            Footprints::of_quads(&pair.uv, &view, field, &self.traits.rule, pair.covered_bits())
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
            self.cast(ground, pair, (groups, samples.is_lit_apart), scratch);
            let ShadeScratch { filter, footprints, lights, filtered } = &mut *scratch;
            filtered.resize(footprints.len(), Filtered::default());
            let batch = Batch { pixels: footprints, lights, is_alone: false };
            self.count(self.settings.filter.colors(ground.prepared, &batch, filter, filtered));
            // Sum up what the samples see, one by one in their order, so that the bits are always
            // equal.
            let mut lights = lights.iter();
            let mut found = footprints.iter().zip(filtered.iter());
            for lane in pair.covered() {
                for (rays, filtered) in found.by_ref().take(groups.len()) {
                    for i in rays.covered() {
                        sums[lane] += self.lit(ground, &filtered.lane(i), lights.next());
                        nums[lane] += 1.0;
                    }
                }
            }
        }
        // A pixel none of whose rays meets the surface is black and not NaN.
        in_lanes(&std::array::from_fn(|lane| sums[lane] / f32::max(nums[lane], 1.0)))
    }

    /// The rays of groups of samples and, under lights, what shines on each: of one covered pixel
    /// of a pair after the other. Lights are those where a ray lies on the screen, or where its
    /// pixel's centre does.
    fn cast(
        &self,
        ground: &Ground,
        pair: &QuadPair,
        (groups, is_lit_apart): (&[([PixelLanes; 2], usize)], bool),
        scratch: &mut ShadeScratch,
    ) {
        let ShadeScratch { footprints, lights, .. } = scratch;
        footprints.clear();
        lights.clear();
        let none = [PixelLanes::ZERO; 3];
        // All samples share their pixel's derivatives, those of the flat polygon.
        let pixels =
            Footprints::of_quads(&pair.uv, &none, None, &FootprintRule::FLAT, pair.covered_bits());
        for lane in pair.covered() {
            let [center_x, center_y] = pixel_center(pair, lane);
            for &([dx, dy], num_samples) in groups {
                let (x, y) = (dx + center_x, dy + center_y);
                let planes = pair.planes[lane / 4];
                let rays = self.rays(ground, planes, ([x, y], num_samples), &pixels.lane(lane));
                if ground.is_lit {
                    lights.extend(rays.covered().filter_map(|i| {
                        let own = [x.as_array()[i], y.as_array()[i]];
                        let place = if is_lit_apart { own } else { [center_x, center_y] };
                        self.lights_at(pair, lane, place)
                    }));
                }
                footprints.push(rays);
            }
        }
    }

    /// The rays of up to eight samples of a pixel through places on the screen.
    fn rays(
        &self,
        ground: &Ground,
        planes: &AttributePlanes,
        ([x, y], num_samples): ([PixelLanes; 2], usize),
        pixel: &Footprint,
    ) -> Footprints {
        // Beyond the horizon there is no surface to sample.
        let is_before = eval(&planes.inverse_w, x, y).simd_gt(PixelLanes::ZERO).to_bitmask() as u8;
        // The last group may hold fewer than eight samples.
        let covered = is_before & (0xff_u16 >> (8 - num_samples)) as u8;
        let (uv, view) = planes.at(x, y);
        let field = ground.prepared.field();
        Footprints::of_samples((&uv, &view), field, self.traits.rule.is_traced, pixel, covered)
    }

    fn is_lit(&self) -> bool {
        self.settings.lighting == Lighting::Lit
    }

    fn count(&self, work: Work) {
        self.num_texels[0].fetch_add(work.num_tested, Ordering::Relaxed);
        self.num_texels[1].fetch_add(work.num_averaged, Ordering::Relaxed);
    }

    /// The colour of a filtered texel.
    fn lit(&self, ground: &Ground, texel: &Texel, lights: Option<&LocalLights>) -> Vec3 {
        let color = Vec3::from(texel.color) * ground.material.diffuse * ground.scale();
        let Some(lights) = lights else { return color };
        let normal = Vec3::from(texel.normal);
        let specular = lights.specular(normal, ground.material);
        // Such a filter has the diffuse light in its mean, texel by texel; the highlight is left.
        if self.traits.asks_for_lights {
            color + specular
        } else {
            color * lights.diffuse(normal, &self.scene.sky) + specular
        }
    }

    /// The lights at a place on the screen, if there is lighting.
    fn lights_at(&self, pair: &QuadPair, lane: usize, [x, y]: [f32; 2]) -> Option<LocalLights> {
        let planes: &AttributePlanes = pair.planes[lane / 4];
        let lit = planes.lit.as_deref().filter(|_| self.is_lit())?;
        let [a, b, c] = planes.inverse_w;
        // Divided once for all twelve coordinates.
        let w = 1.0 / (a * x + b * y + c);
        let at = |planes: &[Plane; 3]| Vec3::from(planes.map(|[a, b, c]| (a * x + b * y + c) * w));
        let LitPlanes { position, normal, tangent_u, tangent_v } = lit;
        let point = SurfacePoint {
            position: at(position),
            normal: at(normal),
            tangents: [at(tangent_u), at(tangent_v)],
        };
        let Scene { camera, lights, sky, .. } = self.scene;
        Some(LocalLights::at(&point, camera.eye, lights, sky))
    }
}

impl Ground<'_> {
    /// What the unit of stored colours is worth.
    fn scale(&self) -> f32 {
        self.prepared.surface().color_scale() / FULL_F32
    }

    /// Stored colours as the material shows them.
    #[inline(always)]
    fn tinted(&self, stored: &[PixelLanes; 3]) -> [PixelLanes; 3] {
        // Products in the order of `lit`, so that a colour without light has the same bits in both.
        let scale = self.scale();
        std::array::from_fn(|c| stored[c] * self.material.diffuse[c] * scale)
    }
}

fn in_lanes(colors: &[Vec3; 8]) -> [PixelLanes; 3] {
    [0, 1, 2].map(|c| PixelLanes::new(colors.map(|color| color[c])))
}

fn eval([a, b, c]: &Plane, x: PixelLanes, y: PixelLanes) -> PixelLanes {
    x * *a + y * *b + *c
}

/// Where a lane's pixel has its centre on the screen.
fn pixel_center(pair: &QuadPair, lane: usize) -> [f32; 2] {
    let [x, y] = pair.pixel(lane);
    [x as f32 + 0.5, y as f32 + 0.5]
}
