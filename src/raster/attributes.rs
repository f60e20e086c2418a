//! The attribute planes of a triangle, made when it turns out to be visible.
//!
//! The ray to a corner, in the corner's texture frame, solves `ray = alpha U + beta V - gamma s N` with `U = dP/du`,
//! `V = dP/dv`, `s = sqrt(|U x V|)`. By Cramer's rule, with `volume = N . (U x V)`, `alpha = (V x N) . ray / volume`,
//! `beta = (N x U) . ray / volume`, `gamma = -(U x V) . ray / (s volume)`. With a frame at each corner, curved surfaces
//! stay smooth.

use super::quad::{AttributePlanes, LitPlanes, Plane};
use crate::geometry::{Geometry, ScreenBasis, ScreenTriangle};
use crate::scene::{Mesh, Scene};
use crate::settings::{Lighting, Settings};
use glam::{DVec3, Vec3};

/// A frame whose volume is less than this share of the product of its lengths counts as flat; tangents in f32 are not
/// known better.
const FLAT: f64 = 1e-6;
/// The view straight down, where there is no frame.
const STRAIGHT: DVec3 = DVec3::Z;

impl AttributePlanes {
    /// The planes of the scene's triangle that `triangle` is, or is a piece of.
    #[must_use]
    pub fn new(geometry: &Geometry, triangle: &ScreenTriangle, scene: &Scene, settings: &Settings) -> Self {
        let mut planes = Self::default();
        planes.set(geometry, triangle, scene, settings);
        planes
    }

    /// As [`AttributePlanes::new`], in place.
    pub fn set(&mut self, geometry: &Geometry, triangle: &ScreenTriangle, scene: &Scene, settings: &Settings) {
        let mesh = &scene.meshes[triangle.mesh as usize];
        let corners = mesh.triangles[triangle.triangle as usize].map(|i| i as usize);
        let projection = geometry.projection();
        let rays = corners.map(|i| projection.ray(mesh.positions[i]));
        let basis = ScreenBasis::new(rays.map(|ray| projection.view_from_ray(ray)), projection.center);
        self.inverse_w = basis.inverse_w();
        if mesh.tex_coords.is_empty() {
            self.uv = [Plane::default(); 2];
            self.view = [Plane::default(), Plane::default(), self.inverse_w];
        } else {
            self.uv = [0, 1].map(|axis| basis.plane(corners.map(|i| f64::from(mesh.tex_coords[i][axis]))));
            let views = [0, 1, 2].map(|c| view_in_texture_frame(DVec3::from(rays[c]), mesh, corners[c]));
            self.view = [0, 1, 2].map(|axis| basis.plane(views.map(|view| view[axis])));
        }
        if settings.lighting == Lighting::Lit {
            self.lit.get_or_insert_default().set(&basis, mesh, corners);
        } else {
            self.lit = None;
        }
    }
}

impl LitPlanes {
    fn set(&mut self, basis: &ScreenBasis, mesh: &Mesh, corners: [usize; 3]) {
        let planes = |vectors: [Vec3; 3]| [0, 1, 2].map(|axis| basis.plane(vectors.map(|v| f64::from(v[axis]))));
        let tangents = |i: usize| mesh.tangents.get(i).copied().unwrap_or_default();
        self.position = planes(corners.map(|i| mesh.positions[i]));
        self.normal = planes(corners.map(|i| mesh.normals[i]));
        self.tangent_u = planes(corners.map(|i| tangents(i)[0]));
        self.tangent_v = planes(corners.map(|i| tangents(i)[1]));
    }
}

/// `(alpha, beta, gamma)` of a ray in the texture frame of a vertex.
fn view_in_texture_frame(ray: DVec3, mesh: &Mesh, vertex: usize) -> DVec3 {
    let [u, v] = mesh.tangents[vertex].map(|tangent| tangent.as_dvec3());
    let n = mesh.normals[vertex].as_dvec3();
    let across = u.cross(v);
    let volume = n.dot(across);
    let size_squared = u.length_squared() * v.length_squared() * n.length_squared();
    if volume * volume > FLAT * FLAT * size_squared && volume.is_normal() {
        let s = across.length().sqrt();
        let scale = 1.0 / (volume * s);
        DVec3::new(v.cross(n).dot(ray) * s, n.cross(u).dot(ray) * s, -across.dot(ray)) * scale
    } else {
        STRAIGHT
    }
}
