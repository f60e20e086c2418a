//! Samples where another mesh may stand in the relief that they see.

use super::behind::{Asked, FollowScratch};
use super::edge::Row;
use super::grid::bounds;
use super::tile::{NONE, VisibilityBuffer, cover};
use crate::geometry::{ScreenBasis, offset_bounds};
use crate::simd::{f32x8, u32x8};

/// How far behind its own polygon relief is looked for, in depths of the relief there: on curved
/// surfaces rays go deeper than the plane through the deepest corners is.
const REACH: f32 = 1.5;

impl FollowScratch {
    /// Asks for samples where another mesh's polygon lies no farther than the deepest relief.
    pub(super) fn ask_contacts<const S: usize>(
        &mut self,
        buffer: &VisibilityBuffer,
        asked: &Asked,
    ) {
        self.find_reaches::<S>(buffer, asked);
        let Asked { geometry, list, rect, .. } = asked;
        for &triangle in *list {
            let triangle = geometry.triangle(triangle);
            let mesh = u32x8::splat(triangle.mesh);
            let (samples, reaches) = (&mut self.samples, &self.reaches);
            let around = bounds(triangle, rect, offset_bounds(S as u32));
            cover::<S>(triangle, &around, &mut |row: Row| {
                let (at, nearness) = buffer.row::<S>(&row, triangle.depth);
                let (reach, own) = reaches[at];
                let is_within = nearness.simd_gt(reach).to_bits() & !own.simd_eq(mesh);
                let is_near = is_within & row.mask.cast_unsigned();
                samples[at].is_asked |= is_near;
                samples[at].is_followed |= is_near;
            });
        }
    }

    /// Finds how far behind its polygon each sample may meet relief.
    fn find_reaches<const S: usize>(&mut self, buffer: &VisibilityBuffer, asked: &Asked) {
        let Self { samples, deepest, reaches, .. } = self;
        deepest.clear();
        deepest.extend((0..asked.list.len()).map(|local| {
            let corners = asked.follow.deepest(asked.triangle(local))?;
            let view = corners.map(|corner| corner.as_dvec3().to_array());
            Some(ScreenBasis::new(view, &asked.geometry.projection().lens).nearness())
        }));
        reaches.clear();
        reaches.resize(samples.len(), (f32x8::splat(f32::INFINITY), u32x8::splat(NONE)));
        for (at, (reach, mesh)) in reaches.iter_mut().enumerate() {
            let triangles = buffer.triangles[at].to_array();
            let depth = buffer.nearness[at].to_array();
            for lane in 0..8 {
                let local = triangles[lane] as usize;
                let Some([a, b, c]) = deepest.get(local).copied().flatten() else { continue };
                let [x, y] = buffer.place::<S>(at, lane).map(|c| c as f32);
                let under = a * x + b * y + c;
                reach.as_mut_array()[lane] = depth[lane] - (depth[lane] - under) * REACH;
                mesh.as_mut_array()[lane] = asked.triangle(local)[0];
            }
        }
    }
}
