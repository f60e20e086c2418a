//! The paper's method: which texels of the ellipse the relief leaves visible.
//!
//! A texel is hidden when the ray from it to the eye meets higher relief. The ray leaves the
//! texel's centre at its height and is followed against the displacement `D` (in texels), in steps
//! of one texel along the longer axis of `D`, until it is above all relief; between two texels
//! across the ray the height is interpolated. At one pixel the slope is the same for all texels, so
//! a step of eight neighbouring rays reads eight neighbouring heights.
//!
//! Beyond the paper's letter, the ellipse has Heckbert's kernel and weight, and where the relief
//! jumps between two pixels of a quad, formula (3), which spans the jump and so takes in texels of
//! two unrelated parts and all around them, gives way to formula (2) (`max_stretch`; 0 keeps the
//! letter). As in the paper, a texel counts whole or not at all, so one seen from its side counts
//! like one that faces the eye.

use super::texel_set::{TexelRow, TexelSet};
use crate::settings::Visibility;
use crate::simd::{TexelLanes, high_half};
use crate::texture::{FULL_F32, Level, Rows};

/// How much higher than the ray, in stored units of height, relief must be to hide a texel:
/// rounding alone must not.
const TOLERANCE: f32 = 1.0 / 16.0;

/// The heights of a level and the direction to the eye.
#[derive(Clone, Copy, Debug)]
pub struct Occlusion<'a> {
    rows: &'a Rows,
    /// Texels towards the eye per step; the longer component is 1 or -1.
    step: [f32; 2],
    runs_along_x: bool,
    /// How much the ray rises per step.
    rise: f32,
}

impl<'a> Occlusion<'a> {
    /// For the displacement (texels of the level down to the deepest relief) of a pixel's view ray.
    pub fn new(level: &'a Level, displacement: [f32; 2]) -> Self {
        let [dx, dy] = displacement;
        let runs_along_x = dx.abs() > dy.abs();
        // Never 0: a ray straight up is then above all relief after one step.
        let length = dx.abs().max(dy.abs()).max(1e-3);
        Self {
            rows: level.rows(false),
            step: [-dx / length, -dy / length],
            runs_along_x,
            rise: FULL_F32 / length,
        }
    }

    /// Which of the texels of `bits`, the first at column `x` of row `y`, the eye sees.
    pub fn visible(&self, x: i32, y: i32, bits: u8) -> u8 {
        let mut height = self.heights(x as f32, y as f32);
        let mut hidden = 0;
        // A ray that starts at height 0 is above everything after this many steps.
        let num_steps = (FULL_F32 / self.rise).ceil() as i32;
        for i in 1..=num_steps {
            height += self.rise;
            let relief = self.heights_across(x, y, i as f32);
            hidden |= relief.simd_gt(height + TOLERANCE).to_bitmask() as u8;
            // Stop when each texel is hidden or its ray is above all relief.
            let open = bits & !hidden;
            if open == 0
                || (height.simd_lt(TexelLanes::splat(FULL_F32)).to_bitmask() as u8 & open) == 0
            {
                break;
            }
        }
        bits & !hidden
    }

    /// The texel that covers a hidden one: where its ray first meets higher relief, the higher of
    /// the two texels across the ray, so that a chain of coverers rises and ends. `None` for a
    /// visible texel.
    pub fn coverer(&self, x: i32, y: i32) -> Option<[i32; 2]> {
        let mut height = self.heights(x as f32, y as f32).as_array()[0];
        for i in 1..=(FULL_F32 / self.rise).ceil() as i32 {
            height += self.rise;
            let [near, far, part] =
                self.neighbours_across(x, y, i as f32).map(|lanes| lanes.as_array()[0]);
            if near + (far - near) * part > height + TOLERANCE {
                let [x, y] = [x, y].map(|c| c as f32);
                let cell =
                    [x + (i as f32 * self.step[0]).floor(), y + (i as f32 * self.step[1]).floor()];
                // Of the two texels across the ray the second is the next: by rows where the ray
                // runs along x, else by columns.
                let across = usize::from(self.runs_along_x);
                let mut texel = cell.map(|c| c as i32);
                texel[across] += i32::from(far > near);
                return Some(texel);
            }
            if height >= FULL_F32 {
                return None;
            }
        }
        None
    }

    /// Heights as stored of eight neighbouring texels.
    fn heights(&self, x: f32, y: f32) -> TexelLanes {
        let row = self.rows.row(y as i32);
        high_half(Rows::run(row, self.rows.run_start(x as i32) + self.rows.stride()))
    }

    /// Heights under eight neighbouring rays after `i` steps, interpolated across the ray.
    fn heights_across(&self, x: i32, y: i32, i: f32) -> TexelLanes {
        let [near, far, part] = self.neighbours_across(x, y, i);
        near + (far - near) * part
    }

    /// The heights on both sides of eight neighbouring rays after `i` steps, and how far these lie
    /// towards the second.
    fn neighbours_across(&self, x: i32, y: i32, i: f32) -> [TexelLanes; 3] {
        let place = [i * self.step[0], i * self.step[1]];
        let cell = place.map(f32::floor);
        let (x, y) = (x as f32 + cell[0], y as f32 + cell[1]);
        let (far, part) = if self.runs_along_x {
            (self.heights(x, y + 1.0), place[1] - cell[1])
        } else {
            (self.heights(x + 1.0, y), place[0] - cell[0])
        };
        [self.heights(x, y), far, TexelLanes::splat(part)]
    }
}

/// Takes the hidden texels out of `set`, whose texels are the paper's T.
pub fn remove_hidden(set: &mut TexelSet, occlusion: &Occlusion, how: Visibility) -> u64 {
    match how {
        Visibility::Exact => remove_exact(set, occlusion),
        Visibility::TwoEnded => {
            let TexelSet { rows, bits } = set;
            rows.iter()
                .map(|row| keep_ends(row, &mut bits[row.batches[0]..][..row.batches[1]], occlusion))
                .sum()
        }
        Visibility::Resolved => resolve(set, occlusion),
    }
}

fn remove_exact(set: &mut TexelSet, occlusion: &Occlusion) -> u64 {
    let mut num_tested = 0;
    for row in &set.rows {
        for (i, bits) in set.bits[row.batches[0]..][..row.batches[1]].iter_mut().enumerate() {
            num_tested += u64::from(bits.count_ones());
            *bits = occlusion.visible(row.x + 8 * i as i32, row.y, *bits);
        }
    }
    num_tested
}

/// Keeps a row's texels from both ends, each until its first hidden one.
fn keep_ends(row: &TexelRow, batches: &mut [u8], occlusion: &Occlusion) -> u64 {
    let mut num_tested = 0;
    let mut hidden_of = |i: usize, bits: u8| {
        num_tested += u64::from(bits.count_ones());
        bits & !occlusion.visible(row.x + 8 * i as i32, row.y, bits)
    };
    let mut first = batches.iter().enumerate().map(|(i, &bits)| (i, hidden_of(i, bits)));
    let Some((low, low_hidden)) = first.find(|(_, hidden)| *hidden != 0) else { return num_tested };
    // The batch of the first hidden texel ends this scan; what it hides is known.
    let mut last = (low + 1..batches.len()).rev().map(|i| (i, hidden_of(i, batches[i])));
    let (high, high_hidden) = last.find(|(_, hidden)| *hidden != 0).unwrap_or((low, low_hidden));
    // Keep what the scans passed: bits below the first hidden one, and above the last.
    let before = (1_u32 << low_hidden.trailing_zeros()) - 1;
    let after = !(0xff_u32 >> high_hidden.leading_zeros());
    for (i, bits) in batches.iter_mut().enumerate().take(high + 1).skip(low) {
        let kept = if i == low { before } else { 0 } | if i == high { after } else { 0 };
        *bits &= kept as u8;
    }
    num_tested
}

/// Traces every texel; a hidden one leads to the texel that covers it, which leads on until a
/// visible one, and that counts, if it lies in T. A buffer of texels traced before ends a chain
/// early and keeps each from counting twice (the paper's Fig. 6).
fn resolve(set: &mut TexelSet, occlusion: &Occlusion) -> u64 {
    let inside = set.clone();
    let mut is_traced = vec![0; set.bits.len()];
    set.bits.fill(0);
    let mut num_tested = 0;
    for [x, y] in inside.iter() {
        let mut texel = [x, y];
        let open = |[x, y]: [i32; 2], is_traced: &[u8]| {
            let place = inside.place(x, y);
            place.filter(|&(byte, bit)| inside.bits[byte] & !is_traced[byte] & bit != 0)
        };
        while let Some((byte, bit)) = open(texel, &is_traced) {
            is_traced[byte] |= bit;
            num_tested += 1;
            match occlusion.coverer(texel[0], texel[1]) {
                Some(coverer) => texel = coverer,
                None => set.bits[byte] |= bit,
            }
        }
    }
    num_tested
}
