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
use super::shade::{ShadeScratch, Shader};
use crate::light::Disc;
use crate::light::exact::{Occluders, Receiver};
use crate::raster::{LitLanes, QuadBlock, QuadPair};
use crate::relief::{displacement, march};
use crate::scene::{Light, Scene};
use crate::simd::PixelLanes;
use glam::Vec3;

/// Rays of a pixel to each sun; a square number.
const RAYS: usize = 16;

/// Those of them that go first: to the four points nearest to the disc's edge, from places all over
/// the pixel.
const FIRST: [usize; 4] = [2, 4, 9, 11];

/// Three coordinates of eight pixels.
type Vectors = [PixelLanes; 3];

/// A sun, and the triangles that may hide it from a block.
struct Hidden {
    /// To each of [`RAYS`] points of its disc, unit directions.
    directions: Vec<Vec3>,
    /// From the block's middle.
    triangles: Vec<[Vec3; 3]>,
}

impl Shader<'_> {
    /// Draws anew what meshes shade of a block: of the sky's part, and of each sun's, what gets
    /// there.
    pub(super) fn shadow(
        &self,
        ground: &Ground,
        lit: &LitPiece,
        block: &QuadBlock,
        scratch: &mut ShadeScratch,
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
    }
}

/// The parts of each sun that are not seen from the pixels of a block's pairs: sun by sun, pair by
/// pair. `None` where nothing is in the way.
fn hidden_suns(
    scene: &Scene,
    occluders: &Occluders,
    (ground, lit): (&Ground, &LitPiece),
    block: &QuadBlock,
) -> Option<Vec<Vec<PixelLanes>>> {
    let points: Vec<_> =
        block.pairs().map(|pair| places(&pair, ground, lit)).collect::<Option<_>>()?;
    let of_lane =
        |vectors: &Vectors, lane: usize| Vec3::from(vectors.map(|axis| axis.as_array()[lane]));
    let relief = points
        .iter()
        .zip(block.pairs())
        .flat_map(|(points, pair)| pair.covered().map(move |lane| of_lane(&points.relief, lane)));
    let polygon = of_lane(&points.first()?.polygon, 0);
    let receiver = Receiver::new(relief, lit.normal, polygon)?;
    let suns: Vec<_> = scene
        .lights
        .iter()
        .map(|light| {
            let Light::Sun { to_light, angular_size, .. } = *light else { return None };
            let disc = Disc::new(to_light.normalize_or_zero(), angular_size);
            let triangles = occluders.between(&receiver, &disc);
            Some(Hidden { directions: disc.points(RAYS).collect(), triangles })
        })
        .collect::<Option<_>>()?;
    if suns.iter().all(|sun| sun.triangles.is_empty()) {
        return None;
    }
    let of_sun = |sun: &Hidden| points.iter().map(|p| sun.share(p, receiver.middle)).collect();
    Some(suns.iter().map(of_sun).collect())
}

/// Where the pixels of a pair are in the world.
struct Places {
    /// Where the view rays of the pixels' centres meet the relief.
    relief: Vectors,
    /// Where they pass the polygon.
    polygon: Vectors,
    /// How far that point moves from a column of pixels to the next, and a row.
    steps: [Vectors; 2],
    /// How far above a ray's start a triangle hides nothing that it passes from behind: its own
    /// polygon, or one that stands on it. See [`LightRay::reach`](crate::light::exact::LightRay).
    reach: PixelLanes,
}

fn places(pair: &QuadPair, ground: &Ground, lit: &LitPiece) -> Option<Places> {
    let LitLanes { position, tangent_u, tangent_v, .. } = pair.lit()?;
    // Pixels of a quad: lanes 0 and 1 side by side, 0 and 2 one above the other.
    let step = |by: usize| {
        position.map(|axis| {
            let axis = axis.to_array();
            PixelLanes::new(std::array::from_fn(|lane| {
                axis[lane / 4 * 4 + by] - axis[lane / 4 * 4]
            }))
        })
    };
    let steps = [step(1), step(2)];
    let Some(field) = ground.prepared.field() else {
        return Some(Places {
            relief: position,
            polygon: position,
            steps,
            reach: PixelLanes::ZERO,
        });
    };
    let along = displacement(&pair.view(), field.relief_depth);
    let depth = march(field, &pair.uv, &along);
    // The world length of a repeat, by which relief goes down.
    let across = cross(&tangent_u, &tangent_v);
    let repeat = dot(&across, &across).sqrt().sqrt();
    let down = depth * repeat * field.relief_depth;
    let relief = [0, 1, 2].map(|i| {
        let moved = (tangent_u[i] * along[0] + tangent_v[i] * along[1]) * depth;
        position[i] + moved - down * lit.normal[i]
    });
    let reach = repeat * (2.0 * field.relief_depth);
    Some(Places { relief, polygon: position, steps, reach })
}

impl Hidden {
    /// The part of the sun that pixels do not see.
    fn share(&self, places: &Places, middle: Vec3) -> PixelLanes {
        if self.triangles.is_empty() {
            return PixelLanes::ZERO;
        }
        let from = [0, 1, 2].map(|i| places.relief[i] - middle[i]);
        let hidden = |sum, ray| sum + self.is_hidden(&from, places, ray);
        let count = FIRST.into_iter().fold(PixelLanes::ZERO, hidden);
        let most = FIRST.len() as f32;
        let is_edge = count.simd_gt(PixelLanes::ZERO) & count.simd_lt(PixelLanes::splat(most));
        if !is_edge.any() {
            return count * (1.0 / most);
        }
        let all = (0..RAYS).filter(|ray| !FIRST.contains(ray)).fold(count, hidden);
        is_edge.select(all * (1.0 / RAYS as f32), count * (1.0 / most))
    }

    /// 1 where a triangle hides a point of the sun, else 0.
    fn is_hidden(&self, from: &Vectors, places: &Places, ray: usize) -> PixelLanes {
        // Over the pixel in rows and columns, over the disc in another order, so that no part of
        // the one goes with a part of the other.
        const SIDE: usize = 4;
        let [x, y] = [ray % SIDE, ray / SIDE].map(|i| (i as f32 + 0.5) / SIDE as f32 - 0.5);
        let direction = self.directions[ray * 7 % RAYS];
        let from = [0, 1, 2].map(|i| from[i] + places.steps[0][i] * x + places.steps[1][i] * y);
        let hits = self.triangles.iter().fold(PixelLanes::ZERO, |hits, triangle| {
            hits | passes(&from, direction, triangle, places.reach)
        });
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

fn cross(a: &Vectors, b: &Vectors) -> Vectors {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: &Vectors, b: &Vectors) -> PixelLanes {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
