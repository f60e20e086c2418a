//! The relief as real geometry: each triangle cut into many, whose corners are moved down by the
//! height map. Drawn without any relief, it is what a relief must look like.
#![allow(dead_code, unreachable_pub, reason = "each test uses a part")]

use crate::common::floor_scene;
use basrelief::texture::{ColorImage, FULL, Surface, SurfaceMaps, srgb_from_linear};
use basrelief::{Camera, Filter, Frame, Layer, Material, Mesh, Renderer, Scene, Settings};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// A unit direction at a part of a turn, by bisecting right angles: no sines.
pub fn direction(turn: f32) -> Vec2 {
    let turn = turn * 4.0;
    let quarter = turn.floor() as usize % 4;
    let axes = [Vec2::X, Vec2::Y, -Vec2::X, -Vec2::Y];
    let (mut from, mut to) = (axes[quarter], axes[(quarter + 1) % 4]);
    let mut part = turn - turn.floor();
    for _ in 0..16 {
        let middle = (from + to).normalize();
        (from, to, part) =
            if part < 0.5 { (from, middle, part * 2.0) } else { (middle, to, part * 2.0 - 1.0) };
    }
    from
}

/// A grid of `num` quads around and across, whose points, normals and texture coordinates are those
/// of a function of the parts, 0 to 1, along both.
pub fn grid(num: [u32; 2], at: impl Fn(f32, f32) -> (Vec3, Vec3, Vec2)) -> Mesh {
    let place = |i: u32| {
        let [x, y] = [i % (num[0] + 1), i / (num[0] + 1)];
        at(x as f32 / num[0] as f32, y as f32 / num[1] as f32)
    };
    let points: Vec<_> = (0..(num[0] + 1) * (num[1] + 1)).map(place).collect();
    let index = |x: u32, y: u32| y * (num[0] + 1) + x;
    let quads = (0..num[1]).flat_map(|y| (0..num[0]).map(move |x| [x, y]));
    let triangles = quads.flat_map(|[x, y]| {
        let [a, b, c, d] = [index(x, y), index(x + 1, y), index(x + 1, y + 1), index(x, y + 1)];
        [[a, b, c], [a, c, d]]
    });
    Mesh::new(
        points.iter().map(|(p, ..)| *p).collect(),
        points.iter().map(|(.., t)| *t).collect(),
        points.iter().map(|(_, n, _)| *n).collect(),
        triangles.collect(),
    )
}

/// A torus around the y axis: radius 1 to the middle of a tube of radius 0.5.
pub fn torus(num: [u32; 2]) -> Mesh {
    grid(num, |u, v| {
        let (around, across) = (direction(u), direction(v));
        let normal = Vec3::new(around.x * across.x, across.y, -around.y * across.x);
        let middle = Vec3::new(around.x, 0.0, -around.y);
        (middle + normal * 0.5, normal, Vec2::new(u * 8.0, v * 4.0))
    })
}

/// A sphere of radius 1.
pub fn sphere(num: [u32; 2]) -> Mesh {
    grid(num, |u, v| {
        let (around, up) = (direction(u), direction(v * 0.5 + 0.75));
        let normal = Vec3::new(around.x * up.x, up.y, -around.y * up.x);
        (normal, normal, Vec2::new(u * 8.0, v * 4.0))
    })
}

/// A mesh with a relief, seen from in front and above, before nothing.
pub fn scene(mesh: Mesh, maps: SurfaceMaps, distance: f32) -> Scene {
    let surface = Some(Arc::new(Surface::new(maps).expect("valid maps")));
    Scene {
        meshes: vec![mesh],
        materials: vec![Material { surface, ..Material::default() }],
        camera: Camera {
            eye: Vec3::new(0.0, 0.65, 0.76) * distance,
            target: Vec3::ZERO,
            fov_degrees: 50.0,
            ..Camera::default()
        },
        ..Scene::default()
    }
}

/// A floor of stones from above, with a ball that is sunk half into it.
pub fn ball_in_stones(maps: SurfaceMaps) -> Scene {
    let mut scene = floor_scene(Surface::new(maps).expect("valid maps"), 0.5);
    let mut ball = sphere([48, 24]);
    ball.positions.iter_mut().for_each(|position| *position *= 0.8);
    ball.material = 1;
    scene.meshes.push(ball);
    scene.materials.push(Material { base_color: Vec3::new(0.8, 0.3, 0.2), ..Default::default() });
    (scene.camera.eye, scene.camera.target) = (Vec3::new(0.0, 1.5, 2.2), Vec3::ZERO);
    scene
}

/// The scene with each triangle of the meshes that have relief cut into `pieces` squared, whose
/// corners lie where the relief is; their material has none. Triangles that are far from facing the
/// eye are left out.
pub fn displaced(scene: &Scene, pieces: u32) -> Scene {
    let mut scene = scene.clone();
    let num_materials = scene.materials.len();
    for mesh in &mut scene.meshes {
        let material = scene.materials[mesh.material].clone();
        let Some(surface) = material.surface.as_ref().filter(|s| s.relief_depth() > 0.0) else {
            continue;
        };
        *mesh = displaced_mesh(mesh, surface, pieces, scene.camera.eye);
        mesh.material += num_materials;
    }
    for i in 0..num_materials {
        let mut material = scene.materials[i].clone();
        material.surface = material.surface.map(|surface| Arc::new(without_relief(&surface)));
        scene.materials.push(material);
    }
    scene
}

/// The colours of a surface alone.
fn without_relief(surface: &Surface) -> Surface {
    let [width, height] = surface.base().size().map(|side| side as u32);
    let scale = surface.color_scale() / FULL as f32;
    let albedo = ColorImage::from_fn(width, height, |x, y| {
        surface.base().texel(x as i32, y as i32).color.map(|c| c * scale)
    });
    let maps = SurfaceMaps { albedo: Some(albedo), wrap: surface.wrap(), ..Default::default() };
    Surface::new(maps).expect("valid maps")
}

fn displaced_mesh(mesh: &Mesh, surface: &Surface, pieces: u32, eye: Vec3) -> Mesh {
    let mut cut = Mesh { material: mesh.material, ..Mesh::default() };
    for triangle in &mesh.triangles {
        let corners = triangle.map(|i| {
            let i = i as usize;
            let [u, v] = mesh.tangents[i];
            // The world length of a repeat, in which depth is measured.
            let down = mesh.normals[i] * (u.cross(v).length().sqrt() * surface.relief_depth());
            (mesh.positions[i], mesh.tex_coords[i], down)
        });
        let facing = triangle.map(|i| {
            let i = i as usize;
            (eye - mesh.positions[i]).normalize().dot(mesh.normals[i])
        });
        if facing.iter().all(|cosine| *cosine < -0.7) {
            continue;
        }
        let first = cut.positions.len() as u32;
        for row in 0..=pieces {
            for column in 0..=pieces - row {
                let b = [row, column].map(|i| i as f32 / pieces as f32);
                let b = [1.0 - b[0] - b[1], b[0], b[1]];
                let place = corners[0].1 * b[0] + corners[1].1 * b[1] + corners[2].1 * b[2];
                let depth = 1.0 - height(surface, place);
                cut.positions.push(
                    (0..3).fold(Vec3::ZERO, |sum, i| {
                        sum + (corners[i].0 - corners[i].2 * depth) * b[i]
                    }),
                );
                cut.tex_coords.push(place);
            }
        }
        let index = |row: u32, column: u32| {
            first + row * (pieces + 1) - row * row.saturating_sub(1) / 2 + column
        };
        for row in 0..pieces {
            for column in 0..pieces - row {
                let [a, b, c] =
                    [index(row, column), index(row + 1, column), index(row, column + 1)];
                cut.triangles.push([a, b, c]);
                if column + 1 < pieces - row {
                    cut.triangles.push([b, index(row + 1, column + 1), c]);
                }
            }
        }
    }
    cut.normals = vec![Vec3::Y; cut.positions.len()];
    cut.tangents = vec![[Vec3::X, Vec3::Z]; cut.positions.len()];
    cut
}

/// The bilinear height, 0 to 1, at a place in repeats.
fn height(surface: &Surface, place: Vec2) -> f32 {
    let base = surface.base();
    let [x, y] = [0, 1].map(|i| place[i] * base.texels_per_repeat()[i] - 0.5);
    let (column, row) = (x.floor(), y.floor());
    let at = |dx: i32, dy: i32| base.height_at(column as i32 + dx, row as i32 + dy);
    let across = |dy: i32| at(0, dy) + (at(1, dy) - at(0, dy)) * (x - column);
    across(0) + (across(1) - across(0)) * (y - row)
}

/// What a picture of displaced triangles shows.
pub struct Shown {
    /// The fourth component is the part of four samples that is covered.
    pub coverage: Frame,
    /// Colours under the kernel `exp(-2 r^2)`; opaque where all of it is covered.
    pub colors: Frame,
    /// The depth layer.
    pub depth: Vec<f32>,
}

/// Pixels a side that stand for one of a picture of [`Shown`].
const FINER: u32 = 8;

/// Draws displaced triangles by a plain filter.
pub fn show(displaced: &Scene, settings: &Settings) -> Shown {
    let plain = Settings { filter: Filter::Bilinear, parallax: false, ..settings.clone() };
    let mut renderer = Renderer::new(displaced.clone(), plain.clone()).expect("a valid scene");
    let coverage = renderer.render();
    let depth = renderer.render_layers(&[Layer::Depth]).floats(Layer::Depth).to_vec();
    let [width, height] = [settings.width, settings.height].map(|side| side * FINER);
    renderer.set_settings(Settings { width, height, msaa: 1, ..plain }).expect("valid settings");
    let fine = renderer.render();
    Shown { coverage, colors: blurred(&fine, settings), depth }
}

fn blurred(fine: &Frame, settings: &Settings) -> Frame {
    let finer = FINER as i32;
    let offsets: Vec<_> = (-finer..2 * finer)
        .flat_map(|y| (-finer..2 * finer).map(move |x| [x, y]))
        .filter_map(|at| {
            let [x, y] = at.map(|c| (c as f32 + 0.5) / finer as f32 - 0.5);
            let squared = x * x + y * y;
            (squared < 1.0).then(|| (at, (-2.0 * squared).exp()))
        })
        .collect();
    let mut frame = Frame { width: settings.width, height: settings.height, pixels: vec![] };
    for y in 0..settings.height as i32 {
        for x in 0..settings.width as i32 {
            let (mut sum, mut weights) = ([0.0_f32; 4], 0.0);
            for ([dx, dy], weight) in &offsets {
                let at = [x * finer + dx, y * finer + dy];
                if (0..fine.width as i32).contains(&at[0])
                    && (0..fine.height as i32).contains(&at[1])
                {
                    let pixel = fine.pixels[(at[1] * fine.width as i32 + at[0]) as usize];
                    (0..4).for_each(|c| sum[c] += pixel[c] * weight);
                    weights += weight;
                }
            }
            frame.pixels.push(sum.map(|c| c / weights));
        }
    }
    frame
}

/// How much the coverage of two frames overlaps: their common part over all that either covers.
pub fn overlap(a: &Frame, b: &Frame) -> f64 {
    let pairs = || a.pixels.iter().zip(&b.pixels).map(|(a, b)| [a[3], b[3]].map(f64::from));
    let common: f64 = pairs().map(|[a, b]| a.min(b)).sum();
    common / pairs().map(|[a, b]| a.max(b)).sum::<f64>()
}

/// PSNR of colours as they are encoded, where both frames are opaque.
pub fn decibels(a: &Frame, b: &Frame) -> f64 {
    let (mut sum, mut num) = (0.0, 0.0);
    let opaque = |pixel: &[f32; 4]| pixel[3] > 0.9999;
    for (a, b) in a.pixels.iter().zip(&b.pixels).filter(|(a, b)| opaque(a) && opaque(b)) {
        for c in 0..3 {
            sum += f64::from(srgb_from_linear(a[c]) - srgb_from_linear(b[c])).powi(2);
            num += 1.0;
        }
    }
    -10.0 * (sum / num).log10()
}

/// The share of pixels that both see whose depths differ by no more than `most`.
pub fn depths_within(a: &[f32], b: &[f32], most: f32) -> f64 {
    let both = || a.iter().zip(b).filter(|(a, b)| a.is_finite() && b.is_finite());
    both().filter(|(a, b)| (**a - **b).abs() <= most).count() as f64 / both().count() as f64
}
