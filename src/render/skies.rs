//! What of the sky gets past the meshes of a scene, at the vertices of curved ones.
//!
//! A curved mesh is cut finely, and how much of the sky it sees changes slowly over it. So rays are
//! sent from its vertices alone, once, and a pixel blends those of its triangle. What they find is
//! kept as the nearest sky that is linear in the direction (see [`LinearSky`]), which the relief's
//! own occlusion is then multiplied with.

use crate::light::LinearSky;
use crate::light::exact::{LightRay, Occluders};
use crate::raster::QuadPair;
use crate::scene::{Mesh, Scene};
use glam::Vec3;
use rayon::prelude::*;

/// The skies at the vertices of some of a scene's meshes.
#[derive(Debug, Default)]
pub(crate) struct Skies {
    /// In the world's axes, of the front; nothing for a mesh that is not curved.
    of_mesh: Vec<Vec<LinearSky>>,
}

impl Skies {
    /// At the vertices of the meshes that `is_curved` tells by their indices.
    pub(crate) fn new(
        scene: &Scene,
        occluders: &Occluders,
        is_curved: impl Fn(usize) -> bool,
    ) -> Self {
        let of_mesh = scene.meshes.iter().enumerate().map(|(i, mesh)| {
            let num = if is_curved(i) { mesh.positions.len() } else { 0 };
            (0..num).into_par_iter().map(|vertex| at(scene, occluders, mesh, vertex)).collect()
        });
        Self { of_mesh: of_mesh.collect() }
    }

    /// At the pixels of a pair, on the side that `eye` sees; anything where none is covered.
    pub(super) fn of_pair(&self, scene: &Scene, pair: &QuadPair) -> [LinearSky; 8] {
        let mut skies = [LinearSky::default(); 8];
        let Some(lit) = pair.lit() else { return skies };
        for lane in pair.covered() {
            let Some(planes) = pair.planes[lane / 4].lit.as_deref() else { continue };
            let [mesh, triangle] = planes.triangle.map(|i| i as usize);
            let of_mesh = &self.of_mesh[mesh];
            if of_mesh.is_empty() {
                continue;
            }
            let mesh = &scene.meshes[mesh];
            let corners = mesh.triangles[triangle].map(|i| i as usize);
            let place = Vec3::from(lit.position.map(|axis| axis.as_array()[lane]));
            let shares = shares(corners.map(|i| mesh.positions[i]), place);
            let terms = corners.into_iter().zip(shares).map(|(i, share)| (of_mesh[i], share));
            skies[lane] = LinearSky::blend(terms);
        }
        skies
    }
}

/// What the sky sends to a vertex past all meshes.
fn at(scene: &Scene, occluders: &Occluders, mesh: &Mesh, vertex: usize) -> LinearSky {
    let normal = mesh.normals[vertex].normalize_or(Vec3::Z);
    let surface = scene.materials[mesh.material].surface.as_ref();
    let down = match (mesh.tangents.get(vertex), surface) {
        (Some([u, v]), Some(surface)) => u.cross(*v).length().sqrt() * surface.relief_depth(),
        _ => 0.0,
    };
    // From half way down the relief: what it hides itself is told apart.
    let from = (mesh.positions[vertex] - normal * (0.5 * down)).as_dvec3();
    let reach = f64::from(2.0 * down) + from.abs().max_element() * 1e-5;
    LinearSky::new(normal, |direction| {
        let color = scene.sky.radiance(direction);
        let direction = direction.as_dvec3();
        let distance = f64::INFINITY;
        let ray = LightRay { from, direction, distance, reach, is_turned: false };
        if color == Vec3::ZERO || occluders.hide(&ray) { Vec3::ZERO } else { color }
    })
}

/// The shares of a triangle's corners in a place on it.
fn shares([a, b, c]: [Vec3; 3], place: Vec3) -> [f32; 3] {
    let normal = (b - a).cross(c - a);
    let scale = 1.0 / normal.length_squared().max(f32::MIN_POSITIVE);
    let share = |p: Vec3, q: Vec3| (p - place).cross(q - place).dot(normal) * scale;
    // A pixel's centre may lie beside its triangle.
    let of = [share(b, c), share(c, a), share(a, b)].map(|share| share.clamp(0.0, 1.0));
    let sum = (of[0] + of[1] + of[2]).max(f32::MIN_POSITIVE);
    of.map(|share| share / sum)
}
