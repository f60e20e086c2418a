//! FLIP: how large differences look when two pictures are shown in turn (P. Andersson, J. Nilsson,
//! T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild 2020, "FLIP: A Difference Evaluator
//! for Alternating Images"), for pictures of standard range.
//!
//! Both pictures are taken to `YCxCz` and blurred as the eye blurs; their colours are compared in
//! Lab by the `HyAB` distance, with the Hunt effect. Edges and points, found in the unblurred
//! lightness, raise the error where only one picture has them: `error = colour ^ (1 - feature)`.
//! Constants are the paper's.

use super::picture::{Picture, check_sizes, is_compared};
use crate::error::{Error, Result};
use crate::texture::linear_from_srgb;
use rayon::prelude::*;
use std::f32::consts::PI;

/// Pixels a degree of view where nothing else is said: a screen of 3840 pixels, 0.7 m wide, seen
/// from 0.7 m.
pub const PIXELS_PER_DEGREE: f32 = 67.020_64;

/// Exponent of the colour difference, and where and to what it is bent so that small differences
/// count.
const COLOR_EXPONENT: f32 = 0.7;
const BEND: [f32; 2] = [0.4, 0.95];
/// Width of a feature in degrees, and the exponent of its difference.
const FEATURE_WIDTH: f32 = 0.082;
const FEATURE_EXPONENT: f32 = 0.5;
/// The eye's contrast sensitivity in `YCxCz`: sums of two Gaussians, `[a1, b1, a2, b2]`.
const SENSITIVITY: [[f32; 4]; 3] =
    [[1.0, 0.0047, 0.0, 1e-5], [1.0, 0.0053, 0.0, 1e-5], [34.1, 0.04, 13.5, 0.025]];

type Triple = [f32; 3];

/// What [`flip`] finds.
#[derive(Clone, Debug, PartialEq)]
pub struct Flip {
    /// Mean error of the pixels that are opaque in both pictures, 0 to 1.
    pub mean: f64,
    /// Error of every pixel, row by row from the top; 0 where the pictures are not compared.
    pub errors: Vec<f32>,
}

/// The FLIP errors of a picture against a reference, seen at a number of pixels a degree (see
/// [`PIXELS_PER_DEGREE`]).
///
/// # Errors
/// Says so when the sizes differ, no pixel is opaque in both pictures, or the pixels a degree are
/// not within 1 to 500.
pub fn flip(reference: &Picture, test: &Picture, pixels_per_degree: f32) -> Result<Flip> {
    check_sizes(reference, test)?;
    if !(1.0..=500.0).contains(&pixels_per_degree) {
        return Err(Error::setting(
            "pixels_per_degree",
            format!("{pixels_per_degree} is not within 1 to 500"),
        ));
    }
    let [a, b] = [reference, test].map(|picture| Seen::new(picture, pixels_per_degree));
    let greatest =
        hyab(hunt(lab([0.0, 1.0, 0.0])), hunt(lab([0.0, 0.0, 1.0]))).powf(COLOR_EXPONENT);
    let pixels = reference.pixels().par_iter().zip(test.pixels()).enumerate();
    let errors = pixels.map(|(i, (&pixel_a, &pixel_b))| {
        if !is_compared(pixel_a, pixel_b) {
            return 0.0;
        }
        let color = bent(hyab(a.lab[i], b.lab[i]).powf(COLOR_EXPONENT), greatest);
        let feature = [0, 1].map(|kind| (a.features[i][kind] - b.features[i][kind]).abs());
        let feature =
            (feature[0].max(feature[1]) / std::f32::consts::SQRT_2).powf(FEATURE_EXPONENT);
        color.powf(1.0 - feature)
    });
    let errors: Vec<f32> = errors.collect();
    let num =
        reference.pixels().iter().zip(test.pixels()).filter(|(a, b)| is_compared(**a, **b)).count();
    if num == 0 {
        return Err(Error::picture("pictures", "no pixel is opaque in both"));
    }
    Ok(Flip { mean: errors.iter().map(|&e| f64::from(e)).sum::<f64>() / num as f64, errors })
}

/// Small colour differences fill most of the range, great ones the rest.
fn bent(difference: f32, greatest: f32) -> f32 {
    let [place, value] = BEND;
    let knee = place * greatest;
    if difference < knee {
        value / knee * difference
    } else {
        value + (difference - knee) / (greatest - knee) * (1.0 - value)
    }
}

/// A picture as it is seen: blurred colours, and the strengths of edges and points.
struct Seen {
    lab: Vec<Triple>,
    features: Vec<[f32; 2]>,
}

impl Seen {
    fn new(picture: &Picture, pixels_per_degree: f32) -> Self {
        let size = [picture.width() as usize, picture.height() as usize];
        let linear =
            picture.pixels().par_iter().map(|&[r, g, b, _]| [r, g, b].map(linear_from_srgb));
        let opponent: Vec<Triple> = linear.map(|rgb| ycxcz_of_xyz(xyz_of_rgb(rgb))).collect();
        let plane = |channel: usize| opponent.iter().map(|c| c[channel]).collect::<Vec<f32>>();
        let blurred = [0, 1, 2]
            .map(|channel| blur(&plane(channel), size, SENSITIVITY[channel], pixels_per_degree));
        let lab = (0..opponent.len()).into_par_iter().map(|i| {
            let rgb = rgb_of_xyz(xyz_of_ycxcz([blurred[0][i], blurred[1][i], blurred[2][i]]));
            hunt(lab(rgb.map(|c| c.clamp(0.0, 1.0))))
        });
        let lightness: Vec<f32> = opponent.iter().map(|[y, ..]| (y + 16.0) / 116.0).collect();
        Self { lab: lab.collect(), features: features(&lightness, size, pixels_per_degree) }
    }
}

/// The eye's blur: a sum of two Gaussians whose weights add up to 1.
fn blur(
    plane: &[f32],
    size: [usize; 2],
    [a1, b1, a2, b2]: [f32; 4],
    pixels_per_degree: f32,
) -> Vec<f32> {
    // All channels are cut at the radius of the widest Gaussian.
    let widest = SENSITIVITY.iter().flat_map(|s| [s[1], s[3]]).fold(0.0, f32::max);
    let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
    let taps = |b: f32| -> Vec<f32> {
        let at = |i: i32| {
            -(PI * PI) * (i as f32 / pixels_per_degree) * (i as f32 / pixels_per_degree) / b
        };
        (-radius..=radius).map(|i| at(i).exp()).collect()
    };
    let part = |a: f32, b: f32| {
        let taps = taps(b);
        let sum: f32 = taps.iter().sum();
        let weight = a * (PI / b).sqrt() * sum * sum;
        let taps: Vec<f32> = taps.iter().map(|tap| tap / sum).collect();
        (weight, convolve(plane, size, &taps, &taps))
    };
    let (w1, first) = part(a1, b1);
    if a2 == 0.0 {
        return first;
    }
    let (w2, second) = part(a2, b2);
    first.iter().zip(&second).map(|(x, y)| (x * w1 + y * w2) / (w1 + w2)).collect()
}

/// The strengths of edges (first derivatives) and points (second derivatives) of each pixel.
fn features(lightness: &[f32], size: [usize; 2], pixels_per_degree: f32) -> Vec<[f32; 2]> {
    let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
    let radius = (3.0 * deviation).ceil() as i32;
    let places = || (-radius..=radius).map(|i| i as f32 / deviation);
    let gaussian = |x: f32| (-0.5 * x * x).exp();
    let across = normalized(places().map(gaussian).collect());
    let edge = normalized(places().map(|x| -x * gaussian(x)).collect());
    let point = normalized(places().map(|x| (x * x - 1.0) * gaussian(x)).collect());
    let strength = |taps: &[f32]| {
        let along_x = convolve(lightness, size, taps, &across);
        let along_y = convolve(lightness, size, &across, taps);
        along_x.into_iter().zip(along_y).map(|(x, y)| x.hypot(y)).collect::<Vec<f32>>()
    };
    let (edges, points) = (strength(&edge), strength(&point));
    edges.into_iter().zip(points).map(|(edge, point)| [edge, point]).collect()
}

/// Positive weights that add up to 1, negative ones to -1.
fn normalized(taps: Vec<f32>) -> Vec<f32> {
    let positive: f32 = taps.iter().filter(|tap| **tap > 0.0).sum();
    let negative: f32 = -taps.iter().filter(|tap| **tap < 0.0).sum::<f32>();
    taps.into_iter()
        .map(|tap| if tap > 0.0 { tap / positive } else { tap / negative.max(f32::MIN_POSITIVE) })
        .collect()
}

/// Convolves with `across` along x and `down` along y; the edge's pixels go on for ever.
fn convolve(plane: &[f32], [width, height]: [usize; 2], across: &[f32], down: &[f32]) -> Vec<f32> {
    let sum = |taps: &[f32], i: usize, size: usize, at: &dyn Fn(usize) -> f32| {
        let first = i as isize - taps.len() as isize / 2;
        let place = |k: usize| (first + k as isize).clamp(0, size as isize - 1) as usize;
        taps.iter().enumerate().map(|(k, tap)| tap * at(place(k))).sum::<f32>()
    };
    let rows = plane.par_chunks(width);
    let rows: Vec<f32> = rows
        .flat_map_iter(|row| (0..width).map(move |x| sum(across, x, width, &|x| row[x])))
        .collect();
    let at = |i: usize| sum(down, i / width, height, &|y| rows[y * width + i % width]);
    (0..width * height).into_par_iter().map(at).collect()
}

/// XYZ of white, linear RGB of 1.
const WHITE: Triple = [0.950_428_55, 1.0, 1.088_900_4];

fn xyz_of_rgb([r, g, b]: Triple) -> Triple {
    [
        0.412_386_57 * r + 0.357_591_5 * g + 0.180_450_49 * b,
        0.212_636_82 * r + 0.715_183 * g + 0.072_180_2 * b,
        0.019_330_62 * r + 0.119_197_16 * g + 0.950_372_6 * b,
    ]
}

fn rgb_of_xyz([x, y, z]: Triple) -> Triple {
    [
        3.241_003_3 * x - 1.537_399 * y - 0.498_615_86 * z,
        -0.969_224_33 * x + 1.875_930_1 * y + 0.041_554_22 * z,
        0.055_639_42 * x - 0.204_011_2 * y + 1.057_149 * z,
    ]
}

fn ycxcz_of_xyz(xyz: Triple) -> Triple {
    let [x, y, z] = [0, 1, 2].map(|i| xyz[i] / WHITE[i]);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn xyz_of_ycxcz([y, cx, cz]: Triple) -> Triple {
    let y = (y + 16.0) / 116.0;
    [(y + cx / 500.0) * WHITE[0], y * WHITE[1], (y - cz / 200.0) * WHITE[2]]
}

/// CIELAB of linear RGB.
fn lab(rgb: Triple) -> Triple {
    let bend = |t: f32| {
        let delta = 6.0_f32 / 29.0;
        if t > delta * delta * delta { t.cbrt() } else { t / (3.0 * delta * delta) + 4.0 / 29.0 }
    };
    let xyz = xyz_of_rgb(rgb);
    let [x, y, z] = [0, 1, 2].map(|i| bend(xyz[i] / WHITE[i]));
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Colours of bright areas look more colourful.
fn hunt([lightness, a, b]: Triple) -> Triple {
    [lightness, 0.01 * lightness * a, 0.01 * lightness * b]
}

/// City blocks in lightness, straight in colour.
fn hyab(p: Triple, q: Triple) -> f32 {
    (p[0] - q[0]).abs() + (p[1] - q[1]).hypot(p[2] - q[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_go_there_and_back() {
        for rgb in [[0.0; 3], [1.0; 3], [0.2, 0.7, 0.1], [0.9, 0.0, 0.4]] {
            let back = rgb_of_xyz(xyz_of_ycxcz(ycxcz_of_xyz(xyz_of_rgb(rgb))));
            assert!((0..3).all(|i| (back[i] - rgb[i]).abs() < 1e-4), "{rgb:?} {back:?}");
        }
        assert!((0..3).all(|i| (xyz_of_rgb([1.0; 3])[i] - WHITE[i]).abs() < 1e-5));
    }

    /// A gradient, and the same with noise and a step.
    fn picture(is_noisy: bool) -> Picture {
        let byte = |x: u32, y: u32, c: u32| {
            let base = (x * 5 + y * 3 + c * 40) % 256;
            let hash =
                x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ c.wrapping_mul(77);
            let noise = (hash.wrapping_mul(0xC2B2_AE3D) >> 24) / 8;
            let step = if x > 32 { 60 } else { 0 };
            (base * 3 / 4 + if is_noisy { step + noise } else { 0 }).min(255)
        };
        let pixel = |i: u32| {
            let [r, g, b] = [0, 1, 2].map(|c| byte(i % 64, i / 64, c) as f32 / 255.0);
            [r, g, b, 1.0]
        };
        Picture::new(64, 48, (0..64 * 48).map(pixel).collect()).unwrap()
    }

    fn plain(rgb: Triple) -> Picture {
        Picture::new(64, 48, vec![[rgb[0], rgb[1], rgb[2], 1.0]; 64 * 48]).unwrap()
    }

    /// Means, and pixels (0, 0), (40, 24) and (33, 10), that the authors' program (nv-flip 0.1.2)
    /// gives.
    #[test]
    fn errors_are_those_of_the_authors_program() {
        let expected = [
            (picture(false), picture(true), [0.526_188_55, 0.273_379_98, 0.741_126, 0.780_748_07]),
            (
                plain([0.0; 3]),
                plain([1.0; 3]),
                [0.967_365_3, 0.967_391_85, 0.967_391_85, 0.967_391_85],
            ),
            (plain([0.0, 1.0, 0.0]), plain([0.0, 0.0, 1.0]), [1.0; 4]),
        ];
        for (reference, test, [mean, errors @ ..]) in expected {
            let found = flip(&reference, &test, 67.0).unwrap();
            assert!((found.mean - mean).abs() < 1e-3, "{} {mean}", found.mean);
            for (place, error) in [0, 24 * 64 + 40, 10 * 64 + 33].into_iter().zip(errors) {
                assert!(
                    (f64::from(found.errors[place]) - error).abs() < 2e-3,
                    "{} {error}",
                    found.errors[place]
                );
            }
        }
    }

    #[test]
    fn equal_pictures_have_no_error_and_sizes_must_agree() {
        assert_eq!(flip(&picture(true), &picture(true), PIXELS_PER_DEGREE).unwrap().mean, 0.0);
        let small = Picture::new(2, 1, vec![[1.0; 4]; 2]).unwrap();
        assert!(flip(&picture(true), &small, PIXELS_PER_DEGREE).is_err());
        assert!(flip(&small, &small, 0.0).is_err());
        let clear = Picture::new(2, 1, vec![[0.0; 4]; 2]).unwrap();
        assert!(flip(&small, &clear, PIXELS_PER_DEGREE).is_err());
    }

    #[test]
    fn derivatives_see_no_even_area() {
        for (edge, point) in
            features(&[0.7; 100], [10, 10], PIXELS_PER_DEGREE).into_iter().map(|[e, p]| (e, p))
        {
            assert!(edge < 1e-5 && point < 1e-5);
        }
    }

    #[test]
    fn blur_keeps_an_even_area() {
        for sensitivity in SENSITIVITY {
            let blurred = blur(&[3.0; 64], [8, 8], sensitivity, PIXELS_PER_DEGREE);
            assert!(blurred.iter().all(|c| (c - 3.0).abs() < 1e-4));
        }
    }
}
