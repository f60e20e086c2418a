//! How far two pictures are apart: peak signal-to-noise ratio, largest error, structural
//! similarity, FLIP, heat map.
//!
//! All figures are of sRGB-encoded values from 0 to 1, over red, green and blue, and over the
//! pixels that are opaque in both pictures ([`compare`]). A [`Frame`](crate::Frame) is encoded
//! without rounding to 8 bits.
//!
//! ```text
//! PSNR = 10 log10(1 / mean((a - b)^2))
//! ```
//!
//! ```
//! use basrelief::{Frame, metrics};
//! let gray = Frame::filled(32, 32, [0.2, 0.2, 0.2, 1.0]);
//! let mut other = gray.clone();
//! other.pixels[5 * 32 + 3][1] = 0.3;
//! let difference = metrics::compare(&(&gray).into(), &(&other).into())?;
//! assert_eq!((difference.largest.x, difference.largest.y, difference.largest.channel), (3, 5, 1));
//! assert!(difference.psnr_db > 40.0 && difference.ssim > 0.9);
//! # Ok::<(), basrelief::Error>(())
//! ```

mod compare;
mod flip;
mod heat_map;
mod picture;
mod ssim;

pub use compare::{Difference, LargestError, compare};
pub use flip::{Flip, PIXELS_PER_DEGREE, flip};
pub use heat_map::{errors_as_colors, heat_map};
pub use picture::Picture;
