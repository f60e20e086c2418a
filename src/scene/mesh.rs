//! Triangles with positions, texture coordinates, normals and tangent frames.
//!
//! The frame of a vertex is unnormalised: `dP/du`, `dP/dv` in world units per texture repeat,
//! averaged over the triangles around it by area, and the unit normal. Mirrored texture coordinates
//! keep their own handedness; a triangle without area, in space or in the texture, adds nothing to
//! the average.

use super::light::is_light;
use crate::error::{Error, Result};
use glam::{DVec3, Vec2, Vec3};

/// Largest component of a position: products of larger ones leave the range of f32.
pub(crate) const MAX_POSITION: f32 = 1e18;
/// Largest texture coordinate in repeats: f32 has no texels left beyond.
pub(crate) const MAX_REPEATS: f32 = 1e6;

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
    /// Linear RGB, 0 to 1e6, one per position, that multiplies the material's base colour; empty:
    /// white.
    pub colors: Vec<Vec3>,
    /// `dP/du` and `dP/dv`, one pair per position where there are texture coordinates, else empty.
    pub tangents: Vec<[Vec3; 2]>,
}

impl Mesh {
    /// A mesh from its triangles; makes normals (area-weighted) where `normals` is empty, and
    /// tangents always. Triangles that name vertices that do not exist add nothing to either; the
    /// renderer refuses them.
    pub fn new(
        positions: Vec<Vec3>,
        tex_coords: Vec<Vec2>,
        normals: Vec<Vec3>,
        triangles: Vec<[u32; 3]>,
    ) -> Self {
        let mut mesh = Self { positions, tex_coords, normals, triangles, ..Self::default() };
        if mesh.normals.is_empty() {
            mesh.normals = mesh.area_weighted_normals();
        }
        mesh.tangents = mesh.area_weighted_tangents();
        mesh
    }

    /// The mesh moved by an affine matrix, row by row, which may turn, move, stretch and shear; into
    /// another mesh, whose memory is taken again.
    ///
    /// # Errors
    /// Says so where the matrix is not finite, not affine, flat, or mirrors.
    pub fn place(&self, matrix: &[[f32; 4]; 4], into: &mut Self) -> Result<()> {
        let refuse = |reason: &str| Err(Error::scene("transform", reason));
        let [x, y, z, origin] =
            [0, 1, 2, 3].map(|column| DVec3::from([0, 1, 2].map(|i| f64::from(matrix[i][column]))));
        if matrix[3] != [0.0, 0.0, 0.0, 1.0] || ![x, y, z, origin].iter().all(|v| v.is_finite()) {
            return refuse("its last row must be 0, 0, 0, 1, and all numbers finite");
        }
        // Normals go with the planes that they stand on: by the cofactors.
        let normals = [y.cross(z), z.cross(x), x.cross(y)];
        if x.dot(normals[0]) <= 0.0 {
            return refuse("it must not mirror or flatten: its determinant must be above 0");
        }
        let along = |[x, y, z]: [DVec3; 3], v: Vec3| {
            let v = v.as_dvec3();
            x * v.x + y * v.y + z * v.z
        };
        let direction = |v: Vec3| along([x, y, z], v).as_vec3();
        // As long as it was, so that what stays in place keeps its bits.
        let normal = |n: &Vec3| {
            let turned = along(normals, *n);
            (turned * (n.as_dvec3().length() / turned.length())).as_vec3()
        };
        let Self { name, material, triangles, positions, tex_coords, normals: own, .. } = self;
        let Self { tangents, colors, .. } = self;
        into.name.clone_from(name);
        into.material = *material;
        into.triangles.clone_from(triangles);
        into.tex_coords.clone_from(tex_coords);
        into.colors.clone_from(colors);
        into.positions.clear();
        into.positions.extend(positions.iter().map(|p| (along([x, y, z], *p) + origin).as_vec3()));
        into.normals.clear();
        into.normals.extend(own.iter().map(normal));
        into.tangents.clear();
        into.tangents.extend(tangents.iter().map(|axes| axes.map(direction)));
        Ok(())
    }

    /// Corners in f64: products of the largest and smallest positions allowed leave the range of
    /// f32.
    fn corners(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        triangle.map(|i| self.positions[i as usize].as_dvec3())
    }

    /// The triangles whose corners all have an index below `num`.
    fn triangles_within(&self, num: usize) -> impl Iterator<Item = [u32; 3]> {
        self.triangles
            .iter()
            .copied()
            .filter(move |triangle| triangle.iter().all(|&i| (i as usize) < num))
    }

    fn area_weighted_normals(&self) -> Vec<Vec3> {
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for triangle in self.triangles_within(self.positions.len()) {
            let [a, b, c] = self.corners(triangle);
            let twice_area = (b - a).cross(c - a);
            triangle.iter().for_each(|&i| sums[i as usize] += twice_area);
        }
        sums.into_iter().map(|sum| sum.try_normalize().map_or(Vec3::Y, |n| n.as_vec3())).collect()
    }

    fn area_weighted_tangents(&self) -> Vec<[Vec3; 2]> {
        let mut sums = vec![([DVec3::ZERO; 2], 0.0_f64); self.tex_coords.len()];
        for triangle in self.triangles_within(self.positions.len().min(self.tex_coords.len())) {
            let [a, b, c] = self.corners(triangle);
            let [ta, tb, tc] = triangle.map(|i| self.tex_coords[i as usize].as_dvec2());
            let (e1, e2, t1, t2) = (b - a, c - a, tb - ta, tc - ta);
            let (area_uv, area) = (t1.perp_dot(t2), e1.cross(e2).length());
            let frame = [(e1 * t2.y - e2 * t1.y) / area_uv, (e2 * t1.x - e1 * t2.x) / area_uv];
            if area > 0.0 && frame.iter().all(|axis| (*axis * area).is_finite()) {
                for i in triangle {
                    let (axes, weight) = &mut sums[i as usize];
                    *axes = [axes[0] + frame[0] * area, axes[1] + frame[1] * area];
                    *weight += area;
                }
            }
        }
        let frames = sums.into_iter().zip(&self.normals);
        frames.map(|((axes, weight), normal)| average_frame(axes, weight, *normal)).collect()
    }

    pub(crate) fn validate(&self, num_materials: usize) -> std::result::Result<(), String> {
        let num = self.positions.len();
        if self.material >= num_materials {
            return Err(format!("material {} of {num_materials} does not exist", self.material));
        }
        if self.normals.len() != num || ![0, num].contains(&self.tex_coords.len()) {
            return Err(format!(
                "{num} positions need as many normals, and as many texture coordinates or none"
            ));
        }
        if ![0, num].contains(&self.colors.len()) {
            return Err(format!("{num} positions need as many colours, or none"));
        }
        if !self.colors.iter().all(|color| is_light(*color)) {
            return Err("colours must be within 0 to 1e6".into());
        }
        if self.tangents.len() != self.tex_coords.len() {
            return Err("tangents are missing; Mesh::new makes them".into());
        }
        if let Some(triangle) = self.triangles.iter().find(|t| t.iter().any(|&i| i as usize >= num))
        {
            return Err(format!(
                "triangle {triangle:?} names a vertex of {num} that does not exist"
            ));
        }
        // Compared by component: the largest component of a vector with NaN need not be NaN.
        let is_bounded = |v: &Vec3| v.abs().cmple(Vec3::splat(MAX_POSITION)).all();
        if !self.positions.iter().all(is_bounded) || !self.normals.iter().all(is_bounded) {
            return Err("positions and normals must be finite and within 1e18".into());
        }
        if !self.tangents.iter().flatten().all(|axis| axis.is_finite()) {
            return Err("tangents must be finite".into());
        }
        if !self.tex_coords.iter().all(|t| t.abs().cmple(Vec2::splat(MAX_REPEATS)).all()) {
            return Err("texture coordinates must be finite and within 1e6 repeats".into());
        }
        Ok(())
    }
}

/// The area-weighted mean of tangents, or any frame around the normal where the texture gives none.
fn average_frame([u, v]: [DVec3; 2], weight: f64, normal: Vec3) -> [Vec3; 2] {
    let (u, v) = (u / weight, v / weight);
    let area = u.cross(v).length();
    let axes = [u.as_vec3(), v.as_vec3()];
    // Axes this close to parallel come from rounding, not from the mesh.
    if area > 1e-6 * u.length() * v.length()
        && axes.iter().all(|axis| axis.is_finite() && *axis != Vec3::ZERO)
    {
        axes
    } else {
        let (u, v) = normal.normalize_or(Vec3::Y).any_orthonormal_pair();
        [u, v]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Vec3; 4] = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];

    fn square(tex_coords: [Vec2; 4], triangles: &[[u32; 3]]) -> Mesh {
        Mesh::new(SQUARE.to_vec(), tex_coords.to_vec(), Vec::new(), triangles.to_vec())
    }

    #[test]
    fn tangents_are_world_units_per_repeat() {
        let coords = SQUARE.map(|p| Vec2::new(p.x * 4.0, p.y * 0.5));
        let mesh = square(coords, &[[0, 1, 2], [0, 2, 3]]);
        assert!(mesh.tangents.iter().all(|t| *t == [Vec3::X * 0.25, Vec3::Y * 2.0]));
    }

    #[test]
    fn mirrored_coordinates_keep_their_handedness() {
        let mesh = square(SQUARE.map(|p| Vec2::new(-p.x, p.y)), &[[0, 1, 2], [0, 2, 3]]);
        assert!(mesh.tangents.iter().all(|t| *t == [Vec3::NEG_X, Vec3::Y]));
    }

    #[test]
    fn triangles_without_area_add_nothing() {
        let good = [[0, 1, 2], [0, 2, 3]];
        let mesh = square(SQUARE.map(|p| p.truncate()), &[good[0], good[1], [0, 0, 1], [2, 2, 2]]);
        assert!(mesh.tangents.iter().all(|t| *t == [Vec3::X, Vec3::Y]));
        assert!(mesh.normals.iter().all(|n| *n == Vec3::Z));
        let mut flat = SQUARE.map(|p| p.truncate());
        flat[3] = Vec2::ZERO;
        let mesh = square(flat, &good);
        assert_eq!(
            mesh.tangents[1],
            [Vec3::X, Vec3::Y],
            "the second triangle has no area in the texture"
        );
    }

    #[test]
    fn where_the_texture_gives_no_frame_any_finite_one_serves() {
        for (scale, coords) in
            [(1.0, [Vec2::ZERO; 4]), (0.0, [Vec2::ONE; 4]), (-1.0, [Vec2::ZERO; 4])]
        {
            let positions = SQUARE.map(|p| p * scale).to_vec();
            let mesh =
                Mesh::new(positions, coords.to_vec(), Vec::new(), vec![[0, 1, 2], [0, 2, 3]]);
            for ([u, v], n) in mesh.tangents.iter().zip(&mesh.normals) {
                assert!(u.is_finite() && v.is_finite() && n.is_normalized(), "scale {scale}");
                assert!(
                    u.normalize().cross(v.normalize()).dot(*n) > 0.9,
                    "scale {scale}: {u} {v} {n}"
                );
            }
        }
    }

    #[test]
    fn frames_of_huge_and_tiny_meshes_are_exact() {
        for scale in [1e18, 1e-18] {
            let (positions, coords) =
                (SQUARE.map(|p| p * scale).to_vec(), SQUARE.map(|p| p.truncate()).to_vec());
            let mesh = Mesh::new(positions, coords, Vec::new(), vec![[0, 1, 2], [0, 2, 3]]);
            assert!(
                mesh.tangents.iter().all(|t| *t == [Vec3::X * scale, Vec3::Y * scale]),
                "scale {scale}"
            );
            assert!(mesh.normals.iter().all(|n| *n == Vec3::Z), "scale {scale}");
        }
    }

    #[test]
    fn wrong_lengths_and_indices_are_refused() {
        let short = Mesh::new(
            SQUARE.to_vec(),
            vec![Vec2::ZERO; 2],
            vec![Vec3::Z; 3],
            vec![[0, 1, 2], [1, 2, u32::MAX]],
        );
        assert!(short.validate(1).is_err());
        let valid = square(SQUARE.map(|p| p.truncate()), &[[0, 1, 2]]);
        assert!(valid.validate(1).is_ok());
        assert!(valid.validate(0).is_err());
        let with = |change: fn(&mut Mesh)| {
            let mut mesh = valid.clone();
            change(&mut mesh);
            mesh.validate(1)
        };
        assert!(with(|m| m.triangles[0][1] = 4).is_err());
        assert!(with(|m| m.normals.clear()).is_err());
        assert!(with(|m| m.tangents.clear()).is_err());
        assert!(with(|m| m.colors = vec![Vec3::ONE; 3]).is_err());
        assert!(with(|m| m.colors = vec![Vec3::NEG_ONE; 4]).is_err());
        assert!(with(|m| m.positions[0].x = f32::NAN).is_err());
        assert!(with(|m| m.tex_coords[0].y = f32::INFINITY).is_err());
    }
}
