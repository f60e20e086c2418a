//! A picture of all directions as a sky.
//!
//! ```text
//!  u  0         1/4         1/2         3/4         1        a direction d, up is +y:
//!     +----------+-----------+-----------+----------+  v 0   u = 1/2 + angle of (-d.z, d.x) + turn
//!     |                     up                      |        v = angle from up, in half turns
//!     | +z      -x          -z          +x       +z |  v 1/2
//!     |                    down                     |
//!     +---------------------------------------------+  v 1
//! ```

use super::super::angle;
use super::is_light;
use crate::error::{Error, Result};
use glam::{DVec3, Vec3};
use std::sync::Arc;

/// Most texels a side.
const MOST_TEXELS: usize = 32768;

/// A picture of all directions, equirectangular: the top row is straight up (+y), the bottom row
/// straight down. The middle column lies towards -z, and +x right of it, as they do for an eye that
/// looks along -z. Between texels it is bilinear.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    size: [usize; 2],
    texels: Arc<[Vec3]>,
    turn: f64,
    /// Coefficients of the irradiance over pi in harmonics up to the second order.
    harmonics: Arc<[DVec3; 9]>,
}

impl Environment {
    /// A picture of linear RGB within 0 to 1e6, row by row from the top. `turn_degrees` turns it
    /// about up, counter-clockwise seen from above.
    ///
    /// # Errors
    /// Says so when the size is 0 or above 32768, is not that of the texels, or a number is out of
    /// its range.
    pub fn new(
        width: usize,
        height: usize,
        texels: impl Into<Arc<[Vec3]>>,
        turn_degrees: f32,
    ) -> Result<Self> {
        let texels = texels.into();
        let refuse = |reason: String| Err(Error::scene("environment", reason));
        let is_side = |side: usize| (1..=MOST_TEXELS).contains(&side);
        if !is_side(width) || !is_side(height) || width * height != texels.len() {
            return refuse(format!("it says {width} x {height} texels and has {}", texels.len()));
        }
        if !texels.iter().all(|texel| is_light(*texel)) {
            return refuse("its light must be within 0 to 1e6".into());
        }
        if !(-1e6..=1e6).contains(&turn_degrees) {
            return refuse("its turn must be within 1e6 degrees".into());
        }
        let turn = f64::from(turn_degrees) / 360.0;
        let mut picture =
            Self { size: [width, height], texels, turn, harmonics: Default::default() };
        picture.harmonics = Arc::new(picture.irradiance_harmonics());
        Ok(picture)
    }

    /// Texels across and down.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Linear RGB, row by row from the top.
    pub fn texels(&self) -> &[Vec3] {
        &self.texels
    }

    /// How far it is turned about up, in degrees, as it was given.
    pub fn turn_degrees(&self) -> f32 {
        // The errors of doubles are far below half a bit of a float.
        (self.turn * 360.0) as f32
    }

    /// A picture whose texels are asked for by the directions of their centres.
    #[cfg(test)]
    pub(super) fn from_fn(
        width: usize,
        height: usize,
        turn_degrees: f32,
        color: impl Fn(Vec3) -> Vec3,
    ) -> Self {
        let black = vec![Vec3::ZERO; width * height];
        let picture = Self::new(width, height, black, turn_degrees).expect("a valid size");
        let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let texels: Vec<_> =
            places.map(|[x, y]| color(picture.direction(x, y).as_vec3())).collect();
        Self::new(width, height, texels, turn_degrees).expect("valid colours")
    }

    /// What comes from a unit direction.
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        let DVec3 { x, y, z } = direction.as_dvec3();
        let [width, height] = self.size;
        let across = (x * x + z * z).sqrt();
        let u = angle::turns(x, -z) + self.turn + 0.5;
        let v = 2.0 * angle::turns(across, y);
        let [u, v] = [(u - u.floor()) * width as f64 - 0.5, v * height as f64 - 0.5];
        let (left, top) = (u.floor(), v.floor());
        let [fx, fy] = [(u - left) as f32, (v - top) as f32];
        // Columns go all the way round; beyond the poles lie their own rows.
        let columns = [0, 1].map(|i| (left as i64 + i).rem_euclid(width as i64) as usize);
        let rows = [0, 1].map(|i| (top as i64 + i).clamp(0, height as i64 - 1) as usize);
        let [upper, lower] = rows.map(|row| {
            let [a, b] = columns.map(|column| self.texels[row * width + column]);
            a * (1.0 - fx) + b * fx
        });
        upper * (1.0 - fy) + lower * fy
    }

    /// The mean radiance, weighed by the cosine to a unit normal; at least 0.
    pub(super) fn irradiance(&self, normal: Vec3) -> Vec3 {
        let basis = basis(normal.as_dvec3());
        let sum = self.harmonics.iter().zip(basis).fold(DVec3::ZERO, |sum, (c, b)| sum + *c * b);
        sum.max(DVec3::ZERO).as_vec3()
    }

    /// The direction of a texel's centre.
    fn direction(&self, x: usize, y: usize) -> DVec3 {
        let [width, height] = self.size;
        let v = (y as f64 + 0.5) / height as f64;
        let u = (x as f64 + 0.5) / width as f64 - 0.5 - self.turn;
        let ([up, across], [ahead, right]) = (angle::cos_sin(v * 0.5), angle::cos_sin(u));
        DVec3::new(right * across, up, -ahead * across)
    }

    /// The picture times each of the harmonics, times what a cosine lobe keeps of its order over
    /// pi: 1, 2/3 and 1/4.
    fn irradiance_harmonics(&self) -> [DVec3; 9] {
        let [width, height] = self.size;
        let mut sums = [DVec3::ZERO; 9];
        for y in 0..height {
            let edge = |row: usize| angle::cos_sin(row as f64 / height as f64 * 0.5)[0];
            // The share of the sphere that a texel has.
            let share = (edge(y) - edge(y + 1)) / (2.0 * width as f64);
            // A row at a time, so that a sum of few large numbers keeps the small ones.
            let mut row = [DVec3::ZERO; 9];
            for x in 0..width {
                let color = self.texels[y * width + x].as_dvec3();
                let basis = basis(self.direction(x, y));
                row.iter_mut().zip(basis).for_each(|(sum, basis)| *sum += color * basis);
            }
            sums.iter_mut().zip(row).for_each(|(sum, row)| *sum += row * share);
        }
        let kept = |i: usize| [1.0, 2.0 / 3.0, 0.25][usize::from(i > 0) + usize::from(i > 3)];
        std::array::from_fn(|i| sums[i] * kept(i))
    }
}

/// The real harmonics up to the second order of a unit direction, each with a mean square of 1 over
/// the sphere.
fn basis(DVec3 { x, y, z }: DVec3) -> [f64; 9] {
    let (three, fifteen, five) = (3.0_f64.sqrt(), 15.0_f64.sqrt(), 5.0_f64.sqrt());
    [
        1.0,
        three * x,
        three * y,
        three * z,
        fifteen * x * y,
        fifteen * y * z,
        fifteen * x * z,
        fifteen / 2.0 * (x * x - z * z),
        five / 2.0 * (3.0 * y * y - 1.0),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_lie_where_the_picture_says() {
        // Black but for one texel, in the middle of the upper half: ahead and up.
        let mut texels = vec![Vec3::ZERO; 8 * 4];
        texels[8 + 4] = Vec3::ONE;
        let picture = Environment::new(8, 4, texels.clone(), 0.0).unwrap();
        let ahead = picture.direction(4, 1);
        assert!(ahead.z < 0.0 && ahead.x > 0.0 && ahead.y > 0.0, "{ahead}");
        assert!((picture.radiance(ahead.as_vec3()) - Vec3::ONE).length() < 1e-5);
        // A quarter turn to the left brings what was ahead to -x.
        let turned = Environment::new(8, 4, texels, 90.0).unwrap();
        let left = Vec3::new(ahead.z as f32, ahead.y as f32, -ahead.x as f32);
        assert!((turned.radiance(left) - Vec3::ONE).length() < 1e-5);
        assert!((turned.direction(4, 1).as_vec3() - left).length() < 1e-6);
    }

    #[test]
    fn one_colour_is_that_colour_everywhere() {
        let picture = Environment::from_fn(5, 3, 20.0, |_| Vec3::new(0.25, 1.0, 4.0));
        for direction in [Vec3::X, Vec3::Y, Vec3::NEG_Y, Vec3::new(0.6, 0.0, 0.8)] {
            assert!((picture.radiance(direction) - Vec3::new(0.25, 1.0, 4.0)).length() < 1e-5);
        }
        // With few rows a centre stands for its row but roughly.
        let picture = Environment::from_fn(64, 32, 0.0, |_| Vec3::ONE);
        assert!((picture.irradiance(Vec3::Y) - Vec3::ONE).length() < 2e-3);
    }

    #[test]
    fn wrong_pictures_are_refused() {
        let new = |width, height, texel, turn| {
            Environment::new(width, height, vec![texel; 6], turn).map(|_| ())
        };
        assert!(new(3, 2, Vec3::ONE, 10.0).is_ok());
        assert!(new(0, 2, Vec3::ONE, 0.0).is_err() && new(3, 3, Vec3::ONE, 0.0).is_err());
        assert!(new(3, 2, Vec3::NAN, 0.0).is_err() && new(3, 2, -Vec3::ONE, 0.0).is_err());
        assert!(new(3, 2, Vec3::ONE, f32::NAN).is_err());
    }
}
