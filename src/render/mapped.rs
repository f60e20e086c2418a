//! Surfaces whose colours hold what textures of a material's numbers say.
//!
//! Light that a surface sends out by itself depends on nothing else, and is drawn as a picture of its
//! own: the filter, with tables and all, of a surface in the colours of emission, unlit. What is
//! metal has no diffuse layer: where light meets a curved surface texel by texel, its colours are
//! those of that layer alone.

use crate::filter::Prepared;
use crate::scene::{Finish, Material};
use crate::texture::{Normals, Texture};
use glam::Vec3;
use std::sync::Arc;

/// What is made of a material's textures.
#[derive(Debug)]
pub(crate) struct Mapped {
    /// Light that it sends out.
    pub(crate) glow: Option<Glow>,
    /// What is left of its colours for the diffuse layer.
    pub(crate) diffuse: Option<Prepared>,
}

/// Light that a surface sends out by a texture.
#[derive(Debug)]
pub(crate) struct Glow {
    /// Whose base colour is 1.
    pub(crate) material: Material,
    pub(crate) prepared: Prepared,
}

impl Mapped {
    /// Of a material and its unlit surface.
    pub(crate) fn new(material: &Material, unlit: &Prepared) -> Self {
        let surface = unlit.surface();
        let finish_at = |x, y| texel_finish(material, unlit, [x, y]);
        let has = |map: &Option<Arc<Texture>>| map.is_some();
        let glow = has(&material.maps.emissive).then(|| Glow {
            material: Material { base_color: Vec3::ONE, ..Material::default() },
            prepared: unlit.recolored(
                surface
                    .with_colors(Normals::Dropped, |x, y, _| finish_at(x, y).emissive.to_array()),
            ),
        });
        let diffuse = has(&material.maps.metallic).then(|| {
            unlit.recolored(surface.with_colors(Normals::Kept, |x, y, albedo| {
                albedo.map(|c| c * (1.0 - finish_at(x, y).metallic))
            }))
        });
        Self { glow, diffuse }
    }
}

/// What a material does with light at a texel of its surface.
pub(super) fn texel_finish(material: &Material, unlit: &Prepared, texel: [usize; 2]) -> Finish {
    let texels = unlit.surface().base().texels_per_repeat();
    let [x, y] = [0, 1].map(|i| 1.0 / texels[i]);
    let place = [(texel[0] as f32 + 0.5) * x, (texel[1] as f32 + 0.5) * y];
    material.finish(|map| map.over(place, [[x, 0.0], [0.0, y]]))
}
