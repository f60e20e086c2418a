//! All triangles of a scene, and whether one of them hides a light: a tree of boxes.
//!
//! The tree halves its triangles by the middles of their boxes, along the longer axis, until few are
//! left. Any hit will do, so they are asked in the tree's order. Rays are in f64, positions are
//! stored as they are.

use super::holes;
use crate::scene::Scene;
use crate::shell::{Outlined, ViewRay};
use glam::{DVec3, Vec3};

/// Most triangles of a leaf: fewer make more boxes than they save.
const LEAF: usize = 4;

/// A ray from a point of a surface to a light.
#[derive(Clone, Copy, Debug)]
pub struct LightRay {
    /// Where it starts.
    pub from: DVec3,
    /// A unit direction.
    pub direction: DVec3,
    /// How far the light is; may be infinite.
    pub distance: f64,
    /// Relief lies below its polygons, so a ray leaves its own from behind, and neighbours too where
    /// it starts near an edge: a triangle that it passes from behind, and no farther above its start
    /// than this, hides nothing. What it passes from the front always hides.
    pub reach: f64,
    /// Whether the surface is seen from its back: then relief lies on the other side.
    pub is_turned: bool,
}

/// The triangles of a scene.
#[derive(Clone, Debug, Default)]
pub struct Occluders {
    nodes: Vec<Node>,
    triangles: Vec<[Vec3; 3]>,
    /// Of each triangle, the indices of its mesh and in it.
    names: Vec<[u32; 2]>,
}

/// A box around triangles. The first child of an inner node is the next one.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) min: Vec3,
    pub(super) max: Vec3,
    /// The first triangle of a leaf, the second child of an inner node.
    at: u32,
    /// How many triangles a leaf has; 0 for an inner node.
    num: u32,
}

/// A triangle with its name.
type Named = ([Vec3; 3], [u32; 2]);

/// Makes the node of triangles, whose first one is the one at `first` of all, and all below it.
fn split(nodes: &mut Vec<Node>, triangles: &mut [Named], first: usize) {
    let corners = triangles.iter().flat_map(|(corners, _)| corners);
    let (min, max) = corners
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), p| (min.min(*p), max.max(*p)));
    let (node, num) = (nodes.len(), triangles.len());
    if num <= LEAF {
        nodes.push(Node { min, max, at: first as u32, num: num as u32 });
        return;
    }
    // Halved by number, so the tree is never deep. Equal middles may change places, but always
    // in the same way.
    let axis = (max - min).max_position();
    let middle = |(t, _): &Named| {
        t[0][axis].min(t[1][axis]).min(t[2][axis]) + t[0][axis].max(t[1][axis]).max(t[2][axis])
    };
    triangles.select_nth_unstable_by(num / 2, |a, b| middle(a).total_cmp(&middle(b)));
    nodes.push(Node { min, max, at: 0, num: 0 });
    let (left, right) = triangles.split_at_mut(num / 2);
    split(nodes, left, first);
    nodes[node].at = nodes.len() as u32;
    split(nodes, right, first + num / 2);
}

impl Occluders {
    /// Of all meshes of a scene.
    pub fn new(scene: &Scene) -> Self {
        let named = scene.meshes.iter().zip(0..).flat_map(|(mesh, name)| {
            let whole = || mesh.triangles.iter().map(|t| t.map(|i| mesh.positions[i as usize]));
            let all = match scene.cut_out(mesh) {
                Some(cut_out) => holes::without(mesh, cut_out),
                None => whole().zip(0..).collect(),
            };
            all.into_iter().map(move |(triangle, i)| (triangle, [name, i]))
        });
        let mut named: Vec<Named> = named.collect();
        let mut nodes = Vec::new();
        if !named.is_empty() {
            split(&mut nodes, &mut named, 0);
        }
        let (triangles, names) = named.into_iter().unzip();
        Self { nodes, triangles, names }
    }

    /// All triangles, in the tree's order.
    pub fn triangles(&self) -> &[[Vec3; 3]] {
        &self.triangles
    }

    /// Whether a triangle lies between a point and its light; of meshes with outlines, if given, their
    /// relief.
    pub fn hide(&self, ray: &LightRay, outlined: Option<&Outlined>) -> bool {
        // Along an axis that the ray does not move along, it is within a slab or never.
        let inverse = ray.direction.to_array().map(|d| if d == 0.0 { 1e300 } else { 1.0 / d });
        let inverse = DVec3::from_array(inverse);
        let LightRay { from, direction, distance, .. } = *ray;
        let way = ViewRay { from, direction };
        self.any(
            |node| node.is_on(ray, inverse),
            |i, triangle| {
                ray.is_hidden_by(triangle)
                    && outlined.is_none_or(|all| all.hides(self.names[i], &way, distance))
            },
        )
    }

    /// Whether a triangle lies between a point in a relief and the sky in a direction; the point is
    /// half way down the relief, which goes `down` in the world from its polygon.
    pub fn hide_sky(&self, from: Vec3, direction: Vec3, (down, is_turned): (f32, bool)) -> bool {
        let (from, direction) = (from.as_dvec3(), direction.as_dvec3());
        let reach = f64::from(2.0 * down) + from.abs().max_element() * 1e-5;
        self.hide(&LightRay { from, direction, distance: f64::INFINITY, reach, is_turned }, None)
    }

    /// The indices of a triangle's mesh and in it.
    pub(super) fn name(&self, i: usize) -> [u32; 2] {
        self.names[i]
    }

    /// Whether a triangle in boxes that are wanted is the one, by its index; none is looked at after it.
    #[inline(always)]
    pub(super) fn any(
        &self,
        is_wanted: impl Fn(&Node) -> bool,
        mut is_it: impl FnMut(usize, &[Vec3; 3]) -> bool,
    ) -> bool {
        // Halved by number, a tree of 2^32 triangles is not as deep.
        let mut left = [0; 64];
        let mut num_left = usize::from(!self.nodes.is_empty());
        while num_left > 0 {
            num_left -= 1;
            let index = left[num_left];
            let node = &self.nodes[index as usize];
            if !is_wanted(node) {
                continue;
            }
            if node.num == 0 {
                (left[num_left], left[num_left + 1]) = (node.at, index + 1);
                num_left += 2;
                continue;
            }
            let first = node.at as usize;
            let leaf = self.triangles[first..first + node.num as usize].iter();
            if leaf.zip(first..).any(|(triangle, i)| is_it(i, triangle)) {
                return true;
            }
        }
        false
    }
}

impl Node {
    /// Whether a ray passes the box.
    fn is_on(&self, ray: &LightRay, inverse: DVec3) -> bool {
        let [a, b] = [self.min, self.max].map(|corner| (corner.as_dvec3() - ray.from) * inverse);
        let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
        // A box without thickness must not be lost to rounding.
        near.max(0.0) <= far.min(ray.distance) + far.abs() * 1e-12
    }
}

impl LightRay {
    /// Whether a triangle lies between the start and the light, by the signs of three volumes.
    fn is_hidden_by(&self, triangle: &[Vec3; 3]) -> bool {
        let [a, b, c] = triangle.map(|corner| corner.as_dvec3() - self.from);
        let normal = (b - a).cross(c - a);
        let towards = self.direction.dot(normal);
        // How far the plane is along the normal, and along the ray.
        let above = a.dot(normal);
        let distance = above / towards;
        // A ray along the plane gives infinity or NaN, which no comparison lets pass.
        if !(distance > 0.0 && distance < self.distance) {
            return false;
        }
        let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| self.direction.dot(p.cross(q)));
        let is_inside = sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0);
        let is_from_behind = (towards > 0.0) != self.is_turned;
        let is_left = is_from_behind && above.abs() <= self.reach * normal.length();
        is_inside && !is_left
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Material, Mesh};

    /// Squares of 2 x 2 that face up, at the heights given.
    fn squares(heights: &[f32]) -> Scene {
        let meshes = heights.iter().map(|y| {
            let corner = |[x, z]: [f32; 2]| Vec3::new(x, *y, z);
            let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(corner);
            Mesh::new(corners.to_vec(), vec![], vec![], vec![[0, 1, 2], [0, 2, 3]])
        });
        let materials = vec![Material::default()];
        Scene { meshes: meshes.collect(), materials, ..Scene::default() }
    }

    fn up(height: f64, reach: f64) -> LightRay {
        let from = DVec3::new(0.3, height, -0.2);
        let direction = DVec3::new(0.1, 1.0, 0.2).normalize();
        LightRay { from, direction, distance: f64::INFINITY, reach, is_turned: false }
    }

    fn hide(occluders: &Occluders, ray: &LightRay) -> bool {
        occluders.hide(ray, None)
    }

    #[test]
    fn what_lies_between_hides() {
        let heights: Vec<f32> = (0..40).map(|i| i as f32 * 0.1).collect();
        let occluders = Occluders::new(&squares(&heights));
        let ray = up(0.95, 0.0);
        assert!(hide(&occluders, &ray));
        assert!(hide(&occluders, &LightRay { distance: 0.06, ..ray }));
        assert!(!hide(&occluders, &LightRay { distance: 0.05, ..ray }), "the light is nearer");
        assert!(!hide(&occluders, &up(4.0, 0.0)), "all lie below");
        let aside = LightRay { from: DVec3::new(1.5, -1.0, 0.0), ..ray };
        assert!(!hide(&occluders, &aside), "it passes beside them");
        assert!(!hide(&Occluders::new(&squares(&[])), &ray));
    }

    #[test]
    fn own_polygon_is_left_from_behind_and_not_from_the_front() {
        let occluders = Occluders::new(&squares(&[0.0]));
        assert!(hide(&occluders, &up(-0.1, 0.05)), "too deep to be its relief");
        assert!(!hide(&occluders, &up(-0.1, 0.11)));
        assert!(hide(&occluders, &LightRay { is_turned: true, ..up(-0.1, 0.11) }));
        let down = |ray: LightRay| LightRay { direction: -ray.direction, ..ray };
        assert!(hide(&occluders, &down(up(0.1, 0.11))));
        assert!(!hide(&occluders, &LightRay { is_turned: true, ..down(up(0.1, 0.11)) }));
    }
}
