//! Surfaces whose colours hold what textures of a material's numbers say.
//!
//! Light that a surface sends out by itself depends on nothing else, and is drawn as a picture of its
//! own: the filter, with tables and all, of a surface in the colours of emission, unlit. What is
//! metal has no diffuse layer: where light meets a curved surface texel by texel, its colours are
//! those of that layer alone.

use crate::filter::Prepared;
use crate::light::reflection::{Fresnel, Reflectance, alpha};
use crate::light::{Layer, Luster, SkyShares, rough_length};
use crate::scene::{Finish, Material, MaterialMaps, Sky};
use crate::texture::{Normals, Surface, Texture};
use glam::Vec3;
use std::sync::{Arc, OnceLock};

/// What is made of a material's textures.
#[derive(Debug)]
pub(crate) struct Mapped {
    /// Light that it sends out.
    pub(crate) glow: Option<Glow>,
    /// What is left of its colours for the diffuse layer.
    pub(crate) diffuse: Option<Prepared>,
    /// What it reflects, made where highlights are swept as diffuse light is.
    pub(crate) gloss: OnceLock<MappedGloss>,
}

/// Light that a surface sends out by a texture.
#[derive(Debug)]
pub(crate) struct Glow {
    /// Whose base colour is 1.
    pub(crate) material: Material,
    pub(crate) prepared: Prepared,
}

/// What a surface reflects of light that comes straight.
#[derive(Debug)]
pub(crate) struct MappedGloss {
    /// Whose base colour is 1.
    pub(crate) material: Material,
    pub(crate) prepared: Prepared,
    pub(crate) luster: Luster,
    /// What its diffuse layer is seen through.
    pub(crate) layer: Layer,
    /// Whether what texels reflect of the sky is better than what their mean does.
    pub(crate) shows_sky: bool,
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
        Self { glow, diffuse, gloss: OnceLock::new() }
    }

    /// Makes what a glossy surface with relief reflects.
    pub(crate) fn make_glossy(
        &self,
        (material, unlit): (&Material, &Prepared),
        (sky, reflectance): (&Sky, &Reflectance),
    ) {
        if material.is_matte() || !unlit.has_relief() {
            return;
        }
        self.gloss.get_or_init(|| {
            let reflecting = reflecting(material, unlit, |_, _| 1.0);
            let (roughness, grazing) = mean_finish(material, unlit);
            let luster = Luster {
                alpha_squared: own_roughness(material).map(|r| alpha(r) * alpha(r)),
                grazing,
                color_scale: reflecting.color_scale(),
                sky: SkyShares::new((roughness, grazing), reflectance),
            };
            let occlusion = material.maps.occlusion.clone();
            let maps = MaterialMaps { occlusion, ..MaterialMaps::default() };
            MappedGloss {
                material: Material { base_color: Vec3::ONE, maps, ..Material::default() },
                prepared: unlit.recolored(reflecting),
                luster,
                layer: layer(material, unlit, reflectance),
                shows_sky: scatters(unlit.surface(), sky),
            }
        });
    }
}

/// What lies above a material's diffuse layer: each texel that is seen hides as much as its own normal says.
pub(super) fn layer(material: &Material, unlit: &Prepared, reflectance: &Reflectance) -> Layer {
    let (roughness, _) = mean_finish(material, unlit);
    let of = Fresnel::of_dielectric(&texel_finish(material, unlit, [0, 0]));
    let shares = SkyShares::new((roughness, of.grazing), reflectance);
    Layer { shares, straight: of.straight.x }
}

/// The roughness of a material, unless its texels have their own.
pub(super) fn own_roughness(material: &Material) -> Option<f32> {
    material.maps.roughness.is_none().then_some(material.roughness)
}

/// A surface with what it reflects of light that comes straight, of which a part gets to each texel, for its
/// colours. Where its roughness has a texture, normals get a length that says it.
pub(super) fn reflecting(
    material: &Material,
    unlit: &Prepared,
    part: impl Fn(usize, usize) -> f32 + Sync,
) -> Surface {
    let finish = |x, y| texel_finish(material, unlit, [x, y]);
    let length = |x, y| rough_length(finish(x, y).roughness);
    let is_even = own_roughness(material).is_some();
    let normals = if is_even { Normals::Kept } else { Normals::Scaled(&length) };
    unlit.surface().with_colors(normals, |x, y, albedo| {
        let base = Vec3::from(albedo) * material.base_color;
        (Fresnel::new(&finish(x, y), base).straight * part(x, y)).to_array()
    })
}

/// What a material does with light at a texel of its surface.
pub(super) fn texel_finish(material: &Material, unlit: &Prepared, texel: [usize; 2]) -> Finish {
    let texels = unlit.surface().base().texels_per_repeat();
    let [x, y] = [0, 1].map(|i| 1.0 / texels[i]);
    let place = [(texel[0] as f32 + 0.5) * x, (texel[1] as f32 + 0.5) * y];
    material.finish(|map| map.over(place, [[x, 0.0], [0.0, y]]))
}

/// Whether what the texels of a surface reflect of a sky says more than what their mean does: of a
/// picture they see the light around a direction alone, so a nearly flat mirror is better off without.
pub(super) fn scatters(surface: &Surface, sky: &Sky) -> bool {
    /// How much shorter the mean normal must be than one. Measured on cobbles, roughness 0.1 and 0.3:
    /// at 0.011 the mean is better by 2 to 5 dB, at 0.073 texels are by 2 to 4.
    const LEAST: f32 = 0.03;
    let mean = surface.levels()[surface.last_level()].texel(0, 0).normal;
    match sky {
        Sky::Color(color) => *color != Vec3::ZERO,
        Sky::Gradient { .. } => true,
        Sky::Environment(_) => Vec3::from(mean).length() < 1.0 - LEAST,
    }
}

/// The mean roughness of a grid of a surface's texels, and how much they reflect of light along it.
pub(super) fn mean_finish(material: &Material, unlit: &Prepared) -> (f32, f32) {
    /// Places a side.
    const SIDE: usize = 16;
    let [width, height] = unlit.surface().base().size();
    let share = 1.0 / (SIDE * SIDE) as f32;
    let places = (0..SIDE * SIDE).map(|i| {
        let place = |i: usize, n: usize| (2 * i + 1) * n / (2 * SIDE);
        texel_finish(material, unlit, [place(i % SIDE, width), place(i / SIDE, height)])
    });
    places.fold((0.0, 0.0), |(roughness, grazing), finish| {
        let of = Fresnel::new(&finish, Vec3::ONE);
        (roughness + finish.roughness * share, grazing + of.grazing * share)
    })
}
