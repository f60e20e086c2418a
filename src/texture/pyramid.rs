//! Builds the mip levels of a surface.
//!
//! Each level halves both sides (rounding down, at least 1). A texel is the mean of the area it
//! covers in the level before, with fractional weights where the size is odd, so any size works and
//! a repeating pattern still repeats.

use super::level::{FULL, FULL_F32, Level, pack_normal, unpack_normal};
use super::rows::{PackedTexel, Rows};
use super::wrap::{Wrap, wrap_index};
use rayon::prelude::*;

/// All levels, the finest first, of a pattern as it is stored: a mirrored one spans two repeats.
pub(super) fn build(
    texels: Vec<PackedTexel>,
    size: [usize; 2],
    wrap: Wrap,
    num_planes: usize,
) -> Vec<Level> {
    let mut levels = Vec::new();
    let (mut texels, mut size) = (texels, size);
    loop {
        let [width, height] = size;
        let rows = Rows::new(width, height, wrap, num_planes, &texels);
        let smaller = size.map(|n| (n / 2).max(1));
        // The finer texels go before their turned copy comes.
        texels =
            if size == [1, 1] { Vec::new() } else { halve(&texels, size, smaller, num_planes) };
        levels.push(Level::new(rows, if wrap == Wrap::Mirror { 2 } else { 1 }));
        if size == [1, 1] {
            return levels;
        }
        size = smaller;
    }
}

/// Source places and weights (sum 1) of one destination texel along one axis.
pub(crate) fn box_taps(i: usize, num_from: usize, num_to: usize) -> Vec<(usize, f32)> {
    let ratio = num_from as f64 / num_to as f64;
    let (start, end) = (i as f64 * ratio, (i + 1) as f64 * ratio);
    (start as usize..(end.ceil() as usize).min(num_from))
        .map(|j| (j, ((end.min(j as f64 + 1.0) - start.max(j as f64)) / ratio) as f32))
        .filter(|(_, weight)| *weight > 1e-9)
        .collect()
}

fn halve(
    texels: &[PackedTexel],
    [w, h]: [usize; 2],
    [to_w, to_h]: [usize; 2],
    num_planes: usize,
) -> Vec<PackedTexel> {
    if [w, h] == [2 * to_w, 2 * to_h] {
        return halve_even(texels, w, num_planes);
    }
    let columns: Vec<_> = (0..to_w).map(|x| box_taps(x, w, to_w)).collect();
    let mut halved = vec![[0; 3]; to_w * to_h];
    halved.par_chunks_exact_mut(to_w).enumerate().for_each(|(y, row)| {
        let rows = box_taps(y, h, to_h);
        for (texel, columns) in row.iter_mut().zip(&columns) {
            let mut sums = [0.0_f32; 7];
            for &(j, wy) in &rows {
                for &(i, wx) in columns {
                    let parts = unpack(texels[j * w + i]);
                    sums.iter_mut().zip(parts).for_each(|(sum, part)| *sum += wx * wy * part);
                }
            }
            *texel = pack(sums);
        }
    });
    halved
}

/// What [`halve`] makes of even sides, several times as fast: each texel is the mean of four.
fn halve_even(texels: &[PackedTexel], w: usize, num_planes: usize) -> Vec<PackedTexel> {
    let mut halved = vec![[0; 3]; texels.len() / 4];
    halved.par_chunks_exact_mut(w / 2).zip(texels.par_chunks_exact(2 * w)).for_each(
        |(to, from)| {
            let (below, above) = from.split_at(w);
            let pairs = below.chunks_exact(2).zip(above.chunks_exact(2));
            for (texel, (below, above)) in to.iter_mut().zip(pairs) {
                let four = [below[0], below[1], above[0], above[1]];
                // Numbers of fifteen bits, whose sums are exact.
                let mean = |plane: usize| {
                    let sum =
                        |shift: u32| four.iter().map(|t| t[plane] >> shift & 0xffff).sum::<u32>();
                    let [low, high] = [sum(0), sum(16)].map(|sum| (sum + 2) / 4);
                    low | high << 16
                };
                *texel = [mean(0), mean(1), 0];
                if num_planes == 3 {
                    let sum = four.iter().fold([0.0; 3], |sum: [f32; 3], texel| {
                        let normal = unpack_normal(texel[2]);
                        std::array::from_fn(|i| sum[i] + 0.25 * normal[i])
                    });
                    texel[2] = pack_normal(sum);
                }
            }
        },
    );
    halved
}

/// Red, green, blue, height (each 0 to [`FULL`]) and the normal.
fn unpack([a, b, n]: PackedTexel) -> [f32; 7] {
    let [x, y, z] = unpack_normal(n);
    [(a & 0xffff) as f32, (a >> 16) as f32, (b & 0xffff) as f32, (b >> 16) as f32, x, y, z]
}

fn pack([r, g, b, h, x, y, z]: [f32; 7]) -> PackedTexel {
    let [r, g, b, h] = [r, g, b, h].map(|c| ((c + 0.5) as u32).min(FULL));
    [r | g << 16, b | h << 16, pack_normal([x, y, z])]
}

/// Writes the unit normals of the height field, by central differences, into the texels.
pub(super) fn normals_from_heights(
    texels: &mut [PackedTexel],
    [w, h]: [usize; 2],
    wrap: Wrap,
    relief_depth: f32,
) {
    let fold =
        |i: i32, n: usize| wrap_index(if wrap == Wrap::Mirror { Wrap::Clamp } else { wrap }, i, n);
    let heights: Vec<f32> =
        texels.iter().map(|texel| (texel[1] >> 16) as f32 * (relief_depth / FULL_F32)).collect();
    texels.par_chunks_exact_mut(w).enumerate().for_each(|(y, row)| {
        let (below, above) = (fold(y as i32 - 1, h) * w, fold(y as i32 + 1, h) * w);
        for (x, texel) in row.iter_mut().enumerate() {
            let (left, right) = (y * w + fold(x as i32 - 1, w), y * w + fold(x as i32 + 1, w));
            let du = (heights[right] - heights[left]) * 0.5 * w as f32;
            let dv = (heights[above + x] - heights[below + x]) * 0.5 * h as f32;
            let length = (du * du + dv * dv + 1.0).sqrt();
            texel[2] = pack_normal([-du / length, -dv / length, 1.0 / length]);
        }
    });
}

/// The texture and its mirror images: twice as wide and high, to be repeated. Normals are mirrored
/// too.
pub(super) fn mirrored(
    texels: Vec<PackedTexel>,
    w: usize,
    h: usize,
) -> (Vec<PackedTexel>, [usize; 2]) {
    let mut all = Vec::with_capacity(4 * w * h);
    for y in 0..2 * h {
        for x in 0..2 * w {
            let (flip_x, flip_y) = (x >= w, y >= h);
            let i = if flip_x { 2 * w - 1 - x } else { x };
            let j = if flip_y { 2 * h - 1 - y } else { y };
            let [a, b, n] = texels[j * w + i];
            let [nx, ny, nz] = unpack_normal(n);
            all.push([
                a,
                b,
                pack_normal([if flip_x { -nx } else { nx }, if flip_y { -ny } else { ny }, nz]),
            ]);
        }
    }
    (all, [2 * w, 2 * h])
}
