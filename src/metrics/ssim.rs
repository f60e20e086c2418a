//! Mean structural similarity (Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli: Image Quality
//! Assessment: From Error Visibility to Structural Similarity, IEEE Transactions on Image
//! Processing 13(4), 2004).
//!
//! ```text
//! ssim = (2 ma mb + C1) (2 sab + C2) / ((ma^2 + mb^2 + C1) (saa + sbb + C2)),   C1 = 0.01^2, C2 = 0.03^2
//! ```
//!
//! `ma`, `mb` are the means, `saa`, `sbb`, `sab` the variances and the covariance of luma in a
//! Gaussian window around a pixel. The mean is over the compared pixels whose window lies within
//! the picture, as in the authors' program; a picture too small for any such pixel uses all its
//! pixels. A window counts only the compared pixels within it, its weights scaled to a sum of 1: so
//! a picture that is opaque everywhere gives the authors' figure.

use super::picture::{Picture, is_compared};
use rayon::prelude::*;

const RADIUS: usize = 5;
const NUM_TAPS: usize = 2 * RADIUS + 1;
const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;

/// Weighted sums of 1, a, b, a², b² and ab over the compared pixels of a window.
type Moments = [f64; 6];

/// The mean over two pictures of the same size with at least one compared pixel.
pub(super) fn mean_ssim(a: &Picture, b: &Picture) -> f64 {
    let (width, height) = (a.width() as usize, a.height() as usize);
    // Margins that keep windows within the picture, or none where that leaves nothing.
    let margins = [width, height].map(|n| if n >= NUM_TAPS { RADIUS } else { 0 });
    sum_within(a, b, margins)
        .or_else(|| sum_within(a, b, [0, 0]))
        .map_or(1.0, |(sum, num)| sum / num as f64)
}

/// The sum and number of window figures of pixels that keep the margins, or `None` where there are
/// none.
fn sum_within(a: &Picture, b: &Picture, [margin_x, margin_y]: [usize; 2]) -> Option<(f64, u64)> {
    let (width, height) = (a.width() as usize, a.height() as usize);
    let taps = gaussian();
    let rows: Vec<(f64, u64)> = (margin_y..height - margin_y)
        .into_par_iter()
        .map(|y| {
            let columns = vertical_moments(a, b, y, &taps);
            let (row_a, row_b) = (a.row(y as u32), b.row(y as u32));
            (margin_x..width - margin_x)
                .filter(|&x| is_compared(row_a[x], row_b[x]))
                .map(|x| similarity(horizontal_moments(&columns, x, &taps)))
                .fold((0.0, 0), |(sum, num), ssim| (sum + ssim, num + 1))
        })
        .collect();
    let total = rows.into_iter().fold((0.0, 0), |(sum, num), row| (sum + row.0, num + row.1));
    (total.1 > 0).then_some(total)
}

/// The windows' weights along one axis; they need no sum of 1, since moments are divided by the
/// first.
fn gaussian() -> [f64; NUM_TAPS] {
    std::array::from_fn(|i| {
        let distance = i as f64 - RADIUS as f64;
        (-distance * distance / (2.0 * 1.5 * 1.5)).exp()
    })
}

fn luma([r, g, b, _]: [f32; 4]) -> f64 {
    0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b)
}

/// The weighted sums of each column around row `y`.
fn vertical_moments(a: &Picture, b: &Picture, y: usize, taps: &[f64; NUM_TAPS]) -> Vec<Moments> {
    let mut columns = vec![[0.0; 6]; a.width() as usize];
    for (i, tap) in taps.iter().enumerate() {
        let Some(row) = (y + i).checked_sub(RADIUS).filter(|&row| row < a.height() as usize) else {
            continue;
        };
        let pixels = a.row(row as u32).iter().zip(b.row(row as u32));
        for (sums, (&a, &b)) in
            columns.iter_mut().zip(pixels).filter(|(_, (a, b))| is_compared(**a, **b))
        {
            let (a, b) = (luma(a), luma(b));
            add(sums, *tap, [1.0, a, b, a * a, b * b, a * b]);
        }
    }
    columns
}

/// The weighted sums of the window around column `x`.
fn horizontal_moments(columns: &[Moments], x: usize, taps: &[f64; NUM_TAPS]) -> Moments {
    let mut sums = [0.0; 6];
    for (i, tap) in taps.iter().enumerate() {
        if let Some(column) = (x + i).checked_sub(RADIUS).and_then(|x| columns.get(x)) {
            add(&mut sums, *tap, *column);
        }
    }
    sums
}

fn add(sums: &mut Moments, weight: f64, moments: Moments) {
    sums.iter_mut().zip(moments).for_each(|(sum, moment)| *sum += weight * moment);
}

fn similarity([weight, a, b, aa, bb, ab]: Moments) -> f64 {
    let (ma, mb) = (a / weight, b / weight);
    let (saa, sbb, sab) = (aa / weight - ma * ma, bb / weight - mb * mb, ab / weight - ma * mb);
    (2.0 * ma * mb + C1) * (2.0 * sab + C2) / ((ma * ma + mb * mb + C1) * (saa + sbb + C2))
}
