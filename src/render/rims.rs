//! Pixels at outlines: what they see lies so far apart that no sweep of neighbouring texels holds it.
//!
//! ```text
//!   eye o  ____________ some rays pass above the relief, some hit the first stone, some the next one
//!            .-.  .-.
//!         __/   \/   \__                       each is followed to what it hits
//! ```
//!
//! They are few, one in a hundred of a picture, and are means over rays with the density of the
//! filter's kernel, as the truth is.

use super::curved_lights::CurvedLights;
use super::ground::{Ground, in_lanes, pixel_center};
use super::outlines::Outlines;
use super::strays::strays;
use crate::filter::{Filtered, SampleOffsets, Samples, lit_at, points};
use crate::footprint::{Footprint, Footprints};
use crate::light::SurfacePoint;
use crate::raster::{AttributePlanes, LitLanes, QuadBlock};
use crate::relief::are_at_outline;
use crate::shell::ReliefHit;
use crate::simd::{PixelLanes, bits_mask, set_bits};
use glam::Vec3;
use std::ops::Range;

/// Rays of a pixel. A torus of cobbles at 400x225, 640x360 and 1280x720 has 40.8, 42.1 and 41.4 dB
/// with 8, 41.5, 42.1 and 41.5 with 12, and 40.0, 40.4 and 40.1 where these pixels are swept as others
/// are.
const NUM_RAYS: u32 = 12;

/// The pixels at outlines of pairs of a block.
pub(super) struct Rims<'a> {
    outlines: &'a Outlines<'a>,
    ground: &'a Ground<'a>,
    block: &'a QuadBlock<'a>,
    /// Pairs, counted from the first, and bits of their pixels.
    pixels: Vec<(usize, u8)>,
}

impl<'a> Rims<'a> {
    /// Takes them off the pixels that a filter is to see.
    pub(super) fn take_off(
        (outlines, ground): (&'a Outlines<'a>, &'a Ground<'a>),
        (block, pairs): (&'a QuadBlock<'a>, Range<usize>),
        (footprints, bows): (&mut [Footprints], &[[PixelLanes; 2]]),
    ) -> Self {
        let relief_depth = ground.prepared.surface().relief_depth();
        let mut pixels = Vec::new();
        for (i, ((index, footprints), bow)) in pairs.zip(footprints).zip(bows).enumerate() {
            let pair = block.pair(index);
            let at_outline =
                pair.bend().map_or(0, |bend| are_at_outline(&pair.view(), &bend, relief_depth));
            let rim = footprints.covered & at_outline
                | strays((outlines, ground), &pair, footprints, bow);
            if rim != 0 {
                footprints.covered &= !rim;
                pixels.push((i, rim));
            }
        }
        Self { outlines, ground, block, pixels }
    }

    /// Draws them, where they are lit with the lights of the pairs.
    pub(super) fn draw(
        &self,
        first: usize,
        footprints: &[Footprints],
        lights: Option<&CurvedLights>,
        out: &mut [Filtered],
    ) {
        if self.pixels.is_empty() {
            return;
        }
        let samples = Samples { num: NUM_RAYS, is_exact: true }.offsets();
        for &(i, rim) in &self.pixels {
            let pair = self.block.pair(first + i);
            for lane in set_bits(rim) {
                let planes = pair.planes[lane / 4];
                let center = pixel_center(&pair, lane);
                let size = self.texel_size(&footprints[i].lane(lane));
                let lights = lights.map(|lights| (lights, [i, lane]));
                let color = self.color((planes, center), (&samples, size), lights);
                (0..3).for_each(|c| out[i].color[c].as_mut_array()[lane] = color[c]);
            }
        }
    }

    /// The size of the texels that its rays read, in those of the base level: the footprint is as wide
    /// as it is across the outline only where it looks down on the relief, and as it is along it
    /// everywhere.
    fn texel_size(&self, pixel: &Footprint) -> f32 {
        let level = self.ground.prepared.surface().base();
        let [[a, b], [c, d]] = [pixel.dx, pixel.dy].map(|derivative| level.in_texels(derivative));
        let squared = (a * a + b * b).max(c * c + d * d).max(f32::MIN_POSITIVE);
        (a * d - b * c).abs() / (squared * NUM_RAYS as f32).sqrt()
    }

    /// The mean of what rays around a place of the screen hit.
    fn color(
        &self,
        (planes, [x, y]): (&AttributePlanes, [f32; 2]),
        (samples, size): (&SampleOffsets, f32),
        lights: Option<(&CurvedLights, [usize; 2])>,
    ) -> Vec3 {
        let prepared = self.ground.prepared;
        let (mut sum, mut num_hits) = (Vec3::ZERO, 0.0_f32);
        for &([dx, dy], num) in &samples.groups {
            let places = ([dx + x, dy + y], num);
            let Some(hits) = self.ground.hits(self.outlines, planes, places) else { continue };
            let lights = lights.and_then(|(lights, pixel)| {
                let shone = lights.at_hits(&self.lit(planes.triangle[0], &hits), pixel);
                let horizons = prepared.horizons(lights.of(&shone).shine.is_some())?;
                Some((lights, shone, horizons))
            });
            for (lane, hit) in hits.iter().enumerate() {
                let Some(hit) = hit else { continue };
                let place = hit.place.uv.map(|c| c as f32);
                let texel = points::trilinear(prepared.surface(), place, size);
                let mut color = Vec3::from(texel.color);
                if let Some((lights, shone, horizons)) = &lights {
                    let at = (place, hit.place.depth as f32, &texel);
                    let curved = lights.of(shone);
                    let lit = lit_at((&curved, lane), (horizons, prepared.surface()), at);
                    color = Vec3::from(lit);
                }
                (sum, num_hits) = (sum + color, num_hits + 1.0);
            }
        }
        // Where no ray hits, the pixel's own would have: rounding decided.
        sum / num_hits.max(1.0)
    }

    /// The polygons above hits.
    fn lit(&self, mesh: u32, hits: &[Option<ReliefHit>; 8]) -> LitLanes {
        let points = hits.map(|hit| hit.map(|hit| self.outlines.point(mesh, &hit)));
        let lanes = |of: fn(&SurfacePoint) -> Vec3| -> [PixelLanes; 3] {
            in_lanes(&points.map(|point| point.as_ref().map_or(Vec3::Z, of)))
        };
        LitLanes {
            position: lanes(|point| point.position),
            normal: lanes(|point| point.normal),
            tangent_u: lanes(|point| point.tangents[0]),
            tangent_v: lanes(|point| point.tangents[1]),
            is_back: {
                let is_back = |point: &Option<SurfacePoint>| point.is_some_and(|p| p.is_back);
                bits_mask((0..8).map(|i| u8::from(is_back(&points[i])) << i).sum())
            },
        }
    }
}
