//! One prism, seen along a ray, which is the origin.

use glam::DVec2;

/// A triangle with its prism: corner `i` at depth `t` is at `p_i + t o_i`, two numbers across the ray.
pub(super) struct Prism {
    pub(super) triangle: u32,
    pub(super) p: [DVec2; 3],
    pub(super) o: [DVec2; 3],
    pub(super) num_pieces: u32,
}

impl Prism {
    /// `c[0] + c[1] t + c[2] t^2`: above 0 where the ray is on the inner side of the edge from
    /// corner `edge` to the next one, if the triangle is seen from the front.
    #[inline(always)]
    pub(super) fn edge(&self, edge: usize) -> [f64; 3] {
        let (i, j) = (edge, (edge + 1) % 3);
        let ([p, q], [o, r]) = ([self.p[i], self.p[j]], [self.o[i], self.o[j]]);
        [p.perp_dot(q), p.perp_dot(r) + o.perp_dot(q), o.perp_dot(r)]
    }

    /// How far the ray goes down or up (`way`) from depth `t` to where it leaves by an edge;
    /// infinite where it does not. By the edge of its entry it may leave, too.
    #[inline(always)]
    pub(super) fn exit(&self, edge: usize, [t, way, side]: [f64; 3], is_entry: bool) -> f64 {
        let [c0, c1, c2] = self.edge(edge);
        let outer = if is_entry { 0.0 } else { side * way * (c0 + t * (c1 + t * c2)) };
        leaves([outer.max(0.0), side * (c1 + 2.0 * t * c2), side * way * c2], is_entry)
    }

    /// Twice the area at a depth; below 0 where the triangle is seen from behind.
    pub(super) fn area(&self, t: f64) -> f64 {
        let [a, b, c] = [0, 1, 2].map(|i| self.p[i] + self.o[i] * t);
        (b - a).perp_dot(c - a)
    }

    /// The shares of the corners where the ray is at a depth.
    pub(super) fn shares(&self, t: f64) -> [f64; 3] {
        let [a, b, c] = [0, 1, 2].map(|i| self.p[i] + self.o[i] * t);
        let area = (b - a).perp_dot(c - a);
        [b.perp_dot(c) / area, c.perp_dot(a) / area, a.perp_dot(b) / area]
    }

    /// The same where the ray is on an edge, by its length and not by areas: they are 0 where the
    /// triangle is seen edge on.
    pub(super) fn shares_on(&self, edge: usize, t: f64) -> [f64; 3] {
        let (i, j) = (edge, (edge + 1) % 3);
        let [a, b] = [i, j].map(|i| self.p[i] + self.o[i] * t);
        let along = b - a;
        let squared = along.length_squared();
        let part = if squared > 0.0 { (-a.dot(along) / squared).clamp(0.0, 1.0) } else { 0.5 };
        let mut shares = [0.0; 3];
        (shares[i], shares[j]) = (1.0 - part, part);
        shares
    }
}

/// Where `c[0] + c[1] s + c[2] s^2`, at least 0 at 0, goes below 0; from an edge by which the ray
/// came, that is not at once.
#[inline(always)]
fn leaves([c0, c1, c2]: [f64; 3], is_entry: bool) -> f64 {
    if c0 == 0.0 {
        return match c1 < 0.0 || (c1 == 0.0 && c2 < 0.0) {
            true if is_entry => f64::INFINITY,
            true => 0.0,
            false if c2 < 0.0 => -c1 / c2,
            false => f64::INFINITY,
        };
    }
    let discriminant = c1 * c1 - 4.0 * c2 * c0;
    if discriminant < 0.0 {
        return f64::INFINITY;
    }
    // Both roots by the form that does not cancel.
    let root = discriminant.sqrt();
    let q = -0.5 * (c1 + if c1 >= 0.0 { root } else { -root });
    let ahead = |root: f64| if root > 0.0 { root } else { f64::INFINITY };
    ahead(c0 / q).min(ahead(q / c2))
}
