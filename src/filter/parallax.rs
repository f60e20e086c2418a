//! Common practice, to compare with: parallax occlusion mapping with mip levels (Tatarchuk 2006).
//!
//! `samples` rays a pixel on a rotated grid over the pixel's square. Each takes 32 linear steps
//! down the relief, then one secant step; heights and colour are trilinear at the level that 16x
//! anisotropic filtering takes: the shorter side of the footprint, or a sixteenth of the longer if
//! that is more, each shrunk by the density of the samples.
//!
//! Eight rays step together until all are under the relief. Lanes are rays.

use super::batch::{Batch, Filtered};
use super::prepared::Prepared;
use super::queue;
use super::{points, trilinear};
use crate::footprint::{Footprints, levels};
use crate::relief::{CellRays, HeightCells};
use crate::simd::{PixelLanes, i32x8};
use crate::texture::FULL_F32;

/// Linear steps from the polygon down to the deepest relief.
const NUM_STEPS: u16 = 32;

/// The depth of a step.
const STEP: f32 = 1.0 / NUM_STEPS as f32;

/// Eight rays: where they meet the polygon (u and v in repeats), how far they move along the
/// texture down to the deepest relief, and the sizes of their texels in base texels.
type Rays = [PixelLanes; 5];

/// Offsets from the pixel's centre, in pixels, of `num` samples: a lattice, turned by the golden
/// ratio.
pub(super) fn offsets(num: u32) -> Vec<[f32; 2]> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let place = |i: u32| {
        let golden = f64::from(i) * GOLDEN + 0.5;
        [
            ((f64::from(i) + 0.5) / f64::from(num) - 0.5) as f32,
            (golden - golden.floor() - 0.5) as f32,
        ]
    };
    (0..num).map(place).collect()
}

/// The colours that the rays of a batch find, each one of so many a pixel; with lights, their
/// normals too.
pub(super) fn colors(prepared: &Prepared, batch: &Batch, num_samples: u32, out: &mut [Filtered]) {
    let (surface, cells) = (prepared.surface(), prepared.cells());
    let rays = |pixels: &Footprints| {
        let Footprints { base: [u, v], displacement: [du, dv], .. } = *pixels;
        [u, v, du, dv, levels::parallax_sizes(surface.base(), pixels, num_samples)]
    };
    if batch.is_lit() {
        // Of the lanes' look-ups only colours are made.
        for (pixels, out) in batch.pixels.iter().zip(out) {
            let [u, v, size] = places(cells, &rays(pixels)).map(|lanes| lanes.to_array());
            for lane in pixels.covered() {
                out.set(lane, &points::trilinear(surface, [u[lane], v[lane]], size[lane]));
            }
        }
        return;
    }
    queue::look_up_all(batch, out, rays, |queue, out| {
        let mut found = [[PixelLanes::ZERO; 3]; queue::AT_ONCE];
        let groups = queue.groups();
        for (found, rays) in found.iter_mut().zip(groups) {
            *found = places(cells, rays);
        }
        trilinear::look_up(surface, &found[..groups.len()], |group, color| {
            queue.hand_out(group, color, out);
        });
    });
}

/// Where the rays meet the relief, and the sizes of their texels.
#[inline(always)]
fn places(cells: Option<&HeightCells>, &[u, v, du, dv, size]: &Rays) -> [PixelLanes; 3] {
    // Where there is no relief, nothing is displaced.
    let Some(cells) = cells else { return [u, v, size] };
    let depth = Relief::new(cells, &[u, v, du, dv, size]).depth_of_hit();
    [u + du * depth, v + dv * depth, size]
}

/// The heights under eight rays: trilinear, at the levels of their texels' sizes.
struct Relief<'a> {
    cells: &'a HeightCells,
    fine: CellRays,
    coarse: CellRays,
    blend: PixelLanes,
    /// Whether any ray has a share of the coarser level.
    is_blended: bool,
}

impl<'a> Relief<'a> {
    #[inline(always)]
    fn new(cells: &'a HeightCells, &[u, v, du, dv, size]: &Rays) -> Self {
        let last = cells.last_level();
        let (level, blend) = levels::of_sizes(size, last);
        let coarser = (level + 1).min(i32x8::splat(last as i32));
        let rays = |level| cells.rays(level, &[u, v], &[du, dv]);
        // One after the other: an array of both would lie in memory.
        let (fine, coarse) = (rays(level), rays(coarser));
        let is_blended = blend.simd_gt(PixelLanes::ZERO).any();
        Self { cells, fine, coarse, blend, is_blended }
    }

    /// How far the rays are above the relief at a depth, in units of stored heights.
    #[inline(always)]
    fn gap(&self, depth: f32) -> PixelLanes {
        let fine = self.cells.heights(&self.fine, depth);
        let height = if self.is_blended {
            fine + (self.cells.heights(&self.coarse, depth) - fine) * self.blend
        } else {
            fine
        };
        PixelLanes::splat(FULL_F32 - FULL_F32 * depth) - height
    }

    /// The depths, 0 to 1, at which the rays are taken to meet the relief.
    #[inline(always)]
    fn depth_of_hit(&self) -> PixelLanes {
        // Step down until all rays are under the relief; those that are stay where they are.
        let mut depth = PixelLanes::ZERO;
        let mut gap = self.gap(0.0);
        let mut gap_above = gap;
        for i in 1..=NUM_STEPS {
            let is_under = gap.simd_le(PixelLanes::ZERO);
            if is_under.all() {
                break;
            }
            let next = f32::from(i) * STEP;
            gap_above = is_under.select(gap_above, gap);
            gap = is_under.select(gap, self.gap(next));
            depth = is_under.select(depth, PixelLanes::splat(next));
        }
        // Take the gap for linear between the last two depths: a secant step. Where the polygon is
        // under the relief already, there is none.
        let back = gap / (gap_above - gap) * STEP;
        depth.simd_gt(PixelLanes::ZERO).select(depth + back, PixelLanes::ZERO)
    }
}
