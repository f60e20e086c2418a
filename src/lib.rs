//! Draws height-mapped surfaces on the CPU, with the texels that the relief hides left out of the texture filter.
//!
//! A pixel far away on a cobbled street covers thousands of texels; the eye sees the near sides and tops of the stones and
//! none of what lies behind them. The usual filters average all of it. This crate averages what the eye sees: by the method
//! of Romanyuk and Archangel 2017 ([`Filter::Visible`]), and by a sweep that gives each texel its own place and its visible
//! length ([`Filter::Horizon`], the default). Any number of threads, tile size and SIMD level gives the same bytes.
//!
//! ```
//! use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps};
//! use basrelief::{Camera, Material, Mesh, Scene, Settings, render};
//! use glam::{Vec2, Vec3};
//!
//! // Planks: five in a repeat, round on top, with dark joints between them.
//! let height = |x: u32| 1.0 - (((x % 26) as f32 - 12.5) / 13.0).powi(4);
//! let maps = SurfaceMaps {
//!     albedo: Some(ColorImage::from_fn(130, 64, |x, _| [0.8, 0.5, 0.3].map(|c: f32| c * height(x)))),
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
//! let scene = Scene { meshes: vec![floor], materials: vec![material], camera, ..Scene::default() };
//!
//! let frame = render(scene, Settings { width: 96, height: 64, ..Settings::default() })?;
//! // Nothing above the horizon, planks below it.
//! assert_eq!(frame.pixels[0], [0.0; 4]);
//! assert_eq!(frame.pixels[63 * 96 + 48][3], 1.0);
//! frame.save(std::env::temp_dir().join("planks.png"))?;
//! # Ok::<(), basrelief::Error>(())
//! ```
//!
//! A frame of bytes, as windows and video encoders take them:
//!
//! ```
//! use basrelief::{Frame, Renderer, Settings, scene};
//!
//! let settings = Settings { width: 160, height: 90, ..Settings::default() };
//! let mut renderer = Renderer::new(scene::builtin(), settings)?;
//! // Bytes of sRGB; a quarter of the memory that linear light takes. Draw into it as often as you like.
//! let mut frame = Frame::<[u8; 4]>::default();
//! renderer.render_into(&mut frame);
//! let bytes: &[u8] = frame.pixels.as_flattened();
//! # assert_eq!((bytes.len(), bytes[3]), (160 * 90 * 4, 255));
//! # Ok::<(), basrelief::Error>(())
//! ```
//!
//! Several frames of one scene, here of the built-in one:
//!
//! ```
//! # std::env::set_current_dir(std::env::temp_dir()).unwrap();
//! use basrelief::{Camera, Renderer, Settings, scene};
//!
//! let settings = Settings { width: 160, height: 90, ..Settings::default() };
//! let mut renderer = Renderer::new(scene::builtin(), settings)?;
//! let camera = renderer.scene().camera;
//! for step in 0..2 {
//!     let walked = (camera.target - camera.eye) * 0.05 * step as f32;
//!     renderer.set_camera(Camera { eye: camera.eye + walked, ..camera })?;
//!     renderer.render().save(format!("walk{step}.png"))?;
//! }
//! # Ok::<(), basrelief::Error>(())
//! ```
//!
//! [`load::load`] reads OBJ files, [`scene::builtin`] makes the scene of the README, [`Renderer`] keeps tables and buffers
//! between frames, [`metrics::compare`] measures two pictures, [`golden::check`] is for tests that
//! compare with an image in their repository, and [`filter`] has the filters alone, on derivatives of your own.
//!
//! # The way of a pixel, one direction only
//!
//! ```text
//! scene ─► geometry ─► raster ─► relief ─► filter ─► shade ─► frame
//! Scene    ScreenTriangle  Quad      ViewSlope/Hit  Footprint→Rgb  Rgb   Frame
//! ```
//!
//! | module | what it does |
//! |---|---|
//! | [`scene`] | what is drawn: meshes, materials, camera, lights; the built-in scene |
//! | [`load`] | OBJ files, their MTL files and images, to a scene |
//! | `decode` | image files to samples, within limits |
//! | [`texture`] | stored texels: maps, packed mip levels, wrap, sRGB |
//! | `geometry` | model space to screen triangles: projection, clipping, set-up in fixed point |
//! | `raster` | screen triangles to quads: tiles, edge functions, depth, helper lanes |
//! | `relief` | the height field with its pyramid of maxima, the displacement, the march to the first hit |
//! | `filter` | footprint, formulas (2) and (3); ellipse, formula (1); all filters; the tables of the far field |
//! | `shade` | filtered colour and normals, and lights, to linear colour |
//! | `render` | a whole frame: one numbered step a stage |
//! | [`frame`] | linear pixels, sRGB bytes, image files |
//! | [`inspect`] | what one pixel sees, and why: the paper's figures as numbers |
//! | [`metrics`] | PSNR, SSIM, FLIP, largest error, heat map |
//! | [`golden`] | pictures that tests must draw again |
//! | `reference` | the scalar oracle that tests compare with |
//! | [`invariants`] | what holds of the filters for any input |
//! | `simd` | lane types; the only file that names `wide` |
//!
//! A stage imports only from stages to its left; `simd`, `texture` and `settings` lie below all. The stages are hidden from
//! these pages and may change with any version.
//!
//! The program is the package `basrelief-cli`. SIMD lanes are as wide as the crate is built for: see [`SIMD_LEVEL`] and
//! the README.
#![forbid(unsafe_code)]

pub mod filter;
pub mod frame;
pub mod golden;
pub mod inspect;
pub mod invariants;
pub mod load;
pub mod metrics;
pub mod scene;
pub mod texture;

mod decode;
mod error;
// The stages are public to the crate's own tests, benches and fuzz targets, and no part of the interface.
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
pub mod simd;

pub use error::{Error, Result};
pub use frame::Frame;
pub use render::{DrawnPixel, Renderer, Stats, render};
pub use scene::{Camera, Light, Material, Mesh, Scene};
pub use settings::{
    Derivatives, Ewa, Filter, FootprintRule, Formulas, Horizon, Lighting, RECONSTRUCTION, Rays, Region, Settings,
    Trilinear, Visibility, Visible,
};
pub use simd::LEVEL as SIMD_LEVEL;
