//! How far towards a sun triangles reach over a plane across its light.
//!
//! A square of cells holds for each the nearest to the sun of what lies in it, and coarser levels the
//! nearest of four. Where all of that lies no farther up than a surface itself, nothing hides the
//! sun from it, and no ray needs to be sent.

use crate::light::Disc;
use glam::Vec3;

/// Cells a side.
const SIDE: usize = 1024;

/// The nearest to a sun, cell by cell.
#[derive(Clone, Debug)]
pub struct Ceiling {
    disc: Disc,
    across: [Vec3; 2],
    /// Where the cells begin, and cells a unit.
    origin: [f32; 2],
    scale: f32,
    /// Of triangles that light passes from behind, and from the front; finest first.
    levels: Vec<Vec<[f32; 2]>>,
}

/// A few points of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Spots {
    /// How far they lie along both axes across the light, the least and the greatest.
    pub across: [[f32; 2]; 2],
    /// How far at least they lie towards the sun.
    pub lowest: f32,
    /// A point of their polygon, and its unit normal, which faces the sun: along both axes across
    /// the light, and to it.
    pub polygon: [Vec3; 2],
    /// A triangle that light passes from behind hides nothing that is nearer to its plane.
    pub reach: f32,
}

/// What rounding may take from the height of a plane over a cell, in cells along it.
const ROUNDING: f32 = 1e-2;

/// Most cells a side that are looked at.
const MOST_CELLS: usize = 8;

impl Ceiling {
    /// Of triangles over an area that is given by its corners.
    pub fn new<'a>(
        disc: Disc,
        triangles: impl Iterator<Item = &'a [Vec3; 3]>,
        area: impl Iterator<Item = Vec3>,
    ) -> Self {
        let across = <[Vec3; 2]>::from(disc.to_middle.any_orthonormal_pair());
        let mut range = [[f32::MAX, f32::MIN]; 2];
        for corner in area {
            for (range, axis) in range.iter_mut().zip(across) {
                let at = axis.dot(corner);
                *range = [range[0].min(at), range[1].max(at)];
            }
        }
        let size = range.iter().fold(1e-9_f32, |size, [least, most]| size.max(most - least));
        let origin = range.map(|[least, _]| least);
        let cells = vec![[f32::MIN; 2]; SIDE * SIDE];
        let scale = SIDE as f32 / size;
        let mut all = Self { disc, across, origin, scale, levels: vec![cells] };
        triangles.for_each(|triangle| all.add(triangle));
        let mut side = SIDE;
        while side > 1 {
            let fine = &all.levels[all.levels.len() - 1];
            side /= 2;
            let most = |i: usize| {
                let at = i / side * 4 * side + i % side * 2;
                let four = [at, at + 1, at + 2 * side, at + 2 * side + 1].map(|i| fine[i]);
                four.into_iter().fold([f32::MIN; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])])
            };
            let coarse = (0..side * side).map(most).collect();
            all.levels.push(coarse);
        }
        all
    }

    /// Raises the cells in a triangle's box to its highest corner, and no higher than its plane goes
    /// there.
    fn add(&mut self, [a, b, c]: &[Vec3; 3]) {
        let to_light = self.disc.to_middle;
        let highest = [a, b, c].into_iter().fold(f32::MIN, |most, p| most.max(to_light.dot(*p)));
        let normal = (*b - *a).cross(*c - *a);
        let facing = normal.dot(to_light);
        let class = usize::from(facing <= 0.0);
        let slopes = self.across.map(|axis| -axis.dot(normal) / facing);
        // How far the plane rises from the middle of a cell, and what rounding may take from it.
        let size = 1.0 / self.scale;
        let rise = (slopes[0].abs() + slopes[1].abs()) * size * (0.5 + ROUNDING);
        let [x, y] = self.across.map(|axis| axis.dot(*a));
        let at = |i: usize, axis: usize| (i as f32 + 0.5) * size + self.origin[axis];
        let most = |column: usize, row: usize| {
            let along = (at(column, 0) - x) * slopes[0] + (at(row, 1) - y) * slopes[1];
            let plane = to_light.dot(*a) + along + rise;
            // An edge-on triangle has none.
            if plane < highest { plane } else { highest }
        };
        let ranges: [[f32; 2]; 2] = self.across.map(|axis| {
            let [a, b, c] = [a, b, c].map(|p| axis.dot(*p));
            [a.min(b).min(c), a.max(b).max(c)]
        });
        let Some([columns, rows]) = self.cells(&ranges) else { return };
        for row in rows[0]..=rows[1] {
            let cells = &mut self.levels[0][row * SIDE..][columns[0]..=columns[1]];
            for (cell, column) in cells.iter_mut().zip(columns[0]..) {
                cell[class] = cell[class].max(most(column, row));
            }
        }
    }

    /// The first and the last column and row of ranges across; `None` outside.
    fn cells(&self, ranges: &[[f32; 2]; 2]) -> Option<[[usize; 2]; 2]> {
        let last = (SIDE - 1) as f32;
        let mut all = [[0; 2]; 2];
        for ((cells, range), origin) in all.iter_mut().zip(ranges).zip(self.origin) {
            let [from, to] = range.map(|at| ((at - origin) * self.scale).floor());
            if !(from <= last && to >= 0.0) {
                return None;
            }
            *cells = [from.max(0.0) as usize, to.min(last) as usize];
        }
        Some(all)
    }

    /// The sun.
    pub fn disc(&self) -> Disc {
        self.disc
    }

    /// The axes across the light and the one to it.
    pub fn axes(&self) -> [Vec3; 3] {
        [self.across[0], self.across[1], self.disc.to_middle]
    }

    /// Whether nothing hides the sun from any of some points.
    pub fn is_clear(&self, spots: &Spots) -> bool {
        // Rays to the edge of the disc part from the one to its middle on their way up.
        let highest = self.levels[self.levels.len() - 1][0];
        let more = (highest[0].max(highest[1]) - spots.lowest).max(0.0) * self.disc.radius;
        let Some(cells) = self.cells(&spots.across.map(|[a, b]| [a - more, b + more])) else {
            return false;
        };
        let most = cells.iter().fold(0, |most, [from, to]| most.max(to - from));
        let level = (usize::BITS - (most / MOST_CELLS).leading_zeros()) as usize;
        let level = level.min(self.levels.len() - 1);
        let side = SIDE >> level;
        let size = (1_usize << level) as f32 / self.scale;
        let [columns, rows] = cells.map(|range| range.map(|i| i >> level));
        // Own triangles lie about as high as the polygon's plane does in the middle of a cell.
        let [point, normal] = spots.polygon;
        let inverse = 1.0 / normal.z;
        let [dx, dy] = [-normal.x * inverse, -normal.y * inverse];
        let at = |i: usize, axis: usize| (i as f32 + 0.5) * size + self.origin[axis] - point[axis];
        (rows[0]..=rows[1]).all(|y| {
            let row = &self.levels[level][y * side..][..side];
            let plane = point.z + at(y, 1) * dy + spots.reach * inverse;
            (columns[0]..=columns[1]).all(|x| {
                let [behind, front] = row[x];
                behind <= plane + at(x, 0) * dx && front <= spots.lowest
            })
        })
    }
}
