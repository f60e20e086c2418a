//! Light at single places of a curved surface, for rays that are followed one by one.

use super::lit::PatchLight;
use super::pixels::PixelOnLines;
use super::shine::{PatchLayer, PatchShine, Shone};
use super::show::{Part, Show};
use crate::light::{Curved, Horizons, Sheen, Shine};
use crate::simd::{BETWEEN_SCALE, Between, LineLanes};
use crate::texture::{FULL_F32, Surface, Texel, near_origin};

/// What a texel of a curved surface shows of the lights, or reflects of them where that is asked for, at a
/// place in repeats and of a depth, as a lane of their first vector of pixels stands.
pub(crate) fn lit_at(
    (curved, lane): (&Curved, usize),
    (horizons, surface): (&Horizons, &Surface),
    (place, depth, texel): ([f32; 2], f32, &Texel),
) -> [f32; 3] {
    let here = [PixelOnLines { half_width: 1.0, half_height: 1.0, ..PixelOnLines::default() }];
    let rows = horizons.rows(0, false);
    let picks = [lane as u8];
    let light = PatchLight::new(curved, rows, &picks, &here);
    let (mut shine, mut layer) = (None, None);
    match &curved.shine {
        Some(Shine { sheen: Sheen::Luster(luster), to_eyes }) => {
            let with = (&picks[..], &here[..]);
            shine = Some(PatchShine::new(&light, (luster, to_eyes), with, (1.0, false)));
        }
        Some(Shine { sheen: Sheen::Layer(of), to_eyes }) => {
            layer = Some(PatchLayer::new(&light, (of, to_eyes), (&picks, &here)));
        }
        None => {}
    }
    let [x, y] = surface.base().in_texels(near_origin(place, surface.wrap())).map(|c| c - 0.5);
    let [column, row] = [x, y].map(f32::floor);
    let between = Between::new(LineLanes::splat(x - column));
    let height = LineLanes::splat((1.0 - depth) * (FULL_F32 * BETWEEN_SCALE));
    let at = [LineLanes::ZERO, LineLanes::ZERO, height];
    let [color, normal] = [texel.color, texel.normal].map(|of| of.map(LineLanes::splat));
    let starts = [0, 1].map(|i| rows.start_at(column as i32, row as i32 + i));
    if let Some(shine) = shine {
        let [near, far] = starts.map(|start| Shone::new([color, normal], at, (start, between)));
        let part = Part { middle: LineLanes::splat(y - row), length: LineLanes::ZERO };
        return shine.between([&near, &far], &part).map(|lanes| lanes.as_array()[0]);
    }
    let [near, far] =
        starts.map(|start| light.at(start, &between, at, 0.0).map(|lanes| lanes.as_array()[0]));
    let shown = [0, 1, 2].map(|c| near[c] + (far[c] - near[c]) * (y - row));
    let passed =
        layer.map_or(1.0, |layer| layer.passed(normal, LineLanes::ZERO, 0.0).as_array()[0]);
    [0, 1, 2].map(|c| texel.color[c] * shown[c] * passed)
}
