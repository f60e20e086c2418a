//! Primitives of meshes to triangles in the world.

use super::document::{Document, Reasoned};
use super::materials::Placement;
use crate::scene::{MAX_POSITION, MAX_REPEATS, Mesh};
use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3, Vec4};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};

/// Where an index breaks a strip or fan into two: none in glTF, but writers know it from OpenGL.
const RESTARTS: [u32; 3] = [0xff, 0xffff, u32::MAX];

/// A primitive, in its mesh or in the world.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// Without tangents; normals that the file does not have are zero.
    pub(super) mesh: Mesh,
    /// Unit tangents of the file, and the sign of `N x T` along `dP/dv`; empty where it has none.
    pub(super) tangents: Vec<Vec4>,
}

impl Document {
    /// The triangles of a mesh's primitives, as they lie in the mesh; `placements` say where the
    /// textures of materials lie, the last of what has none.
    ///
    /// # Errors
    /// Names the mesh, the primitive and what is wrong with it.
    pub(super) fn pieces(
        &mut self,
        index: Index<gltf::json::Mesh>,
        placements: &[Placement],
    ) -> Reasoned<Vec<Piece>> {
        let mesh = self.root.get(index).ok_or_else(|| format!("mesh {index} does not exist"))?;
        let name = mesh.name.clone().unwrap_or_else(|| format!("mesh {index}"));
        let (mut pieces, mut warnings) = (Vec::new(), Vec::new());
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let Some(mode) = triangles_mode(primitive) else {
                warnings.push(format!("mesh {index} has points or lines; left out"));
                continue;
            };
            let piece = self.piece(primitive, mode, placements);
            let mut piece =
                piece.map_err(|reason| format!("mesh {index}, primitive {i}: {reason}"))?;
            piece.mesh.name.clone_from(&name);
            if !piece.mesh.triangles.is_empty() {
                pieces.push(piece);
            }
        }
        warnings.into_iter().for_each(|warning| self.warn(warning));
        Ok(pieces)
    }

    fn piece(
        &self,
        primitive: &Primitive,
        mode: Mode,
        placements: &[Placement],
    ) -> Reasoned<Piece> {
        let get = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let positions = get(Semantic::Positions).ok_or("has no positions")?;
        let positions: Vec<Vec3> =
            self.floats(positions)?.into_iter().map(Vec3::from_array).collect();
        let num = positions.len();
        let triangles = self.triangles(primitive, mode, num)?;
        let material = primitive.material.map_or(placements.len() - 1, |index| index.value());
        let placement = placements.get(material).ok_or("has a material that does not exist")?;
        let tex_coords = get(Semantic::TexCoords(placement.set));
        let tex_coords = self.optional::<2>(tex_coords, num, "texture coordinates")?;
        let tex_coords = tex_coords.into_iter().map(|t| placement.apply(Vec2::from(t))).collect();
        let normals = self.optional::<3>(get(Semantic::Normals), num, "normals")?;
        let normals: Vec<Vec3> = normals.into_iter().map(Vec3::from).collect();
        // Tangents without normals say nothing.
        let tangents = get(Semantic::Tangents).filter(|_| !normals.is_empty());
        let tangents = self.optional::<4>(tangents, num, "tangents")?;
        let tangents = tangents.into_iter().map(Vec4::from).collect();
        let colors = self.colors(get(Semantic::Colors(0)), num)?;
        let mesh =
            Mesh { material, triangles, positions, tex_coords, normals, colors, ..Mesh::default() };
        let mut piece = Piece { mesh, tangents };
        piece.drop_unused();
        Ok(piece)
    }

    /// An attribute of all vertices; empty where the primitive does not have it.
    fn optional<const N: usize>(
        &self,
        accessor: Option<Index<Accessor>>,
        num: usize,
        what: &str,
    ) -> Reasoned<Vec<[f32; N]>> {
        let values = accessor.map_or(Ok(Vec::new()), |accessor| self.floats::<N>(accessor))?;
        if accessor.is_some() && values.len() != num {
            return Err(format!("has {num} positions and {} {what}", values.len()));
        }
        Ok(values)
    }

    /// Linear colours of all vertices, without what they say of opacity.
    fn colors(&self, accessor: Option<Index<Accessor>>, num: usize) -> Reasoned<Vec<Vec3>> {
        let has_opacity = accessor.and_then(|accessor| self.num_components(accessor)) == Some(4);
        let colors: Vec<Vec3> = if has_opacity {
            let colors = self.optional::<4>(accessor, num, "colours")?;
            colors.into_iter().map(|[r, g, b, _]| Vec3::new(r, g, b)).collect()
        } else {
            self.optional::<3>(accessor, num, "colours")?.into_iter().map(Vec3::from).collect()
        };
        // `max` and `min` of a number and NaN are the number.
        Ok(colors.into_iter().map(|color| color.max(Vec3::ZERO).min(Vec3::splat(1e6))).collect())
    }

    fn triangles(
        &self,
        primitive: &Primitive,
        mode: Mode,
        num_vertices: usize,
    ) -> Reasoned<Vec<[u32; 3]>> {
        let num = u32::try_from(num_vertices).map_err(|_| "has too many vertices")?;
        let indices: Vec<u32> = match primitive.indices {
            Some(accessor) => self.integers::<1>(accessor)?.into_iter().map(|[i]| i).collect(),
            None => (0..num).collect(),
        };
        if let Some(index) = indices.iter().find(|&&i| i >= num) {
            let hint = if RESTARTS.contains(index) { " (glTF has no restarts)" } else { "" };
            return Err(format!("has index {index} of {num} vertices{hint}"));
        }
        Ok(match mode {
            // Every other triangle of a strip is turned over.
            Mode::TriangleStrip => indices
                .windows(3)
                .enumerate()
                .map(|(i, t)| if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] })
                .collect(),
            Mode::TriangleFan => {
                let rim = indices.get(1..).unwrap_or_default();
                rim.windows(2).map(|t| [indices[0], t[0], t[1]]).collect()
            }
            _ => indices.as_chunks().0.to_vec(),
        })
    }
}

/// How a primitive's triangles are listed; `None` for points and lines.
fn triangles_mode(primitive: &Primitive) -> Option<Mode> {
    match primitive.mode {
        Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => {
            Some(mode)
        }
        _ => None,
    }
}

impl Piece {
    /// Leaves out vertices of no triangle: many primitives may share one large list.
    fn drop_unused(&mut self) {
        let Self { mesh, tangents } = self;
        if mesh.triangles.len() * 3 >= mesh.positions.len() {
            return;
        }
        const UNUSED: u32 = u32::MAX;
        let mut new_of_old = vec![UNUSED; mesh.positions.len()];
        let mut old_of_new = Vec::new();
        for index in mesh.triangles.as_flattened_mut() {
            let new = &mut new_of_old[*index as usize];
            if *new == UNUSED {
                *new = old_of_new.len() as u32;
                old_of_new.push(*index as usize);
            }
            *index = *new;
        }
        keep(&mut mesh.positions, &old_of_new);
        keep(&mut mesh.tex_coords, &old_of_new);
        keep(&mut mesh.normals, &old_of_new);
        keep(&mut mesh.colors, &old_of_new);
        keep(tangents, &old_of_new);
    }

    /// The piece at a place in the world.
    ///
    /// # Errors
    /// Says which of its numbers are out of range there.
    pub(super) fn placed(&self, to_world: &DAffine3) -> Reasoned<Self> {
        let mut piece = self.clone();
        piece.move_to(to_world);
        piece.check()?;
        Ok(piece)
    }

    fn move_to(&mut self, to_world: &DAffine3) {
        let Self { mesh, tangents } = self;
        let linear = to_world.matrix3;
        for position in &mut mesh.positions {
            *position = to_world.transform_point3(position.as_dvec3()).as_vec3();
        }
        let flip = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
        let of_normals = cofactors(&linear) * flip;
        for normal in &mut mesh.normals {
            *normal = unit_or_zero(of_normals * normal.as_dvec3());
        }
        // Normals that the file does not have are made, like those that have no direction.
        mesh.normals.resize(mesh.positions.len(), Vec3::ZERO);
        for tangent in tangents {
            let axis = unit_or_zero(linear * tangent.truncate().as_dvec3());
            *tangent = axis.extend(tangent.w * flip as f32);
        }
        if flip < 0.0 {
            mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
    }

    fn check(&self) -> Reasoned<()> {
        let mesh = &self.mesh;
        // A comparison with NaN is false.
        if !mesh.positions.iter().all(|p| p.abs().cmple(Vec3::splat(MAX_POSITION)).all()) {
            return Err("has a position that is not finite or beyond 1e18".into());
        }
        if !mesh.tex_coords.iter().all(|t| t.abs().cmple(Vec2::splat(MAX_REPEATS)).all()) {
            return Err("has texture coordinates that are not finite or beyond 1e6".into());
        }
        Ok(())
    }
}

fn keep<T: Copy>(values: &mut Vec<T>, kept: &[usize]) {
    if !values.is_empty() {
        *values = kept.iter().map(|&i| values[i]).collect();
    }
}

/// What turns normals as a matrix turns surfaces, but for its sign and length.
fn cofactors(m: &DMat3) -> DMat3 {
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y))
}

fn unit_or_zero(vector: DVec3) -> Vec3 {
    // Divided first: the square of a large component would be infinite.
    let largest = vector.abs().max_element();
    (vector / largest).try_normalize().map_or(Vec3::ZERO, |unit| unit.as_vec3())
}
