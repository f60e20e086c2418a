//! Surfaces that are lit place by place: those without relief that are curved, or have no texture.
//!
//! Meshes throw shadows on them, themselves among them, and hide a part of the sky, as they do where
//! there is relief. Only the sky that a surface mirrors is dimmed as a whole: what it shows of other
//! meshes is not drawn.

use super::ground::{in_lanes, pixel_center, point_of};
use super::hidden_lights::HiddenLights;
use super::shade::Shader;
use crate::raster::{QuadBlock, QuadPair};
use crate::relief::HeightField;
use crate::scene::{Material, Sky};
use crate::simd::PixelLanes;
use glam::Vec3;

impl Shader<'_> {
    /// What meshes hide from the pixels of a block whose lights are evaluated place by place; some
    /// have relief nevertheless. `None` by filters that do not ask for lights: they draw no shadow
    /// there.
    pub(super) fn hidden_by_place(
        &self,
        field: Option<&HeightField>,
        block: &QuadBlock,
    ) -> Option<HiddenLights> {
        if !self.traits.asks_for_lights || !self.prepared.is_baked() {
            return None;
        }
        let mut hidden = HiddenLights::none(self.scene.lights.len());
        self.hide_on_curved(field, block, &mut hidden);
        self.hide_points((field, Vec3::ZERO), block, &mut hidden);
        if self.scene.sky != Sky::default() {
            let skies = block.pairs().map(|pair| self.open_sky(&pair));
            hidden.skies = skies.collect::<Option<_>>().unwrap_or_default();
        }
        Some(hidden)
    }

    /// The shares of the sky that get past all meshes to the pixels of a pair of a curved mesh.
    fn open_sky(&self, pair: &QuadPair) -> Option<[Vec3; 8]> {
        let (scene, prepared) = (self.scene, self.prepared);
        let skies = prepared.skies(scene).of_pair((scene, prepared.occluders(scene)), pair)?;
        let lit = pair.lit()?;
        let mut shares = [Vec3::ONE; 8];
        for lane in pair.covered() {
            let [_, _, normal] = point_of(&lit, lane).axes();
            let (open, all) = (skies[lane].irradiance(normal), scene.sky.irradiance(normal));
            // A channel that is black stays black.
            let share = open / all.max(Vec3::splat(f32::MIN_POSITIVE));
            shares[lane] = share.clamp(Vec3::ZERO, Vec3::ONE);
        }
        Some(shares)
    }

    /// Pixels of a material without a texture.
    pub(super) fn plain(
        &self,
        block: &QuadBlock,
        material: &Material,
        colors: &mut Vec<[PixelLanes; 3]>,
    ) {
        let hidden = if self.is_lit() { self.hidden_by_place(None, block) } else { None };
        colors.extend(block.pairs().enumerate().map(|(i, pair)| {
            let mut colors = [Vec3::ZERO; 8];
            let tint = pair.tint();
            let tint = |lane: usize| {
                tint.map_or(Vec3::ONE, |tint| Vec3::from(tint.map(|c| c.as_array()[lane])))
            };
            // Helper lanes stay black: nothing adds them to a pixel.
            for lane in pair.covered() {
                let base = material.base_color * tint(lane);
                let mut lights = self.lights_at(&pair, lane, pixel_center(&pair, lane));
                colors[lane] = match &mut lights {
                    Some(lights) => {
                        if let Some(hidden) = &hidden {
                            hidden.dim_at(lights, [i, lane]);
                        }
                        // Nothing bends the normal here: it is z in the surface's own frame.
                        let mut finish = material.plain_finish();
                        if material.base_color == Vec3::ZERO {
                            finish.emissive *= tint(lane);
                        }
                        self.lit_color(&finish, (base, false), Vec3::Z, lights)
                    }
                    None => base,
                };
            }
            in_lanes(&colors)
        }));
    }
}
