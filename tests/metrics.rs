//! Differences of pictures against values worked out by hand or by the definition.

use basrelief::metrics::{Picture, compare, heat_map};
use basrelief::{Frame, texture::srgb_from_linear};

fn picture(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [f32; 4]) -> Picture {
    let pixels = (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| pixel(x, y))
        .collect();
    Picture::new(width, height, pixels).unwrap()
}

/// An uneven pattern without a random generator.
fn noise(x: u32, y: u32, seed: u32) -> f32 {
    let hash = (x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ seed)
        .wrapping_mul(0xC2B2_AE3D);
    ((hash ^ (hash >> 15)) & 0xFFFF) as f32 / 65535.0
}

fn gray(value: f32) -> [f32; 4] {
    [value, value, value, 1.0]
}

#[test]
fn equal_pictures_are_infinitely_close() {
    let a = picture(20, 15, |x, y| gray(noise(x, y, 1)));
    let difference = compare(&a, &a).unwrap();
    assert_eq!(difference.psnr_db, f64::INFINITY);
    assert_eq!((difference.largest.error, difference.num_compared), (0.0, 300));
    assert!((difference.ssim - 1.0).abs() < 1e-12);
}

#[test]
fn psnr_and_largest_error_are_as_by_hand() {
    let a = picture(10, 10, |_, _| gray(0.5));
    let b =
        picture(10, 10, |x, y| if (x, y) == (7, 4) { [0.5, 0.5, 0.75, 1.0] } else { gray(0.5) });
    let difference = compare(&a, &b).unwrap();
    let expected = 10.0 * (300.0_f64 / 0.0625).log10();
    assert!((difference.psnr_db - expected).abs() < 1e-9, "{difference:?}");
    let largest = difference.largest;
    assert_eq!((largest.error, largest.x, largest.y, largest.channel), (0.25, 7, 4, 2));
}

#[test]
fn uniform_shift_is_twenty_decibels_at_a_tenth() {
    let difference =
        compare(&picture(16, 16, |_, _| gray(0.25)), &picture(16, 16, |_, _| gray(0.35))).unwrap();
    assert!((difference.psnr_db - 20.0).abs() < 1e-5);
    let (a, b) = (0.25_f64, 0.35_f64);
    assert!((difference.ssim - (2.0 * a * b + 1e-4) / (a * a + b * b + 1e-4)).abs() < 1e-6);
}

/// SSIM by the definition: one double sum for each window.
fn ssim_by_definition(a: &Picture, b: &Picture, margin: i64) -> f64 {
    let (w, h) = (i64::from(a.width()), i64::from(a.height()));
    let luma =
        |p: [f32; 4]| 0.299 * f64::from(p[0]) + 0.587 * f64::from(p[1]) + 0.114 * f64::from(p[2]);
    let (mut sum, mut num) = (0.0, 0.0);
    for (x, y) in (margin..h - margin).flat_map(|y| (margin..w - margin).map(move |x| (x, y))) {
        let mut window = Vec::new();
        for (i, j) in (-5..=5_i64).flat_map(|j| (-5..=5_i64).map(move |i| (i, j))) {
            if (0..w).contains(&(x + i)) && (0..h).contains(&(y + j)) {
                let at = ((y + j) * w + x + i) as usize;
                let (pa, pb) = (a.pixels()[at], b.pixels()[at]);
                if pa[3] >= 1.0 && pb[3] >= 1.0 {
                    window.push(((-((i * i + j * j) as f64) / 4.5).exp(), luma(pa), luma(pb)));
                }
            }
        }
        let center = (y * w + x) as usize;
        if a.pixels()[center][3] < 1.0 || b.pixels()[center][3] < 1.0 {
            continue;
        }
        let total: f64 = window.iter().map(|s| s.0).sum();
        let mean = |f: &dyn Fn(f64, f64) -> f64| {
            window.iter().map(|s| s.0 * f(s.1, s.2)).sum::<f64>() / total
        };
        let (ma, mb) = (mean(&|a, _| a), mean(&|_, b| b));
        let (saa, sbb) = (mean(&|a, _| (a - ma).powi(2)), mean(&|_, b| (b - mb).powi(2)));
        let sab = mean(&|a, b| (a - ma) * (b - mb));
        sum += (2.0 * ma * mb + 1e-4) * (2.0 * sab + 9e-4)
            / ((ma * ma + mb * mb + 1e-4) * (saa + sbb + 9e-4));
        num += 1.0;
    }
    sum / num
}

#[test]
fn ssim_equals_its_definition() {
    for (width, height, margin) in [(24, 19, 5), (7, 5, 0)] {
        let a = picture(width, height, |x, y| [noise(x, y, 1), noise(x, y, 2), 0.25, 1.0]);
        let b = picture(width, height, |x, y| [noise(x, y, 1), noise(x, y, 3), 0.75, 1.0]);
        let (ssim, expected) = (compare(&a, &b).unwrap().ssim, ssim_by_definition(&a, &b, margin));
        assert!(
            (ssim - expected).abs() < 1e-9 && (0.05..0.95).contains(&ssim),
            "{ssim} {expected}"
        );
    }
}

#[test]
fn only_pixels_opaque_in_both_count() {
    let a = picture(16, 16, |x, y| [noise(x, y, 1), 0.5, 0.5, if x < 4 { 0.5 } else { 1.0 }]);
    let b = picture(16, 16, |x, y| {
        [if x < 6 { 0.0 } else { noise(x, y, 1) }, 0.5, 0.5, if x < 6 { 0.0 } else { 1.0 }]
    });
    let difference = compare(&a, &b).unwrap();
    assert_eq!((difference.num_compared, difference.num_opacity_unequal), (160, 96));
    assert_eq!(difference.psnr_db, f64::INFINITY);
    let c = picture(16, 16, |x, y| [noise(x, y, 4), 0.5, 0.5, if x < 6 { 0.0 } else { 1.0 }]);
    assert!((compare(&a, &c).unwrap().ssim - ssim_by_definition(&a, &c, 5)).abs() < 1e-9);
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let (a, b) = (picture(4, 4, |_, _| gray(0.5)), picture(4, 3, |_, _| gray(0.5)));
    assert_eq!(
        compare(&a, &b).unwrap_err().to_string(),
        "pictures: sizes differ: 4x4 and 4x3 pixels"
    );
    let clear = picture(4, 4, |_, _| [0.0; 4]);
    assert!(compare(&a, &clear).unwrap_err().to_string().contains("no pixel is opaque"));
    assert!(Picture::new(2, 2, vec![[0.0; 4]; 3]).is_err());
    assert!([0.0, -1.0, 1.5, f32::NAN].into_iter().all(|scale| heat_map(&a, &a, scale).is_err()));
}

#[test]
fn frames_are_compared_before_rounding() {
    let frame = Frame::filled(12, 12, [0.2, 0.2, 0.2, 1.0]);
    let mut other = frame.clone();
    other.pixels[0][0] = 0.2001;
    let difference = compare(&(&frame).into(), &(&other).into()).unwrap();
    let expected = f64::from(srgb_from_linear(0.2001)) - f64::from(srgb_from_linear(0.2));
    assert!(difference.largest.error > 0.0 && (difference.largest.error - expected).abs() < 1e-12);
}

#[test]
fn files_hold_what_frames_show() {
    let folder = tempfile::tempdir().unwrap();
    let mut frame = Frame::filled(17, 9, [0.1, 0.4, 0.9, 1.0]);
    frame.pixels[3] = [0.0, 0.25, 0.25, 0.5];
    for (name, bound) in
        [("a.png", 0.5 / 255.0), ("a.tga", 0.5 / 255.0), ("a.tiff", 0.5 / 255.0), ("a.exr", 1e-7)]
    {
        let path = folder.path().join(name);
        frame.save(&path).unwrap();
        let difference = compare(&Picture::open(&path).unwrap(), &(&frame).into()).unwrap();
        assert!(
            difference.largest.error <= bound + 1e-7 && difference.num_compared == 152,
            "{name} {difference:?}"
        );
    }
    let text = frame.save(folder.path().join("a.gif")).unwrap_err().to_string();
    assert!(text.contains("a.gif") && text.contains(".png"), "{text}");
    std::fs::write(folder.path().join("b.png"), "no png").unwrap();
    assert!(Picture::open(folder.path().join("b.png")).unwrap_err().to_string().contains("b.png"));
}

#[test]
fn heat_map_shows_where() {
    let a = picture(4, 2, |_, _| gray(0.5));
    let b = picture(4, 2, |x, _| [0.5, 0.5 + 0.05 * x as f32, 0.5, if x == 3 { 0.0 } else { 1.0 }]);
    let map = heat_map(&a, &b, 0.1).unwrap();
    assert_eq!(map.pixels[0], [0.0, 0.0, 0.0, 1.0]);
    assert_eq!(map.pixels[3], [0.0; 4]);
    assert!(map.pixels[2][1] > 0.8 && map.pixels[1][1] < map.pixels[2][1]);
}
