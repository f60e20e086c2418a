//! The march finds the first crossing of the ray with the bilinear height field.

mod common;

use basrelief::relief::{HeightField, march};
use basrelief::simd::PixelLanes;
use basrelief::texture::{HeightImage, Surface, SurfaceMaps, Wrap};
use common::{Random, rough_surface};

/// The depth of the first crossing, by steps of a hundredth of a texel and halving.
fn dense_march(field: &HeightField, base: [f32; 2], reach: [f32; 2]) -> f64 {
    let texels = field.texels_per_repeat;
    let place = |t: f64| {
        [0, 1].map(|i| (f64::from(base[i]) + f64::from(reach[i]) * t) * f64::from(texels[i]))
    };
    let above = |t: f64| {
        let [u, v] = place(t);
        1.0 - t > field.height_at(u, v)
    };
    let length = (0..2).map(|i| f64::from(reach[i] * texels[i]).abs()).fold(0.01, f64::max);
    let num = (length * 100.0).ceil() as usize;
    for i in 0..=num {
        let t = i as f64 / num as f64;
        if !above(t) {
            let (mut low, mut high) = (((i as f64 - 1.0) / num as f64).max(0.0), t);
            for _ in 0..40 {
                let middle = (low + high) * 0.5;
                if above(middle) { low = middle } else { high = middle }
            }
            return high;
        }
    }
    1.0
}

fn check(surface: &Surface, seed: u64, longest: f32) {
    let field = HeightField::new(surface);
    let mut random = Random(seed);
    let mut num_grazing = 0;
    for _ in 0..200 {
        let mut lanes = || PixelLanes::new([0.0; 8].map(|_| random.within(-1.0, 1.0)));
        let (base, reach) =
            ([lanes() * 3.0, lanes() * 3.0], [lanes() * longest, lanes() * longest]);
        let depth = march(&field, &base, &reach).to_array();
        for (lane, &found) in depth.iter().enumerate() {
            let [b, r] = [base, reach].map(|v| v.map(|lanes| lanes.to_array()[lane]));
            let expected = dense_march(&field, b, r);
            let texels =
                (0..2).map(|i| (r[i] * field.texels_per_repeat[i]).abs()).fold(0.0, f32::max);
            let found = f64::from(found);
            let error = (found - expected).abs() * f64::from(texels);
            // Where the ray grazes the relief, rounding decides whether it is hit there or further
            // on.
            let [u, v] = [0, 1].map(|i| {
                (f64::from(b[i]) + f64::from(r[i]) * found) * f64::from(field.texels_per_repeat[i])
            });
            let grazes = found < expected && (1.0 - found - field.height_at(u, v)).abs() < 1e-4;
            num_grazing += usize::from(error >= 0.05 && grazes);
            assert!(
                error < 0.05 || grazes,
                "{error} texels off: {} for {expected}, from {b:?} by {r:?}",
                found
            );
        }
    }
    assert!(num_grazing < 5, "{num_grazing} of 1600 rays");
}

#[test]
fn hits_lie_within_a_twentieth_texel_of_the_exact_crossing() {
    check(&rough_surface(16, 16, Wrap::Repeat, 1), 2, 0.5);
    check(&rough_surface(13, 7, Wrap::Repeat, 3), 4, 0.8);
    check(&rough_surface(1, 5, Wrap::Repeat, 3), 9, 0.8);
}

#[test]
fn hits_are_exact_beyond_the_edges_of_clamped_and_mirrored_maps() {
    check(&rough_surface(16, 8, Wrap::Clamp, 5), 6, 0.5);
    check(&rough_surface(9, 11, Wrap::Mirror, 7), 8, 0.5);
}

#[test]
fn a_needle_of_one_texel_is_not_stepped_over() {
    let heights =
        HeightImage::from_fn(256, 256, |x, y| if (x, y) == (200, 77) { 1.0 } else { 0.0 });
    let surface = Surface::new(SurfaceMaps { height: Some(heights), ..Default::default() })
        .expect("valid maps");
    let field = HeightField::new(&surface);
    // Along the needle's row, grazing its tip.
    let lanes = PixelLanes::splat;
    let base = [lanes(10.5 / 256.0), lanes(77.5 / 256.0)];
    let depth = march(&field, &base, &[lanes(20.0), lanes(0.0)]).to_array()[0];
    let hit = 10.5 + 20.0 * 256.0 * depth;
    assert!((199.5..201.5).contains(&hit), "hit at {hit}");
}

#[test]
fn flat_and_degenerate_rays_end() {
    let field = HeightField::new(&rough_surface(8, 8, Wrap::Repeat, 1));
    let strange = PixelLanes::new([
        0.0,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        1e30,
        -1e30,
        1e-30,
        64.0,
    ]);
    for base in [PixelLanes::ZERO, strange] {
        let depth = march(&field, &[base; 2], &[strange, PixelLanes::ONE]).to_array();
        assert!(depth.iter().all(|t| (0.0..=1.0).contains(t)), "{depth:?}");
    }
}
