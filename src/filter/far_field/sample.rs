//! A pixel from the tables: elliptical weighted average over the blend of four directions.

use super::encode::{FarImage, UNITS, decode};
use super::tables::FarField;
use crate::footprint::levels::{for_tables, rows_in_excess};
use crate::footprint::{Ellipse, Ellipses, Footprint, Footprints, RowQuadric};
use crate::settings::Horizon;
use crate::simd::{PixelLanes, TexelLanes, exp_negative, lane_columns, sum, u32x8};
use crate::texture::{FULL_F32, Surface, Texel};

/// Texels of the finest table across a footprint where the tables begin to count. Measured, 400x225,
/// dB of the wall, the torus and a tiled facade: 3.8 gives 48.0 41.2 50.2, 4.2 gives 48.8 42.1 49.7,
/// 5.0 gives 49.3 41.4 46.4: sweeps then run into the bound on their rows.
const HAND_OVER: f32 = 4.2;

/// Times as many where nothing but the tables counts.
const HAND_OVER_END: f32 = 4.0 / 3.0;

impl FarField {
    /// How much of the colour of eight pixels the tables give, 0 to 1: all of it where a footprint
    /// is large.
    pub(in crate::filter) fn shares(
        &self,
        surface: &Surface,
        pixels: &Footprints,
        horizon: &Horizon,
    ) -> PixelLanes {
        let texels = surface.levels()[self.first_level].texels_per_repeat();
        let across = Ellipses::new(pixels, texels, horizon.max_anisotropy).short.sqrt() * 2.0;
        // Where sweeps would be too long and take a coarser level, tables begin earlier, by the
        // square of it: on a tiled facade at 1280x720 45.7 dB without the square, 37.0 without all.
        let excess = rows_in_excess(surface, pixels, horizon).fast_max(PixelLanes::ONE);
        let across = across * excess * excess;
        let share = (across - HAND_OVER) / (HAND_OVER * (HAND_OVER_END - 1.0));
        share.fast_max(PixelLanes::ZERO).fast_min(PixelLanes::ONE)
    }

    /// The mean of what is seen in a footprint around its base place.
    pub(in crate::filter) fn mean(
        &self,
        surface: &Surface,
        footprint: &Footprint,
        max_anisotropy: f32,
    ) -> Texel {
        let Footprint { base, displacement, .. } = *footprint;
        let (index, ellipse) = for_tables(surface, self.first_level, footprint, max_anisotropy);
        // Take the place on the tables' plane, where the four agree.
        let place = [0, 1].map(|i| base[i] + displacement[i] * self.plane);
        let place = surface.levels()[index].in_texels(place).map(|c| c - 0.5);
        let nearest = self.neighbours(surface.base().in_texels(displacement));
        let images = nearest.map(|(image, share)| (&self.images[image], share));
        let color = average(&images, index - self.first_level, &ellipse, place);
        Texel { color: std::array::from_fn(|i| color[i] * UNITS[i] * FULL_F32), normal: Texel::UP }
    }
}

/// The Gaussian mean over the ellipse around `place` (texel centres at whole numbers) of four
/// images by their shares.
fn average(
    images: &[(&FarImage, f32); 4],
    level: usize,
    ellipse: &Ellipse,
    place: [f32; 2],
) -> [f32; 3] {
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
            // Weigh eight texels: the weights are the same in all four images.
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
    // Sum the lanes in one fixed order, for the same bytes on every machine.
    let weight = sum(weights).max(f32::MIN_POSITIVE);
    colors.map(|lanes| sum(lanes) / weight)
}
