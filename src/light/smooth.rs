//! Triangles that stand for a smooth surface.
//!
//! Interpolated normals turn smoothly where the triangles do not. Towards a low sun the normal still
//! faces it where the triangle turns away, and a shadow would end in steps at its edges. So light is
//! met a little above, on the planes that the corners' normals stand on, as far as they lie above the
//! triangle (Hanika 2021, "Hacking the Shadow Terminator").
//!
//! ```text
//!              . - * - .           * where light is met
//!         n  /     |     \  n
//!          \ ------o------ /       o the place on the triangle
//! ```

use crate::scene::Scene;
use glam::Vec3;

/// A triangle of a mesh and the normals at its corners.
#[derive(Clone, Copy, Debug)]
pub struct SmoothTriangle {
    corners: [Vec3; 3],
    /// Unit normals on the front.
    normals: [Vec3; 3],
}

impl SmoothTriangle {
    /// A triangle of a scene, by the index of its mesh and in it.
    pub fn new(scene: &Scene, [mesh, triangle]: [u32; 2]) -> Self {
        let mesh = &scene.meshes[mesh as usize];
        let corners = mesh.triangles[triangle as usize].map(|i| i as usize);
        Self {
            corners: corners.map(|i| mesh.positions[i]),
            normals: corners.map(|i| mesh.normals[i].normalize_or_zero()),
        }
    }

    /// The way from a place on it to where light meets it, on its front or on its back.
    pub fn lift(&self, place: Vec3, is_back: bool) -> Vec3 {
        let shares = shares(self.corners, place);
        (0..3).fold(Vec3::ZERO, |sum, i| {
            let normal = if is_back { -self.normals[i] } else { self.normals[i] };
            let below = (self.corners[i] - place).dot(normal).max(0.0);
            sum + normal * (below * shares[i])
        })
    }
}

/// The shares of a triangle's corners in a place on it.
pub(crate) fn shares([a, b, c]: [Vec3; 3], place: Vec3) -> [f32; 3] {
    let normal = (b - a).cross(c - a);
    let scale = 1.0 / normal.length_squared().max(f32::MIN_POSITIVE);
    let share = |p: Vec3, q: Vec3| (p - place).cross(q - place).dot(normal) * scale;
    // A pixel's centre may lie beside its triangle.
    let of = [share(b, c), share(c, a), share(a, b)].map(|share| share.clamp(0.0, 1.0));
    let sum = (of[0] + of[1] + of[2]).max(f32::MIN_POSITIVE);
    of.map(|share| share / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner_of_a_ball(radius: f32) -> SmoothTriangle {
        let normals =
            [Vec3::new(0.1, 0.0, 1.0), Vec3::new(-0.1, 0.1, 1.0), Vec3::new(0.0, -0.1, 1.0)];
        let normals = normals.map(Vec3::normalize);
        SmoothTriangle { corners: normals.map(|normal| normal * radius), normals }
    }

    #[test]
    fn light_meets_a_ball_near_its_surface() {
        for radius in [1.0, 7.0] {
            let ball = corner_of_a_ball(radius);
            let [a, b, c] = ball.corners;
            for shares in [[1.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.4, 0.3, 0.3], [0.1, 0.2, 0.7]] {
                let place = a * shares[0] + b * shares[1] + c * shares[2];
                let lifted = place + ball.lift(place, false);
                // Planes that touch the ball lie outside of it, by no more than it bulges itself.
                let (depth, above) = (radius - place.length(), lifted.length() - radius);
                assert!(
                    above > -1e-5 * radius && above <= depth + 1e-5 * radius,
                    "{depth} {above}"
                );
                assert!(ball.lift(place, true).length() < 1e-6 * radius, "hollow from behind");
                let found = super::shares(ball.corners, place);
                assert!((0..3).all(|i| (found[i] - shares[i]).abs() < 1e-4), "{found:?}");
            }
        }
    }
}
