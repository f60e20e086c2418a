//! Repeating noise from an integer hash: the same bits on every machine, since it needs only sums
//! and products.

/// A hash of a lattice point (a finaliser of `MurmurHash3`'s kind over a weighted sum).
pub(super) fn hash(x: i32, y: i32, seed: u32) -> u32 {
    let (a, b) = ((x as u32).wrapping_mul(0x85eb_ca6b), (y as u32).wrapping_mul(0xc2b2_ae35));
    let mut h = a ^ b.rotate_left(13) ^ seed.wrapping_mul(0x27d4_eb2f);
    h = (h ^ h >> 16).wrapping_mul(0x7feb_352d);
    h = (h ^ h >> 15).wrapping_mul(0x846c_a68b);
    h ^ h >> 16
}

/// The hash as a number from 0 to 1.
pub(super) fn unit(x: i32, y: i32, seed: u32) -> f32 {
    (hash(x, y, seed) >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Texels a side of the table, a power of two.
const SIDE: usize = 256;
/// Cells of the coarsest octave; with five octaves the finest has four texels a cell.
const COARSEST: i32 = 4;
const NUM_OCTAVES: u32 = 5;

/// A table of fractal noise that repeats over `0..1`; looked up at whole multiples, finer noise
/// repeats too.
pub(super) struct Noise {
    table: Vec<f32>,
}

impl Noise {
    /// Octaves of smooth noise, each twice as fine and half as strong.
    pub(super) fn new(seed: u32) -> Self {
        let texel = |i: usize| {
            let uv = [i % SIDE, i / SIDE].map(|x| x as f32 / SIDE as f32);
            let octaves =
                (0..NUM_OCTAVES).map(|n| value(uv, COARSEST << n, seed + n) / (1 << n) as f32);
            octaves.sum::<f32>() / (2.0 - 1.0 / (1 << (NUM_OCTAVES - 1)) as f32)
        };
        Self { table: (0..SIDE * SIDE).map(texel).collect() }
    }

    /// About 0 to 1, `repeats` times over `0..1`; `kind` picks another part of the table.
    pub(super) fn at(&self, [u, v]: [f32; 2], repeats: i32, kind: u32) -> f32 {
        let scale = (repeats as usize * SIDE) as f32;
        let (x, y) = (u * scale + (kind * 61) as f32, v * scale + (kind * 149) as f32);
        let (i, j) = (x.floor(), y.floor());
        let row = |j: i32| (j as usize & (SIDE - 1)) * SIDE;
        let at = |i: i32, row: usize| self.table[row + (i as usize & (SIDE - 1))];
        let (low, high) = (row(j as i32), row(j as i32 + 1));
        let near = mix(at(i as i32, low), at(i as i32 + 1, low), x - i);
        let far = mix(at(i as i32, high), at(i as i32 + 1, high), x - i);
        mix(near, far, y - j)
    }
}

/// Smooth noise, 0 to 1, of `period` cells over `0..1` in both directions.
fn value([u, v]: [f32; 2], period: i32, seed: u32) -> f32 {
    let (x, y) = (u * period as f32, v * period as f32);
    let (i, j) = (x.floor(), y.floor());
    let (s, t) = (smooth(x - i), smooth(y - j));
    let corner = |di: i32, dj: i32| {
        unit((i as i32 + di).rem_euclid(period), (j as i32 + dj).rem_euclid(period), seed)
    };
    let low = mix(corner(0, 0), corner(1, 0), s);
    let high = mix(corner(0, 1), corner(1, 1), s);
    mix(low, high, t)
}

/// From `a` (t = 0) to `b` (t = 1).
pub(super) fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// 0 below `from`, 1 above `to`, smooth between.
pub(super) fn step(from: f32, to: f32, x: f32) -> f32 {
    smooth(((x - from) / (to - from)).clamp(0.0, 1.0))
}

fn smooth(t: f32) -> f32 {
    t * t * (3.0 - 2.0 * t)
}
