//! The scene that is drawn when none is given: a cobbled street to the horizon and a stone arch
//! that stands on it.
//!
//! Nothing is read: textures and meshes are made at start, from integer hashes and arithmetic that
//! rounds alike on every machine.

mod arch;
mod noise;
mod stones;

use crate::scene::camera::Camera;
use crate::scene::light::Light;
use crate::scene::material::Material;
use crate::scene::mesh::Mesh;
use crate::scene::sky::Sky;
use crate::scene::whole::Scene;
use crate::texture::{Surface, SurfaceMaps};
use arch::Arch;
use glam::{Vec2, Vec3};
use std::sync::Arc;
use stones::{Bond, Quarry, Style};

/// World units of a repeat of the street's texture, and of the arch's.
const STREET_REPEAT: f32 = 2.0;
const ARCH_REPEAT: f32 = 1.8;
/// Beyond this distance the street is lower than a pixel of a large frame.
const HORIZON: f32 = 1500.0;

/// The embedded scene: cobbles and an arch under a low sun.
pub fn builtin() -> Scene {
    let (street, arch) =
        rayon::join(|| surface(&street_style(), 1024, 0.06), || surface(&arch_style(), 512, 0.05));
    let materials = vec![
        Material { name: "street".into(), surface: street, ..Material::default() },
        Material { name: "arch".into(), surface: arch, ..Material::default() },
    ];
    Scene {
        meshes: vec![street_mesh(), arch_mesh()],
        materials,
        camera: Camera {
            eye: Vec3::new(-1.5, 0.66, 3.9),
            target: Vec3::new(0.1, 1.22, -2.0),
            fov_degrees: 54.0,
            near: 0.02,
            ..Camera::default()
        },
        lights: vec![Light::sun(Vec3::new(-0.62, 0.55, 0.56), Vec3::new(1.15, 1.02, 0.84))],
        sky: Sky::Color(Vec3::new(0.26, 0.29, 0.34)),
        background: [0.50, 0.64, 0.80, 1.0],
    }
}

fn surface(style: &Style, size: u32, relief_depth: f32) -> Option<Arc<Surface>> {
    let (albedo, height) = Quarry::new(style).maps(size);
    let maps = SurfaceMaps {
        albedo: Some(albedo),
        height: Some(height),
        relief_depth,
        ..SurfaceMaps::default()
    };
    let surface = Surface::new(maps).expect("maps made here have a valid size");
    Some(Arc::new(surface))
}

/// Granite setts.
fn street_style() -> Style {
    Style {
        bond: Bond::Cobbles,
        num_in_row: 8,
        num_rows: 10,
        repeat: STREET_REPEAT,
        joint: 0.007,
        shoulder: 0.052,
        roughness: 0.22,
        tints: [
            [0.46, 0.36, 0.26],
            [0.34, 0.27, 0.21],
            [0.54, 0.43, 0.30],
            [0.42, 0.265, 0.17],
            [0.27, 0.27, 0.27],
            [0.48, 0.39, 0.31],
        ],
        mortar: [0.045, 0.037, 0.028],
        seed: 7,
    }
}

/// Sandstone blocks, hewn by hand.
fn arch_style() -> Style {
    Style {
        bond: Bond::Blocks,
        num_in_row: 4,
        num_rows: 6,
        repeat: ARCH_REPEAT,
        joint: 0.009,
        shoulder: 0.05,
        roughness: 0.3,
        tints: [
            [0.56, 0.43, 0.28],
            [0.50, 0.36, 0.23],
            [0.62, 0.50, 0.35],
            [0.52, 0.33, 0.21],
            [0.47, 0.40, 0.31],
            [0.58, 0.46, 0.33],
        ],
        mortar: [0.10, 0.08, 0.06],
        seed: 19,
    }
}

/// A plane in strips that grow with the distance, so that no triangle is all of it.
fn street_mesh() -> Mesh {
    let mut rows = vec![12.0, 4.0, 0.0, -4.0, -12.0];
    while rows.last().is_some_and(|z: &f32| *z > -HORIZON) {
        rows.extend(rows.last().map(|z| z * 2.0));
    }
    let (mut positions, mut tex_coords, mut triangles) = (vec![], vec![], vec![]);
    for (i, &z) in rows.iter().enumerate() {
        let first = positions.len() as u32;
        for x in [-HORIZON, -60.0, 0.0, 60.0, HORIZON] {
            positions.push(Vec3::new(x, 0.0, z));
            tex_coords.push(Vec2::new(x, -z) / STREET_REPEAT);
        }
        for k in 0..if i == 0 { 0 } else { 4 } {
            let (near, far) = (first - 5 + k, first + k);
            triangles.extend([[near, near + 1, far + 1], [near, far + 1, far]]);
        }
    }
    let normals = vec![Vec3::Y; positions.len()];
    Mesh {
        name: "street".into(),
        material: 0,
        ..Mesh::new(positions, tex_coords, normals, triangles)
    }
}

fn arch_mesh() -> Mesh {
    let arch = Arch { radius: 1.3, pillar: 1.8, thickness: 0.9, depth: 1.35, repeat: ARCH_REPEAT };
    let mut mesh = arch.mesh();
    mesh.positions.iter_mut().for_each(|p| p.z -= 2.0);
    Mesh { name: "arch".into(), material: 1, ..mesh }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_builtin_scene_is_valid_and_always_the_same() {
        let (a, b) = (builtin(), builtin());
        a.validate().expect("valid");
        assert_eq!(a.meshes[1].positions, b.meshes[1].positions);
        let heights = |scene: &Scene| {
            let surface = scene.materials[0].surface.as_ref().expect("textured");
            (0..64).map(|i| surface.base().height_at(i * 16, i * 7)).collect::<Vec<_>>()
        };
        assert_eq!(heights(&a), heights(&b));
    }

    #[test]
    fn faces_of_the_builtin_meshes_look_outwards() {
        for mesh in [street_mesh(), arch_mesh()] {
            for triangle in &mesh.triangles {
                let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
                assert!(
                    (b - a).cross(c - a).dot(mesh.normals[triangle[0] as usize]) > 0.0,
                    "{} {triangle:?}",
                    mesh.name
                );
                let [u, v] = mesh.tangents[triangle[0] as usize];
                assert!(
                    u.cross(v).dot(mesh.normals[triangle[0] as usize]) > 0.0,
                    "{} is not mirrored",
                    mesh.name
                );
            }
        }
    }
}
