//! What flat pieces of glossy surfaces reflect, ready to be seen texel by texel.

use super::mapped::{mean_finish, own_roughness, reflecting, scatters};
use crate::filter::Prepared;
use crate::light::reflection::Reflectance;
use crate::light::{Gloss, Openings, SkyLobe, TextureFrame, lit_parts};
use crate::scene::{Light, Material, Scene};
use std::sync::Arc;

/// What it reflects of each sun, by its number, and of the sky.
pub(super) fn gloss(
    frame: &TextureFrame,
    material: &Material,
    (scene, reflectance): (&Scene, &Reflectance),
    unlit: &Prepared,
) -> Vec<(Option<usize>, Prepared)> {
    let surface = unlit.surface();
    let (roughness, relief_depth) = (own_roughness(material), surface.relief_depth());
    let of_sun = |(i, light): (usize, &Light)| {
        let Light::Sun { to_light, .. } = *light else { return None };
        let beams = frame.sun(light);
        let gloss = Gloss::of_sun(frame, to_light, roughness, relief_depth);
        let reflecting = || reflecting(material, unlit, lit_parts(surface, &beams));
        (!beams.is_empty()).then(|| (Some(i), unlit.glossy(reflecting(), gloss)))
    };
    let mut gloss: Vec<_> = scene.lights.iter().enumerate().filter_map(of_sun).collect();
    if unlit.has_relief() && scatters(surface, &scene.sky) {
        let reflecting = reflecting(material, unlit, |_, _| 1.0);
        let lobe = SkyLobe::new(
            (&scene.sky, frame),
            mean_finish(material, unlit),
            reflectance,
            Arc::new(Openings::new(surface, frame)),
        );
        let lobe = (lobe, reflecting.color_scale());
        let gloss_of_sky = Gloss::of_sky(frame, lobe, roughness, relief_depth);
        gloss.push((None, unlit.glossy(reflecting, gloss_of_sky)));
    }
    gloss
}
