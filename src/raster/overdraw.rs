//! How often pixels are covered: what tests of coverage look at.

use super::bin::Bins;
use super::edge::Row;
use super::grid::{TileGrid, bounds};
use super::tile::cover;
use crate::geometry::Geometry;
use crate::settings::Settings;

/// How often each pixel's samples are covered, without depth: a sum over the samples of each pixel
/// of the grid's area, cut off at 255. What tests of coverage look at, and what shows overdraw.
pub fn hit_counts(geometry: &Geometry, settings: &Settings) -> Vec<u8> {
    match settings.msaa {
        8 => count_hits::<8>(geometry, settings),
        4 => count_hits::<4>(geometry, settings),
        _ => count_hits::<1>(geometry, settings),
    }
}

fn count_hits<const S: usize>(geometry: &Geometry, settings: &Settings) -> Vec<u8> {
    let grid = TileGrid::new(settings);
    let mut bins = Bins::default();
    bins.fill(geometry, &grid);
    let [width, height] = grid.area.size().map(|side| side as usize);
    let mut counts = vec![0_u8; width * height];
    let mut list = Vec::new();
    for tile in 0..grid.num() {
        list.clear();
        bins.list(tile, &mut list);
        let rect = grid.rect(tile);
        for &index in &list {
            let triangle = geometry.triangle(index);
            cover::<S>(triangle, &bounds(triangle, &rect, grid.offset_bounds), &mut |row: Row| {
                let [x, y] =
                    [row.x - grid.area.min[0], row.y - grid.area.min[1]].map(|v| v as usize);
                let start = y * width + x;
                // The last lanes may lie to the right of the area: their places are those of the next
                // row.
                let num = (rect.max[0] - row.x).min(8) as usize;
                for (count, is_covered) in
                    counts[start..start + num].iter_mut().zip(row.mask.to_array())
                {
                    // A covered lane has all bits set: its lowest counts 1.
                    *count = count.saturating_add((is_covered & 1) as u8);
                }
            });
        }
    }
    counts
}
