//! Whole frames: triangles, scenes and command lines.

use crate::input::{Input, Number, floor};
use crate::{check, hold};
use arbitrary::Arbitrary;
use basrelief::invariants::{
    fan_is_hit_once, frame_is_finite, layers_agree, lights_add, no_more_than_the_sky, outlines_hold,
};
use basrelief::{
    Camera, Filter, Intrinsics, Light, Lighting, Material, Mesh, Rays, Scene, Settings, Sky,
};
use basrelief_cli::{Cli, Ending};
use glam::{Vec2, Vec3};
use std::ffi::OsString;
use std::sync::{Arc, LazyLock};

/// A closed fan of triangles, partly behind the eye, hits no pixel twice.
pub fn coverage(bytes: &[u8]) {
    type Fan = ([i16; 2], [(u8, u8); 8], [i8; 2], u8);
    check(bytes, |(center, ring, tilt, msaa): Fan| {
        // From 4 to four million pixels.
        let radius = |(size, digits): (u8, u8)| {
            (1.0 + f32::from(digits) / 256.0) * (4_u32 << (size % 20)) as f32
        };
        let center = center.map(|c| f32::from(c) / 1024.0);
        let tilt = tilt.map(|t| f32::from(t) / 16.0);
        hold(fan_is_hit_once(center, &ring.map(radius), tilt, [1, 4, 8][usize::from(msaa % 3)]));
    });
}

/// Small scenes of any triangles, camera and settings: refused with a reason, or drawn with finite
/// colours; the truth's lights add up, and none sends out more than it gets.
pub fn render(bytes: &[u8]) {
    type Corner = ([Number; 3], [Number; 2]);
    type Drawn = (Input, Vec<Corner>, [[Number; 3]; 2], u8);
    check(bytes, |(texture, mut corners, [eye, light], options): Drawn| {
        corners.truncate(48);
        let vector = |v: [Number; 3]| Vec3::from(v.map(Number::get));
        let positions = corners.iter().map(|corner| vector(corner.0)).collect();
        let tex_coords =
            corners.iter().map(|corner| Vec2::from(corner.1.map(Number::get))).collect();
        let triangles =
            (0..corners.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let surface = Some(Arc::new(texture.surface()));
        let scene = Scene {
            meshes: vec![Mesh::new(positions, tex_coords, vec![], triangles)],
            materials: vec![Material { surface, ..Material::default() }],
            camera: Camera { eye: vector(eye), ..Camera::default() },
            lights: vec![Light::Point { position: vector(light), intensity: Vec3::ONE }],
            ..Scene::default()
        };
        let rays = Rays { samples: 2 };
        let [parallax, truth] = [Filter::Parallax(rays), Filter::Truth(rays)];
        let filters = [texture.filter(), parallax, truth, Filter::Horizon(texture.horizon())];
        let settings = Settings {
            width: 24,
            height: 16,
            filter: filters[usize::from(options >> 4 & 3)],
            lighting: if options & 1 == 0 { Lighting::Unlit } else { Lighting::Lit },
            msaa: [1, 4, 8, 4][usize::from(options >> 1 & 3)],
            ..Settings::default()
        };
        if options & 0x40 != 0 {
            // Four frames of the truth: smaller ones.
            let settings = Settings { width: 12, height: 8, ..settings.clone() };
            hold(no_more_than_the_sky(scene.clone(), &settings, 2));
            let sun = Light::sun(vector(eye) + Vec3::Y, Vec3::ONE);
            let sky = Sky::Gradient { top: Vec3::ONE, horizon: Vec3::X, ground: Vec3::ZERO };
            let lights = [&scene.lights[..], &[sun]].concat();
            hold(lights_add(Scene { lights, sky, ..scene.clone() }, &settings, 2));
        }
        hold(frame_is_finite(scene, settings));
    });
}

/// Small scenes of any triangles, seen from anywhere: what their layers say agrees.
pub fn layers(bytes: &[u8]) {
    type Corner = ([Number; 3], [Number; 2]);
    type Drawn = (Input, Vec<Corner>, [[Number; 3]; 3], [[Number; 2]; 3], u8);
    check(bytes, |(texture, mut corners, [eye, target, up], numbers, options): Drawn| {
        let [[fov, near], [fx, fy], [cx, cy]] = numbers;
        let lens = [fx, fy, cx, cy].map(Number::get);
        corners.truncate(48);
        let vector = |v: [Number; 3]| Vec3::from(v.map(Number::get));
        let positions = corners.iter().map(|corner| vector(corner.0)).collect();
        let has_uv = options & 1 == 0;
        let uv = corners.iter().map(|corner| Vec2::from(corner.1.map(Number::get)));
        let tex_coords = if has_uv { uv.collect() } else { vec![] };
        let triangles =
            (0..corners.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let surface = (options & 2 == 0).then(|| Arc::new(texture.surface()));
        let scene = Scene {
            meshes: vec![Mesh::new(positions, tex_coords, vec![], triangles)],
            materials: vec![Material { surface, ..Material::default() }],
            camera: Camera {
                eye: vector(eye),
                target: vector(target),
                up: vector(up),
                fov_degrees: 60.0 + 30.0 * fov.get(),
                near: near.get().abs(),
                orthographic: (options & 48 == 32).then(|| 8.0 * (1.0 + fov.get())),
                intrinsics: (options & 16 != 0).then_some(Intrinsics {
                    fx: lens[0],
                    fy: lens[1],
                    cx: lens[2],
                    cy: lens[3],
                }),
            },
            ..Scene::default()
        };
        let settings = Settings {
            width: 21,
            height: 14,
            filter: Filter::Nearest,
            parallax: options & 4 == 0,
            silhouette: options & 64 == 0,
            cull_back_faces: options & 8 != 0,
            ..Settings::default()
        };
        hold(layers_agree(scene, settings));
    });
}

/// A lattice of a curved relief of any corners, and a triangle that may lie in it: no sample is
/// covered where no polygon is, and tiles show nowhere.
pub fn outlines(bytes: &[u8]) {
    type Corner = ([Number; 3], [Number; 2]);
    type Drawn = (Input, [Corner; 16], [[Number; 3]; 3], [Number; 3], u8);
    check(bytes, |(texture, corners, other, eye, options): Drawn| {
        let vector = |v: [Number; 3]| Vec3::from(v.map(Number::get));
        let positions = corners.iter().map(|corner| vector(corner.0)).collect();
        let tex_coords =
            corners.iter().map(|corner| Vec2::from(corner.1.map(Number::get))).collect();
        let quads = (0..9).map(|i| i / 3 * 4 + i % 3);
        let triangles = quads.flat_map(|i| [[i, i + 1, i + 5], [i, i + 5, i + 4]]).collect();
        let other = Mesh::new(other.map(vector).to_vec(), vec![], vec![], vec![[0, 1, 2]]);
        let scene = Scene {
            meshes: vec![
                Mesh::new(positions, tex_coords, vec![], triangles),
                Mesh { material: 1, ..other },
            ],
            materials: vec![
                Material { surface: Some(Arc::new(texture.surface())), ..Material::default() },
                Material::default(),
            ],
            camera: Camera { eye: vector(eye), ..Camera::default() },
            ..Scene::default()
        };
        let settings = Settings {
            width: 40,
            height: 24,
            filter: Filter::Nearest,
            cull_back_faces: options & 1 == 0,
            msaa: [1, 4, 8, 4][usize::from(options >> 1 & 3)],
            ..Settings::default()
        };
        hold(outlines_hold(scene.clone(), settings.clone()));
        hold(layers_agree(scene, settings));
    });
}

#[derive(Arbitrary, Debug)]
enum Word<'a> {
    /// An option or a word that it takes, by number.
    Known(u8),
    Numbers([Number; 3], u8),
    Text(&'a str),
    Bytes(&'a [u8]),
}

/// All options, and all words that they take.
static KNOWN: LazyLock<Vec<String>> = LazyLock::new(|| {
    let mut words = Cli::words();
    words.extend(["compare", "inspect", "render", "study", "64x36"].map(str::to_owned));
    words
});

impl Word<'_> {
    fn argument(self) -> OsString {
        match self {
            Self::Known(i) => KNOWN[usize::from(i) % KNOWN.len()].clone().into(),
            Self::Numbers(numbers, num) => {
                let numbers = numbers.map(|n| n.get().to_string());
                numbers[..1 + usize::from(num % 3)].join(",").into()
            }
            Self::Text(text) => text.into(),
            Self::Bytes(bytes) => os_string(bytes),
        }
    }
}

#[cfg(unix)]
fn os_string(bytes: &[u8]) -> OsString {
    std::os::unix::ffi::OsStringExt::from_vec(bytes.to_vec())
}

#[cfg(not(unix))]
fn os_string(bytes: &[u8]) -> OsString {
    String::from_utf8_lossy(bytes).into_owned().into()
}

/// Any command line: help, a refusal of one line, or options with which a small scene is drawn or
/// refused. Reads and writes no file.
pub fn command_line(bytes: &[u8]) {
    check(bytes, |words: Vec<Word>| {
        let words = words.into_iter().map(Word::argument);
        let cli = match Cli::read(std::iter::once("basrelief".into()).chain(words)) {
            Ok(cli) => cli,
            Err(Ending::Refused(refusal)) => {
                let line = refusal.to_string();
                return assert!(!line.contains('\n') && !line.is_empty(), "not one line: {line}");
            }
            Err(Ending::Help(help)) => return assert!(!help.to_string().is_empty()),
        };
        let mut scene = floor();
        let Ok(Some(mut settings)) = cli.picture(&mut scene) else { return };
        if let Filter::Parallax(rays) | Filter::Truth(rays) = &mut settings.filter {
            rays.samples = rays.samples.min(4);
        }
        let (width, height) = (settings.width.min(16), settings.height.min(12));
        hold(frame_is_finite(scene, Settings { width, height, region: None, ..settings }));
    });
}
