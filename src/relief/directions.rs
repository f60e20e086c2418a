//! A fan of displacements over which what is seen of a relief is tabled: lengths in geometric
//! steps, azimuths around.

use super::displacement::MAX_SLOPE;
use crate::texture::Surface;

/// Slopes that are told apart, from gentle to the steepest that there is. A gentler one hides too
/// little to matter in a large footprint. (Up to 28 alone, the last rows before a skyline are 1 % of
/// the range too dark: 43 dB there, where 64 gives 50.)
pub const SLOPES: [f32; 2] = [0.25, MAX_SLOPE];

/// Lengths of the displacement, in geometric steps over [`SLOPES`]: 1.74 times from one to
/// the next.
pub const NUM_LENGTHS: usize = 11;

/// The lengths of the displacements of one surface, in base texels.
#[derive(Clone, Copy, Debug)]
pub struct Lengths {
    /// The first as a [`pseudo_log`] value, and the step.
    first: f32,
    step: f32,
}

impl Lengths {
    /// The lengths for a surface's relief depth.
    pub fn new(surface: &Surface) -> Self {
        let texels = surface.base().texels_per_repeat();
        let unit = surface.relief_depth() * texels[0].max(texels[1]);
        let [first, last] = SLOPES.map(|slope| pseudo_log(slope * unit));
        Self { first, step: (last - first) / (NUM_LENGTHS - 1) as f32 }
    }

    /// Where a displacement's length lies among them, 0 to the last.
    pub fn place_of(&self, [du, dv]: [f32; 2]) -> f32 {
        let place = (pseudo_log((du * du + dv * dv).sqrt()) - self.first) / self.step;
        place.clamp(0.0, (NUM_LENGTHS - 1) as f32)
    }

    /// The displacement of a length, by its number, in the direction of a [`diamond_angle`].
    pub fn displacement(&self, length: usize, angle: f32) -> [f32; 2] {
        let size = pseudo_exp(self.first + self.step * length as f32);
        let [x, y] = diamond_direction(angle);
        [x * size, y * size]
    }
}

/// The binary logarithm, linear between powers of two: the same bits on every machine.
pub fn pseudo_log(x: f32) -> f32 {
    // A float's exponent is the whole part, and its mantissa, from 1 to 2, the rest.
    let bits = x.max(f32::MIN_POSITIVE).to_bits();
    ((bits >> 23) as i32 - 127) as f32 + (f32::from_bits(bits & 0x007f_ffff | 0x3f80_0000) - 1.0)
}

/// The inverse of [`pseudo_log`].
pub fn pseudo_exp(y: f32) -> f32 {
    let whole = y.floor();
    f32::from_bits(((whole as i32 + 127) as u32) << 23) * (1.0 + y - whole)
}

/// The angle of a direction as a number from 0 to 4 that grows evenly along the diamond `|x| + |y|
/// = 1`.
pub fn diamond_angle(x: f32, y: f32) -> f32 {
    // The least divisor gives a direction of no length the angle 0.
    let part = y / (x.abs() + y.abs()).max(f32::MIN_POSITIVE);
    let angle = if x < 0.0 {
        2.0 - part
    } else if part < 0.0 {
        4.0 + part
    } else {
        part
    };
    // Just under 4 may be rounded to 4, which is angle 0 again.
    if angle < 4.0 { angle } else { 0.0 }
}

/// The unit vector of a [`diamond_angle`].
pub fn diamond_direction(angle: f32) -> [f32; 2] {
    let y = if angle < 1.0 {
        angle
    } else if angle < 3.0 {
        2.0 - angle
    } else {
        angle - 4.0
    };
    let x = (1.0 - y.abs()) * if (1.0..3.0).contains(&angle) { -1.0 } else { 1.0 };
    let length = (x * x + y * y).sqrt();
    [x / length, y / length]
}
