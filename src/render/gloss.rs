//! What flat pieces of glossy surfaces reflect, ready to be seen texel by texel.

use super::mapped::texel_finish;
use crate::filter::Prepared;
use crate::light::reflection::{Fresnel, Reflectance};
use crate::light::{Gloss, Openings, SkyLobe, TextureFrame, glossy, rough_length};
use crate::scene::{Finish, Light, Material, Scene, Sky};
use crate::texture::{Normals, Surface};
use glam::Vec3;
use std::sync::Arc;

/// What it reflects of each sun, by its number, and of the sky.
pub(super) fn gloss(
    frame: &TextureFrame,
    material: &Material,
    (scene, reflectance): (&Scene, &Reflectance),
    unlit: &Prepared,
) -> Vec<(Option<usize>, Prepared)> {
    let surface = unlit.surface();
    let finish = |x, y| texel_finish(material, unlit, [x, y]);
    let fresnel =
        |x, y, albedo| Fresnel::new(&finish(x, y), Vec3::from(albedo) * material.base_color);
    let roughness = material.maps.roughness.is_none().then_some(material.roughness);
    let length = |x, y| rough_length(finish(x, y).roughness);
    let normals = if roughness.is_some() { Normals::Kept } else { Normals::Scaled(&length) };
    let relief_depth = surface.relief_depth();
    let of_sun = |(i, light): (usize, &Light)| {
        let Light::Sun { to_light, .. } = *light else { return None };
        let beams = frame.beams(std::slice::from_ref(light), &Sky::default());
        let gloss = Gloss::of_sun(frame, to_light, roughness, relief_depth);
        let straight = |x, y, albedo| fresnel(x, y, albedo).straight;
        let is_up = !beams.is_empty();
        is_up.then(|| (Some(i), unlit.glossy(glossy(surface, &beams, normals, straight), gloss)))
    };
    let mut gloss: Vec<_> = scene.lights.iter().enumerate().filter_map(of_sun).collect();
    if unlit.has_relief() && scatters(surface, &scene.sky) {
        let straight = |x, y, albedo| fresnel(x, y, albedo).straight.to_array();
        let reflecting = surface.with_colors(normals, straight);
        let lobe = SkyLobe::new(
            (&scene.sky, frame),
            mean_finish(surface.base().size(), finish),
            reflectance,
            Arc::new(Openings::new(surface, frame)),
        );
        let lobe = (lobe, reflecting.color_scale());
        let gloss_of_sky = Gloss::of_sky(frame, lobe, roughness, relief_depth);
        gloss.push((None, unlit.glossy(reflecting, gloss_of_sky)));
    }
    gloss
}

/// Whether what the texels of a surface reflect of a sky says more than what their mean does: of a
/// picture they see the light around a direction alone, so a nearly flat mirror is better off without.
fn scatters(surface: &Surface, sky: &Sky) -> bool {
    /// How much shorter the mean normal must be than one. Measured on cobbles, roughness 0.1 and 0.3:
    /// at 0.011 the mean is better by 2 to 5 dB, at 0.073 texels are by 2 to 4.
    const LEAST: f32 = 0.03;
    let mean = surface.levels()[surface.last_level()].texel(0, 0).normal;
    match sky {
        Sky::Color(color) => *color != Vec3::ZERO,
        Sky::Gradient { .. } => true,
        Sky::Environment(_) => Vec3::from(mean).length() < 1.0 - LEAST,
    }
}

/// The mean roughness of a grid of a surface's texels, and how much they reflect of light along it.
fn mean_finish([width, height]: [usize; 2], at: impl Fn(usize, usize) -> Finish) -> (f32, f32) {
    /// Places a side.
    const SIDE: usize = 16;
    let share = 1.0 / (SIDE * SIDE) as f32;
    let places = (0..SIDE * SIDE).map(|i| {
        let place = |i: usize, n: usize| (2 * i + 1) * n / (2 * SIDE);
        at(place(i % SIDE, width), place(i / SIDE, height))
    });
    places.fold((0.0, 0.0), |(roughness, grazing), finish| {
        let of = Fresnel::new(&finish, Vec3::ONE);
        (roughness + finish.roughness * share, grazing + of.grazing * share)
    })
}
