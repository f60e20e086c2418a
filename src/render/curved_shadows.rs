//! Shadows that meshes throw on curved ones, themselves among them.
//!
//! The triangles of a curved mesh lie on all sides of a block of pixels, so that most of those that
//! are near are its own. A sun's [`Ceiling`] first tells of a few pixels whether anything else may be
//! in the way: where nothing is, no ray is sent and nothing of the relief is looked for.

use super::hidden_lights::HiddenLights;
use super::places::{Places, along, half_width, of_lane, pixel_reach, places, range, steps};
use super::shade::Shader;
use super::shadows::Hidden;
use crate::light::exact::{Ceiling, Occluders, Receiver, Spots};
use crate::light::{FrameLanes, Vectors, cross, repeat_length};
use crate::raster::{LitLanes, QuadBlock, QuadPair};
use crate::relief::{HeightField, displacement};
use crate::shell::Outlined;
use crate::simd::{PixelLanes, set_bits};
use glam::Vec3;

/// Least cosine to a sun with which the plane of a few pixels says where their polygons lie.
const LEAST_FACING: f32 = 0.1;

impl Shader<'_> {
    /// Finds the parts of suns that are not seen from the pixels of a block of a curved surface.
    pub(super) fn hide_on_curved(
        &self,
        field: Option<&HeightField>,
        block: &QuadBlock,
        hidden: &mut HiddenLights,
    ) {
        let occluders = self.prepared.occluders(self.scene);
        let rays = block.pairs().filter_map(|pair| ViewRays::new(field, &pair));
        let rays: Vec<_> = rays.collect();
        let of_sun = |ceiling: &Ceiling| {
            let mut hidden = vec![PixelLanes::ZERO; rays.len()];
            let up = ceiling.axes()[2];
            let mut open = Vec::new();
            for (i, rays) in rays.iter().enumerate() {
                // What turns away from a sun is dark without any shadow.
                let facing = along(&rays.normal, up).to_array();
                let is_lit = set_bits(rays.covered).any(|lane| facing[lane] > 0.0);
                // The plane of what is seen edge on from a sun says nothing of where it lies.
                let is_steep = set_bits(rays.covered).any(|lane| facing[lane] < LEAST_FACING);
                if is_lit && (is_steep || !ceiling.is_clear(&rays.spots(ceiling.axes()))) {
                    let pair = block.pair(i);
                    if let Some(lit) = pair.lit() {
                        open.push((
                            i,
                            places((self.scene, &pair), field, &lit, &rays.normal),
                            rays.normal,
                        ));
                    }
                }
            }
            hide((occluders, self.outlined), ceiling, &open, &mut hidden);
            hidden
        };
        for (ceiling, hidden) in self.prepared.ceilings(self.scene).iter().zip(&mut hidden.lights) {
            if let Some(ceiling) = ceiling {
                *hidden = of_sun(ceiling);
            }
        }
    }
}

/// Sets the parts of a sun that are not seen from places of pairs, by their numbers, whose unit
/// normals are given.
fn hide(
    (occluders, outlined): (&Occluders, Option<&Outlined>),
    ceiling: &Ceiling,
    pairs: &[(usize, Places, Vectors)],
    hidden: &mut [PixelLanes],
) {
    let (mut normal, mut points, mut reach) = (Vec3::ZERO, Vec::new(), f32::INFINITY);
    for (_, places, normals) in pairs {
        for lane in set_bits(places.covered) {
            normal += of_lane(normals, lane);
            points.push(of_lane(&places.relief, lane));
            reach = reach.min(places.reach.as_array()[lane]);
        }
    }
    let Some(receiver) = Receiver::curved(&points, normal.normalize_or_zero(), reach) else {
        return;
    };
    let disc = ceiling.disc();
    let sun = Hidden::new((occluders, outlined), &receiver, &disc);
    pairs.iter().for_each(|(i, places, _)| hidden[*i] = sun.share(places));
}

/// The view rays of a pair on a curved surface, between the polygon and the deepest relief.
struct ViewRays {
    /// Where they pass the polygon, and from there down.
    polygon: Vectors,
    way: Vectors,
    /// Unit normals on the eye's side.
    normal: Vectors,
    /// See [`Places`].
    steps: [Vectors; 2],
    reach: PixelLanes,
    covered: u8,
}

impl ViewRays {
    fn new(field: Option<&HeightField>, pair: &QuadPair) -> Option<Self> {
        let LitLanes { position, normal, tangent_u, tangent_v, is_back } = pair.lit()?;
        let [_, _, normal] = FrameLanes::new(&normal, &[tangent_u, tangent_v], is_back).axes;
        let (covered, steps) = (pair.covered_bits(), steps(&position));
        let (way, reach) = (Vectors::default(), pixel_reach(&steps));
        let flat = Self { polygon: position, way, normal, steps, reach, covered };
        let Some(HeightField { relief_depth, .. }) = field else { return Some(flat) };
        let moved = displacement(&pair.view(), *relief_depth);
        let down = repeat_length(&cross(&tangent_u, &tangent_v)) * *relief_depth;
        let way =
            [0, 1, 2].map(|i| tangent_u[i] * moved[0] + tangent_v[i] * moved[1] - down * normal[i]);
        Some(Self { way, reach: down * 2.0, ..flat })
    }

    /// All of their points by the axes across a light and to it.
    fn spots(&self, axes: [Vec3; 3]) -> Spots {
        let ranges = axes.map(|axis| {
            let (from, way) = (along(&self.polygon, axis), along(&self.way, axis));
            let (to, half) = (from + way, half_width(&self.steps, axis));
            range(self.covered, from.fast_min(to) - half, from.fast_max(to) + half)
        });
        let mean = |of: &Vectors| {
            let sum = set_bits(self.covered).fold(Vec3::ZERO, |sum, lane| sum + of_lane(of, lane));
            let mean = sum / (self.covered.count_ones().max(1) as f32);
            Vec3::from(axes.map(|axis| axis.dot(mean)))
        };
        let [x, y, up] = ranges;
        let [reach, _] = range(self.covered, self.reach, self.reach);
        let polygon = [mean(&self.polygon), mean(&self.normal)];
        Spots { across: [x, y], lowest: up[0], polygon, reach }
    }
}
