//! The mesh of an arch: a rectangle swept up a pillar, over a half circle and down again.
//!
//! The circle's points come from `((1 - t²) / (1 + t²), 2t / (1 + t²))`, which needs no sine and so
//! gives the same mesh on every machine. `u` runs along the way, so that courses of stones lie
//! level in the pillars and radial above.

use crate::scene::mesh::Mesh;
use glam::{Vec2, Vec3};

/// Measures in world units; the arch stands on y = 0, open along z, its middle at the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arch {
    /// Half the width of the opening.
    pub(super) radius: f32,
    /// Height of the pillars up to where the circle begins.
    pub(super) pillar: f32,
    /// From the inner to the outer face.
    pub(super) thickness: f32,
    /// From the front to the back face.
    pub(super) depth: f32,
    /// World units of a texture repeat.
    pub(super) repeat: f32,
}

/// A stop on the way: a point of the inner face, the direction away from the opening, and the way
/// so far.
struct Stop {
    inner: Vec2,
    outwards: Vec2,
    way: f32,
}

impl Arch {
    /// The four faces, each with its own corners, since the edges are sharp.
    pub(super) fn mesh(&self) -> Mesh {
        let stops = self.stops();
        let (front, back) = (0.5 * self.depth, -0.5 * self.depth);
        let corners = [
            (0.0, front),
            (self.thickness, front),
            (self.thickness, back),
            (0.0, back),
            (0.0, front),
        ];
        let (mut positions, mut tex_coords, mut normals, mut triangles) =
            (vec![], vec![], vec![], vec![]);
        let mut around = 0.0;
        for (face, pair) in corners.windows(2).enumerate() {
            let [from, to] = [pair[0], pair[1]];
            let width = (to.0 - from.0).abs() + (to.1 - from.1).abs();
            for stop in &stops {
                let first = positions.len() as u32;
                let radial = stop.outwards.extend(0.0);
                for (corner, v) in [(from, around), (to, around + width)] {
                    positions.push((stop.inner + stop.outwards * corner.0).extend(corner.1));
                    tex_coords.push(Vec2::new(stop.way, v) / self.repeat);
                    normals.push([Vec3::Z, radial, Vec3::NEG_Z, -radial][face]);
                }
                if stop.way > 0.0 {
                    triangles
                        .extend([[first - 2, first, first + 1], [first - 2, first + 1, first - 1]]);
                }
            }
            around += width;
        }
        Mesh::new(positions, tex_coords, normals, triangles)
    }

    fn stops(&self) -> Vec<Stop> {
        const NUM_QUARTER: usize = 24;
        let mut points = vec![(Vec2::new(-self.radius, 0.0), Vec2::NEG_X)];
        let quarter = (0..=NUM_QUARTER).map(|i| {
            let t = i as f32 / NUM_QUARTER as f32;
            Vec2::new(1.0 - t * t, 2.0 * t) / (1.0 + t * t)
        });
        let left: Vec<Vec2> = quarter.map(|p| Vec2::new(-p.x, p.y)).collect();
        let right = left.iter().rev().skip(1).map(|p| Vec2::new(-p.x, p.y));
        let circle: Vec<Vec2> = left.iter().copied().chain(right).collect();
        points.extend(circle.into_iter().map(|n| (n * self.radius + Vec2::Y * self.pillar, n)));
        points.push((Vec2::new(self.radius, 0.0), Vec2::X));
        let middle = |(inner, outwards): (Vec2, Vec2)| inner + outwards * (0.5 * self.thickness);
        let mut way = 0.0;
        let mut before = middle(points[0]);
        points
            .into_iter()
            .map(|point| {
                way += middle(point).distance(before);
                before = middle(point);
                Stop { inner: point.0, outwards: point.1, way }
            })
            .collect()
    }
}
