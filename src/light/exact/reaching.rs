//! What of a scene's light gets to a hit, light by light: for pictures and numbers that show why a
//! place is bright or dark.

use super::rays::{ExactLight, Ground, Hit, cosine_direction, frame_around};
use super::sequence::Sequence;
use glam::Vec3;

/// What of a scene's light gets to a hit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reaching {
    /// Of each light of the scene.
    pub lights: Vec<LightReaching>,
    /// What the sky lights a white surface to, linear RGB.
    pub sky: Vec3,
    /// The part of a sky that is the same all over which nothing hides, 0 to 1, weighed by the
    /// cosine.
    pub open: f32,
}

/// What of a light gets to a hit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightReaching {
    /// What it would light a white surface to that lies in the polygon, with nothing in the way:
    /// linear RGB.
    pub sent: Vec3,
    /// The part of it that nothing hides, 0 to 1; 0 where the surface turns away.
    pub part: f32,
    /// What it lights a white surface to.
    pub shown: Vec3,
}

impl ExactLight<'_> {
    /// What gets to a hit, by so many rays to each light and to the sky.
    pub fn reaching(&self, hit: &Hit, num_rays: u32) -> Reaching {
        let ground = Ground::new(*self, hit);
        let sequence = Sequence::of_pixel([0; 2]);
        let share = 1.0 / num_rays as f32;
        let frame = frame_around(ground.normal);
        let mut found = Reaching {
            lights: vec![Default::default(); self.scene.lights.len()],
            ..Default::default()
        };
        for i in 0..num_rays {
            let [_, point] = sequence.points(i);
            let direction = frame * cosine_direction(point);
            if ground.sees(direction, f64::INFINITY) {
                let share = share * hit.finish.occlusion;
                found.open += share;
                found.sky += self.scene.sky.radiance(direction.as_vec3()) * share;
            }
            for (light, found) in self.scene.lights.iter().zip(&mut found.lights) {
                let (to_light, distance, intensity) = ground.towards(light, point);
                let cosine = |normal| to_light.dot(normal).max(0.0) as f32;
                found.sent += intensity * (cosine(ground.side) * share);
                let n_l = cosine(ground.normal);
                if n_l > 0.0 && ground.sees(to_light, distance) {
                    found.part += share;
                    found.shown += intensity * (n_l * share);
                }
            }
        }
        found
    }
}

impl Reaching {
    /// What all of it lights a white surface to.
    pub fn shown(&self) -> Vec3 {
        self.lights.iter().fold(self.sky, |sum, light| sum + light.shown)
    }

    /// The part of what all lights send that nothing hides, 0 to 1; 1 where nothing is sent.
    pub fn part(&self) -> f32 {
        let [mut all, mut seen] = [0.0; 2];
        for light in &self.lights {
            let sent = light.sent.element_sum();
            (all, seen) = (all + sent, seen + sent * light.part);
        }
        if all > 0.0 { seen / all } else { 1.0 }
    }

    /// The light that sends most, if any sends some.
    pub fn main(&self) -> Option<usize> {
        let sent = |i: usize| self.lights[i].sent.element_sum();
        let by_light = |a: &usize, b: &usize| sent(*a).total_cmp(&sent(*b));
        // Of equal ones the first.
        (0..self.lights.len()).rev().max_by(by_light).filter(|i| sent(*i) > 0.0)
    }
}
