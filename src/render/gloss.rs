//! What flat pieces of glossy surfaces reflect, ready to be seen texel by texel.

use super::mapped::{mean_finish, own_roughness, reflecting, scatters};
use crate::filter::Prepared;
use crate::light::reflection::Reflectance;
use crate::light::{Gloss, SkyLobe, Skylines, TextureFrame, lit_parts};
use crate::scene::{Light, Material, Scene};
use crate::texture::{FULL_F32, Surface, Texel};
use glam::Vec3;
use rayon::prelude::*;
use std::sync::Arc;

/// What a flat piece of a glossy surface reflects of a sun or of the sky.
#[derive(Debug)]
pub(super) struct PieceGloss {
    /// The sun, by its number among the lights; `None` for the sky.
    pub(super) sun: Option<usize>,
    /// What texels that the sun reaches reflect of light that comes straight, in the mean, linear RGB.
    pub(super) straight: Vec3,
    /// What texels reflect, for the horizon to sweep.
    pub(super) prepared: Prepared,
}

/// What it reflects of each sun and of the sky.
pub(super) fn gloss(
    frame: &TextureFrame,
    material: &Material,
    (scene, reflectance): (&Scene, &Reflectance),
    unlit: &Prepared,
) -> Vec<PieceGloss> {
    let surface = unlit.surface();
    let (roughness, relief_depth) = (own_roughness(material), surface.relief_depth());
    let of_sun = |(i, light): (usize, &Light)| {
        let Light::Sun { to_light, .. } = *light else { return None };
        let beams = frame.sun(light);
        let gloss = Gloss::of_sun(frame, to_light, roughness, relief_depth);
        (!beams.is_empty()).then(|| {
            let lit = lit_parts(surface, &beams);
            let reflecting = reflecting(material, unlit, &lit);
            let straight = mean_color(&reflecting) / mean(surface, lit).max(f32::MIN_POSITIVE);
            PieceGloss { sun: Some(i), straight, prepared: unlit.glossy(reflecting, gloss) }
        })
    };
    let mut gloss: Vec<_> = scene.lights.iter().enumerate().filter_map(of_sun).collect();
    if unlit.has_relief() && scatters(surface, &scene.sky) {
        let reflecting = reflecting(material, unlit, |_, _| 1.0);
        let lobe = SkyLobe::new(
            (&scene.sky, frame),
            mean_finish(material, unlit),
            reflectance,
            Arc::new(Skylines::new(surface, frame)),
        );
        let lobe = (lobe, reflecting.color_scale());
        let gloss_of_sky = Gloss::of_sky(frame, lobe, roughness, relief_depth);
        let straight = mean_color(&reflecting);
        gloss.push(PieceGloss {
            sun: None,
            straight,
            prepared: unlit.glossy(reflecting, gloss_of_sky),
        });
    }
    gloss
}

/// The mean linear colour of a surface.
fn mean_color(surface: &Surface) -> Vec3 {
    let Texel { color, .. } = surface.levels()[surface.last_level()].texel(0, 0);
    Vec3::from(color) * (surface.color_scale() / FULL_F32)
}

/// The mean of a number of a surface's texels, by column and row.
fn mean(surface: &Surface, of: impl Fn(usize, usize) -> f32 + Sync) -> f32 {
    let [width, height] = surface.base().size();
    let of_row = |y: usize| (0..width).map(|x| of(x, y)).sum::<f32>() / width as f32;
    // Added in the order of the rows, so that the bits are always the same.
    let rows: Vec<_> = (0..height).into_par_iter().map(of_row).collect();
    rows.iter().sum::<f32>() / height as f32
}
