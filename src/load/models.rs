//! tobj's models to meshes with texture coordinates as the materials scale them, normals and
//! tangents.

use super::mtl::{MtlMaterial, TextureRef};
use super::normals;
use crate::scene::{MAX_POSITION, MAX_REPEATS, Mesh};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// One mesh a model, without tangents yet; a model without material gets the index `num_materials`.
pub(super) fn meshes(models: Vec<tobj::Model>, num_materials: usize) -> Vec<Mesh> {
    models.into_par_iter().map(|model| mesh(model, num_materials)).collect()
}

fn mesh(model: tobj::Model, num_materials: usize) -> Mesh {
    let tobj::Model { mesh, name } = model;
    let positions: Vec<Vec3> =
        mesh.positions.as_chunks().0.iter().map(|p| Vec3::from_array(*p)).collect();
    let mut tex_coords: Vec<Vec2> =
        mesh.texcoords.as_chunks().0.iter().map(|t| Vec2::from_array(*t)).collect();
    let mut normals: Vec<Vec3> =
        mesh.normals.as_chunks().0.iter().map(|n| Vec3::from_array(*n)).collect();
    // Models are split where their corners change in what they name; what differs nevertheless
    // cannot be assigned.
    if tex_coords.len() != positions.len() {
        tex_coords.clear();
    }
    if normals.len() != positions.len() {
        normals.clear();
    }
    let triangles = mesh.indices.as_chunks().0.to_vec();
    let material = mesh.material_id.filter(|&i| i < num_materials).unwrap_or(num_materials);
    Mesh { name, material, positions, tex_coords, normals, triangles, ..Mesh::default() }
}

/// Whether a position, coordinate or normal is not finite or too large.
pub(super) fn has_bad_number(mesh: &Mesh) -> bool {
    // A comparison with NaN is false.
    !mesh.positions.iter().all(|p| p.abs().cmple(Vec3::splat(MAX_POSITION)).all())
        || !mesh.tex_coords.iter().all(|t| t.abs().cmple(Vec2::splat(MAX_REPEATS)).all())
        || !mesh.normals.iter().all(|n| n.is_finite())
}

/// Scales texture coordinates, and makes unit normals and tangents.
///
/// # Errors
/// Says which mesh's texture coordinates leave their range.
pub(super) fn finish(
    mut meshes: Vec<Mesh>,
    materials: &[MtlMaterial],
    crease_angle: f32,
) -> Result<Vec<Mesh>, String> {
    meshes.par_iter_mut().for_each(|mesh| {
        let (scale, offset) =
            materials.get(mesh.material).map_or((Vec2::ONE, Vec2::ZERO), placement);
        if (scale, offset) != (Vec2::ONE, Vec2::ZERO) {
            mesh.tex_coords.iter_mut().for_each(|t| *t = *t * scale + offset);
        }
        // Normals that have no direction are made, like missing ones.
        mesh.normals.resize(mesh.positions.len(), Vec3::ZERO);
        mesh.normals.iter_mut().for_each(|normal| *normal = unit_or_zero(*normal));
    });
    if let Some(mesh) = meshes.iter().find(|mesh| has_bad_number(mesh)) {
        return Err(format!("-s or -o moves texture coordinates of '{}' out of range", mesh.name));
    }
    normals::make(&mut meshes, crease_angle)?;
    Ok(meshes.into_par_iter().map(with_tangents).collect())
}

fn with_tangents(mesh: Mesh) -> Mesh {
    let Mesh { name, material, positions, tex_coords, normals, triangles, .. } = mesh;
    Mesh { name, material, ..Mesh::new(positions, tex_coords, normals, triangles) }
}

fn unit_or_zero(normal: Vec3) -> Vec3 {
    // Divided first: the square of a large component would be infinite.
    (normal / normal.abs().max_element()).normalize_or_zero()
}

/// Scale and shift of a material's texture coordinates: those of its colour map, else of its first
/// other map.
fn placement(material: &MtlMaterial) -> (Vec2, Vec2) {
    let first = textures(material).next();
    first.map_or((Vec2::ONE, Vec2::ZERO), |map| {
        (map.texture.scale.into(), map.texture.offset.into())
    })
}

fn textures(material: &MtlMaterial) -> impl Iterator<Item = &TextureRef> {
    let MtlMaterial { albedo, height, bump, normal, .. } = material;
    let MtlMaterial { metallic_map, roughness_map, emissive_map, .. } = material;
    [albedo, height, bump, normal, metallic_map, roughness_map, emissive_map].into_iter().flatten()
}

/// Warns of maps whose own scale and shift are not those that are used.
pub(super) fn remark_placements(materials: &[MtlMaterial], warnings: &mut Vec<String>) {
    for material in materials {
        let Some(first) = textures(material).next() else {
            continue;
        };
        for map in textures(material).skip(1) {
            if (map.texture.scale, map.texture.offset)
                != (first.texture.scale, first.texture.offset)
            {
                let text = format_args!(
                    "-s and -o of {} give way to those of {}",
                    map.keyword, first.keyword
                );
                warnings.push(map.place().remark(text));
            }
        }
    }
}
