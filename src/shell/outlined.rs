//! Light on its way past the outlines of meshes: what their polygons would stop and their relief does
//! not.
//!
//! ```text
//!   from a light   1      2      3
//!                  |      |      |        1 goes so steeply through the polygons that any relief
//!        polygons .-------|-.    |          stops it: it is not followed
//!              .' | .---. |  '.  |        2 is followed, and meets the relief
//!             /   o'     'o    \ |        3 is followed, comes out of the polygons again, and lights
//!            |   / relief  \    ||          the floor
//!             \ |           |   /|
//!   ____________|___________|____|___ floor
//! ```

use super::follow::{Met, ViewRay, Width};
use super::prisms::Shell;
use crate::relief::HeightField;
use crate::scene::Mesh;
use glam::{DVec3, Vec3};

/// The meshes of a scene whose relief light may pass.
#[derive(Clone, Debug)]
pub struct Outlined<'a> {
    meshes: &'a [Mesh],
    /// Of each mesh that has an outline.
    reliefs: Vec<Option<(&'a Shell, &'a HeightField)>>,
}

impl<'a> Outlined<'a> {
    /// Of a scene's meshes with the reliefs of those that have outlines; `None` if none has.
    pub fn new(
        meshes: &'a [Mesh],
        reliefs: Vec<Option<(&'a Shell, &'a HeightField)>>,
    ) -> Option<Self> {
        reliefs.iter().any(Option::is_some).then_some(Self { meshes, reliefs })
    }

    /// Whether a triangle, by its mesh and its index there, may let light pass that goes along a unit
    /// direction, or along one that differs by `spread`: from afar, or from within a ball around a place.
    pub fn may_let_pass(
        &self,
        [mesh, triangle]: [u32; 2],
        (direction, spread): (Vec3, f32),
        (place, radius): (Vec3, f32),
    ) -> bool {
        let Some((shell, _)) = self.reliefs[mesh as usize] else { return false };
        let mesh = &self.meshes[mesh as usize];
        let corners = mesh.triangles[triangle as usize].map(|i| i as usize);
        let [a, b, c] = corners.map(|i| mesh.positions[i] - place);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let facing = corners.map(|i| direction.dot(mesh.normals[i]).abs());
        let least = (facing[0].min(facing[1]).min(facing[2]) - spread).max(0.0);
        // Corners that face both ways have places between them that are seen edge on.
        let signs = corners.map(|i| direction.dot(mesh.normals[i]) > 0.0);
        let is_edge = signs[0] != signs[1] || signs[0] != signs[2];
        is_edge
            || least * least < shell.front_limit(triangle)
            || a.dot(normal).abs() <= shell.depth(mesh, triangle) + radius
    }

    /// Whether a light, so far away, is hidden from where a ray begins, which passes a triangle on its
    /// way there: by the relief, or the polygon where there is no relief with an outline.
    pub fn hides(&self, [mesh, triangle]: [u32; 2], ray: &ViewRay, distance: f64) -> bool {
        let Some((shell, field)) = self.reliefs[mesh as usize] else { return true };
        let mesh = &self.meshes[mesh as usize];
        // The relief is below the polygon. A ray that leaves it is followed as it comes from the light.
        let passed = Passed::new(mesh, triangle, ray);
        let is_within = passed.is_left && passed.above <= f64::from(shell.depth(mesh, triangle));
        if !is_within && passed.facing.powi(2) >= f64::from(shell.front_limit(triangle)) {
            return true;
        }
        let side = if passed.is_left { -1.0 } else { 1.0 };
        let seen = ViewRay { from: ray.from, direction: ray.direction * side };
        let is_between = |met: &Met| match met {
            Met::Relief(hit) => (0.0..distance).contains(&(hit.distance * side)),
            Met::Polygon => true,
            Met::Nothing(_) => false,
        };
        // Most rays meet the next stone.
        is_between(&shell.probe(mesh, field, triangle, (&seen, Width::default())))
            || is_between(&shell.follow(mesh, field, triangle, &seen))
    }
}

/// Where a ray passes a triangle.
struct Passed {
    /// Whether it comes from behind.
    is_left: bool,
    /// How far the triangle's plane is from where the ray begins.
    above: f64,
    /// The cosine between the ray and the normal there; 0 if that one faces the other way.
    facing: f64,
}

impl Passed {
    fn new(mesh: &Mesh, triangle: u32, ray: &ViewRay) -> Self {
        let corners = mesh.triangles[triangle as usize].map(|i| i as usize);
        let [a, b, c] = corners.map(|i| mesh.positions[i].as_dvec3() - ray.from);
        let normal = (b - a).cross(c - a);
        let is_left = normal.dot(ray.direction) > 0.0;
        // Shares of the corners, by volumes.
        let shares = [(b, c), (c, a), (a, b)].map(|(p, q)| ray.direction.dot(p.cross(q)));
        let toward = |i: usize| mesh.normals[i].as_dvec3().dot(ray.direction);
        let weighed = (0..3).map(|i| shares[i] * toward(corners[i])).sum::<f64>();
        let mean = weighed / shares.iter().sum::<f64>();
        let facing = if is_left { mean } else { -mean };
        let above = a.dot(normal.normalize_or(DVec3::ZERO)).abs();
        // Edge on it has no shares.
        Self { is_left, above, facing: facing.max(0.0) }
    }
}
