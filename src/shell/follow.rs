//! A view ray on its way through the prisms of a relief.
//!
//! Seen along the ray, which is the origin then, corner `i` of a prism's triangle at depth `t` is at
//! `p_i + t o_i`. The ray is on the line through two corners where their cross product, a quadratic
//! in `t`, is 0; both triangles at an edge find the same `t` there. Between two sides of a prism the
//! ray is cut into pieces that are straight in the texture. All in f64, one ray at a time.

use super::neighbors::NONE;
use super::prism::Prism;
use super::prisms::Shell;
use crate::relief::{HeightField, MOST_STEPS, ReliefPlace};
use crate::scene::Mesh;
use glam::{DVec2, DVec3};

/// Most triangles of a ray: only a mesh that is knotted has more; the ray then ends where it is.
const MOST_TRIANGLES: usize = 4096;

/// How much farther around rays others are taken to go: prisms are narrower the deeper.
const MARGIN: f64 = 1.25;

/// A ray from the eye, or between a place and a light.
#[derive(Clone, Copy, Debug)]
pub struct ViewRay {
    /// Where it begins.
    pub from: DVec3,
    /// Where it goes, of any length; distances are counted in it.
    pub direction: DVec3,
}

/// How far around a ray others go, in world units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Width {
    /// Where it begins.
    pub at_eye: f64,
    /// More for each distance from there.
    pub per_distance: f64,
}

/// What a ray that enters a relief meets.
#[derive(Clone, Copy, Debug)]
pub enum Met {
    /// Relief.
    Relief(ReliefHit),
    /// No relief is there: the polygon itself.
    Polygon,
    /// Nothing: so far from the eye it leaves the relief through a polygon.
    Nothing(f64),
}

/// Where a ray meets relief.
#[derive(Clone, Copy, Debug)]
pub struct ReliefHit {
    /// The triangle above.
    pub triangle: u32,
    /// The shares of its corners.
    pub shares: [f64; 3],
    /// Place on the texture, and depth.
    pub place: ReliefPlace,
    /// Distance from the eye.
    pub distance: f64,
    /// Whether the ray came in from behind, where relief is on the other side.
    pub is_back: bool,
}

/// A point of the ray within a prism.
#[derive(Clone, Copy)]
struct Point {
    shares: [f64; 3],
    place: ReliefPlace,
}

/// A ray on its way.
struct Walk<'a> {
    shell: &'a Shell,
    mesh: &'a Mesh,
    field: &'a HeightField,
    ray: &'a ViewRay,
    width: Width,
    /// Two axes across the ray.
    axes: [DVec3; 2],
    /// 1 where the mesh is seen from the front, -1 where its back shows relief on the other side.
    side: f64,
    /// Of the whole ray, over all prisms: see [`HeightField::first_hit`].
    steps_left: &'a mut u32,
}

impl Shell {
    /// What a ray meets that enters the relief of the mesh through a triangle, or beside it.
    pub fn follow(&self, mesh: &Mesh, field: &HeightField, triangle: u32, ray: &ViewRay) -> Met {
        self.follow_within(mesh, field, triangle, (ray, &mut { MOST_STEPS }))
    }

    /// The same of a ray that has so many steps left, and takes its own from them: where none is
    /// left, it ends.
    pub fn follow_within(
        &self,
        mesh: &Mesh,
        field: &HeightField,
        triangle: u32,
        (ray, steps_left): (&ViewRay, &mut u32),
    ) -> Met {
        self.walk::<false>(mesh, field, triangle, (ray, Width::default(), steps_left))
    }

    /// The same where a place within the relief, not before the hit, will do: a few heights are
    /// looked at, and none between. What is said to be nothing may be a hit.
    ///
    /// All rays that are no farther from this one than `width` says hit relief, too, if they enter that
    /// of the mesh before the place.
    pub fn probe(
        &self,
        mesh: &Mesh,
        field: &HeightField,
        triangle: u32,
        (ray, width): (&ViewRay, Width),
    ) -> Met {
        self.walk::<true>(mesh, field, triangle, (ray, width, &mut { MOST_STEPS }))
    }

    fn walk<const PROBES: bool>(
        &self,
        mesh: &Mesh,
        field: &HeightField,
        triangle: u32,
        (ray, width, steps_left): (&ViewRay, Width, &mut u32),
    ) -> Met {
        let along = ray.direction.normalize_or(DVec3::Z);
        let (x, y) = along.any_orthonormal_pair();
        // Turned so that what is seen from the front is counter-clockwise.
        let (axes, side) = ([y, x], 1.0);
        let mut walk = Walk { shell: self, mesh, field, ray, width, axes, side, steps_left };
        let prism = walk.prism(triangle);
        if prism.area(0.0) < 0.0 {
            walk.side = -1.0;
        }
        // Beside the triangle the ray may see it from another side than those that pass it do.
        if width != Width::default() && walk.is_back(triangle) != (walk.side < 0.0) {
            return Met::Nothing(0.0);
        }
        walk.run::<PROBES>(triangle)
    }
}

impl Walk<'_> {
    fn run<const PROBES: bool>(&mut self, triangle: u32) -> Met {
        let Some(mut prism) = self.entry(triangle) else {
            return Met::Nothing(self.distance_of(triangle));
        };
        let mut from = self.point(&prism, prism.shares(0.0), 0.0);
        let (mut entry, mut goes_down, mut is_beyond) = (3, true, false);
        for _ in 0..MOST_TRIANGLES {
            if *self.steps_left == 0 {
                break;
            }
            let t = from.place.depth;
            let way = if goes_down { 1.0 } else { -1.0 };
            // Find the side by which the ray leaves the prism, unless that is above or below.
            let left = if goes_down { 1.0 - t } else { t };
            let edges = if is_beyond { 0..0 } else { 0..3 };
            let exits =
                edges.map(|edge| (prism.exit(edge, [t, way, self.side], edge == entry), edge));
            let (rise, edge) = exits.fold((left, 3), |a, b| if b.0 < a.0 { b } else { a });
            if let Some(hit) = self.pieces::<PROBES>(&prism, &mut from, (t + way * rise, edge)) {
                return Met::Relief(hit);
            }
            if edge == 3 {
                // At full depth every height is met, but by probes of several rays.
                return if goes_down && (!PROBES || self.width == Width::default()) {
                    Met::Relief(self.hit(&prism, &from))
                } else {
                    Met::Nothing(self.distance(&prism, &from))
                };
            }
            match self.shell.neighbors[prism.triangle as usize][edge] {
                // Beyond a border the last triangle goes on: nobody looks through a seam.
                NONE => is_beyond = true,
                next => {
                    prism = self.prism(next / 3);
                    entry = next as usize % 3;
                    goes_down = self.side * prism.area(from.place.depth) > 0.0;
                    // The texture may go on in other coordinates.
                    let shares = prism.shares_on(entry, from.place.depth);
                    from = self.point(&prism, shares, from.place.depth);
                }
            }
        }
        Met::Relief(self.hit(&prism, &from))
    }

    /// The prism where the ray passes the polygons, starting to look from a triangle near by; `None`
    /// where it passes beside the mesh.
    fn entry(&self, triangle: u32) -> Option<Prism> {
        let mut prism = self.prism(triangle);
        for _ in 0..64 {
            let outside = (0..3)
                .map(|edge| (self.side * prism.edge(edge)[0], edge))
                .fold((0.0, 3), |a, b| if b.0 < a.0 { b } else { a });
            let next = match outside.1 {
                3 => NONE,
                edge => self.shell.neighbors[prism.triangle as usize][edge],
            };
            if next == NONE {
                break;
            }
            let beyond = self.prism(next / 3);
            if self.side * beyond.area(0.0) <= 0.0 {
                return None;
            }
            prism = beyond;
        }
        // Edge on, it has no place where the ray passes.
        prism.shares(0.0).iter().all(|share| share.is_finite()).then_some(prism)
    }

    /// Whether a triangle is seen from behind where the ray begins.
    fn is_back(&self, triangle: u32) -> bool {
        let corners = self.mesh.triangles[triangle as usize];
        let [a, b, c] = corners.map(|i| self.mesh.positions[i as usize].as_dvec3());
        (b - a).cross(c - a).dot(self.ray.from - a) < 0.0
    }

    fn prism(&self, triangle: u32) -> Prism {
        let Self { shell, mesh, ray, axes: [x, y], side, .. } = self;
        let corners = mesh.triangles[triangle as usize].map(|i| i as usize);
        let across = |v: DVec3| DVec2::new(v.dot(*x), v.dot(*y));
        Prism {
            triangle,
            p: corners.map(|i| across(mesh.positions[i].as_dvec3() - ray.from)),
            o: corners.map(|i| across(shell.offsets[i].as_dvec3() * *side)),
            num_pieces: u32::from(shell.num_pieces[triangle as usize]),
        }
    }

    /// Goes on within a prism to a depth, where the ray leaves by an edge or, for 3, by none; gives
    /// the hit, if there is one.
    fn pieces<const PROBES: bool>(
        &mut self,
        prism: &Prism,
        from: &mut Point,
        (end, edge): (f64, usize),
    ) -> Option<ReliefHit> {
        let start = from.place.depth;
        for i in 1..=prism.num_pieces {
            let is_last = i == prism.num_pieces;
            let part = f64::from(i) / f64::from(prism.num_pieces);
            let depth = if is_last { end } else { start + (end - start) * part };
            let shares = if is_last && edge < 3 {
                prism.shares_on(edge, depth)
            } else {
                prism.shares(depth)
            };
            // A triangle seen edge on has no place.
            if !shares.iter().all(|share| share.is_finite()) {
                return Some(self.hit(prism, from));
            }
            let to = self.point(prism, shares, depth);
            let part = if PROBES {
                // No more than the ray itself takes: where a probe ends for that, the ray does.
                *self.steps_left = self.steps_left.saturating_sub(1);
                [0.5, 1.0].into_iter().find(|part| {
                    let place = from.place.toward(&to.place, *part);
                    self.is_within(prism, &Point { shares: to.shares, place })
                })
            } else {
                self.field.first_hit(&from.place, &to.place, self.steps_left)
            };
            if let Some(part) = part {
                let shares =
                    [0, 1, 2].map(|i| from.shares[i] + (to.shares[i] - from.shares[i]) * part);
                let place = from.place.toward(&to.place, part);
                return Some(self.hit(prism, &Point { shares, place }));
            }
            *from = to;
        }
        None
    }

    /// Whether a point lies in the relief, and so do those of the rays around this one.
    fn is_within(&self, prism: &Prism, point: &Point) -> bool {
        if !self.field.holds(&point.place) {
            return false;
        }
        if self.width == Width::default() {
            return true;
        }
        let around = self.width.at_eye + self.width.per_distance * self.distance(prism, point);
        let corner = self.mesh.triangles[prism.triangle as usize][0] as usize;
        let (depth, around) = self.shell.around(self.mesh, corner, around * MARGIN);
        self.field.is_above(point.place.uv, around, point.place.depth - depth)
    }

    fn point(&self, prism: &Prism, shares: [f64; 3], depth: f64) -> Point {
        let corners = self.mesh.triangles[prism.triangle as usize].map(|i| i as usize);
        let mut uv = [0.0; 2];
        for (i, share) in corners.into_iter().zip(shares) {
            let coordinates = self.mesh.tex_coords[i];
            uv[0] += share * f64::from(coordinates.x);
            uv[1] += share * f64::from(coordinates.y);
        }
        Point { shares, place: ReliefPlace { uv, depth } }
    }

    fn hit(&self, prism: &Prism, at: &Point) -> ReliefHit {
        let (shares, place) = (at.shares, at.place);
        let (distance, is_back) = (self.distance(prism, at), self.side < 0.0);
        ReliefHit { triangle: prism.triangle, shares, place, distance, is_back }
    }

    /// How far from the eye a point is.
    fn distance(&self, prism: &Prism, at: &Point) -> f64 {
        let corners = self.mesh.triangles[prism.triangle as usize].map(|i| i as usize);
        let mut place = -self.ray.from;
        for (i, share) in corners.into_iter().zip(at.shares) {
            let down = self.shell.offsets[i].as_dvec3() * (at.place.depth * self.side);
            place += (self.mesh.positions[i].as_dvec3() + down) * share;
        }
        place.dot(self.ray.direction) / self.ray.direction.length_squared()
    }

    /// How far from the eye the first corner of a triangle is.
    fn distance_of(&self, triangle: u32) -> f64 {
        let corner = self.mesh.triangles[triangle as usize][0] as usize;
        let from_eye = self.mesh.positions[corner].as_dvec3() - self.ray.from;
        from_eye.dot(self.ray.direction) / self.ray.direction.length_squared()
    }
}
