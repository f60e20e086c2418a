//! Blocks of pixels by the horizon filter: what is near is swept together, what is far comes from tables.

use super::quads::{Ground, QuadShader, albedo, in_lanes, pixel_center};
use crate::filter::horizon::{self, MOST_PIXELS, Patches, Scratch};
use crate::filter::{self, FarField, Filtered, PixelFootprints};
use crate::raster::{QuadBlock, QuadPair};
use crate::settings::{Derivatives, Formulas};
use crate::shade::LocalLights;
use crate::simd::PixelLanes;
use glam::Vec3;
use std::sync::PoisonError;

/// Pairs of quads whose pixels may share a sweep.
const NUM_PAIRS: usize = MOST_PIXELS / 8;

/// Pixels of up to [`NUM_PAIRS`] pairs on their way.
struct Batch {
    footprints: Vec<PixelFootprints>,
    /// How much of each pixel the tables give.
    shares: Vec<[f32; 8]>,
    /// Pixels that are swept, vector times 8 plus lane.
    near: Vec<u8>,
    lights: Vec<LocalLights>,
    found: Vec<Filtered>,
}

impl QuadShader<'_> {
    /// Appends the colours of a block's pairs by the horizon filter.
    pub(super) fn horizon(&self, ground: &Ground, block: &QuadBlock, colors: &mut Vec<[PixelLanes; 3]>) {
        let pool = &self.tables.scratches;
        let taken = pool.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut scratch = taken.unwrap_or_default();
        // The tables hold unlit colour.
        let far = self.tables.far_fields[block.material].as_deref().filter(|_| ground.field.is_some());
        let pairs: Vec<_> = block.pairs().collect();
        for pairs in pairs.chunks(NUM_PAIRS) {
            self.batch(ground, far, pairs, &mut scratch, colors);
        }
        pool.lock().unwrap_or_else(PoisonError::into_inner).push(scratch);
    }

    fn batch(
        &self,
        ground: &Ground,
        far: Option<&FarField>,
        pairs: &[QuadPair],
        scratch: &mut Scratch,
        colors: &mut Vec<[PixelLanes; 3]>,
    ) {
        let Ground { surface, material, .. } = *ground;
        let batch = Batch::new(self, ground, far, pairs);
        let Batch { footprints, shares, near, lights, mut found } = batch;
        let num_bins = horizon::picture_bins(self.settings, !lights.is_empty());
        let patches = Patches { surface, far, pixels: &footprints, settings: self.settings, num_bins };
        let num_rows = patches.means(&near, &lights, scratch, &mut found);
        self.count([num_rows, 0]);
        let mut swept = found.iter().enumerate();
        for ((pair, footprints), shares) in pairs.iter().zip(&footprints).zip(&shares) {
            let mut shaded = [Vec3::ZERO; 8];
            for lane in (0..8).filter(|lane| pair.coverage[*lane] > 0) {
                let far = far.filter(|_| shares[lane] > 0.0).map(|far| {
                    let reach = footprints.displacement.map(|lanes| lanes.as_array()[lane]);
                    far.mean(surface, &footprints.footprint(lane), reach, self.settings)
                });
                let near = if shares[lane] < 1.0 { swept.next() } else { None };
                let texel = match (near, far) {
                    (Some((_, near)), Some(far)) => near.lerp(&far, shares[lane]),
                    (Some((_, near)), None) => *near,
                    (None, far) => far.unwrap_or_default(),
                };
                // Lambert is in the sums already; the highlight is that of the mean normal.
                let lights = near.and_then(|(i, _)| lights.get(i));
                let specular = lights.map_or(Vec3::ZERO, |lights| lights.specular(Vec3::from(texel.normal), material));
                shaded[lane] = albedo(ground, &texel) + specular;
            }
            colors.push(in_lanes(&shaded));
        }
    }
}

impl Batch {
    fn new(shader: &QuadShader, ground: &Ground, far: Option<&FarField>, pairs: &[QuadPair]) -> Self {
        let mut batch = Self {
            footprints: Vec::with_capacity(NUM_PAIRS),
            shares: Vec::with_capacity(NUM_PAIRS),
            near: Vec::with_capacity(MOST_PIXELS),
            lights: Vec::new(),
            found: Vec::new(),
        };
        for (vector, pair) in pairs.iter().enumerate() {
            let none = [PixelLanes::ZERO; 2];
            let differences = filter::differences(&pair.uv, &none, (Derivatives::Flat, Formulas::Meant));
            let pixels = PixelFootprints::new(&pair.uv, &differences, ground.reach(pair));
            let shares = far.map_or(none[0], |far| far.shares(ground.surface, &pixels, shader.settings)).to_array();
            for lane in (0..8).filter(|lane| pair.coverage[*lane] > 0 && shares[*lane] < 1.0) {
                batch.near.push((8 * vector + lane) as u8);
                batch.lights.extend(shader.lights_at(pair, lane, pixel_center(pair, lane)));
            }
            batch.footprints.push(pixels);
            batch.shares.push(shares);
        }
        batch.found.resize(batch.near.len(), Filtered::default());
        batch
    }
}
