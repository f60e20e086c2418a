//! The mean of all texels of an ellipse, in one pass over the rows that it takes.

use super::gaussian::gaussian;
use super::sums::WideSums;
use crate::filter::points;
use crate::footprint::levels::for_gaussian;
use crate::footprint::{Ellipse, Footprint};
use crate::settings::Ewa;
use crate::simd::{
    LineLanes, from_words, join, join_words, lane_columns, line_indices, pick, u32x8, u32x16, words,
};
use crate::texture::{APRON, FARTHEST, Rows, Surface, Texel};

/// Rows whose places are found at once.
const ROWS: usize = 16;

/// The mean of all texels of the ellipse, and how many were in the batches that were read: one pass
/// over the rows of the coarsest level on which the Gaussian is sampled well, or of the base level
/// where `texel_budget` is 0. The normal is left out where it is not asked for.
pub fn mean(
    surface: &Surface,
    footprint: &Footprint,
    ewa: &Ewa,
    with_normal: bool,
) -> (Texel, u64) {
    let (index, ellipse) = for_gaussian(surface, footprint, ewa);
    let level = &surface.levels()[index];
    let [x, y] = level.in_texels(footprint.hit).map(|c| c - 0.5);
    // Rows along the longer side: fewer of them.
    let is_turned = ellipse.a > ellipse.c;
    let rows = level.rows(is_turned);
    let (ellipse, place) = if is_turned {
        (Ellipse { a: ellipse.c, c: ellipse.a, ..ellipse }, [y, x])
    } else {
        (ellipse, [x, y])
    };
    // A scan for each case, so that its loop over the texels asks for none.
    let (mean, num_read) = match (with_normal && level.has_normals(), ewa.cut > 1.0) {
        (false, false) => scan::<false, false>(rows, &ellipse, place, 1.0),
        (false, true) => scan::<false, true>(rows, &ellipse, place, ewa.cut),
        (true, false) => scan::<true, false>(rows, &ellipse, place, 1.0),
        (true, true) => scan::<true, true>(rows, &ellipse, place, ewa.cut),
    };
    (mean.unwrap_or_else(|| points::bilinear(level, footprint.hit)), num_read)
}

/// The mean over the ellipse around `place`, texel centres at whole numbers, cut at radius `cut`;
/// `None` if it holds none.
#[inline(always)]
fn scan<const HAS_NORMALS: bool, const IS_WIDE: bool>(
    texels: &Rows,
    ellipse: &Ellipse,
    [x0, y0]: [f32; 2],
    cut: f32,
) -> (Option<Texel>, u64) {
    // Bound the ellipse.
    let Ellipse { a, b, c, f } = *ellipse;
    // r^2 = (a (U + s V)^2 + (det / a) V^2) / f, where det is f but for a printed f.
    let (inverse_f, s) = (1.0 / f, b * 0.5 / a);
    let det = (a * c - b * b * 0.25).max(f32::MIN_POSITIVE);
    let [half_width, half_height] = [f / a, a * (f / det)].map(|square| cut * square.sqrt());
    if !(half_width.max(half_height) < 1e6 && f > 0.0) {
        return (None, 0);
    }
    // Rows of equal length, so that no branch depends on a row, and two rows at a time: what lies
    // outside weighs nothing.
    let num = (half_width * 0.25) as i32 + 1;
    let num_rows = 2 * (half_height as i32 + 1);
    let first = (y0 - half_height).clamp(-FARTHEST, FARTHEST).ceil() as i32;
    let end = first + num_rows;
    let mut sums = WideSums::<HAS_NORMALS>::default();
    let limit = LineLanes::splat(cut * cut);
    // Divide by F here, and not at each texel.
    let [a, b, c] = [a, b, c].map(|coefficient| coefficient * inverse_f);
    let columns = join([lane_columns(0); 2]);
    // Scan the rows; what they need is found for sixteen of them at once.
    for first in (first..end).step_by(ROWS) {
        let v = line_indices() + (first as f32 - y0);
        // A row is as long as the longest, around its own middle, which the shear moves.
        let starts = (LineLanes::splat(x0 - half_width) - v * s).ceil();
        let (from, linear, constant) = (starts - x0, v * b, v * v * c);
        let bound = LineLanes::splat(FARTHEST);
        let starts = starts.fast_max(-bound).fast_min(bound).fast_trunc_int();
        let mut two = join_words([u32x8::ZERO, u32x8::ONE]);
        for i in (0..(end - first).min(ROWS as i32)).step_by(2) {
            let of_two = |lanes: LineLanes| from_words(pick(words(lanes), two));
            let (u, linear, constant) = (of_two(from) + columns, of_two(linear), of_two(constant));
            let starts = [0, 1].map(|row| starts.as_array()[i as usize + row]);
            let rows = [texels.row_start(first + i), texels.row_start(first + i + 1)];
            // What the apron repeats lies in one piece.
            for block in (0..num).step_by(APRON / 8) {
                let runs = [0, 1].map(|i| rows[i] + texels.run_start(starts[i] + 8 * block));
                for j in block..num.min(block + (APRON / 8) as i32) {
                    let u = u + (8 * j) as f32;
                    // The Gaussian's polynomials hold from 0 to the cut: bring r^2 there first.
                    let r2 = ((u * a + linear) * u + constant).fast_max(LineLanes::ZERO);
                    let weight = gaussian::<IS_WIDE>(r2.fast_min(limit)) & r2.simd_le(limit);
                    sums.add_runs(texels, runs.map(|run| run + 8 * (j - block) as usize), weight);
                }
            }
            two += u32x16::splat(2);
        }
    }
    (sums.mean(), num_rows as u64 * num as u64 * 8)
}
