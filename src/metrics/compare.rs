//! Error figures of two pictures.

use super::picture::{Picture, check_sizes, is_compared};
use super::ssim;
use crate::error::{Error, Result};
use rayon::prelude::*;

/// What [`compare`] finds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Pixels that were compared: those opaque in both pictures.
    pub num_compared: u64,
    /// Pixels whose opacity differs.
    pub num_opacity_unequal: u64,
    /// Peak signal-to-noise ratio in decibels; infinite where all compared pixels are equal.
    pub psnr_db: f64,
    /// The first of the largest errors, row by row from the top.
    pub largest: LargestError,
    /// Mean structural similarity of luma after Wang, Bovik, Sheikh and Simoncelli 2004: Gaussian
    /// windows of 11x11 pixels with a standard deviation of 1.5, K1 = 0.01, K2 = 0.03, and luma by
    /// Rec. 601. 1 is equal.
    pub ssim: f64,
}

/// Where two pictures are furthest apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LargestError {
    /// The error, 0 to 1.
    pub error: f64,
    /// Column of the pixel.
    pub x: u32,
    /// Row of the pixel, 0 at the top.
    pub y: u32,
    /// 0 red, 1 green, 2 blue.
    pub channel: usize,
}

/// Compares two pictures of the same size.
///
/// # Errors
/// Says so when the sizes differ or no pixel is opaque in both pictures.
pub fn compare(a: &Picture, b: &Picture) -> Result<Difference> {
    check_sizes(a, b)?;
    // Rows in parallel, their sums in order: the same figures for any number of threads.
    let rows: Vec<RowSums> =
        (0..a.height()).into_par_iter().map(|y| RowSums::of(a, b, y)).collect();
    let total = rows.into_iter().fold(RowSums::default(), RowSums::then);
    if total.num_compared == 0 {
        return Err(Error::picture("pictures", "no pixel is opaque in both"));
    }
    let mean = total.squares / (total.num_compared as f64 * 3.0);
    Ok(Difference {
        num_compared: total.num_compared,
        num_opacity_unequal: total.num_opacity_unequal,
        psnr_db: -10.0 * mean.log10(),
        largest: total.largest,
        ssim: ssim::mean_ssim(a, b),
    })
}

/// Sums over pixels.
#[derive(Default)]
struct RowSums {
    num_compared: u64,
    num_opacity_unequal: u64,
    squares: f64,
    largest: LargestError,
}

impl RowSums {
    fn of(a: &Picture, b: &Picture, y: u32) -> Self {
        let mut sums = Self::default();
        for (x, (a, b)) in (0..).zip(a.row(y).iter().zip(b.row(y))) {
            sums.num_opacity_unequal += u64::from(a[3] != b[3]);
            if is_compared(*a, *b) {
                sums.num_compared += 1;
                sums.add_errors([0, 1, 2].map(|i| (f64::from(a[i]) - f64::from(b[i])).abs()), x, y);
            }
        }
        sums
    }

    fn add_errors(&mut self, errors: [f64; 3], x: u32, y: u32) {
        for (channel, error) in errors.into_iter().enumerate() {
            self.squares += error * error;
            if error > self.largest.error {
                self.largest = LargestError { error, x, y, channel };
            }
        }
    }

    /// Adds the sums of a row further down.
    fn then(self, below: Self) -> Self {
        Self {
            num_compared: self.num_compared + below.num_compared,
            num_opacity_unequal: self.num_opacity_unequal + below.num_opacity_unequal,
            squares: self.squares + below.squares,
            largest: if below.largest.error > self.largest.error {
                below.largest
            } else {
                self.largest
            },
        }
    }
}
