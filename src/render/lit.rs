//! Lights on what filters find: texels of a pixel, and surfaces without a texture.

use super::ground::{Ground, pixel_center, surface_point};
use super::shade::Shader;
use crate::footprint::Footprint;
use crate::light::{LocalLights, Reflected, SeenGloss};
use crate::raster::{QuadBlock, QuadPair};
use crate::scene::{Finish, Scene};
use crate::settings::Lighting;
use crate::texture::Texel;
use glam::Vec3;
use std::ops::Range;

impl Shader<'_> {
    pub(super) fn is_lit(&self) -> bool {
        self.settings.lighting == Lighting::Lit
    }

    /// The colour of a filtered texel of a pixel.
    pub(super) fn lit(
        &self,
        ground: &Ground,
        (texel, pixel): (&Texel, &Footprint),
        lights: Option<&LocalLights>,
    ) -> Vec3 {
        let color = ground.color_of(ground.prepared.surface(), texel);
        let Some(lights) = lights else { return color };
        let normal = Vec3::from(texel.normal);
        let has_light = self.traits.asks_for_lights;
        self.lit_color(&ground.finish(pixel), (color, has_light), normal, lights)
    }

    /// A colour under lights; a filter that asks for lights has the diffuse part in its mean
    /// already, texel by texel.
    pub(super) fn lit_color(
        &self,
        finish: &Finish,
        (color, has_light): (Vec3, bool),
        normal: Vec3,
        lights: &LocalLights,
    ) -> Vec3 {
        let (sky, mut base) = (&self.scene.sky, color);
        let mut diffuse = color;
        if !has_light {
            diffuse *= lights.diffuse(normal, sky);
        } else if finish.metallic > 0.0 {
            // What has this colour in this light.
            base /= lights.diffuse(normal, sky).max(Vec3::splat(1e-6));
        }
        let reflected = self.reflected((finish, base), normal, lights, SeenGloss::default());
        diffuse * (reflected.passed * (1.0 - finish.metallic)) + reflected.added
    }

    /// What a material whose base colour is `base` does with lights.
    pub(super) fn reflected(
        &self,
        (finish, base): (&Finish, Vec3),
        normal: Vec3,
        lights: &LocalLights,
        seen: SeenGloss,
    ) -> Reflected {
        let reflectance = self.prepared.reflectance();
        lights.reflected(normal, (finish, base), &self.scene.sky, reflectance, seen)
    }

    /// Lists the lights of the covered pixels of pairs of a block, pair by pair and lane by lane.
    pub(super) fn list_lights(
        &self,
        (block, pairs): (&QuadBlock, Range<usize>),
        lights: &mut Vec<LocalLights>,
    ) {
        lights.extend(pairs.map(|index| block.pair(index)).flat_map(|pair| {
            pair.covered()
                .filter_map(move |lane| self.lights_at(&pair, lane, pixel_center(&pair, lane)))
        }));
    }

    /// The lights at a place on the screen, if there is lighting.
    pub(super) fn lights_at(
        &self,
        pair: &QuadPair,
        lane: usize,
        place: [f32; 2],
    ) -> Option<LocalLights> {
        let point = self.is_lit().then(|| surface_point(pair.planes[lane / 4], place))??;
        let Scene { camera, lights, sky, .. } = self.scene;
        Some(LocalLights::at(&point, camera.viewpoint(), lights, sky))
    }
}
