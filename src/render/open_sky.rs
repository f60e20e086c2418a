//! What the meshes of a scene leave of the sky to a flat piece that they stand on or hang over.
//!
//! That changes slowly from place to place, as the meshes are large against the relief. So it is
//! measured once, by rays from a grid over the part of the piece that is near meshes, and blended
//! between:
//!
//! ```text
//!        \ | /    what gets past        __________
//!         \|/                      ____|   mesh   |____  height
//!     .  .  .  .  .  .  .  .  .  ./ .  .  .  .  .  .  . \   nodes up to four heights away
//!   --------------------------------------------------------- polygon
//! ```
//!
//! What the relief hides of the sky is baked already; of both a place shows the product.

use crate::light::exact::Occluders;
use crate::light::spiral;
use crate::raster::{QuadBlock, QuadPair};
use crate::scene::Scene;
use crate::simd::PixelLanes;
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// Rays from a node, each for the same share of what lights a polygon.
const RAYS: usize = 128;

/// Most cells of a grid's longer side.
const CELLS: f32 = 96.0;

/// How far from meshes a grid reaches, in their heights: there they hide a fiftieth of the light at
/// most.
const REACH: f32 = 4.0;

/// Least share of the sky that counts as all of it.
const ALL: f32 = 0.998;

/// Most planes that the polygons of a piece may lie in; those in others see all of the sky.
const MOST_PLANES: usize = 8;

/// Greatest distance of what lies in one plane, as a share of its numbers: what rounding makes.
const SAME: f32 = 1e-4;

/// A plane with polygons of a piece.
#[derive(Clone, Debug)]
pub(crate) struct Plane {
    /// How far it is along the piece's normal.
    height: f32,
    /// The box around the polygons along its axes.
    min: Vec2,
    max: Vec2,
}

/// A side of a piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facing {
    /// Unit normal on that side.
    pub(crate) normal: Vec3,
    /// Whether that is the back.
    pub(crate) is_turned: bool,
    /// The world length of the relief's depth.
    pub(crate) down: f32,
}

/// The part of the sky that is left to a side of a piece.
#[derive(Debug)]
pub(crate) struct OpenSky {
    axes: [Vec3; 3],
    grids: Vec<Grid>,
}

/// The part of the sky that is left to a plane, linear RGB, node by node and row by row.
#[derive(Debug)]
struct Grid {
    height: f32,
    first: Vec2,
    spacing: f32,
    size: [usize; 2],
    shares: Vec<Vec3>,
}

impl Plane {
    /// Adds a triangle of a piece with a unit normal to its planes.
    pub(crate) fn add(planes: &mut Vec<Self>, normal: Vec3, triangle: [Vec3; 3]) {
        let axes = axes(normal);
        let height = normal.dot(triangle[0]);
        let is_same = |plane: &Self| (plane.height - height).abs() <= SAME * height.abs().max(1.0);
        let index = planes.iter().position(is_same).unwrap_or_else(|| {
            if planes.len() < MOST_PLANES {
                planes.push(Self { height, min: Vec2::INFINITY, max: Vec2::NEG_INFINITY });
            }
            planes.len() - 1
        });
        let plane = &mut planes[index];
        for place in triangle.map(|corner| on(axes, corner)) {
            (plane.min, plane.max) = (plane.min.min(place), plane.max.max(place));
        }
    }
}

impl OpenSky {
    /// Of a side with polygons in planes of the front's normal; `None` where no mesh hides any sky.
    pub(crate) fn new(
        (scene, occluders): (&Scene, &Occluders),
        facing: &Facing,
        planes: &[Plane],
    ) -> Option<Self> {
        let front = if facing.is_turned { -facing.normal } else { facing.normal };
        let [u, v, _] = axes(front);
        let grid = |plane: &Plane| Grid::new((scene, occluders), facing, [u, v, front], plane);
        let grids: Vec<_> = planes.iter().filter_map(grid).collect();
        (!grids.is_empty()).then_some(Self { axes: [u, v, front], grids })
    }

    /// At the pixels of a block's pairs; `None` where they see all of it.
    pub(super) fn of_block(&self, block: &QuadBlock) -> Option<Vec<[PixelLanes; 3]>> {
        let mut least = 1.0_f32;
        let of_pair = |pair: QuadPair| {
            let position = pair.lit()?.position.map(PixelLanes::to_array);
            let mut shares = [Vec3::ONE; 8];
            for lane in pair.covered() {
                shares[lane] = self.at(Vec3::from(position.map(|axis| axis[lane])));
                least = least.min(shares[lane].min_element());
            }
            Some([0, 1, 2].map(|c| PixelLanes::new(shares.map(|share| share[c]))))
        };
        let shares: Vec<_> = block.pairs().map(of_pair).collect::<Option<_>>()?;
        (least < ALL).then_some(shares)
    }

    fn at(&self, place: Vec3) -> Vec3 {
        let height = self.axes[2].dot(place);
        let off = |grid: &Grid| (grid.height - height).abs();
        let nearest = self.grids.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        // Positions of pixels went through planes of attributes.
        let is_on = |grid: &&Grid| off(grid) <= 10.0 * SAME * height.abs().max(1.0);
        nearest.filter(is_on).map_or(Vec3::ONE, |grid| grid.at(on(self.axes, place)))
    }
}

impl Grid {
    fn new(
        (scene, occluders): (&Scene, &Occluders),
        facing: &Facing,
        axes: [Vec3; 3],
        plane: &Plane,
    ) -> Option<Self> {
        let [low, high] = above(scene, facing, axes, plane.height)?;
        let (first, end) = (low.max(plane.min), high.min(plane.max));
        let sides = end - first;
        let spacing = sides.max_element() / CELLS;
        // No part of the plane is near.
        if !(sides.min_element() > 0.0 && spacing.is_finite()) {
            return None;
        }
        let size = (sides / spacing).to_array().map(|side| side.ceil() as usize + 1);
        let rays = rays(scene, facing.normal);
        let all = rays.iter().fold(Vec3::ZERO, |sum, (_, color)| sum + *color);
        let node = |i: usize| {
            let place = first + Vec2::new((i % size[0]) as f32, (i / size[0]) as f32) * spacing;
            // From half way down the relief: what the relief hides itself is told apart.
            let from = axes[0] * place.x + axes[1] * place.y + axes[2] * plane.height
                - facing.normal * (0.5 * facing.down);
            let left = left(occluders, facing, from, &rays);
            Vec3::select(all.cmpgt(Vec3::ZERO), left / all, Vec3::ONE)
        };
        let shares: Vec<_> = (0..size[0] * size[1]).into_par_iter().map(node).collect();
        let is_any_hidden = shares.iter().any(|share| share.min_element() < ALL);
        let grid = Self { height: plane.height, first, spacing, size, shares };
        is_any_hidden.then(|| grid.without_buried())
    }

    /// Gives nodes that lie within a mesh what those around them see, so that no darkness leaks
    /// out.
    fn without_buried(self) -> Self {
        let [width, height] = self.size;
        let around = |i: usize| {
            let (x, y) = (i % width, i / width);
            let rows = y.saturating_sub(1)..(y + 2).min(height);
            let all = rows.flat_map(|y| {
                (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| x + width * y)
            });
            let (sum, num) = all
                .map(|i| self.shares[i])
                .filter(|share| *share != Vec3::ZERO)
                .fold((Vec3::ZERO, 0.0), |(sum, num), share| (sum + share, num + 1.0));
            sum / f32::max(num, 1.0)
        };
        let share =
            |(i, share): (usize, &Vec3)| if *share == Vec3::ZERO { around(i) } else { *share };
        Self { shares: self.shares.iter().enumerate().map(share).collect(), ..self }
    }

    /// At a place of the plane, beyond the grid as at its edge.
    fn at(&self, place: Vec2) -> Vec3 {
        let last = Vec2::new((self.size[0] - 1) as f32, (self.size[1] - 1) as f32);
        let along = ((place - self.first) / self.spacing).max(Vec2::ZERO).min(last);
        let node = along.floor().min(last - 1.0).max(Vec2::ZERO);
        let part = along - node;
        let at = |dx: usize, dy: usize| {
            let x = (node.x as usize + dx).min(self.size[0] - 1);
            let y = (node.y as usize + dy).min(self.size[1] - 1);
            self.shares[x + self.size[0] * y]
        };
        let [top, bottom] = [0, 1].map(|dy| at(0, dy) + (at(1, dy) - at(0, dy)) * part.x);
        top + (bottom - top) * part.y
    }
}

/// Unit axes of planes: two along them, and their normal.
fn axes(normal: Vec3) -> [Vec3; 3] {
    let (u, v) = normal.any_orthonormal_pair();
    [u, v, normal]
}

/// A place along the first two axes.
fn on([u, v, _]: [Vec3; 3], place: Vec3) -> Vec2 {
    Vec2::new(u.dot(place), v.dot(place))
}

/// The box along a plane's axes around all that meshes have before it, widened by [`REACH`].
fn above(scene: &Scene, facing: &Facing, axes: [Vec3; 3], height: f32) -> Option<[Vec2; 2]> {
    let (mut low, mut high, mut top) = (Vec2::INFINITY, Vec2::NEG_INFINITY, 0.0_f32);
    let side = if facing.is_turned { -1.0 } else { 1.0 };
    for mesh in &scene.meshes {
        for triangle in &mesh.triangles {
            let corners = triangle.map(|i| mesh.positions[i as usize]);
            let heights = corners.map(|corner| (axes[2].dot(corner) - height) * side);
            let highest = heights.into_iter().fold(f32::MIN, f32::max);
            if highest <= SAME * height.abs().max(1.0) {
                continue;
            }
            top = top.max(highest);
            for place in corners.map(|corner| on(axes, corner)) {
                (low, high) = (low.min(place), high.max(place));
            }
        }
    }
    let reach = top * REACH;
    (top > 0.0).then_some([low - reach, high + reach])
}

/// Directions before a plane, as dense as their cosine to it, and what comes from there.
fn rays(scene: &Scene, normal: Vec3) -> Vec<(Vec3, Vec3)> {
    let [x, y, z] = axes(normal);
    let ray = |([cos, sin], share): ([f64; 2], f64)| {
        let [cos, sin, share] = [cos, sin, share].map(|c| c as f32);
        let direction = (x * cos + y * sin) * share.sqrt() + z * (1.0 - share).sqrt();
        (direction, scene.sky.radiance(direction))
    };
    spiral(RAYS).map(ray).collect()
}

/// The sum of what gets to a point past all meshes.
fn left(occluders: &Occluders, facing: &Facing, from: Vec3, rays: &[(Vec3, Vec3)]) -> Vec3 {
    let Facing { down, is_turned, .. } = *facing;
    rays.iter().fold(Vec3::ZERO, |sum, (direction, color)| {
        let is_hidden = || occluders.hide_sky(from, *direction, (down, is_turned));
        if *color == Vec3::ZERO || is_hidden() { sum } else { sum + *color }
    })
}
