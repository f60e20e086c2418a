//! Whether the triangle by which a ray comes in tells how it goes on.

use super::curvature::{Limits, NO_BREAK};
use super::follow::ViewRay;
use super::prisms::Shell;
use crate::scene::Mesh;

/// What a triangle tells of the course of a ray that enters the relief through it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Course {
    /// All, as far as the ray may get.
    Told,
    /// The mesh bends by more, or by less, where the ray may get.
    Bent,
    /// The ray may get to where the texture goes on elsewhere.
    Broken,
}

impl Shell {
    /// What a triangle tells of the course of a ray that enters the relief through it.
    pub fn course(&self, mesh: &Mesh, triangle: u32, ray: &ViewRay) -> Course {
        let Limits { squares, is_uneven, to_break } = self.limits[triangle as usize];
        if !is_uneven && to_break == NO_BREAK {
            return Course::Told;
        }
        let corners = mesh.triangles[triangle as usize].map(|i| i as usize);
        let [a, b, c] = corners.map(|i| mesh.positions[i].as_dvec3());
        let normal = (b - a).cross(c - a);
        let area = normal.length();
        let along = normal.dot(ray.direction) / (area * ray.direction.length());
        let square = along * along;
        let may_pass = square < f64::from(squares[usize::from(along > 0.0)]);
        // As many triangles as it goes on over a flat mesh, in edges of their mean size: through corners
        // twice as many lie on the way.
        let depth = self.offsets[corners[0]].length_squared();
        let num = (f64::from(depth) * (1.0 / square - 1.0) / area).sqrt();
        if to_break != NO_BREAK && (may_pass || num * 2.0 + 2.0 >= f64::from(to_break)) {
            Course::Broken
        } else if is_uneven && may_pass {
            Course::Bent
        } else {
            Course::Told
        }
    }
}
