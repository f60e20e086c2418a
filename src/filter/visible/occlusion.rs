//! The paper's method: which texels of the ellipse the relief leaves visible.
//!
//! A texel is hidden when the ray from it to the eye meets higher relief. The ray leaves the
//! texel's centre at its height and is followed against the displacement `D` (in texels), in steps
//! of one texel along the longer axis of `D`, until it is above all relief; between two texels
//! across the ray the height is interpolated. At one pixel the slope is the same for all texels, so
//! a step of sixteen neighbouring rays reads sixteen neighbouring heights.
//!
//! Beyond the paper's letter, the ellipse has Heckbert's kernel and weight, and where the relief
//! jumps between two pixels of a quad, formula (3), which spans the jump and so takes in texels of
//! two unrelated parts and all around them, gives way to formula (2) (`max_stretch`; 0 keeps the
//! letter). As in the paper, a texel counts whole or not at all, so one seen from its side counts
//! like one that faces the eye.

use super::bounds::{BLOCK, Bounds, Course, Spot};
use super::texel_set::{TexelRow, TexelSet, place, texels};
use crate::settings::Visibility;
use crate::simd::{LineLanes, high_halves};
use crate::texture::{FULL_F32, Level, Rows};

/// How much higher than the ray, in stored units of height, relief must be to hide a texel:
/// rounding alone must not.
const TOLERANCE: f32 = 1.0 / 16.0;

/// The heights of a level and the direction to the eye.
#[derive(Clone, Copy, Debug)]
pub struct Occlusion<'a> {
    level: &'a Level,
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
            level,
            rows: level.rows(false),
            step: [-dx / length, -dy / length],
            runs_along_x,
            rise: FULL_F32 / length,
        }
    }

    /// Which of the texels of `bits`, the first at column `x` of row `y`, the eye sees; `N` is that
    /// of [`Spot`].
    #[inline(always)]
    fn visible<const N: usize>(&self, [x, y]: [i32; 2], bits: u16, bounds: Option<&Bounds>) -> u16 {
        let mut height = self.heights(x, y);
        let Some(bounds) = bounds else { return bits & !self.hidden([x, y], bits, height) };
        // Leave to rays what the bounds leave open.
        let spot = bounds.spot::<N>(x, y, height);
        let mut hidden = bounds.hidden(&spot, TOLERANCE);
        let mut open = bits & !hidden & bounds.open(&spot, 0);
        let mut step = 1;
        while open != 0 && step <= self.num_steps() as usize {
            // Most of its way a ray is above all that lies beside it.
            if step % BLOCK == 1 && bounds.meets_soon(&spot, step) & open == 0 {
                // Add up one by one: a ray's height is the same however it comes there.
                (0..BLOCK).for_each(|_| height += self.rise);
                step += BLOCK;
                continue;
            }
            height += self.rise;
            if bounds.meets(&spot, step) & open != 0 {
                hidden |= self.higher([x, y], step as i32, height) & open;
                // A ray ends where it is hidden or above all relief that is left.
                open &= !hidden & bounds.open(&spot, step);
            }
            step += 1;
        }
        bits & !hidden
    }

    /// Which of the texels of `bits`, of those heights, are hidden, by rays alone.
    fn hidden(&self, [x, y]: [i32; 2], bits: u16, mut height: LineLanes) -> u16 {
        let (mut hidden, mut open) = (0, bits);
        for i in 1..=self.num_steps() {
            height += self.rise;
            hidden |= self.higher([x, y], i, height) & open;
            open &= !hidden & height.simd_lt(LineLanes::splat(FULL_F32)).to_bitmask() as u16;
            if open == 0 {
                break;
            }
        }
        hidden
    }

    /// Where, after `i` steps, relief is higher than rays of the given heights.
    #[inline(always)]
    fn higher(&self, [x, y]: [i32; 2], i: i32, height: LineLanes) -> u16 {
        let [near, far, part] = self.neighbours_across(x, y, i);
        let relief = near + (far - near) * part;
        relief.simd_gt(height + TOLERANCE).to_bitmask() as u16
    }

    /// A ray that starts at height 0 is above everything after this many steps.
    fn num_steps(&self) -> i32 {
        (FULL_F32 / self.rise).ceil() as i32
    }

    /// How the rays go.
    fn course(&self) -> Course {
        let [along, across] = if self.runs_along_x { [0, 1] } else { [1, 0] };
        Course {
            runs_along_x: self.runs_along_x,
            away: if self.step[along] > 0.0 { -1 } else { 1 },
            across: self.step[across],
            rise: self.rise,
            num_steps: self.num_steps(),
        }
    }

    /// The texel that covers a hidden one: where its ray first meets higher relief, the higher of
    /// the two texels across the ray, so that a chain of coverers rises and ends. `None` for a
    /// visible texel.
    pub fn coverer(&self, x: i32, y: i32) -> Option<[i32; 2]> {
        self.first_above([x, y], None)
    }

    fn first_above(&self, [x, y]: [i32; 2], bounds: Option<&Bounds>) -> Option<[i32; 2]> {
        let start = self.heights(x, y);
        let mut height = start.as_array()[0];
        let spot = bounds.map(|bounds| (bounds, bounds.spot::<16>(x, y, start)));
        for i in 1..=self.num_steps() {
            let is_open = |(bounds, spot): &(&Bounds, Spot<16>)| bounds.open(spot, i as usize - 1);
            if spot.as_ref().is_some_and(|spot| is_open(spot) & 1 == 0) {
                return None;
            }
            height += self.rise;
            let [near, far, part] =
                self.neighbours_across(x, y, i).map(|lanes| lanes.as_array()[0]);
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

    /// Heights as stored of sixteen neighbouring texels.
    #[inline(always)]
    fn heights(&self, x: i32, y: i32) -> LineLanes {
        let start = self.rows.start_at(x, y) + self.rows.stride();
        high_halves(Rows::long_run(self.rows.words(), start))
    }

    /// The heights on both sides of sixteen neighbouring rays after `i` steps, and how far these
    /// lie towards the second.
    #[inline(always)]
    fn neighbours_across(&self, x: i32, y: i32, i: i32) -> [LineLanes; 3] {
        let [along, across] = if self.runs_along_x { [0, 1] } else { [1, 0] };
        let place = i as f32 * self.step[across];
        let cell = place.floor();
        // A whole number, or next to 0 where the ray goes straight up.
        let whole = (i as f32 * self.step[along]).floor() as i32;
        let (words, plane) = (self.rows.words(), self.rows.stride());
        let [near, far] = if self.runs_along_x {
            let (column, y) = (self.rows.run_start(x + whole), y + cell as i32);
            [y, y + 1].map(|y| self.rows.row_start(y) + column)
        } else {
            // The next texel of a row lies beside it, beyond the pattern's end too.
            let near = self.rows.start_at(x + cell as i32, y + whole);
            [near, near + 1]
        };
        let [near, far] =
            [near, far].map(|start| high_halves(Rows::long_run(words, start + plane)));
        [near, far, LineLanes::splat(place - cell)]
    }
}

/// Takes the hidden texels out of `set`, whose texels are the paper's T. Gives how many were
/// tested.
pub fn remove_hidden(set: &mut TexelSet, occlusion: &Occlusion, how: Visibility) -> u64 {
    let TexelSet { rows, bits, bounds } = set;
    // A ray by itself goes along with those of the fifteen texels beside its own.
    let ends = |row: &TexelRow| [row.x, row.x + 8 * row.batches[1] as i32 + 14].map(|x| [x, row.y]);
    let ends = rows.iter().flat_map(ends);
    let rows_across = occlusion.level.rows(occlusion.runs_along_x);
    let bounds = bounds.of((ends, bits.len()), occlusion.course(), rows_across);
    if how == Visibility::Resolved {
        return resolve(rows, bits, |texel| occlusion.first_above(texel, bounds));
    }
    if occlusion.runs_along_x {
        keep(rows, bits, how, |texel, bits| occlusion.visible::<16>(texel, bits, bounds))
    } else {
        keep(rows, bits, how, |texel, bits| occlusion.visible::<1>(texel, bits, bounds))
    }
}

/// Keeps what is visible, or what scans of the rows from both ends reach of it.
fn keep(
    rows: &[TexelRow],
    bits: &mut [u8],
    how: Visibility,
    visible: impl Fn([i32; 2], u16) -> u16,
) -> u64 {
    let each = |row: &TexelRow| {
        let batches = &mut bits[row.batches[0]..][..row.batches[1]];
        if how == Visibility::TwoEnded {
            keep_ends(row, batches, &visible)
        } else {
            keep_visible(row, batches, &visible)
        }
    };
    rows.iter().map(each).sum()
}

/// Keeps a row's visible texels, two batches at a time.
fn keep_visible(row: &TexelRow, batches: &mut [u8], visible: impl Fn([i32; 2], u16) -> u16) -> u64 {
    let mut num_tested = 0;
    for (i, batches) in batches.chunks_mut(2).enumerate() {
        let bits = joined(batches);
        num_tested += u64::from(bits.count_ones());
        let kept = visible([row.x + 16 * i as i32, row.y], bits);
        batches.copy_from_slice(&kept.to_le_bytes()[..batches.len()]);
    }
    num_tested
}

/// Keeps a row's texels from both ends, each until its first hidden one.
fn keep_ends(row: &TexelRow, batches: &mut [u8], visible: impl Fn([i32; 2], u16) -> u16) -> u64 {
    if batches.len() <= 2 {
        // Both ends of a short row are looked at together.
        let bits = joined(batches);
        let hidden = bits & !visible([row.x, row.y], bits);
        let kept = if hidden == 0 { bits } else { bits & (before(hidden) | after(hidden)) };
        batches.copy_from_slice(&kept.to_le_bytes()[..batches.len()]);
        return bits.count_ones().into();
    }
    let mut num_tested = 0;
    let mut hidden_of = |i: usize, bits: u8| {
        num_tested += u64::from(bits.count_ones());
        let bits = u16::from(bits);
        bits & !visible([row.x + 8 * i as i32, row.y], bits)
    };
    let mut first = batches.iter().enumerate().map(|(i, &bits)| (i, hidden_of(i, bits)));
    let Some((low, low_hidden)) = first.find(|(_, hidden)| *hidden != 0) else { return num_tested };
    // The batch of the first hidden texel ends this scan; what it hides is known.
    let mut last = (low + 1..batches.len()).rev().map(|i| (i, hidden_of(i, batches[i])));
    let (high, high_hidden) = last.find(|(_, hidden)| *hidden != 0).unwrap_or((low, low_hidden));
    // Keep what the scans passed.
    for (i, bits) in batches.iter_mut().enumerate().take(high + 1).skip(low) {
        let low_end = if i == low { before(low_hidden) } else { 0 };
        let high_end = if i == high { after(high_hidden) } else { 0 };
        *bits &= (low_end | high_end) as u8;
    }
    num_tested
}

/// One or two batches as one.
fn joined(batches: &[u8]) -> u16 {
    u16::from(batches[0]) | batches.get(1).map_or(0, |&bits| u16::from(bits) << 8)
}

/// The bits below the lowest one.
fn before(hidden: u16) -> u16 {
    (hidden & hidden.wrapping_neg()) - 1
}

/// The bits above the highest one.
fn after(hidden: u16) -> u16 {
    !(u16::MAX >> hidden.leading_zeros())
}

/// Traces every texel; a hidden one leads to the texel that covers it, which leads on until a
/// visible one, and that counts, if it lies in T. A buffer of texels traced before ends a chain
/// early and keeps each from counting twice (the paper's Fig. 6).
fn resolve(
    rows: &[TexelRow],
    bits: &mut [u8],
    coverer: impl Fn([i32; 2]) -> Option<[i32; 2]>,
) -> u64 {
    let inside = bits.to_vec();
    let mut is_traced = vec![0; bits.len()];
    bits.fill(0);
    let mut num_tested = 0;
    for mut texel in texels(rows, &inside) {
        let open = |texel: [i32; 2], is_traced: &[u8]| {
            let place = place(rows, texel);
            place.filter(|&(byte, bit)| inside[byte] & !is_traced[byte] & bit != 0)
        };
        while let Some((byte, bit)) = open(texel, &is_traced) {
            is_traced[byte] |= bit;
            num_tested += 1;
            match coverer(texel) {
                Some(coverer) => texel = coverer,
                None => bits[byte] |= bit,
            }
        }
    }
    num_tested
}
