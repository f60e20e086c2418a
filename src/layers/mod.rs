//! Pictures for programs: what lies at the centre of each pixel, as numbers.
//!
//! Training data, compositors and viewers want to know how far a pixel is, where, which way it
//! faces and what it belongs to. [`Renderer::render_layers`] answers that for a frame, or a
//! [region](Settings::region) of it. Every number is that of one ray, through the pixel's centre:
//! column `x` and row `y` have it at `(x + 0.5, y + 0.5)` pixels from the upper left corner.
//! Nothing is filtered or averaged, whatever [`Settings::filter`] and [`Settings::msaa`] say, and
//! the numbers are the same for any number of threads and tile size. Only what is asked for is
//! computed.
//!
//! ```
//! use basrelief::{Filter, Layer, Renderer, Settings, scene};
//!
//! // A filter without tables: layers need none.
//! let settings = Settings { width: 160, height: 90, filter: Filter::Nearest, ..Settings::default() };
//! let mut renderer = Renderer::new(scene::builtin(), settings)?;
//! let layers = renderer.render_layers(&[Layer::Depth, Layer::Object]);
//! let at = 80 * 160 + 40; // column 40, row 80
//! let (depth, object) = (layers.floats(Layer::Depth)[at], layers.ids(Layer::Object)[at]);
//! assert!(depth > 0.0 && depth.is_finite());
//! println!("{} is {depth} away", renderer.scene().meshes[object as usize].name);
//! // The sky.
//! assert_eq!(layers.floats(Layer::Depth)[0], f32::INFINITY);
//! assert_eq!(layers.ids(Layer::Object)[0], u32::MAX);
//! # Ok::<(), basrelief::Error>(())
//! ```
//!
//! # Where relief is traced
//!
//! The layers of the *hit* say where the ray meets the relief, those of the *polygon* where it
//! meets the mesh. They differ where a material has relief and [`Settings::parallax`] is on. Relief
//! goes down from its polygon: a hit is never before it. Which triangle a pixel sees is as in a
//! frame: that behind which its ray meets a surface. A hit lies on the pixel's view ray, as far behind the polygon as
//! the depth of the relief there asks for:
//!
//! ```text
//!   eye o                        the ray R goes gamma repeats of the texture down on its way
//!        \                       from the eye to the polygon, and t S repeats more to the hit,
//!         \  R                   with the relief's depth S and the depth t there, 0 to 1:
//!          \
//!   --------b------------        polygon: distance w along the view
//!            \    ___
//!   __        \  /               hit: distance w (1 + t S / gamma),
//!     \________q/                     place eye + R (1 + t S / gamma)
//! ```
//!
//! On a flat mesh this is exact; on a curved one the ray is followed from triangle to triangle, unless
//! [`Settings::silhouette`] is off: then the polygon's own frame is taken along it.

mod draw;
mod hits;
mod layer;
mod place;
mod values;

pub use layer::Layer;
pub use values::{Layers, PixelsMut, Values, ValuesMut};

#[cfg(doc)]
use crate::{Renderer, Settings};
