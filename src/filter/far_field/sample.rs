//! A pixel from the tables: elliptical weighted average over the blend of four directions.

use super::encode::{UNITS, decode};
use super::{FarField, FarImage, NUM_LENGTHS};
use crate::filter::texel_set::{RowQuadric, lane_columns};
use crate::filter::{Ellipse, Filtered, Footprint, PixelFootprints, RECONSTRUCTION};
use crate::settings::{Formulas, Settings};
use crate::simd::{PixelLanes, TexelLanes, exp_negative, sum, u32x8};
use crate::texture::{FULL_F32, Surface};

/// Texels of a table across a footprint's shorter axis: at least this many, and less than twice as many.
const TEXELS_ACROSS: f32 = 3.0;

/// Most texels along the longer axis: a thin footprint at the horizon takes a coarser table.
const TEXELS_ALONG: f32 = 32.0;

/// Texels of the finest table across a footprint where the tables begin to count, where sweeps lose nothing by their levels
/// and where they do.
const HAND_OVER: [f32; 2] = [4.5, 3.0];

/// Times as many where nothing but the tables counts.
const HAND_OVER_END: f32 = 4.0 / 3.0;

impl FarField {
    /// How much of the colour of eight pixels the tables give, 0 to 1: all of it where a footprint is large.
    #[must_use]
    pub fn shares(&self, surface: &Surface, pixels: &PixelFootprints, settings: &Settings) -> PixelLanes {
        let across = pixels.width(surface.texels_per_repeat(self.first_level), settings.max_anisotropy);
        if across.simd_le(PixelLanes::splat(HAND_OVER[1])).all() {
            return PixelLanes::ZERO;
        }
        let base = surface.texels_per_repeat(0);
        let [du, dv] = pixels.displacement.map(PixelLanes::to_array);
        let start = std::array::from_fn(|i| self.hand_over([du[i] * base[0], dv[i] * base[1]]));
        let start = PixelLanes::new(start);
        let share = (across - start) / (start * (HAND_OVER_END - 1.0));
        share.fast_max(PixelLanes::ZERO).fast_min(PixelLanes::ONE)
    }

    /// Where the tables begin to count for a displacement in base texels, between those of the nearest lengths.
    fn hand_over(&self, displacement: [f32; 2]) -> f32 {
        let place = self.place_of_length(displacement);
        let near = (place as usize).min(NUM_LENGTHS - 2);
        let [near_start, far_start] = [near, near + 1].map(|length| HAND_OVER[self.level_bias[length].min(1)]);
        near_start + (far_start - near_start) * (place - near as f32)
    }

    /// The mean of what is seen in a footprint around its base coordinate, for a displacement in repeats.
    #[must_use]
    pub fn mean(
        &self,
        surface: &Surface,
        footprint: &Footprint,
        displacement: [f32; 2],
        settings: &Settings,
    ) -> Filtered {
        let (index, ellipse) = self.choose_level(surface, footprint, settings);
        let texels = surface.texels_per_repeat(index);
        let place = [0, 1].map(|i| (footprint.center[i] + displacement[i] * self.mean_depth) * texels[i] - 0.5);
        let base = surface.texels_per_repeat(0);
        let nearest = self.neighbours([displacement[0] * base[0], displacement[1] * base[1]]);
        let images = nearest.map(|(image, share)| (&self.images[image], share));
        let color = average(&images, index - self.first_level, &ellipse, place);
        Filtered { color: std::array::from_fn(|i| color[i] * UNITS[i] * FULL_F32), normal: [0.0, 0.0, 1.0] }
    }

    /// The coarsest level on which the footprint has [`TEXELS_ACROSS`], and the ellipse in its texels.
    fn choose_level(&self, surface: &Surface, footprint: &Footprint, settings: &Settings) -> (usize, Ellipse) {
        let at = |level: usize| {
            let ellipse = Ellipse::new(footprint, surface.texels_per_repeat(level), Formulas::Meant);
            ellipse.bounded(settings.max_anisotropy)
        };
        let last = surface.levels.len() - 1;
        let fits = |level: &usize| {
            let [short, long] = at(*level).squared_axes().map(f32::sqrt);
            2.0 * short < 2.0 * TEXELS_ACROSS && 2.0 * long < TEXELS_ALONG
        };
        let level = (self.first_level..last).find(fits).unwrap_or(last);
        let Ellipse { a, b, c, f } = at(level);
        let [short, long] = at(level).squared_axes();
        // A thin ellipse may fall between texels: it gets their kernel.
        let kernel = RECONSTRUCTION * (2.0 - short).clamp(0.0, 1.0);
        let f = if kernel > 0.0 { (short + kernel) * (long + kernel) } else { f };
        (level, Ellipse { a: a + kernel, b, c: c + kernel, f })
    }
}

/// The Gaussian mean over the ellipse around `place` (texel centres at whole numbers) of four images by their shares.
fn average(images: &[(&FarImage, f32); 4], level: usize, ellipse: &Ellipse, place: [f32; 2]) -> [f32; 3] {
    let width = images[0].0.width(level);
    let half_height = ellipse.half_height();
    let (mut weights, mut colors) = (TexelLanes::ZERO, [TexelLanes::ZERO; 3]);
    for y in (place[1] - half_height).ceil() as i32..=(place[1] + half_height).floor() as i32 {
        let v = y as f32 - place[1];
        let Some([left, right]) = ellipse.row(v) else { continue };
        let quadric = RowQuadric::new(ellipse, v);
        let rows = images.map(|(image, _)| image.row(level, y));
        let (mut x, last) = ((place[0] + left).ceil() as i32, (place[0] + right).floor() as i32);
        while x <= last {
            let r2 = quadric.at(lane_columns(x) - place[0]).fast_max(TexelLanes::ZERO);
            let inside = r2.simd_le(TexelLanes::ONE);
            let weight = exp_negative((r2 + r2).fast_min(TexelLanes::splat(2.0))) & inside;
            let start = x.rem_euclid(width as i32) as usize;
            weights += weight;
            for (row, (_, share)) in rows.iter().zip(images) {
                let run: &[u32; 8] = row[start..start + 8].try_into().expect("a slice of eight");
                let (texel, weight) = (decode(u32x8::new(*run)), weight * *share);
                (0..3).for_each(|i| colors[i] += texel[i] * weight);
            }
            x += 8;
        }
    }
    let weight = sum(weights).max(f32::MIN_POSITIVE);
    colors.map(|lanes| sum(lanes) / weight)
}
