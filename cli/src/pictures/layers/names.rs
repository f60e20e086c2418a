//! What the numbers in layers of names stand for.

use crate::refusal::Refusal;
use basrelief::Scene;
use serde::Serialize;

/// The names of a scene; the number of each is its place in the list.
#[derive(Serialize)]
struct Names<'a> {
    objects: Vec<Object<'a>>,
    materials: Vec<&'a str>,
}

#[derive(Serialize)]
struct Object<'a> {
    name: &'a str,
    /// The number of its material.
    material: usize,
    /// How many triangles it has.
    triangles: usize,
}

/// The JSON file of a scene's names.
pub(crate) fn names(scene: &Scene) -> Result<Vec<u8>, Refusal> {
    let objects = scene.meshes.iter().map(|mesh| Object {
        name: &mesh.name,
        material: mesh.material,
        triangles: mesh.triangles.len(),
    });
    let materials = scene.materials.iter().map(|material| material.name.as_str()).collect();
    let mut text = serde_json::to_vec_pretty(&Names { objects: objects.collect(), materials })
        .map_err(|e| Refusal::from(format!("--layer-names: {e}")))?;
    text.push(b'\n');
    Ok(text)
}
