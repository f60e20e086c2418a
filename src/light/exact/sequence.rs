//! Points that fill a square evenly, however many are taken: fixed by the number of the sample and
//! the pixel.
//!
//! Point `i` has the fractions of `i g^-1` to `i g^-4`, where `g` solves `g^5 = g + 1`: Roberts 2018,
//! "The Unreasonable Effectiveness of Quasirandom Sequences". They are shifted by a hash of the
//! pixel, so that neighbours err differently and no structure shows. All in whole numbers.

/// `g^-1` to `g^-4` in units of `2^-32`.
const STEPS: [u32; 4] = [0xdb4f_0b91, 0xbbe0_5633, 0xa0f2_ec76, 0x89e1_8285];

/// The points of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct Sequence {
    shifts: [u32; 4],
}

impl Sequence {
    /// Of the pixel in a column and row of the whole frame.
    pub fn of_pixel([x, y]: [i32; 2]) -> Self {
        let mut state = hash(x as u32 ^ hash(y as u32));
        let shifts = std::array::from_fn(|_| {
            state = hash(state.wrapping_add(0x9e37_79b9));
            state
        });
        Self { shifts }
    }

    /// Sample `i`'s two points within 0 to 1, which together fill four dimensions.
    pub(super) fn points(&self, i: u32) -> [[f64; 2]; 2] {
        let [a, b, c, d] = std::array::from_fn(|k| {
            let fraction = STEPS[k].wrapping_mul(i).wrapping_add(self.shifts[k]);
            // The middle of its step: never 0 or 1.
            (f64::from(fraction) + 0.5) / 4_294_967_296.0
        });
        [[a, b], [c, d]]
    }
}

/// A hash of 32 bits whose every bit depends on all others (Wellons 2018, `lowbias32`).
fn hash(mut x: u32) -> u32 {
    x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_powers_of_the_root() {
        let mut g = 1.2_f64;
        (0..60).for_each(|_| g = (1.0 + g).powf(0.2));
        for (k, step) in STEPS.into_iter().enumerate() {
            let expected = g.powi(-(k as i32 + 1)) * 4_294_967_296.0;
            assert!((f64::from(step) - expected).abs() <= 1.0, "{k}: {expected}");
        }
    }

    #[test]
    fn points_fill_the_square_evenly() {
        let sequence = Sequence::of_pixel([3, 7]);
        for pair in 0..2 {
            let mut counts = [0; 64];
            for i in 0..4096 {
                let [x, y] = sequence.points(i)[pair];
                counts[(x * 8.0) as usize + 8 * (y * 8.0) as usize] += 1;
            }
            assert!(counts.iter().all(|count| (56..=72).contains(count)), "{counts:?}");
        }
    }
}
