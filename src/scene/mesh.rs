//! Triangles with positions, texture coordinates, normals and tangent frames.
//!
//! The frame of a vertex is unnormalised: `dP/du`, `dP/dv` in world units per texture repeat, averaged over the
//! triangles around it by area, and the unit normal. Mirrored texture coordinates keep their own handedness; a
//! triangle without area, in space or in the texture, adds nothing to the average.

use glam::{Vec2, Vec3};

/// Triangles of one material.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Its name, for messages.
    pub name: String,
    /// Index into [`Scene::materials`](crate::Scene).
    pub material: usize,
    /// Vertex indices, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// World units.
    pub positions: Vec<Vec3>,
    /// One per position in texture repeats, v upwards; empty: drawn in the material's plain colour.
    pub tex_coords: Vec<Vec2>,
    /// One unit vector per position.
    pub normals: Vec<Vec3>,
    /// `dP/du` and `dP/dv`, one pair per position where there are texture coordinates, else empty.
    pub tangents: Vec<[Vec3; 2]>,
}

impl Mesh {
    /// A mesh from its triangles; makes normals (area-weighted) where `normals` is empty, and tangents always.
    #[must_use]
    pub fn new(positions: Vec<Vec3>, tex_coords: Vec<Vec2>, normals: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self {
        let mut mesh = Self { positions, tex_coords, normals, triangles, ..Self::default() };
        if mesh.normals.is_empty() {
            mesh.normals = mesh.area_weighted_normals();
        }
        mesh.tangents = mesh.area_weighted_tangents();
        mesh
    }

    fn corners(&self, triangle: [u32; 3]) -> [Vec3; 3] {
        triangle.map(|i| self.positions[i as usize])
    }

    fn area_weighted_normals(&self) -> Vec<Vec3> {
        let mut sums = vec![Vec3::ZERO; self.positions.len()];
        for &triangle in &self.triangles {
            let [a, b, c] = self.corners(triangle);
            let twice_area = (b - a).cross(c - a);
            triangle.iter().for_each(|&i| sums[i as usize] += twice_area);
        }
        sums.into_iter().map(|sum| sum.try_normalize().unwrap_or(Vec3::Y)).collect()
    }

    fn area_weighted_tangents(&self) -> Vec<[Vec3; 2]> {
        let mut sums = vec![([Vec3::ZERO; 2], 0.0_f32); self.tex_coords.len()];
        for &triangle in self.triangles.iter().filter(|_| !self.tex_coords.is_empty()) {
            let [a, b, c] = self.corners(triangle);
            let [ta, tb, tc] = triangle.map(|i| self.tex_coords[i as usize]);
            let (e1, e2, t1, t2) = (b - a, c - a, tb - ta, tc - ta);
            let (area_uv, area) = (t1.perp_dot(t2), e1.cross(e2).length());
            let frame = [(e1 * t2.y - e2 * t1.y) / area_uv, (e2 * t1.x - e1 * t2.x) / area_uv];
            if area > 0.0 && frame.iter().all(|axis| (*axis * area).is_finite()) {
                for &i in &triangle {
                    let (axes, weight) = &mut sums[i as usize];
                    *axes = [axes[0] + frame[0] * area, axes[1] + frame[1] * area];
                    *weight += area;
                }
            }
        }
        let frames = sums.into_iter().zip(&self.normals);
        frames.map(|((axes, weight), normal)| average_frame(axes, weight, *normal)).collect()
    }

    pub(crate) fn validate(&self, num_materials: usize) -> Result<(), String> {
        let num = self.positions.len();
        if self.material >= num_materials {
            return Err(format!("material {} of {num_materials} does not exist", self.material));
        }
        if self.normals.len() != num || ![0, num].contains(&self.tex_coords.len()) {
            return Err(format!("{num} positions need as many normals, and as many texture coordinates or none"));
        }
        if self.tangents.len() != self.tex_coords.len() {
            return Err("tangents are missing; Mesh::new makes them".into());
        }
        if let Some(triangle) = self.triangles.iter().find(|t| t.iter().any(|&i| i as usize >= num)) {
            return Err(format!("triangle {triangle:?} names a vertex of {num} that does not exist"));
        }
        let bounded = |v: &Vec3| v.abs().max_element() <= 1e18;
        if !self.positions.iter().all(bounded) || !self.normals.iter().all(bounded) {
            return Err("positions and normals must be finite and within 1e18".into());
        }
        if !self.tex_coords.iter().all(|t| t.abs().max_element() <= 1e6) {
            return Err("texture coordinates must be finite and within 1e6 repeats".into());
        }
        Ok(())
    }
}

/// The area-weighted mean of tangents, or any frame around the normal where the texture gives none.
fn average_frame([u, v]: [Vec3; 2], weight: f32, normal: Vec3) -> [Vec3; 2] {
    let (u, v) = (u / weight, v / weight);
    let area = u.cross(v).length();
    if area.is_finite() && area > 1e-6 * u.length() * v.length() && area > 1e-30 {
        [u, v]
    } else {
        let (u, v) = normal.normalize_or(Vec3::Y).any_orthonormal_pair();
        [u, v]
    }
}
