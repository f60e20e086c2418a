//! Which triangles may come between a piece of a surface and a sun.

use super::occluders::Occluders;
use crate::light::Disc;
use glam::Vec3;

/// Least height above the polygon's plane, as a share of the distance, that counts as above: what
/// rounding makes of triangles that lie in it.
const ROUNDING: f32 = 1e-5;

/// A piece of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    /// The middle of a box around it.
    pub middle: Vec3,
    /// Half the box's sides.
    half: Vec3,
    /// The polygon's unit normal on the side that is lit.
    normal: Vec3,
    /// How far the polygon is above the middle.
    top: f32,
    /// Where it is curved.
    own: Option<Own>,
}

/// Which triangles around a curved piece are its own.
#[derive(Clone, Copy, Debug)]
struct Own {
    /// Its mean unit normal.
    normal: Vec3,
    /// How far points lie along it from the middle, the least and the greatest, and across it.
    range: [f32; 2],
    radius: f32,
    /// A triangle that light passes from behind hides nothing that is nearer to its plane.
    reach: f32,
}

/// The middle of a box around points, and half its sides.
fn boxed(points: impl Iterator<Item = Vec3>) -> Option<(Vec3, Vec3)> {
    let (min, max) = points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), point| {
        (min.min(point), max.max(point))
    });
    let (middle, half) = ((min + max) * 0.5, (max - min) * 0.5);
    middle.is_finite().then_some((middle, half))
}

impl Own {
    /// Whether light passes a triangle, by its corners from the middle, from behind and near by.
    fn has(&self, disc: &Disc, [a, b, c]: &[Vec3; 3]) -> bool {
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let (above, up) = (a.dot(normal), self.normal.dot(normal));
        let across = (normal - self.normal * up).length() * self.radius;
        let farthest = self.range.map(|at| (above - up * at).abs());
        disc.to_middle.dot(normal) > 0.0 && farthest[0].max(farthest[1]) + across <= self.reach
    }
}

impl Receiver {
    /// Of points of a relief on a flat piece, whose polygon has a unit normal and holds a point;
    /// `None` without points.
    pub fn new(points: impl Iterator<Item = Vec3>, normal: Vec3, polygon: Vec3) -> Option<Self> {
        let (middle, half) = boxed(points)?;
        Some(Self { middle, half, normal, top: normal.dot(polygon - middle), own: None })
    }

    /// Of points around a relief on a curved piece whose mean unit normal is given; `None` without
    /// points. A triangle that light passes from behind hides nothing that is nearer to its plane
    /// than `reach`.
    pub fn curved(points: &[Vec3], normal: Vec3, reach: f32) -> Option<Self> {
        let (middle, half) = boxed(points.iter().copied())?;
        let mut own = Own { normal, range: [f32::MAX, f32::MIN], radius: 0.0, reach };
        for point in points {
            let from = *point - middle;
            let up = normal.dot(from);
            own.range = [own.range[0].min(up), own.range[1].max(up)];
            own.radius = own.radius.max((from - normal * up).length());
        }
        // Its polygons lie in no plane below which nothing hides.
        let (normal, top) = (Vec3::ZERO, f32::NEG_INFINITY);
        Some(Self { middle, half, normal, top, own: Some(own) })
    }

    /// How far from its middle its points are, at most.
    pub fn radius(&self) -> f32 {
        self.half.length()
    }

    /// Whether something in a box, by its middle and half its sides from the receiver's middle, may
    /// hide a part of a disc from a part of the receiver: a ray from the one to the other's middle
    /// passes a box that is larger by both.
    fn may_be_hidden_by(&self, disc: &Disc, middle: Vec3, half: Vec3) -> bool {
        let distance = middle.length() + half.length();
        let half = half + self.half + distance * (disc.radius + ROUNDING);
        // Along an axis that the ray does not move along, it is within a slab or never.
        let inverse = disc.to_middle.to_array().map(|d| if d == 0.0 { 1e30 } else { 1.0 / d });
        let inverse = Vec3::from(inverse);
        let [a, b] = [(middle - half) * inverse, (middle + half) * inverse];
        let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
        near.max(0.0) <= far
    }
}

impl Occluders {
    /// Whether a triangle may come between a receiver and a point: one that reaches into the box
    /// around both, above the receiver's plane, or below it where light enters it from the front.
    pub fn may_hide(&self, receiver: &Receiver, point: Vec3) -> bool {
        let to = point - receiver.middle;
        let (min, max) = (to.min(-receiver.half), to.max(receiver.half));
        let more = Vec3::splat((max - min).max_element() * ROUNDING);
        let may = |from: Vec3, until: Vec3, is_front: bool| {
            let (from, until) = (from - receiver.middle, until - receiver.middle);
            let (middle, half) = ((from + until) * 0.5, (until - from) * 0.5);
            let (height, reach) = (receiver.normal.dot(middle), receiver.normal.abs().dot(half));
            let rounding = ROUNDING * (middle.length() + half.length());
            let is_flat = receiver.normal != Vec3::ZERO;
            let is_above = height + reach > receiver.top + rounding;
            let is_below = height - reach < receiver.top - rounding;
            let is_within = from.cmple(max + more).all() && until.cmpge(min - more).all();
            is_within && (is_above || (is_below && is_front) || !is_flat)
        };
        self.any(
            |node| may(node.min, node.max, true),
            |_, [a, b, c]| {
                let is_front = (point - *a).dot((*b - *a).cross(*c - *a)) < 0.0;
                may(a.min(*b).min(*c), a.max(*b).max(*c), is_front)
            },
        )
    }

    /// The triangles that may hide a part of a disc from a part of a receiver, from its middle, each with
    /// the indices of its mesh and in it.
    pub fn between(&self, receiver: &Receiver, disc: &Disc) -> Vec<([Vec3; 3], [u32; 2])> {
        let mut found = Vec::new();
        self.any(
            |node| {
                let middle = (node.min + node.max) * 0.5 - receiver.middle;
                receiver.may_be_hidden_by(disc, middle, (node.max - node.min) * 0.5)
            },
            |i, triangle| {
                let [a, b, c] = triangle.map(|corner| corner - receiver.middle);
                let (min, max) = (a.min(b).min(c), a.max(b).max(c));
                let height = [a, b, c].map(|corner| receiver.normal.dot(corner));
                let height = height.into_iter().fold(f32::MIN, f32::max);
                let distance = a.length().max(b.length()).max(c.length());
                // Below the polygon lies what stands in the relief, which light enters from the front,
                // and what the relief itself ends in, which light leaves from behind.
                let is_above = height > receiver.top + ROUNDING * distance;
                let is_front = disc.to_middle.dot((b - a).cross(c - a)) < 0.0;
                if (is_above || is_front)
                    && !receiver.own.is_some_and(|own| own.has(disc, &[a, b, c]))
                    && receiver.may_be_hidden_by(disc, (min + max) * 0.5, (max - min) * 0.5)
                {
                    found.push(([a, b, c], self.name(i)));
                }
                false
            },
        );
        found
    }
}
