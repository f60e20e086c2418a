//! Pixels under the truth's light: every sample of the screen is lit by rays from its own hit.

use super::ground::{Ground, clearance, eval, in_lanes, of_hits, pixel_center, surface_point};
use super::outlines::Outlines;
use crate::filter::{Batch, Filtered, SampleOffsets, Scratch};
use crate::footprint::{Footprint, FootprintRule, Footprints};
use crate::light::SurfacePoint;
use crate::light::exact::{ExactLight, Hit, Sequence, Spot};
use crate::raster::{AttributePlanes, QuadPair};
use crate::scene::Material;
use crate::settings::Filter;
use crate::simd::{PixelLanes, set_bits};
use glam::Vec3;

/// Eight samples of a pixel, as they lie on the screen.
struct Samples<'a> {
    planes: &'a AttributePlanes,
    x: PixelLanes,
    y: PixelLanes,
    num: usize,
    /// The number of the first in the pixel.
    first: u32,
    sequence: Sequence,
}

/// Draws pixels of one material by samples that are each lit exactly.
pub(super) struct Exact<'a> {
    pub(super) light: &'a ExactLight<'a>,
    pub(super) samples: &'a SampleOffsets,
    pub(super) filter: &'a Filter,
    /// Whether its rays are followed to the relief.
    pub(super) is_traced: bool,
    pub(super) material: &'a Material,
    /// The material's texture, if it has one.
    pub(super) ground: Option<Ground<'a>>,
    /// Where rays end on curved meshes.
    pub(super) outlines: Option<&'a Outlines<'a>>,
}

impl Exact<'_> {
    /// The colours of a pair of quads.
    pub(super) fn colors(&self, pair: &QuadPair, scratch: &mut Scratch) -> [PixelLanes; 3] {
        let mut colors = [Vec3::ZERO; 8];
        let none = [PixelLanes::ZERO; 3];
        let pixels =
            Footprints::of_quads(&pair.uv, &none, None, &FootprintRule::FLAT, pair.covered_bits());
        for lane in pair.covered() {
            let [center_x, center_y] = pixel_center(pair, lane);
            let sequence = Sequence::of_pixel(pair.pixel(lane));
            let (mut sum, mut num_found) = (Vec3::ZERO, 0.0);
            for (i, &([dx, dy], num)) in self.samples.groups.iter().enumerate() {
                let (x, y) = (dx + center_x, dy + center_y);
                let (planes, first) = (pair.planes[lane / 4], 8 * i as u32);
                let samples = Samples { planes, x, y, num, first, sequence };
                let (color, num) = match &self.ground {
                    Some(ground) => self.on_texture(ground, &samples, &pixels.lane(lane), scratch),
                    None => self.plain(&samples),
                };
                (sum, num_found) = (sum + color, num_found + num);
            }
            // A pixel none of whose rays meets the surface is black and not NaN.
            colors[lane] = sum / f32::max(num_found, 1.0);
        }
        in_lanes(&colors)
    }

    /// The sum of the colours of samples on a texture, and how many there are.
    fn on_texture(
        &self,
        ground: &Ground,
        samples: &Samples,
        pixel: &Footprint,
        scratch: &mut Scratch,
    ) -> (Vec3, f32) {
        let Samples { planes, x, y, num, .. } = *samples;
        let hits = self.outlines.and_then(|all| ground.hits(all, planes, ([x, y], num)));
        let rays = match &hits {
            Some(hits) => of_hits(hits, pixel),
            None => ground.rays(planes, ([x, y], num), (pixel, self.is_traced)),
        };
        let mut texels = [Filtered::default()];
        let batch = Batch { pixels: &[rays], ..Batch::default() };
        self.filter.colors(ground.prepared, &batch, scratch, &mut texels);
        let [texels] = texels;
        let point = |lane: usize| {
            let (outlines, hit) = (self.outlines?, hits.as_ref()?[lane].as_ref()?);
            Some(outlines.point(planes.triangle[0], hit))
        };
        self.sum(samples, rays.covered, point, |lane| {
            let (texel, ray) = (texels.lane(lane), rays.lane(lane));
            let albedo = ground.color_of(ground.prepared.surface(), &texel);
            let (relief, normal) = (ground.prepared.field(), Vec3::from(texel.normal));
            Spot { relief, base: ray.base, place: ray.hit, albedo, normal }
        })
    }

    /// The sum of the colours of samples without a texture, and how many there are.
    fn plain(&self, samples: &Samples) -> (Vec3, f32) {
        let Samples { planes, x, y, num, .. } = *samples;
        let is_before = eval(&planes.inverse_w, x, y).simd_gt(PixelLanes::ZERO).to_bitmask() as u8;
        let wanted = (0xff_u16 >> (8 - num)) as u8;
        let (base, albedo, normal) = ([0.0; 2], self.material.base_color, Vec3::Z);
        let spot = Spot { relief: None, base, place: base, albedo, normal };
        self.sum(samples, is_before & wanted, |_| None, |_| spot)
    }

    /// The sum of the colours of the samples that see a surface, one by one in their order, so that
    /// the bits are always equal.
    fn sum<'a>(
        &self,
        samples: &Samples,
        covered: u8,
        point: impl Fn(usize) -> Option<SurfacePoint>,
        spot: impl Fn(usize) -> Spot<'a>,
    ) -> (Vec3, f32) {
        let (mut sum, mut num_found) = (Vec3::ZERO, 0.0);
        for lane in set_bits(covered) {
            let place = [samples.x.as_array()[lane], samples.y.as_array()[lane]];
            // Planes of lit frames have all that makes a point.
            let of_polygon = || surface_point(samples.planes, place);
            let Some(point) = point(lane).or_else(of_polygon) else { continue };
            let spot = spot(lane);
            let finish = self.material.finish(|map| map.at(spot.place));
            let on = (samples.planes, spot.relief);
            let clearance = clearance(self.light.scene, on, (place, &point));
            let hit = Hit { point, clearance, finish, spot };
            sum += self.light.shade(&hit, &samples.sequence, samples.first + lane as u32);
            num_found += 1.0;
        }
        (sum, num_found)
    }
}
