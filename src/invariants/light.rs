//! What must hold of the truth's light.

use super::check::{Checked, ensure};
use crate::frame::Frame;
use crate::scene::{Scene, Sky};
use crate::settings::{Filter, Lighting, Rays, Settings};
use glam::Vec3;

/// Under a sky of 1 alone no surface whose colours are at most 1 sends out more than 1, whatever
/// relief and meshes hide: base colours are cut there, and emission is taken away. By the truth,
/// with so many rays a pixel. Scenes with brighter textures are not looked at.
///
/// # Errors
/// Says what broke.
pub fn no_more_than_the_sky(mut scene: Scene, settings: &Settings, samples: u32) -> Checked {
    for material in &mut scene.materials {
        material.base_color = material.base_color.min(Vec3::ONE);
        material.emissive = Vec3::ZERO;
    }
    let surfaces = scene.materials.iter().filter_map(|material| material.surface.as_ref());
    if surfaces.into_iter().any(|surface| surface.color_scale() > 1.0) {
        return Ok(());
    }
    let scene = Scene { lights: vec![], sky: Sky::Color(Vec3::ONE), background: [0.0; 4], ..scene };
    let Some(frame) = lit(scene, settings, samples) else { return Ok(()) };
    let is_good = |p: &[f32; 4]| p[..3].iter().all(|c| (0.0..=1.0 + 1e-4).contains(c));
    let bad = frame.pixels.iter().position(|p| !is_good(p));
    ensure(bad.is_none(), || format!("pixel {bad:?} is {:?}", frame.pixels[bad.unwrap_or(0)]))
}

/// The truth's picture is the sum of that with the first light alone and that with all else, up to
/// rounding: samples do not depend on what lights there are.
///
/// # Errors
/// Says what broke.
pub fn lights_add(mut scene: Scene, settings: &Settings, samples: u32) -> Checked {
    scene.background = [0.0; 4];
    let mut first = scene.clone();
    first.lights.truncate(1);
    first.sky = Sky::default();
    first.materials.iter_mut().for_each(|material| material.emissive = Vec3::ZERO);
    let mut rest = scene.clone();
    rest.lights.drain(..rest.lights.len().min(1));
    let frames = [scene, first, rest].map(|scene| lit(scene, settings, samples));
    let [Some(all), Some(first), Some(rest)] = frames else { return Ok(()) };
    let pixels = all.pixels.iter().flatten().zip(first.pixels.iter().flatten());
    for (i, ((all, first), rest)) in pixels.zip(rest.pixels.iter().flatten()).enumerate() {
        // The fourth component is the opacity, and the same in all three.
        let error = (all - (first + rest)).abs();
        ensure(i % 4 == 3 || error <= 1e-4 * all.max(1e-3), || {
            format!("pixel {} is {all}, and {first} + {rest} by its lights", i / 4)
        })?;
    }
    Ok(())
}

/// The truth's picture of a scene, if that is valid.
fn lit(scene: Scene, settings: &Settings, samples: u32) -> Option<Frame> {
    let (filter, lighting) = (Filter::Truth(Rays { samples }), Lighting::Lit);
    crate::render(scene, Settings { filter, lighting, exposure: 0.0, ..settings.clone() }).ok()
}
