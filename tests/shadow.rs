//! Where light reaches the relief, by the sweep and by rays.

mod common;

use basrelief::relief::{HeightField, LitParts, RowScratch, march};
use basrelief::simd::PixelLanes;
use basrelief::texture::{HeightImage, Surface, SurfaceMaps, Wrap};
use common::Random;

/// The lit part of every texel of the base level, row by row along u.
fn lit_parts(surface: &Surface, displacement: [f32; 2]) -> Vec<Vec<f32>> {
    let lit = LitParts::new(surface.base(), displacement, surface.relief_depth());
    let [width, height] = surface.base().size();
    let rows = |num: usize| {
        (0..num).map(|y| {
            let mut row = Vec::new();
            lit.row(y, &mut RowScratch::default(), &mut row);
            row
        })
    };
    if !lit.is_turned {
        return rows(height).collect();
    }
    let turned: Vec<_> = rows(width).collect();
    (0..height).map(|y| turned.iter().map(|column| column[y]).collect()).collect()
}

/// Whether a ray of light comes down to the surface at a place in texels, centres at halves.
fn is_lit(field: &HeightField, [u, v]: [f32; 2], displacement: [f32; 2]) -> bool {
    let depth = 1.0 - field.height_at(f64::from(u), f64::from(v)) as f32;
    is_reached(field, [u, v], depth, displacement)
}

/// Whether a ray of light comes down to a depth, 0 to 1, at such a place.
fn is_reached(field: &HeightField, [u, v]: [f32; 2], depth: f32, displacement: [f32; 2]) -> bool {
    let place = [u / field.texels_per_repeat[0], v / field.texels_per_repeat[1]];
    let base = [0, 1].map(|i| PixelLanes::splat(place[i] - depth * displacement[i]));
    let hit = march(field, &base, &displacement.map(PixelLanes::splat)).to_array()[0];
    // What the ray meets at its own end is the surface that it lights.
    hit > depth - 1e-3
}

/// Stones with round tops and steep sides, of a few sizes, over 64 by 48 texels.
fn stones(wrap: Wrap) -> Surface {
    let mut random = Random(11);
    let stones: Vec<[f32; 4]> =
        (0..24).map(|_| [64.0, 48.0, 6.0, 1.0].map(|most| random.within(0.0, most))).collect();
    let height = |x: u32, y: u32| {
        let top = |[u, v, radius, height]: &[f32; 4]| {
            let [dx, dy] = [(x as f32 - u).abs(), (y as f32 - v).abs()];
            let [dx, dy] = [dx.min(64.0 - dx), dy.min(48.0 - dy)];
            let square = (dx * dx + dy * dy) / ((radius + 2.0) * (radius + 2.0));
            if square < 1.0 { height * (1.0 - 0.4 * square) } else { 0.0 }
        };
        stones.iter().map(top).fold(0.0, f32::max)
    };
    Surface::new(SurfaceMaps {
        height: Some(HeightImage::from_fn(64, 48, height)),
        wrap,
        relief_depth: 0.08,
        ..SurfaceMaps::default()
    })
    .expect("valid maps")
}

/// Lengths of displacements that go with low and high suns, in repeats.
const DISPLACEMENTS: [[f32; 2]; 6] =
    [[0.0, 0.11], [0.2, 0.0], [0.09, -0.05], [-0.13, 0.12], [-0.02, -0.31], [0.01, 0.004]];

#[test]
fn the_sweep_lights_what_rays_reach() {
    let mut random = Random(3);
    for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
        let surface = stones(wrap);
        let field = HeightField::new(&surface);
        let [width, height] = surface.base().size();
        for displacement in DISPLACEMENTS {
            let parts = lit_parts(&surface, displacement);
            let (mut sums, mut num_wrong, num) = ([0.0; 2], 0, 4000);
            for _ in 0..num {
                // Inside of a clamped pattern, whose edge has no neighbours.
                let [x, y] = [width, height].map(|n| random.within(2.0, n as f32 - 2.0));
                let lit = is_lit(&field, [x, y], displacement);
                // The sweep's own lines lie half a texel off at the most, so what it says of the
                // place is bilinear, as everything that is kept at texels.
                let (i, j) = ((x - 0.5).floor() as usize, (y - 0.5).floor() as usize);
                let (fx, fy) = (x - 0.5 - i as f32, y - 0.5 - j as f32);
                let at = |i: usize, j: usize| parts[j % height][i % width];
                let corners = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
                let part = (corners[0] * (1.0 - fx) + corners[1] * fx) * (1.0 - fy)
                    + (corners[2] * (1.0 - fx) + corners[3] * fx) * fy;
                sums[0] += f64::from(part);
                sums[1] += f64::from(u8::from(lit));
                // Where all four are sure, the ray must agree.
                let is_sure = |part: f32| corners.iter().all(|c| (c - part).abs() < 1e-3);
                num_wrong += u32::from(is_sure(1.0) && !lit || is_sure(0.0) && lit);
            }
            let [swept, traced] = sums.map(|sum| sum / f64::from(num));
            assert!(
                (swept - traced).abs() < 0.015,
                "{wrap:?} {displacement:?}: {swept} of the surface is lit, by rays {traced}"
            );
            assert!(num_wrong * 200 <= num, "{wrap:?} {displacement:?}: {num_wrong}");
        }
    }
}

#[test]
fn a_wall_throws_its_shadow_as_far_as_the_light_is_low() {
    // A wall of 4 texels along v on a plain at the deepest relief.
    let surface = Surface::new(SurfaceMaps {
        height: Some(HeightImage::from_fn(64, 16, |x, _| {
            f32::from(u8::from((20..24).contains(&x)))
        })),
        relief_depth: 0.1,
        ..SurfaceMaps::default()
    })
    .expect("valid maps");
    // 10 texels along u, from left to right.
    let row = &lit_parts(&surface, [10.0 / 64.0, 0.0])[7];
    let expected = |x: usize| match x {
        0..=18 | 20..=22 | 34.. => Some(1.0),
        24..=32 => Some(0.0),
        // Beside the edges of wall and shadow.
        _ => None,
    };
    for (x, part) in row.iter().enumerate() {
        assert!(expected(x).is_none_or(|lit| (part - lit).abs() < 1e-3), "{x}: {part}");
        assert!((0.0..=1.0).contains(part));
    }
    // From straight above everything is lit.
    assert!(lit_parts(&surface, [0.0; 2]).iter().flatten().all(|part| *part > 0.999));
}

#[test]
fn a_light_moved_by_turns_of_the_texture_lights_it_turned() {
    let surface = stones(Wrap::Repeat);
    let height = |x: i32, y: i32| surface.base().height_at(x, y);
    let turned = Surface::new(SurfaceMaps {
        height: Some(HeightImage::from_fn(48, 64, |x, y| height(y as i32, x as i32))),
        relief_depth: 0.08,
        ..SurfaceMaps::default()
    })
    .expect("valid maps");
    for [du, dv] in DISPLACEMENTS {
        let (a, b) = (lit_parts(&surface, [du, dv]), lit_parts(&turned, [dv, du]));
        for (y, row) in a.iter().enumerate() {
            for (x, part) in row.iter().enumerate() {
                assert!((part - b[x][y]).abs() < 2e-3, "{x} {y}: {part} {}", b[x][y]);
            }
        }
    }
}

/// Above the edge of a shadow a ray of light comes down to the column of a texel, below it does not.
#[test]
fn edges_of_shadows_lie_where_rays_pass() {
    for wrap in [Wrap::Repeat, Wrap::Mirror] {
        let surface = stones(wrap);
        let field = HeightField::new(&surface);
        let [mut num_dark, mut num_wrong] = [0; 2];
        for displacement in DISPLACEMENTS {
            let lit = LitParts::new(surface.base(), displacement, surface.relief_depth());
            let [width, height] = surface.base().size();
            let (rows, columns) = if lit.is_turned { (width, height) } else { (height, width) };
            for row in 0..rows {
                let mut edges = Vec::new();
                lit.edges(row, &mut RowScratch::default(), &mut edges);
                let edges = edges.iter().flat_map(|[edges, _]| edges.to_array()).take(columns);
                for (column, edge) in edges.enumerate() {
                    let (x, y) = if lit.is_turned { (row, column) } else { (column, row) };
                    // On lit texels the edge is shared with what lies behind them.
                    if edge <= surface.base().height_at(x as i32, y as i32) + 0.02 {
                        continue;
                    }
                    let place = [x, y].map(|c| c as f32 + 0.5);
                    let passes = |height| is_reached(&field, place, 1.0 - height, displacement);
                    num_dark += 1;
                    num_wrong += u32::from(passes(edge - 0.04) || !passes(edge + 0.04));
                }
            }
        }
        // The sweep knows heights where light crosses rows, rays all of the bilinear surface.
        assert!(
            num_dark > 2000 && num_wrong * 25 < num_dark,
            "{wrap:?}: {num_wrong} of {num_dark}"
        );
    }
}
