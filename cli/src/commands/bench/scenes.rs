//! The standard scenes. Nothing is read: meshes are made here, textures are those of the built-in
//! scene, and sines are the same on every machine.

use crate::options::bench::Standard;
use basrelief::texture::Surface;
use basrelief::{Camera, Material, Mesh, Scene, scene};
use glam::{Vec2, Vec3};
use libm::{cosf, sinf};
use std::f32::consts::TAU;
use std::sync::Arc;

/// Squares a side of the hills: a million triangles.
const HILLS: u32 = 707;

/// The surfaces of the scenes.
pub(super) struct Stones {
    cobbles: Option<Arc<Surface>>,
    blocks: Option<Arc<Surface>>,
}

/// Where a mesh has a vertex, and its normal.
type Vertex = (Vec3, Vec3);

impl Stones {
    /// Those of the built-in scene, which take a moment to make.
    pub(super) fn new() -> Self {
        let mut surfaces = scene::builtin().materials.into_iter().map(|material| material.surface);
        let mut next = || surfaces.next().flatten();
        Self { cobbles: next(), blocks: next() }
    }

    /// One of the scenes.
    pub(super) fn scene(&self, standard: Standard) -> Scene {
        let (surface, mesh, eye, target) = match standard {
            Standard::Floor => (
                &self.cobbles,
                grid([1, 1], [32.0; 2], |at| (flat(at, 64.0, 0.0), Vec3::Y)),
                [0.0, 1.6, 6.0],
                [0.0, 0.6, 0.0],
            ),
            Standard::Wall => (
                &self.blocks,
                grid([1, 1], [4.0; 2], |at| ((at * 4.0 - 2.0).extend(0.0), Vec3::Z)),
                [2.2, 0.0, 0.55],
                [0.0; 3],
            ),
            Standard::Torus => (
                &self.cobbles,
                grid([256, 128], [10.0, 4.0], ring),
                [0.0, 1.35, 1.75],
                [0.0, -0.15, 0.1],
            ),
            Standard::Triangles => (
                &self.cobbles,
                grid([HILLS; 2], [20.0; 2], |at| (flat(at, 20.0, hill(at)), Vec3::Y)),
                [0.0, 5.5, 11.0],
                [0.0, -0.6, 0.5],
            ),
        };
        let camera = Camera {
            eye: Vec3::from(eye),
            target: Vec3::from(target),
            fov_degrees: 60.0,
            near: 0.05,
            ..Camera::default()
        };
        Scene {
            meshes: vec![mesh],
            materials: vec![Material { surface: surface.clone(), ..Material::default() }],
            camera,
            background: [0.18, 0.3, 0.5, 1.0],
            ..Scene::default()
        }
    }
}

/// A place of a level square with so many units a side, v away from the eye.
fn flat(at: Vec2, side: f32, height: f32) -> Vec3 {
    Vec3::new((at.x - 0.5) * side, height, (0.5 - at.y) * side)
}

/// The height of the hills.
fn hill(at: Vec2) -> f32 {
    sinf(at.x * 37.0) * cosf(at.y * 29.0) * 0.4 + sinf(at.x * 211.0) * 0.05
}

/// A place on a torus: u around its axis, v around its tube.
fn ring(at: Vec2) -> Vertex {
    let (around, across) = (at.x * TAU, at.y * TAU);
    let outwards = Vec3::new(cosf(around), 0.0, -sinf(around));
    let normal = outwards * cosf(across) + Vec3::Y * sinf(across);
    (outwards + normal * 0.45, normal)
}

/// A mesh over the unit square: two triangles for each of its cells, counter-clockwise where u
/// runs to the right and v up, and so many repeats of the texture along u and v.
fn grid([columns, rows]: [u32; 2], repeats: [f32; 2], vertex: impl Fn(Vec2) -> Vertex) -> Mesh {
    let stride = columns + 1;
    let corners = (0..=rows).flat_map(|j| (0..=columns).map(move |i| [i, j]));
    let places = corners.map(|[i, j]| Vec2::new(i as f32 / columns as f32, j as f32 / rows as f32));
    let places: Vec<Vec2> = places.collect();
    let (positions, normals) = places.iter().map(|at| vertex(*at)).unzip();
    let tex_coords = places.iter().map(|at| *at * Vec2::from(repeats)).collect();
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| j * stride + i));
    let triangles =
        cells.flat_map(|i| [[i, i + 1, i + stride + 1], [i, i + stride + 1, i + stride]]);
    Mesh::new(positions, tex_coords, normals, triangles.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::bench::SCENES;

    #[test]
    fn scenes_are_valid_and_look_outwards() {
        let stones = Stones { cobbles: None, blocks: None };
        for &(name, standard, _) in SCENES {
            let scene = stones.scene(standard);
            scene.validate().unwrap();
            let mesh = &scene.meshes[0];
            for triangle in &mesh.triangles {
                let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
                let normal = mesh.normals[triangle[0] as usize];
                assert!((b - a).cross(c - a).dot(normal) > 0.0, "{name} {triangle:?}");
            }
        }
        assert_eq!(stones.scene(Standard::Triangles).meshes[0].triangles.len(), 999_698);
    }
}
