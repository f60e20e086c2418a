//! Shadows that meshes throw on flat pieces lit for good.
//!
//! For a block of pixels the triangles between it and a sun are listed once: most blocks have none.
//! Where there are some, each pixel sends rays from where its own view ray meets the *relief*, not
//! the polygon, to points of the sun's disc, from places spread over the pixel. A few tell whether a
//! pixel is all dark or all lit; only edges take the rest. Lanes are pixels.
//!
//! ```text
//!      sun's disc  * * *
//!                 / / /   ____ mesh: the only triangles that the block's rays are tested against
//!                / / /   |
//!      ---------/-/-/----|--------  polygon
//!        ______p_p_p____ |          relief
//! ```

use super::ground::{Ground, LitPiece};
use super::hidden_lights::HiddenLights;
use super::shade::{ShadeScratch, Shader};
use crate::light::exact::{Occluders, Receiver};
use crate::light::{Disc, SmoothTriangle, Vectors, cross, dot, repeat_length};
use crate::raster::{LitLanes, QuadBlock, QuadPair};
use crate::relief::{HeightField, displacement, march};
use crate::scene::{Light, Scene};
use crate::simd::{PixelLanes, bits_mask, set_bits};
use glam::Vec3;

/// Rays of a pixel to each sun; a square number.
pub(super) const RAYS: usize = 16;

/// Those of them that go first: to points near the disc's edge, from places of which each has a row and
/// a column of the pixel for itself.
pub(super) const FIRST: [usize; 4] = [2, 4, 11, 13];

/// A sun, and the triangles that may hide it from a block.
pub(super) struct Hidden {
    /// To each of [`RAYS`] points of its disc, unit directions.
    directions: Vec<Vec3>,
    /// From the block's middle.
    triangles: Vec<[Vec3; 3]>,
    /// Two axes across the light, and how far each triangle reaches along them, widened by the disc.
    across: [Vec3; 2],
    outlines: Vec<[[f32; 2]; 2]>,
}

impl Shader<'_> {
    /// Draws anew what meshes shade of a block: of the sky's part, and of each sun's, what gets
    /// there.
    pub(super) fn shadow(
        &self,
        (ground, lit): (&Ground, &LitPiece),
        block: &QuadBlock,
        scratch: &mut ShadeScratch,
        hidden_lights: &mut HiddenLights,
        colors: &mut [[PixelLanes; 3]],
    ) {
        let [sky, suns @ ..] = lit.apart else { return };
        let occluders = self.prepared.occluders(self.scene);
        let hidden = hidden_suns(self.scene, occluders, (ground, lit), block);
        let open_sky = lit.open_sky.and_then(|sky| sky.of_block(block));
        if hidden.is_none() && open_sky.is_none() {
            return;
        }
        let mut part = Vec::with_capacity(colors.len());
        self.textured(&Ground { prepared: sky, ..*ground }, block, scratch, &mut part);
        if let Some(shares) = open_sky {
            for (part, share) in part.iter_mut().zip(shares) {
                (0..3).for_each(|c| part[c] *= share[c]);
            }
        }
        colors.copy_from_slice(&part);
        for (i, sun) in suns.iter().enumerate() {
            part.clear();
            self.textured(&Ground { prepared: sun, ..*ground }, block, scratch, &mut part);
            for (p, (color, part)) in colors.iter_mut().zip(&part).enumerate() {
                let seen = hidden.as_ref().map_or(PixelLanes::ONE, |h| PixelLanes::ONE - h[i][p]);
                (0..3).for_each(|c| color[c] += part[c] * seen);
            }
        }
        // The others are points.
        let lights = self.scene.lights.iter().zip(&mut hidden_lights.lights);
        let suns = lights.filter(|(light, _)| matches!(light, Light::Sun { .. }));
        suns.zip(hidden.into_iter().flatten()).for_each(|((_, to), hidden)| *to = hidden);
    }
}

/// Where a ray starts in its pixel, in pixels from the middle: by rows and columns.
fn ray_offset(ray: usize) -> [f32; 2] {
    const SIDE: usize = 4;
    [ray % SIDE, ray / SIDE].map(|i| (i as f32 + 0.5) / SIDE as f32 - 0.5)
}

/// The covered pixels that all rays are sent from, by those whose first rays all arrive and those of
/// which none does: quads that are not all lit or all dark, since few rays do not find each edge.
pub(super) fn edges(alike: [u8; 2], covered: u8) -> u8 {
    const QUADS: [u8; 2] = [0x0f, 0xf0];
    let of_quad = |quad| covered & quad;
    let is_edge = |pixels: &u8| alike.iter().all(|alike| pixels & !alike != 0);
    QUADS.map(of_quad).into_iter().filter(is_edge).fold(0, |all, pixels| all | pixels)
}

/// The parts of each sun that are not seen from the pixels of a block's pairs: sun by sun, pair by
/// pair. `None` where nothing is in the way.
fn hidden_suns(
    scene: &Scene,
    occluders: &Occluders,
    (ground, lit): (&Ground, &LitPiece),
    block: &QuadBlock,
) -> Option<Vec<Vec<PixelLanes>>> {
    let normal = lit.normal.to_array().map(PixelLanes::splat);
    let points: Vec<_> = block
        .pairs()
        .map(|pair| Some(places((scene, &pair), ground.prepared.field(), &pair.lit()?, &normal)))
        .collect::<Option<_>>()?;
    let relief = points
        .iter()
        .zip(block.pairs())
        .flat_map(|(points, pair)| pair.covered().map(move |lane| of_lane(&points.relief, lane)));
    let polygon = of_lane(&points.first()?.polygon, 0);
    let receiver = Receiver::new(relief, lit.normal, polygon)?;
    let suns = between(scene, occluders, &receiver)?;
    let of_sun = |sun: &Hidden| points.iter().map(|p| sun.share(p, receiver.middle)).collect();
    Some(suns.iter().map(of_sun).collect())
}

/// The triangles that may hide each of the suns from a receiver; `None` if there are none.
fn between(scene: &Scene, occluders: &Occluders, receiver: &Receiver) -> Option<Vec<Hidden>> {
    let suns: Vec<_> = scene
        .lights
        .iter()
        .filter_map(|light| {
            let disc = Disc::of(light)?;
            let triangles = occluders.between(receiver, &disc);
            Some(Hidden::new(&disc, triangles))
        })
        .collect();
    suns.iter().any(|sun| !sun.triangles.is_empty()).then_some(suns)
}

pub(super) fn of_lane(vectors: &Vectors, lane: usize) -> Vec3 {
    Vec3::from(vectors.map(|axis| axis.as_array()[lane]))
}

pub(super) fn along(v: &Vectors, axis: Vec3) -> PixelLanes {
    v[0] * axis.x + v[1] * axis.y + v[2] * axis.z
}

/// Where the pixels of a pair are in the world.
pub(super) struct Places<'a> {
    /// Where the view rays of the pixels' centres meet the relief.
    pub(super) relief: Vectors,
    /// Where they pass the polygon.
    pub(super) polygon: Vectors,
    /// How far that point moves from a column of pixels to the next, and a row.
    steps: [Vectors; 2],
    /// The way from there into the relief, where there is one.
    descent: Option<Descent<'a>>,
    /// How far above a ray's start a triangle hides nothing that it passes from behind: its own
    /// polygon, or one that stands on it. See [`LightRay::reach`](crate::light::exact::LightRay).
    pub(super) reach: PixelLanes,
    /// Which of the pixels are covered.
    pub(super) covered: u8,
}

/// View rays on their way from the polygon into a relief.
struct Descent<'a> {
    field: &'a HeightField,
    /// Where they pass the polygon, in repeats, and how far that moves from a column of pixels to the
    /// next, and a row.
    uv: [PixelLanes; 2],
    uv_steps: [[PixelLanes; 2]; 2],
    /// How far they move along the texture down to the deepest relief, in repeats, and in the world.
    displacement: [PixelLanes; 2],
    way: Vectors,
}

impl Descent<'_> {
    /// From the polygon to where the rays so many pixels from the pixels' centres meet the relief.
    fn to_relief(&self, offset: [f32; 2]) -> Vectors {
        let uv = moved(&self.uv, &self.uv_steps, offset);
        let depth = march(self.field, &uv, &self.displacement);
        self.way.map(|axis| axis * depth)
    }
}

impl Places<'_> {
    /// Where a ray starts: the first ones where relief as deep as under the pixel's centre lies under
    /// their place, the others where their own view ray meets it, as within a pixel of the far field the
    /// relief goes up and down by more than the pixel is wide.
    pub(super) fn start(&self, ray: usize) -> Vectors {
        let offset = ray_offset(ray);
        let moved = |points| moved(points, &self.steps, offset);
        match &self.descent {
            Some(descent) if !FIRST.contains(&ray) => {
                let (polygon, way) = (moved(&self.polygon), descent.to_relief(offset));
                [0, 1, 2].map(|i| polygon[i] + way[i])
            }
            _ => moved(&self.relief),
        }
    }

    /// How far along an axis, from a point, the covered pixels lie down to the deepest relief.
    fn range(&self, from: Vec3, axis: Vec3) -> [f32; 2] {
        let half = half_width(&self.steps, axis);
        let polygon = along(&self.polygon, axis) - axis.dot(from);
        let way = self.descent.as_ref().map_or(PixelLanes::ZERO, |down| along(&down.way, axis));
        let (least, most) = (way.fast_min(PixelLanes::ZERO), way.fast_max(PixelLanes::ZERO));
        range(self.covered, polygon + least - half, polygon + most + half)
    }
}

/// Half of what pixels span along an axis, by how far a point moves from one to the next.
pub(super) fn half_width(steps: &[Vectors; 2], axis: Vec3) -> PixelLanes {
    (along(&steps[0], axis).abs() + along(&steps[1], axis).abs()) * 0.5
}

/// How far a ray's start may lie from a triangle that it belongs to, without relief: within a pixel
/// its place is that of the plane that its centre lies in, which neighbours rise above.
pub(super) fn pixel_reach([column, row]: &[Vectors; 2]) -> PixelLanes {
    dot(column, column).sqrt() + dot(row, row).sqrt()
}

/// The least and the greatest of picked lanes.
pub(super) fn range(lanes: u8, least: PixelLanes, most: PixelLanes) -> [f32; 2] {
    let [least, most] = [least, most].map(PixelLanes::to_array);
    set_bits(lanes)
        .fold([f32::MAX, f32::MIN], |[a, b], lane| [a.min(least[lane]), b.max(most[lane])])
}

/// How far something moves from a column of pixels to the next, and a row.
pub(super) fn steps<const N: usize>(of: &[PixelLanes; N]) -> [[PixelLanes; N]; 2] {
    // Pixels of a quad: lanes 0 and 1 side by side, 0 and 2 one above the other.
    [1, 2].map(|by| {
        of.map(|axis| {
            let axis = axis.to_array();
            PixelLanes::new(std::array::from_fn(|lane| {
                axis[lane / 4 * 4 + by] - axis[lane / 4 * 4]
            }))
        })
    })
}

/// Something so many pixels from the pixels' centres, by its [`steps`].
fn moved<const N: usize>(
    of: &[PixelLanes; N],
    [column, row]: &[[PixelLanes; N]; 2],
    [x, y]: [f32; 2],
) -> [PixelLanes; N] {
    std::array::from_fn(|i| of[i] + column[i] * x + row[i] * y)
}

pub(super) fn places<'a>(
    (scene, pair): (&Scene, &QuadPair),
    field: Option<&'a HeightField>,
    lit: &LitLanes,
    normal: &Vectors,
) -> Places<'a> {
    let LitLanes { position, tangent_u, tangent_v, .. } = *lit;
    let steps_along = steps(&position);
    let all = Places {
        relief: position,
        polygon: position,
        reach: pixel_reach(&steps_along),
        steps: steps_along,
        descent: None,
        covered: pair.covered_bits(),
    };
    let Some(field) = field else {
        return Places { relief: smooth_places(scene, pair, lit), ..all };
    };
    let displacement = displacement(&pair.view(), field.relief_depth);
    let repeat = repeat_length(&cross(&tangent_u, &tangent_v));
    let down = repeat * field.relief_depth;
    let way = [0, 1, 2].map(|i| {
        tangent_u[i] * displacement[0] + tangent_v[i] * displacement[1] - down * normal[i]
    });
    let to_relief = march(field, &pair.uv, &displacement);
    let relief = [0, 1, 2].map(|i| position[i] + way[i] * to_relief);
    let descent =
        Some(Descent { field, uv: pair.uv, uv_steps: steps(&pair.uv), displacement, way });
    Places { relief, descent, reach: down * 2.0, ..all }
}

/// Where light meets the polygons of the pixels of a pair, without relief.
fn smooth_places(scene: &Scene, pair: &QuadPair, lit: &LitLanes) -> Vectors {
    let is_back = lit.is_back.to_bitmask();
    let mut places = lit.position;
    let triangles = pair.planes.map(|planes| {
        let [mesh, triangle] = planes.triangle.map(|i| i as usize);
        SmoothTriangle::new(&scene.meshes[mesh], triangle)
    });
    for lane in pair.covered() {
        let lift = triangles[lane / 4].lift(of_lane(&lit.position, lane), is_back >> lane & 1 == 1);
        (0..3).for_each(|c| places[c].as_mut_array()[lane] += lift[c]);
    }
    places
}

impl Hidden {
    /// Of a sun's disc and the triangles that may hide it, from a block's middle.
    pub(super) fn new(disc: &Disc, triangles: Vec<[Vec3; 3]>) -> Self {
        let across = <[Vec3; 2]>::from(disc.to_middle.any_orthonormal_pair());
        let outline = |triangle: &[Vec3; 3]| {
            // The farther a triangle is, the farther apart are the rays to all of the disc.
            let far = triangle.iter().fold(0.0_f32, |far, corner| far.max(corner.length()));
            let more = far * disc.radius;
            across.map(|axis| {
                let [a, b, c] = triangle.map(|corner| axis.dot(corner));
                [a.min(b).min(c) - more, a.max(b).max(c) + more]
            })
        };
        let outlines = triangles.iter().map(outline).collect();
        Self { directions: disc.points(RAYS).collect(), across, triangles, outlines }
    }

    /// The part of the sun that pixels do not see.
    pub(super) fn share(&self, places: &Places, middle: Vec3) -> PixelLanes {
        if self.triangles.is_empty() {
            return PixelLanes::ZERO;
        }
        let near = self.near(places, middle);
        if near.is_empty() {
            return PixelLanes::ZERO;
        }
        let hidden = |sum, ray| sum + self.is_hidden(&near, places, middle, ray);
        let count = FIRST.into_iter().fold(PixelLanes::ZERO, hidden);
        let most = FIRST.len() as f32;
        let is = |num: f32| count.simd_eq(PixelLanes::splat(num)).to_bitmask() as u8;
        let edges = edges([is(0.0), is(most)], places.covered);
        if edges == 0 {
            return count * (1.0 / most);
        }
        let all = (0..RAYS).filter(|ray| !FIRST.contains(ray)).fold(count, hidden);
        bits_mask(edges).select(all * (1.0 / RAYS as f32), count * (1.0 / most))
    }

    /// The triangles that cover a pixel of a pair as the sun sees them.
    fn near(&self, places: &Places, middle: Vec3) -> Vec<&[Vec3; 3]> {
        let ranges = self.across.map(|axis| places.range(middle, axis));
        let is_near = |outline: &[[f32; 2]; 2]| {
            outline.iter().zip(&ranges).all(|(a, b)| a[0] <= b[1] && b[0] <= a[1])
        };
        let all = self.triangles.iter().zip(&self.outlines);
        all.filter(|(_, outline)| is_near(outline)).map(|(triangle, _)| triangle).collect()
    }

    /// 1 where a triangle hides a point of the sun, else 0.
    fn is_hidden(
        &self,
        triangles: &[&[Vec3; 3]],
        places: &Places,
        middle: Vec3,
        ray: usize,
    ) -> PixelLanes {
        // Over the disc they go in another order than over the pixel, so that no part of the one goes
        // with a part of the other.
        let direction = self.directions[ray * 7 % RAYS];
        let from = places.start(ray);
        let from = [0, 1, 2].map(|i| from[i] - middle[i]);
        let mut hits = PixelLanes::ZERO;
        for triangle in triangles {
            hits |= passes(&from, direction, triangle, places.reach);
            if hits.all() {
                break;
            }
        }
        hits.select(PixelLanes::ONE, PixelLanes::ZERO)
    }
}

/// Where rays in one direction pass a triangle, by the signs of three volumes.
#[inline(always)]
fn passes(from: &Vectors, direction: Vec3, triangle: &[Vec3; 3], reach: PixelLanes) -> PixelLanes {
    let corners = triangle.map(|corner| [0, 1, 2].map(|i| PixelLanes::splat(corner[i]) - from[i]));
    let side = |a: usize, b: usize| {
        let [x, y, z] = cross(&corners[a], &corners[b]);
        x * direction.x + y * direction.y + z * direction.z
    };
    let sides = [side(0, 1), side(1, 2), side(2, 0)];
    let zero = PixelLanes::ZERO;
    let is_left = sides[0].simd_ge(zero) & sides[1].simd_ge(zero) & sides[2].simd_ge(zero);
    let is_right = sides[0].simd_le(zero) & sides[1].simd_le(zero) & sides[2].simd_le(zero);
    // Ahead: the plane is on that side of the start to which the ray goes.
    let normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    let towards = direction.dot(normal);
    let [x, y, z] = corners[0];
    let distance = x * normal.x + y * normal.y + z * normal.z;
    let is_ahead = (distance * towards).simd_gt(zero);
    let hides = (is_left | is_right) & is_ahead;
    if towards <= 0.0 {
        return hides;
    }
    // From behind, which hides nothing near by.
    hides & distance.abs().simd_gt(reach * normal.length())
}
