//! Where rays pass what they meet: through holes of cut-outs, and by the relief at outlines.

use super::outlines::{EVERYWHERE, Outlines};
use crate::geometry::{Plane, Projection};
use crate::raster::{Behind, Follow};
use crate::scene::{Eye, Mesh, Scene};
use crate::shell::{Met, is_seen_from_behind};
use glam::{DVec2, DVec3, Vec3};

/// Follows rays through a frame's holes and behind its reliefs.
#[derive(Clone, Copy)]
pub(crate) struct Passages<'a> {
    scene: &'a Scene,
    projection: &'a Projection,
    eye: Eye,
    outlines: Option<&'a Outlines<'a>>,
}

impl<'a> Passages<'a> {
    /// Of a scene with its projection; `None` where each ray meets the polygon that it sees.
    pub(crate) fn new(
        scene: &'a Scene,
        projection: &'a Projection,
        outlines: Option<&'a Outlines<'a>>,
    ) -> Option<Self> {
        let all = Self { scene, projection, eye: scene.camera.viewpoint(), outlines };
        let has_holes = scene.meshes.iter().any(|mesh| scene.cut_out(mesh).is_some());
        (outlines.is_some() || has_holes).then_some(all)
    }

    /// Whether a mesh has holes.
    fn is_cut(&self, mesh: u32) -> bool {
        self.scene.cut_out(&self.scene.meshes[mesh as usize]).is_some()
    }

    /// How far along the view the ray through a place of the screen meets a hole of a triangle: where
    /// it hits the relief, or else the polygon.
    fn hole(&self, [mesh, triangle]: [u32; 2], pixel: [f64; 2], met: Option<&Met>) -> Option<f64> {
        let mesh = &self.scene.meshes[mesh as usize];
        let cut_out = self.scene.cut_out(mesh)?;
        let corners = mesh.triangles[triangle as usize].map(|i| i as usize);
        let at = |place: [f64; 2]| self.on_triangle(mesh, corners, place);
        // Beyond its horizon a plane is nowhere; what is seen of it there is a matter of rounding.
        let (uv, distance) = at(pixel)?;
        let [right, down] = [[1.0, 0.0], [0.0, 1.0]].map(|[x, y]| {
            let next = at([pixel[0] + x, pixel[1] + y]);
            next.map_or([1e6; 2], |(next, _)| (next - uv).as_vec2().to_array())
        });
        let (uv, distance) = match met {
            Some(Met::Relief(hit)) => (DVec2::from(hit.place.uv), hit.distance),
            _ => (uv, distance),
        };
        let place = uv.as_vec2().to_array();
        let is_there = cut_out.is_there(place, [right, down], chance(triangle, pixel));
        (!is_there).then_some(distance)
    }

    /// Texture coordinates and distance where the ray through a place of the screen meets the plane
    /// of a triangle.
    fn on_triangle(
        &self,
        mesh: &Mesh,
        corners: [usize; 3],
        place: [f64; 2],
    ) -> Option<(DVec2, f64)> {
        let [a, b, c] = corners.map(|i| mesh.positions[i].as_dvec3());
        let [ab, ac, from] = [b - a, c - a, self.projection.origin(place) - a];
        let direction: DVec3 = self.projection.direction(place);
        // Shares of the corners by Cramer's rule.
        let across = direction.cross(ac);
        let volume = ab.dot(across);
        let of_b = from.dot(across) / volume;
        let beside = from.cross(ab);
        let of_c = direction.dot(beside) / volume;
        let distance = ac.dot(beside) / volume;
        let [ta, tb, tc] = corners.map(|i| mesh.tex_coords[i].as_dvec2());
        let uv = ta + (tb - ta) * of_b + (tc - ta) * of_c;
        (uv.is_finite() && distance > 0.0).then_some((uv, distance))
    }
}

/// A number from 0 to below 1 for a sample of a triangle. Samples of a pixel have columns of their
/// own, evenly spread; from pixel to pixel and triangle to triangle they are moved on by steps whose
/// multiples are spread evenly.
fn chance(triangle: u32, [x, y]: [f64; 2]) -> f32 {
    let [column, row] = [x.floor(), y.floor()];
    let moved = column * 0.754_877_666_246_693 + row * 0.569_840_290_998_053;
    let chance = moved + f64::from(triangle) * 0.618_033_988_749_895 + (x - column);
    // Rounded to f32, a number just below 1 would be 1.
    ((chance - chance.floor()) as f32).min(0.999_999)
}

impl Follow for Passages<'_> {
    fn has_relief(&self, mesh: u32) -> bool {
        self.outlines.is_some_and(|outlines| outlines.has_relief(mesh))
    }

    fn passable(&self, triangle: [u32; 2]) -> Option<Plane> {
        if self.is_cut(triangle[0]) { Some(EVERYWHERE) } else { self.outlines?.passable(triangle) }
    }

    fn is_seen_from_behind(&self, [mesh, triangle]: [u32; 2]) -> bool {
        is_seen_from_behind(&self.scene.meshes[mesh as usize], triangle, self.eye)
    }

    fn deepest(&self, triangle: [u32; 2]) -> Option<[Vec3; 3]> {
        self.outlines?.deepest(triangle)
    }

    fn probe(&self, triangle: [u32; 2], place: [f64; 2], around: f64) -> Option<f32> {
        // Following finds holes once and for all.
        self.outlines.filter(|_| !self.is_cut(triangle[0]))?.probe(triangle, place, around)
    }

    fn follow(&self, triangle: [u32; 2], place: [f64; 2]) -> Behind {
        let met = self.outlines.map(|outlines| outlines.met(triangle, place));
        if let Some(distance) = self.hole(triangle, place, met.as_ref()) {
            return Behind::Nothing(distance as f32);
        }
        match met {
            Some(Met::Relief(hit)) => Behind::Surface(hit.distance as f32),
            Some(Met::Nothing(distance)) => Behind::Nothing(distance as f32),
            Some(Met::Polygon) | None => Behind::Surface(0.0),
        }
    }
}
