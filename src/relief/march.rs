//! The first hits of view rays with the bilinear height field.
//!
//! A ray is at `b + t D` at the depth `t` (0 on the polygon, 1 deepest), where the relief's depth
//! is `1 - h`. It descends the pyramid of maxima: a node whose relief stays under the ray is left
//! at its far side, others are opened; in a cell the crossing of the ray with the bilinear patch, a
//! quadratic in t, is solved. So no feature is stepped over, however thin.
//!
//! Sixteen rays go at once, a lane each, and a lane whose ray has ended takes the next one: none
//! waits for the longest. Cells are solved together, once half of the rays have come to one that
//! they may hit, since that takes longer than a step. What a ray does depends on no other one.

use super::displacement::{MAX_SLOPE, finite};
use super::height_field::HeightField;
use super::walk::{Course, Walk};
use crate::simd::{PixelLanes, i32x8, mask, set_bits};

/// Most steps of a ray. A walk of 64 repeats over a map of any size that opens every node takes
/// fewer in practice; the bound makes the time of a hostile input finite, and the ray then ends
/// where it is.
const MAX_STEPS: i32 = 1 << 14;

/// Most patterns from the first that a ray over a clamped map starts at: all beyond looks like its
/// edge.
const FARTHEST: f32 = 128.0;

/// Eight view rays.
#[derive(Clone, Copy, Debug)]
pub struct ViewRays {
    /// Where they meet the polygon, in repeats.
    pub base: [PixelLanes; 2],
    /// How far they move along the texture down to the deepest relief, in repeats.
    pub displacement: [PixelLanes; 2],
    /// A bit for each whose hit is asked for.
    pub wanted: u8,
}

/// The depth `t`, 0 to 1, of the first hit of the rays from `base` along `displacement`, both in
/// repeats.
pub fn march(
    field: &HeightField,
    base: &[PixelLanes; 2],
    displacement: &[PixelLanes; 2],
) -> PixelLanes {
    let mut depths = [PixelLanes::ZERO];
    let rays = ViewRays { base: *base, displacement: *displacement, wanted: u8::MAX };
    run::<1>(field, std::iter::once(rays), &mut depths);
    depths[0]
}

/// [`march`] of many rays, which is faster by the ray: `depths` has a vector for each of theirs,
/// whose lanes stay as they are where no hit is wanted.
pub fn march_all(
    field: &HeightField,
    rays: impl Iterator<Item = ViewRays>,
    depths: &mut [PixelLanes],
) {
    run::<2>(field, rays, depths);
}

/// Marches rays in so many walks of sixteen, whose lanes are numbered in a row. Two overlap: while
/// one waits for its maxima, the other computes.
fn run<const WALKS: usize>(
    field: &HeightField,
    rays: impl Iterator<Item = ViewRays>,
    depths: &mut [PixelLanes],
) {
    let mut queue = Queue { field, rays, num_vectors: 0, ready: None, left: 0 };
    let mut walks = [(); WALKS].map(|()| Walk::new(field));
    let mut numbers = [[0; 16]; WALKS];
    let all = u32::MAX >> (32 - 16 * WALKS);
    let (mut idle, mut done) = (0, all);
    loop {
        // Let each free lane take the next ray.
        for lane in set_bits(done) {
            match queue.next() {
                Some((number, ray)) => {
                    numbers[lane / 16][lane % 16] = number;
                    walks[lane / 16].put(lane % 16, &ray, MAX_STEPS);
                }
                None => idle |= 1 << lane,
            }
        }
        if idle == all {
            return;
        }
        // Walk until half of the rays wait, then let those meet the relief.
        let enough = idle.count_ones() + (all & !idle).count_ones().div_ceil(2);
        let mut waiting: u32 = 0;
        while waiting.count_ones() < enough {
            waiting = 0;
            (0..WALKS).for_each(|i| waiting |= walks[i].advance() << (16 * i));
        }
        waiting &= !idle;
        done = 0;
        (0..WALKS).for_each(|i| done |= walks[i].meet(waiting >> (16 * i) & 0xffff) << (16 * i));
        for lane in set_bits(done) {
            let (number, depth) = (numbers[lane / 16][lane % 16], &walks[lane / 16].depth);
            depths[number / 8].as_mut_array()[number % 8] = depth.as_array()[lane % 16];
        }
    }
}

/// Rays that wait for a lane, with their numbers: 8 * vector + lane.
struct Queue<'a, R> {
    field: &'a HeightField,
    rays: R,
    num_vectors: usize,
    /// The last vector, and those of its rays that still wait.
    ready: Option<Course<PixelLanes, i32x8>>,
    left: u8,
}

impl<R: Iterator<Item = ViewRays>> Iterator for Queue<'_, R> {
    type Item = (usize, Course<f32, i32>);

    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        while self.left == 0 {
            let rays = self.rays.next()?;
            self.num_vectors += 1;
            self.left = rays.wanted;
            self.ready = Some(course(self.field, &rays));
        }
        let lane = self.left.trailing_zeros() as usize;
        self.left &= self.left - 1;
        Some((8 * (self.num_vectors - 1) + lane, self.ready.as_ref()?.lane(lane)))
    }
}

/// Makes eight rays ready to go.
fn course(field: &HeightField, rays: &ViewRays) -> Course<PixelLanes, i32x8> {
    // Whole repeats are taken off first, so that far tiles keep their precision.
    let start = [0, 1].map(|axis| {
        let size = field.size[axis] as f32;
        let patterns = finite(rays.base[axis] * (field.texels_per_repeat[axis] / size));
        let whole = if field.is_clamped { PixelLanes::ZERO } else { patterns.floor() };
        let most = PixelLanes::splat(FARTHEST);
        (patterns - whole).fast_max(-most).fast_min(most) * size - 0.5
    });
    let step = [0, 1].map(|axis| {
        let most = PixelLanes::splat(MAX_SLOPE);
        finite(rays.displacement[axis]).fast_max(-most).fast_min(most)
            * field.texels_per_repeat[axis]
    });
    // Let all move forwards.
    let is_backwards = step.map(|step| step.simd_lt(PixelLanes::ZERO));
    let start = [0, 1].map(|axis| is_backwards[axis].select(-start[axis], start[axis]));
    let step = step.map(PixelLanes::abs);
    let moves = step.map(|step| step.simd_gt(PixelLanes::splat(1e-9)));
    // Each ray's own, so that its hit does not depend on the rays beside it.
    let level = step[0].fast_max(step[1]).to_array().map(|length| field.first_level(length));
    Course {
        start,
        step,
        inverse: [0, 1].map(|i| moves[i].select(PixelLanes::ONE / step[i], PixelLanes::ZERO)),
        late: moves.map(|moves| moves.select(PixelLanes::ZERO, PixelLanes::splat(2.0))),
        mirror: is_backwards.map(mask),
        cell: start.map(|start| start.floor().fast_trunc_int()),
        level: i32x8::new(level),
    }
}
