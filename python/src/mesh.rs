//! Triangles of one material.

use crate::arguments::{mistyped, places, points, refused, triangles};
use crate::material::Material;
use crate::pickles::{Made, array, made};
use glam::Vec3;
use pyo3::prelude::*;

/// Triangles of one material.
///
/// Mesh(vertices, faces, uv=None, normals=None, material=None, name="",
///     colors=None)
///
/// vertices: (N, 3) numbers, world units.
/// faces: (M, 3) whole numbers, indices of vertices, counter-clockwise seen from the front.
/// uv: (N, 2), texture coordinates in repeats, v upwards. Without them the material's plain colour
///     is drawn.
/// normals: (N, 3), unit vectors; made from the faces where there are none.
/// material: a Material; without one it is white.
/// colors: (N, 3), linear, 0 to 1e6: what multiplies the material's colour at each vertex.
#[pyclass(frozen, module = "basrelief")]
#[derive(Debug)]
pub(crate) struct Mesh {
    pub(crate) mesh: basrelief::Mesh,
    pub(crate) material: Option<Py<Material>>,
}

#[pymethods]
impl Mesh {
    #[new]
    #[pyo3(signature = (vertices, faces, uv = None, normals = None, material = None, name = "",
        colors = None))]
    fn new(
        py: Python<'_>,
        vertices: &Bound<'_, PyAny>,
        faces: &Bound<'_, PyAny>,
        uv: Option<&Bound<'_, PyAny>>,
        normals: Option<&Bound<'_, PyAny>>,
        material: Option<&Bound<'_, PyAny>>,
        name: &str,
        colors: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let material = material.map(|arg| arg.cast::<Material>().map(|m| m.clone().unbind()));
        let material =
            material.transpose().map_err(|_| mistyped("material", "must be a Material"))?;
        let positions = points(vertices, "vertices")?;
        let num = positions.len();
        let triangles = triangles(faces, "faces", num)?;
        let tex_coords = uv.map_or(Ok(Vec::new()), |uv| places(uv, "uv"))?;
        let normals = normals.map_or(Ok(Vec::new()), |normals| points(normals, "normals"))?;
        let colors = colors.map_or(Ok(Vec::new()), |colors| points(colors, "colors"))?;
        let given = [tex_coords.len(), normals.len(), colors.len()];
        for (name, len) in ["uv", "normals", "colors"].into_iter().zip(given) {
            if ![0, num].contains(&len) {
                return Err(refused(name, format!("has {len} rows for {num} vertices")));
            }
        }
        let mut mesh =
            py.detach(|| basrelief::Mesh::new(positions, tex_coords, normals, triangles));
        mesh.name = name.into();
        mesh.colors = colors;
        Ok(Self { mesh, material })
    }

    #[getter]
    fn name(&self) -> &str {
        &self.mesh.name
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py>> {
        let basrelief::Mesh { name, triangles, positions, tex_coords, normals, colors, .. } =
            &self.mesh;
        let rows = |rows: &[Vec3]| {
            array(py, rows.iter().flat_map(|v| v.to_array()).collect(), &[rows.len(), 3])
        };
        let uv = (!tex_coords.is_empty()).then(|| {
            let numbers = tex_coords.iter().flat_map(|v| v.to_array()).collect();
            array(py, numbers, &[tex_coords.len(), 2])
        });
        let colors = (!colors.is_empty()).then(|| rows(colors));
        let faces = array(py, triangles.as_flattened().to_vec(), &[triangles.len(), 3])?;
        let material = self.material.as_ref().map(|material| material.clone_ref(py));
        let (uv, colors) = (uv.transpose()?, colors.transpose()?);
        made::<Self>(py, (rows(positions)?, faces, uv, rows(normals)?, material, name, colors))
    }

    fn __repr__(&self) -> String {
        let [num_vertices, num_faces] = [self.mesh.positions.len(), self.mesh.triangles.len()];
        let name = self.mesh.name.escape_debug();
        format!("<Mesh \"{name}\", {num_vertices} vertices, {num_faces} faces>")
    }
}
