//! Draws height-mapped surfaces on the CPU, with the texels that the relief hides left out of the
//! texture filter.
//!
//! A pixel far away on a cobbled street covers thousands of texels; the eye sees the near sides and
//! tops of the stones and none of what lies behind them. The usual filters average all of it. This
//! crate averages what the eye sees: by the method of Romanyuk and Archangel 2017
//! ([`Filter::Visible`]), and by a sweep that gives each texel its own place and its visible length
//! ([`Filter::Horizon`], the default). Any number of threads, tile size and SIMD level gives the
//! same bytes.
//!
//! # A frame
//!
//! ```no_run
//! use basrelief::{Settings, render, scene};
//!
//! render(scene::builtin(), Settings::default())?.save("street.png")?;
//! # Ok::<(), basrelief::Error>(())
//! ```
//!
//! [`load::load`] makes a scene of an OBJ file, its MTL files and images, or of a glTF file.
//!
//! # A filter alone
//!
//! For a renderer that has texture coordinates and derivatives of its own:
//!
//! ```
//! use basrelief::filter::Prepared;
//! use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps};
//! use basrelief::{Filter, Visible};
//!
//! // White ridges and black joints, as deep as a tenth of a repeat.
//! let ridge = |x: u32| if x % 16 < 8 { 1.0 } else { 0.0 };
//! let ground = Prepared::new(Surface::new(SurfaceMaps {
//!     albedo: Some(ColorImage::from_fn(64, 64, |x, _| [ridge(x); 3])),
//!     height: Some(HeightImage::from_fn(64, 64, |x, _| ridge(x))),
//!     relief_depth: 0.1,
//!     ..SurfaceMaps::default()
//! })?);
//! // A place, its derivatives to the right and down the screen, and the direction from the eye:
//! // along u, along v, and down. Once from above, once from low over the ground.
//! let seen_along = |view| ground.footprint([0.3, 0.7], [0.5, 0.0], [0.0, 0.1], view);
//! let pixels = [seen_along([0.0, 0.0, 1.0]), seen_along([0.9, 0.0, 0.3])];
//! let colors = ground.colors(&Filter::default(), &pixels);
//! assert!(colors[0][0] < 0.6 && colors[1][0] > 0.8);
//! // By the paper's own method.
//! let colors = ground.colors(&Filter::Visible(Visible::default()), &pixels);
//! assert!(colors[0][0] < 0.6 && colors[1][0] > 0.8);
//! # Ok::<(), basrelief::Error>(())
//! ```
//!
//! # Meshes of one's own
//!
//! ```
//! use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps};
//! use basrelief::{Camera, Material, Mesh, Scene, Settings, render};
//! use glam::{Vec2, Vec3};
//!
//! // Planks: five in a repeat, round on top, with dark joints between them.
//! let height = |x: u32| 1.0 - (((x % 26) as f32 - 12.5) / 13.0).powi(4);
//! let color = |x: u32| [0.8, 0.5, 0.3].map(|c: f32| c * height(x));
//! let maps = SurfaceMaps {
//!     albedo: Some(ColorImage::from_fn(130, 64, |x, _| color(x))),
//!     height: Some(HeightImage::from_fn(130, 64, |x, _| height(x))),
//!     relief_depth: 0.1,
//!     ..SurfaceMaps::default()
//! };
//! let material = Material { surface: Some(Surface::new(maps)?.into()), ..Material::default() };
//! let corners = [(-9.0, 1.0), (9.0, 1.0), (9.0, -60.0), (-9.0, -60.0)];
//! let positions = corners.map(|(x, z)| Vec3::new(x, -1.0, z)).to_vec();
//! let tex_coords = corners.map(|(x, z)| Vec2::new(x, -z)).to_vec();
//! let floor = Mesh::new(positions, tex_coords, vec![], vec![[0, 1, 2], [0, 2, 3]]);
//! let camera = Camera { eye: Vec3::ZERO, target: Vec3::NEG_Z, ..Camera::default() };
//! let (meshes, materials) = (vec![floor], vec![material]);
//! let scene = Scene { meshes, materials, camera, ..Scene::default() };
//!
//! let frame = render(scene, Settings { width: 96, height: 64, ..Settings::default() })?;
//! // Nothing above the horizon, planks below it.
//! assert_eq!(frame.pixels[0], [0.0; 4]);
//! assert_eq!(frame.pixels[63 * 96 + 48][3], 1.0);
//! # Ok::<(), basrelief::Error>(())
//! ```
//!
//! # Many frames, as bytes
//!
//! A [`Renderer`] keeps buffers, and what it has prepared of the scene, between frames:
//!
//! ```
//! use basrelief::{Camera, Frame, Renderer, Settings, scene};
//!
//! let settings = Settings { width: 160, height: 90, ..Settings::default() };
//! let mut renderer = Renderer::new(scene::builtin(), settings)?;
//! let camera = renderer.scene().camera;
//! // Bytes of sRGB, as windows and video encoders take them: a quarter of what linear light takes.
//! let mut frame = Frame::<[u8; 4]>::default();
//! for step in 0..2 {
//!     let walked = (camera.target - camera.eye) * 0.05 * step as f32;
//!     renderer.set_camera(Camera { eye: camera.eye + walked, ..camera })?;
//!     renderer.render_into(&mut frame);
//!     let bytes: &[u8] = frame.pixels.as_flattened();
//! #   assert_eq!((bytes.len(), bytes[3]), (160 * 90 * 4, 255));
//! }
//! # Ok::<(), basrelief::Error>(())
//! ```
//!
//! [`golden::check`] is for tests that compare with a picture in their repository, and
//! [`metrics::compare`] measures two pictures. `examples/` has these as programs.
//!
//! # The way of a pixel, one direction only
//!
//! ```text
//!  scene ──► geometry ──► raster ──► relief ──► footprint ──► light ──► filter ──► render
//!  Scene     Screen-      Quad-      Height-    Footprints    Local-    colours    Frame
//!            Triangle     Block      Field, hit Ellipses      Lights
//!
//!  ground floor, below all:   error   simd   texture   settings   frame
//!  before the scene:          decode ──► load ──► Scene
//! ```
//!
//! | room | what it is |
//! |---|---|
//! | `error` | [`Error`] and [`Result`]: one line for a person, `source()` for a program |
//! | `simd` | lanes: eight pixels, sixteen lines; the only file that names `wide` |
//! | [`texture`] | stored texels: images, packed mip levels, wrap, sRGB |
//! | `settings` | how a frame is drawn: [`Settings`], and [`Filter`] with its options |
//! | [`frame`] | pixels and image files |
//! | [`scene`] | what is drawn: meshes, materials, camera, lights; the built-in scene |
//! | `decode` | bytes of image files to samples |
//! | [`load`] | OBJ, MTL and glTF files to a scene, within limits |
//! | `geometry` | model space to screen triangles: projection, culling, clipping, fixed point |
//! | `raster` | screen triangles to quads: tiles, edge functions, depth, helper lanes |
//! | `relief` | height field, displacement, march to the hit; what a mip level loses |
//! | `shell` | the relief of a mesh in the world, and rays that are followed through it |
//! | `footprint` | formulas (2) and (3), the ellipse of formula (1), all rules for mip levels |
//! | `light` | how bright a normal is |
//! | [`filter`] | footprints to colours: all filters; the tables of the far field |
//! | `render` | a whole frame, one numbered step a stage: [`Renderer`] |
//! | [`layers`] | pictures for programs: depth, places, normals, names at the pixels' centres |
//! | [`inspect`] | what one pixel sees, and why: the paper's figures as numbers |
//! | [`metrics`] | PSNR, SSIM, FLIP, largest error, heat map |
//! | [`golden`] | pictures that tests must draw again |
//! | `reference` | the oracle that tests compare with: definitions in f64 |
//! | [`invariants`] | what holds of filters and coverage for any input |
//!
//! A stage imports only from stages to its left and from the ground floor; the last six stand
//! outside, and no stage imports them. Rooms without a link are no part of the interface and may
//! change with any version.
//!
//! The program is the package `basrelief-cli`. SIMD lanes are as wide as the crate is built for:
//! see [`SIMD_LEVEL`] and the README.
#![forbid(unsafe_code)]

pub mod filter;
pub mod frame;
pub mod golden;
pub mod inspect;
pub mod invariants;
pub mod layers;
pub mod load;
pub mod metrics;
pub mod scene;
pub mod texture;

mod decode;
mod error;
// The stages are public to the crate's own tests, benches and fuzz targets, and no part of the
// interface.
#[doc(hidden)]
pub mod footprint;
#[doc(hidden)]
pub mod geometry;
#[doc(hidden)]
pub mod light;
#[doc(hidden)]
pub mod raster;
#[doc(hidden)]
pub mod reference;
#[doc(hidden)]
pub mod relief;
mod render;
mod settings;
#[doc(hidden)]
pub mod shell;
#[doc(hidden)]
pub mod simd;

pub use error::{Error, Result};
pub use footprint::FootprintRule;
pub use frame::Frame;
pub use layers::{Layer, Layers};
pub use render::{DrawnPixel, Renderer, Stats, render};
pub use scene::{
    Camera, CutOut, Environment, Eye, Intrinsics, Light, Material, MaterialMaps, Mesh, PoseAxes,
    Scene, Sky,
};
pub use settings::{
    Derivatives, Ewa, Filter, Formulas, Horizon, Lighting, OptionsMut, RECONSTRUCTION, Rays,
    Region, Settings, Tone, Trilinear, Visibility, Visible,
};
pub use simd::LEVEL as SIMD_LEVEL;
