//! Stones in a bond, as a colour and a height map.
//!
//! A [`Bond`] says to which stone a place belongs and how far its edge is; a [`Style`] makes colour
//! and height of that: a rounded top that falls to a deep joint, a tint for every stone, grain,
//! stains, and a little shade in the joints so that the picture holds without lighting.

use super::noise::{Noise, hash, mix, step, unit};
use crate::texture::{ColorImage, HeightImage};
use rayon::prelude::*;

/// Crystals along a side of the texture.
const SPECKLES: f32 = 640.0;

/// How stones are laid.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bond {
    /// Cobbles: Voronoi cells of shifted rows along u.
    Cobbles,
    /// Blocks: courses side by side along u, blocks one after another along v, each course shifted
    /// by half a block.
    Blocks,
}

/// What stones look like. Lengths are in world units, colours linear.
#[derive(Clone, Debug)]
pub(super) struct Style {
    pub(super) bond: Bond,
    /// Stones in a row, over one repeat.
    pub(super) num_in_row: i32,
    /// Rows over one repeat; even, so that shifted rows repeat.
    pub(super) num_rows: i32,
    /// Side of the texture.
    pub(super) repeat: f32,
    /// Half the width of a joint.
    pub(super) joint: f32,
    /// How far in from the joint a stone is rounded.
    pub(super) shoulder: f32,
    /// How rough the tops are, as a part of the relief's depth.
    pub(super) roughness: f32,
    pub(super) tints: [[f32; 3]; 6],
    pub(super) mortar: [f32; 3],
    pub(super) seed: u32,
}

/// One stone: a number of its own from 0 to 1 for each of its traits, and its two tints blended.
#[derive(Clone, Copy, Default)]
struct Stone {
    tone: f32,
    level: f32,
    tilt: [f32; 2],
    jitter: [f32; 2],
    tint: [f32; 3],
}

/// The stone at a place, the distance to the middle of the nearest joint, and the place relative to
/// the stone's middle.
struct Spot<'a> {
    stone: &'a Stone,
    edge: f32,
    offset: [f32; 2],
}

/// A [`Style`] with the tables that its texels need.
pub(super) struct Quarry<'a> {
    style: &'a Style,
    noise: Noise,
    stones: Vec<Stone>,
}

impl<'a> Quarry<'a> {
    pub(super) fn new(style: &'a Style) -> Self {
        let places = (0..style.num_rows).flat_map(|j| (0..style.num_in_row).map(move |i| (i, j)));
        let stones = places.map(|(i, j)| style.stone(hash(i, j, style.seed))).collect();
        Self { style, noise: Noise::new(style.seed), stones }
    }

    /// The two maps, `size` texels a side.
    pub(super) fn maps(&self, size: u32) -> (ColorImage, HeightImage) {
        let num = (size * size) as usize;
        let (mut colors, mut heights) = (vec![[0; 3]; num], vec![0; num]);
        let rows = colors
            .par_chunks_exact_mut(size as usize)
            .zip(heights.par_chunks_exact_mut(size as usize));
        rows.enumerate().for_each(|(y, (colors, heights))| {
            for (x, (color, height)) in colors.iter_mut().zip(heights).enumerate() {
                let bits = |x: f32| (x.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16;
                let texel = self.texel([x, y].map(|x| (x as f32 + 0.5) / size as f32));
                (*color, *height) = (texel.0.map(bits), bits(texel.1));
            }
        });
        let color = ColorImage { width: size, height: size, texels: colors, scale: 1.0 };
        (color, HeightImage { width: size, height: size, texels: heights })
    }

    /// Linear colour and height, each 0 to 1.
    fn texel(&self, uv: [f32; 2]) -> ([f32; 3], f32) {
        let Style { bond, joint, shoulder, roughness, repeat, .. } = *self.style;
        let spot = match bond {
            Bond::Cobbles => self.cobble(self.warped(uv, 0.02)),
            Bond::Blocks => self.block(self.warped(uv, 0.012)),
        };
        let (grain, lumps) = (self.noise.at(uv, 11, 1), self.noise.at(uv, 4, 2));
        let edge = spot.edge + (lumps - 0.5) * 0.3 * shoulder;
        let inside = ((edge - joint) / shoulder).clamp(0.0, 1.0);
        let dome = (inside * (2.0 - inside)).sqrt();
        let tilt =
            (spot.offset[0] * spot.stone.tilt[0] + spot.offset[1] * spot.stone.tilt[1]) / repeat;
        let top = 0.97 - 0.14 * spot.stone.level + tilt - roughness * (0.7 * lumps + 0.3 * grain);
        let bed = 0.05 + 0.16 * self.noise.at(uv, 7, 3);
        let height = mix(bed, mix(bed, top, 0.22 + 0.78 * dome), step(0.0, 0.12, inside));
        (self.color(uv, spot.stone, inside, [grain, lumps]), height)
    }

    fn color(
        &self,
        uv: [f32; 2],
        stone: &Stone,
        inside: f32,
        [grain, lumps]: [f32; 2],
    ) -> [f32; 3] {
        let stains = self.noise.at(uv, 1, 4);
        let [x, y] = uv.map(|x| (x * SPECKLES) as i32);
        let speckle = unit(x, y, self.style.seed);
        // Tops are worn light, shoulders stay dark, and joints lie in their own shade.
        let wear = mix(0.52, 1.12, step(0.1, 1.0, inside));
        let tone = stone.tone * (0.52 + 0.62 * grain + 0.34 * lumps) * (0.8 + 0.4 * stains) * wear;
        let crystal = if speckle > 0.94 { 1.35 } else { 0.84 + 0.26 * speckle };
        let tone = tone * crystal;
        let wet = mix(0.6, 1.3, lumps) * mix(0.7, 1.2, stains);
        let in_stone = step(0.0, 0.22, inside);
        std::array::from_fn(|c| mix(self.style.mortar[c] * wet, stone.tint[c] * tone, in_stone))
    }

    /// The place moved by smooth noise, so that no edge is straight.
    fn warped(&self, uv: [f32; 2], strength: f32) -> [f32; 2] {
        let shift = |kind: u32| (self.noise.at(uv, 2, kind) - 0.5) * strength;
        [uv[0] + shift(6), uv[1] + shift(7)]
    }

    fn stone(&self, i: i32, j: i32) -> &Stone {
        let (i, j) = (i.rem_euclid(self.style.num_in_row), j.rem_euclid(self.style.num_rows));
        &self.stones[(j * self.style.num_in_row + i) as usize]
    }

    /// The Voronoi cell at `uv` and the distance to its border, corners rounded.
    fn cobble(&self, uv: [f32; 2]) -> Spot<'_> {
        let p = uv.map(|x| x * self.style.repeat);
        let [w, h] = self.style.cell();
        let (i, j) = ((p[0] / w).floor() as i32, (p[1] / h).floor() as i32);
        let site = |n: i32| {
            let (column, row) = (i + n % 5 - 2, j + n / 5 - 1);
            let stone = self.stone(column, row);
            let shift = if row.rem_euclid(2) == 1 { 1.0 } else { 0.5 };
            let place =
                [column as f32 + shift + stone.jitter[0], row as f32 + 0.5 + stone.jitter[1]];
            let d = [place[0] * w - p[0], place[1] * h - p[1]];
            (d, d[0] * d[0] + d[1] * d[1], stone)
        };
        let sites: [_; 15] = std::array::from_fn(|n| site(n as i32));
        let nearest = sites.iter().fold(sites[0], |a, b| if b.1 < a.1 { *b } else { a });
        // Sites more than twice a cell away share no border with the nearest one.
        let reach = 4.0 * w.max(h) * w.max(h);
        let edge = sites.iter().filter(|site| site.1 > nearest.1 && site.1 < reach).fold(
            f32::MAX,
            |edge, (d, ..)| {
                let across = [d[0] - nearest.0[0], d[1] - nearest.0[1]];
                let length = (across[0] * across[0] + across[1] * across[1]).sqrt();
                let to_border = (d[0] + nearest.0[0]) * 0.5 * across[0]
                    + (d[1] + nearest.0[1]) * 0.5 * across[1];
                smooth_min(edge, to_border / length.max(1e-6), 0.22 * h)
            },
        );
        Spot { stone: nearest.2, edge, offset: nearest.0.map(|d| -d) }
    }

    /// The block at `uv`, corners rounded.
    fn block(&self, [u, v]: [f32; 2]) -> Spot<'_> {
        let [h, w] = self.style.cell();
        let (x, y) = (u * self.style.repeat / w, v * self.style.repeat / h);
        let j = x.floor() as i32;
        let y = y + if j.rem_euclid(2) == 1 { 0.5 } else { 0.0 };
        let i = y.floor() as i32;
        let offset = [(x - j as f32 - 0.5) * w, (y - i as f32 - 0.5) * h];
        let [to_row, to_end] = [0.5 * w - offset[0].abs(), 0.5 * h - offset[1].abs()];
        Spot { stone: self.stone(i, j), edge: smooth_min(to_row, to_end, 0.25 * w), offset }
    }
}

impl Style {
    /// World size of a stone: along its row, and across.
    fn cell(&self) -> [f32; 2] {
        [self.repeat / self.num_in_row as f32, self.repeat / self.num_rows as f32]
    }

    /// The stone that a hash stands for.
    fn stone(&self, id: u32) -> Stone {
        let random = |n: i32| unit(id as i32, n, self.seed);
        let around = |n: i32| random(n) - 0.5;
        let tint = |n: i32| self.tints[hash(id as i32, n, self.seed) as usize % self.tints.len()];
        let (a, b, blend) = (tint(5), tint(6), 0.6 * random(7));
        Stone {
            tone: 0.78 + 0.44 * random(4),
            level: random(3),
            tilt: [0.9 * around(1), 0.9 * around(2)],
            jitter: [0.42 * around(10), 0.3 * around(11)],
            tint: std::array::from_fn(|c| mix(a[c], b[c], blend)),
        }
    }
}

/// The smaller of two distances, rounded where they are within `radius` of each other.
fn smooth_min(a: f32, b: f32, radius: f32) -> f32 {
    let near = (1.0 - (a - b).abs() / radius).max(0.0);
    a.min(b) - near * near * radius * 0.25
}
