//! Scenes of several benches.
#![allow(dead_code, reason = "each bench uses a part")]

use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps};
use basrelief::{Camera, Material, Mesh, Scene};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// A hilly square of `2 * side^2` triangles, seen from above its border.
pub(crate) fn terrain(side: u32) -> Scene {
    let num = side + 1;
    let corner = |i: u32| Vec2::new((i % num) as f32, (i / num) as f32) / side as f32;
    let position = |at: Vec2| {
        let height = (at.x * 37.0).sin() * (at.y * 29.0).cos() * 0.4 + (at.x * 211.0).sin() * 0.05;
        Vec3::new(at.x * 20.0 - 10.0, height, at.y * 20.0 - 10.0)
    };
    let cells = (0..side * num).filter(|i| i % num != side);
    let triangles =
        cells.flat_map(|i| [[i, i + num, i + 1], [i + 1, i + num, i + num + 1]]).collect();
    let positions = (0..num * num).map(|i| position(corner(i))).collect();
    let tex_coords = (0..num * num).map(|i| corner(i) * 20.0).collect();
    let camera = Camera {
        eye: Vec3::new(0.0, 5.5, 11.0),
        target: Vec3::new(0.0, -0.6, 0.5),
        ..Camera::default()
    };
    scene(Mesh::new(positions, tex_coords, vec![], triangles), camera)
}

/// Two triangles to the horizon.
pub(crate) fn floor() -> Scene {
    let at = [(-32.0, 32.0), (32.0, 32.0), (32.0, -32.0), (-32.0, -32.0)];
    let positions = at.map(|(x, z)| Vec3::new(x, 0.0, z)).to_vec();
    let tex_coords = at.map(|(x, z)| Vec2::new(x, -z)).to_vec();
    let camera = Camera {
        eye: Vec3::new(0.0, 1.6, 6.0),
        target: Vec3::new(0.0, 0.6, 0.0),
        ..Camera::default()
    };
    scene(Mesh::new(positions, tex_coords, vec![], vec![[0, 1, 2], [0, 2, 3]]), camera)
}

fn scene(mesh: Mesh, camera: Camera) -> Scene {
    Scene { meshes: vec![mesh], materials: vec![Material::default()], camera, ..Scene::default() }
}

/// A surface of `size` texels a side with stones of 64 texels, or bare of relief.
pub(crate) fn stones(size: u32, seed: u32, relief_depth: f32) -> Arc<Surface> {
    let noise = move |x: u32, y: u32| {
        let hash = (x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77) ^ seed)
            .wrapping_mul(0xc2b2_ae3d);
        ((hash ^ hash >> 15) & 0xffff) as f32 / 65535.0
    };
    let height = |x: u32, y: u32| {
        let [u, v] = [x, y].map(|c| ((c % 64) as f32 + 0.5) / 32.0 - 1.0);
        (1.0 - u.powi(6)) * (1.0 - v.powi(6))
    };
    let albedo =
        ColorImage::from_fn(size, size, |x, y| [0.3, 0.25, 0.2].map(|c| c + 0.5 * noise(x, y)));
    let heights = (relief_depth > 0.0).then(|| HeightImage::from_fn(size, size, height));
    let maps = SurfaceMaps {
        albedo: Some(albedo),
        height: heights,
        relief_depth,
        ..SurfaceMaps::default()
    };
    Arc::new(Surface::new(maps).expect("valid maps"))
}

/// The scene with its first material's surface and `repeats` times its texture coordinates.
pub(crate) fn textured(mut scene: Scene, surface: Arc<Surface>, repeats: f32) -> Scene {
    scene.materials[0].surface = Some(surface);
    for mesh in &mut scene.meshes {
        let tex_coords = mesh.tex_coords.iter().map(|uv| *uv * repeats).collect();
        *mesh = Mesh {
            material: mesh.material,
            ..Mesh::new(mesh.positions.clone(), tex_coords, vec![], mesh.triangles.clone())
        };
    }
    scene
}

/// The terrain of `2 * side^2` triangles cut into `tiles^2` objects with a material each, which
/// share the surfaces in turn.
pub(crate) fn objects(side: u32, tiles: u32, surfaces: &[Arc<Surface>]) -> Scene {
    let whole = terrain(side);
    let mesh = &whole.meshes[0];
    let part = side.div_ceil(tiles);
    let mut triangles = vec![Vec::new(); (tiles * tiles) as usize];
    for pair in mesh.triangles.chunks(2) {
        let (x, y) = (pair[0][0] % (side + 1), pair[0][0] / (side + 1));
        triangles[(y / part * tiles + x / part) as usize].extend_from_slice(pair);
    }
    // Neighbours in the list are far apart on the screen, as the objects of a file are.
    let num = triangles.len();
    let order = (0..num).map(|i| i * 7919 % num);
    let cut = order.map(|i| {
        let mut places = std::collections::BTreeMap::new();
        let triangles = triangles[i].iter().map(|triangle| {
            triangle.map(|vertex| {
                let next = places.len() as u32;
                places.entry(vertex).or_insert(next).to_owned()
            })
        });
        let triangles = triangles.collect();
        let mut vertices: Vec<_> = places.into_iter().collect();
        vertices.sort_by_key(|(_, place)| *place);
        let pick = |(vertex, _): &(u32, u32)| *vertex as usize;
        let positions = vertices.iter().map(|v| mesh.positions[pick(v)]).collect();
        let tex_coords = vertices.iter().map(|v| mesh.tex_coords[pick(v)]).collect();
        Mesh { material: i, ..Mesh::new(positions, tex_coords, vec![], triangles) }
    });
    let meshes = cut.collect();
    let surface = |i: usize| Some(surfaces[i % surfaces.len()].clone());
    let materials =
        (0..num).map(|i| Material { surface: surface(i), ..Material::default() }).collect();
    Scene { meshes, materials, camera: whole.camera, ..Scene::default() }
}
