//! Light from everywhere.

mod environment;

use super::angle;
use super::light::is_light;
use glam::Vec3;
use std::f64::consts::PI;

pub use environment::Environment;

/// What shines from all directions, unless it is hidden, under
/// [`Lighting::Lit`](crate::Lighting::Lit). Linear RGB, 0 to 1e6. Up is +y of the world.
///
/// A sky of one colour lights a white surface that sees all of it to that colour. The sky is light
/// only: [`Scene::background`](super::Scene::background) is what is drawn where nothing is hit.
#[derive(Clone, Debug, PartialEq)]
pub enum Sky {
    /// The same colour everywhere.
    Color(Vec3),
    /// Three colours, and between them a blend linear in how far a unit direction goes up.
    Gradient {
        /// Straight up.
        top: Vec3,
        /// Level.
        horizon: Vec3,
        /// Straight down.
        ground: Vec3,
    },
    /// A picture of all directions.
    Environment(Environment),
}

impl Default for Sky {
    /// No light.
    fn default() -> Self {
        Self::Color(Vec3::ZERO)
    }
}

impl Sky {
    /// What comes from a unit direction, in linear RGB.
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        match self {
            Self::Color(color) => *color,
            Self::Gradient { top, horizon, ground } => {
                let up = direction.y.clamp(-1.0, 1.0);
                let end = if up < 0.0 { ground } else { top };
                *horizon * (1.0 - up.abs()) + *end * up.abs()
            }
            Self::Environment(picture) => picture.radiance(direction),
        }
    }

    /// What a white surface with this unit normal is lit to, if nothing hides the sky: the mean
    /// radiance, weighed by the cosine. In closed form, for a picture by its harmonics up to the
    /// second order (Ramamoorthi and Hanrahan 2001), which is within a few percent.
    pub fn irradiance(&self, normal: Vec3) -> Vec3 {
        match self {
            Self::Color(color) => *color,
            Self::Gradient { top, horizon, ground } => {
                let up = f64::from(normal.y).clamp(-1.0, 1.0);
                let [above, below] = [seen_upness(up), seen_upness(-up)];
                *horizon * (1.0 - above - below) + *top * above + *ground * below
            }
            Self::Environment(picture) => picture.irradiance(normal),
        }
    }

    /// Whether it is the same colour everywhere.
    pub(crate) fn is_uniform(&self) -> bool {
        matches!(self, Self::Color(_))
    }

    pub(crate) fn validate(&self) -> Result<(), String> {
        let is_valid = match self {
            Self::Color(color) => is_light(*color),
            Self::Gradient { top, horizon, ground } => {
                [top, horizon, ground].into_iter().all(|color| is_light(*color))
            }
            // Checked where it is made.
            Self::Environment(_) => true,
        };
        if is_valid { Ok(()) } else { Err("sky must be within 0 to 1e6".into()) }
    }
}

/// The mean of how far directions go up, 0 for those that go down, weighed by the cosine to a
/// normal that goes up by `cos`: `(1/pi) int max(0, w.y) max(0, n.w) dw`, which is `2 / (3 pi)
/// (sin a + (pi - a) cos a)` for the angle `a` between up and normal.
fn seen_upness(cos: f64) -> f32 {
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    let angle = angle::turns(sin, cos) * 2.0 * PI;
    (2.0 / (3.0 * PI) * (sin + (PI - angle) * cos)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// The mean radiance over directions spread evenly over the sphere, weighed by the cosine.
    fn measured(sky: &Sky, normal: Vec3) -> Vec3 {
        let num = 20_000;
        let mut sum = DVec3::ZERO;
        for i in 0..num {
            let y = (f64::from(i) + 0.5) / f64::from(num) * 2.0 - 1.0;
            let [cos, sin] = angle::cos_sin(f64::from(i) * 0.381_966_011_250_105);
            let across = (1.0 - y * y).sqrt();
            let direction = DVec3::new(across * cos, y, across * sin).as_vec3();
            let cosine = direction.dot(normal).max(0.0);
            sum += (sky.radiance(direction) * cosine).as_dvec3();
        }
        (sum * 4.0 / f64::from(num)).as_vec3()
    }

    #[test]
    fn irradiance_is_the_mean_of_what_is_seen() {
        let gradient = Sky::Gradient {
            top: Vec3::new(0.2, 0.4, 1.0),
            horizon: Vec3::new(1.0, 0.8, 0.6),
            ground: Vec3::new(0.3, 0.2, 0.1),
        };
        let picture = Environment::from_fn(32, 16, 0.0, |direction| {
            Vec3::new(1.0 + direction.x, 1.0 - direction.z, 0.5 + 0.5 * direction.y)
        });
        let picture = Sky::Environment(picture);
        for normal in [Vec3::Y, Vec3::NEG_Y, Vec3::X, Vec3::new(0.6, 0.0, -0.8), Vec3::ONE] {
            let normal = normal.normalize();
            for sky in [&gradient, &picture, &Sky::Color(Vec3::new(0.1, 0.5, 2.0))] {
                let (found, expected) = (sky.irradiance(normal), measured(sky, normal));
                assert!((found - expected).abs().max_element() < 4e-3, "{found} {expected}");
            }
        }
    }
}
