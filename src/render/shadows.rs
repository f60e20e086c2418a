//! Shadows that meshes throw on flat pieces lit for good.
//!
//! For a block of pixels the triangles between it and a sun are listed once: most blocks have none.
//! Where there are some, each pixel sends rays from where its own view ray meets the *relief*, not
//! the polygon, to points of the sun's disc, from places spread over the pixel. A few tell whether a
//! pixel is all dark or all lit; only edges take the rest. Lanes are pixels. A triangle at the outline of
//! a relief, as the sun sees it, stops a ray only if its relief does, and is asked last.
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
use super::places::{FIRST, Places, RAYS, of_lane, places};
use super::shade::{ShadeScratch, Shader};
use crate::light::exact::{Occluders, Receiver};
use crate::light::{Disc, Vectors, cross};
use crate::raster::QuadBlock;
use crate::scene::{Light, Scene};
use crate::shell::{Outlined, ViewRay};
use crate::simd::{PixelLanes, bits_mask, set_bits};
use glam::Vec3;

/// A sun, and the triangles that may hide it from a block.
pub(super) struct Hidden<'a> {
    /// To each of [`RAYS`] points of its disc, unit directions.
    directions: Vec<Vec3>,
    /// The block's middle.
    middle: Vec3,
    /// From there; those at outlines come last.
    triangles: Vec<[Vec3; 3]>,
    /// Two axes across the light, and how far each triangle reaches along them, widened by the disc.
    across: [Vec3; 2],
    extents: Vec<[[f32; 2]; 2]>,
    /// The triangles whose relief light may pass.
    outlines: Option<Passed<'a>>,
}

/// Triangles at outlines, as the sun sees them: where light passes one, its relief is asked.
struct Passed<'a> {
    outlined: &'a Outlined<'a>,
    /// Their number among all that may hide the sun, and their names.
    first: usize,
    names: Vec<[u32; 2]>,
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
        let hidden = hidden_suns(self.scene, (occluders, self.outlined), (ground, lit), block);
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
    all: (&Occluders, Option<&Outlined>),
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
    let discs = scene.lights.iter().filter_map(Disc::of);
    let suns: Vec<_> = discs.map(|disc| Hidden::new(all, &receiver, &disc)).collect();
    if suns.iter().all(|sun| sun.triangles.is_empty()) {
        return None;
    }
    let of_sun = |sun: &Hidden| points.iter().map(|places| sun.share(places)).collect();
    Some(suns.iter().map(of_sun).collect())
}

impl<'a> Hidden<'a> {
    /// Of a sun's disc and what may hide it from a receiver.
    pub(super) fn new(
        (occluders, outlined): (&Occluders, Option<&'a Outlined<'a>>),
        receiver: &Receiver,
        disc: &Disc,
    ) -> Self {
        let across = <[Vec3; 2]>::from(disc.to_middle.any_orthonormal_pair());
        let (mut triangles, mut names) = (Vec::new(), Vec::new());
        let ball = (receiver.middle, receiver.radius());
        let mut passed = Vec::new();
        for (triangle, name) in occluders.between(receiver, disc) {
            let way = (disc.to_middle, disc.radius);
            if outlined.is_some_and(|all| all.may_let_pass(name, way, ball)) {
                passed.push(triangle);
                names.push(name);
            } else {
                triangles.push(triangle);
            }
        }
        let first = triangles.len();
        triangles.append(&mut passed);
        let outlines = outlined.filter(|_| !names.is_empty());
        let outlines = outlines.map(|outlined| Passed { outlined, first, names });
        let extent = |triangle: &[Vec3; 3]| {
            // The farther a triangle is, the farther apart are the rays to all of the disc.
            let far = triangle.iter().fold(0.0_f32, |far, corner| far.max(corner.length()));
            let more = far * disc.radius;
            across.map(|axis| {
                let [a, b, c] = triangle.map(|corner| axis.dot(corner));
                [a.min(b).min(c) - more, a.max(b).max(c) + more]
            })
        };
        let extents = triangles.iter().map(extent).collect();
        let (directions, middle) = (disc.points(RAYS).collect(), receiver.middle);
        Self { directions, middle, across, triangles, extents, outlines }
    }

    /// The part of the sun that pixels do not see.
    pub(super) fn share(&self, places: &Places) -> PixelLanes {
        if self.triangles.is_empty() {
            return PixelLanes::ZERO;
        }
        let near = self.near(places);
        if near.is_empty() {
            return PixelLanes::ZERO;
        }
        let hidden = |sum, ray| sum + self.is_hidden(&near, places, ray);
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

    /// The triangles that cover a pixel of a pair as the sun sees them, by their numbers.
    fn near(&self, places: &Places) -> Vec<usize> {
        let ranges = self.across.map(|axis| places.range(self.middle, axis));
        let is_near = |extent: &[[f32; 2]; 2]| {
            extent.iter().zip(&ranges).all(|(a, b)| a[0] <= b[1] && b[0] <= a[1])
        };
        let all = self.extents.iter().enumerate();
        all.filter(|(_, extent)| is_near(extent)).map(|(i, _)| i).collect()
    }

    /// 1 where a triangle hides a point of the sun, else 0.
    fn is_hidden(&self, near: &[usize], places: &Places, ray: usize) -> PixelLanes {
        // Over the disc they go in another order than over the pixel, so that no part of the one goes
        // with a part of the other.
        let direction = self.directions[ray * 7 % RAYS];
        let start = places.start(ray);
        let from = [0, 1, 2].map(|i| start[i] - self.middle[i]);
        let mut hits = PixelLanes::ZERO;
        for &i in near {
            let mut passing = passes(&from, direction, &self.triangles[i], places.reach);
            if let Some(outlines) = self.outlines.as_ref().filter(|o| i >= o.first) {
                let open = (passing & !hits).to_bitmask() as u8 & places.covered;
                passing = outlines.stopped(i, (&start, direction), open);
            }
            hits |= passing;
            if hits.all() {
                break;
            }
        }
        hits.select(PixelLanes::ONE, PixelLanes::ZERO)
    }
}

impl Passed<'_> {
    /// Those of picked lanes whose rays through a triangle, by its number, are stopped by its relief.
    fn stopped(&self, i: usize, (start, direction): (&Vectors, Vec3), lanes: u8) -> PixelLanes {
        let (name, direction) = (self.names[i - self.first], direction.as_dvec3());
        let is_stopped = |lane: &usize| {
            let ray = ViewRay { from: of_lane(start, *lane).as_dvec3(), direction };
            self.outlined.hides(name, &ray, f64::INFINITY)
        };
        bits_mask(set_bits(lanes).filter(is_stopped).fold(0, |bits, lane| bits | 1 << lane))
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
