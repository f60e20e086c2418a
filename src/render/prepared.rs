//! The prepared surface of each material.

use super::baked::Baked;
use super::ground::{Ground, Swept};
use super::mapped::Mapped;
use super::outlines::{Outlines, Relief, outlined};
use super::skies::Skies;
use crate::filter::Prepared;
use crate::geometry::Projection;
use crate::light::Disc;
use crate::light::Sheen;
use crate::light::exact::{Ceiling, Occluders};
use crate::light::reflection::Reflectance;
use crate::relief::HeightField;
use crate::scene::{Light, Material, Mesh, Scene};
use crate::settings::{Lighting, Settings};
use crate::shell::{Outlined, Shell};
use crate::texture::Surface;
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};

/// Most texels of all surfaces together that far-field tables are built for: some seconds of work.
/// Surfaces beyond, in the order of the materials, are drawn without.
const MOST_FAR_TEXELS: usize = 1 << 22;

/// The surfaces of a scene, ready for its settings. Materials that share a surface share what is
/// made of it.
#[derive(Debug)]
pub(crate) struct PreparedScene {
    surfaces: Vec<Prepared>,
    /// The same drawn flat, as they are where relief is not traced.
    flat: Vec<Prepared>,
    has_points: bool,
    /// The surface of each material that has one.
    of_material: Vec<Option<usize>>,
    /// Lit for good, with relief or without; `None` where lights are evaluated place by place.
    baked: Option<(bool, Baked)>,
    /// Of the materials that have textures of their numbers, in lit frames; with relief or without.
    mapped: Option<(bool, Vec<Option<Mapped>>)>,
    /// What lit frames ask for, made when the first of them does.
    reflectance: OnceLock<Reflectance>,
    /// What the truth's light and shadows ask for.
    occluders: OnceLock<Occluders>,
    /// What curved surfaces ask for: of each light that is a sun.
    ceilings: OnceLock<Vec<Option<Ceiling>>>,
    /// The same of the sky.
    skies: OnceLock<Skies>,
    /// The relief of each mesh that has one, for rays that may pass it or meet another mesh in it.
    shells: OnceLock<Vec<Option<Shell>>>,
}

impl PreparedScene {
    /// The surfaces with their height fields.
    pub(crate) fn new(scene: &Scene) -> Self {
        let mut surfaces: Vec<Arc<Surface>> = Vec::new();
        // Surfaces are told apart by address: comparing texels would read them all.
        let mut index_of = |surface: &Arc<Surface>| {
            surfaces.iter().position(|other| Arc::ptr_eq(other, surface)).unwrap_or_else(|| {
                surfaces.push(surface.clone());
                surfaces.len() - 1
            })
        };
        let of_material = scene
            .materials
            .iter()
            .map(|material| material.surface.as_ref().map(&mut index_of))
            .collect();
        // Give out what tables may cost in the order of materials. After a surface that is too
        // large, a smaller one may still fit.
        let mut left = MOST_FAR_TEXELS;
        let has_far_field = surfaces.iter().map(|surface| {
            let num_texels = surface.base().size().iter().product();
            let fits = surface.relief_depth() > 0.0 && num_texels <= left;
            left -= if fits { num_texels } else { 0 };
            fits
        });
        // Collected before the parallel step, since each answer hangs on those before it.
        let has_far_field: Vec<bool> = has_far_field.collect();
        let surfaces: Vec<_> = surfaces
            .into_par_iter()
            .zip(has_far_field)
            .map(|(surface, has_far_field)| {
                let prepared = Prepared::new(surface);
                if has_far_field { prepared } else { prepared.without_far_field() }
            })
            .collect();
        let flat = surfaces.iter().map(Prepared::without_relief).collect();
        let (reflectance, occluders, ceilings, skies, shells) = Default::default();
        Self {
            surfaces,
            flat,
            has_points: scene.lights.iter().any(|light| matches!(light, Light::Point { .. })),
            of_material,
            baked: None,
            mapped: None,
            reflectance,
            occluders,
            ceilings,
            skies,
            shells,
        }
    }

    /// Forgets what is made of meshes, which have changed.
    pub(crate) fn forget_meshes(&mut self) {
        self.baked = None;
        (self.occluders, self.ceilings, self.skies, self.shells) = Default::default();
    }

    /// Makes what frames of the scene with these settings need, so that no frame has to wait for
    /// it.
    pub(crate) fn make_ready(&mut self, scene: &Scene, settings: &Settings) {
        let is_lit = settings.lighting == Lighting::Lit;
        if settings.has_outlines() {
            self.shells(scene);
        }
        if is_lit {
            self.reflectance();
        }
        // The truth lights each of its samples.
        let is_exact = settings.filter.traits().samples.is_some_and(|rays| rays.is_exact);
        if is_lit && is_exact {
            self.occluders(scene);
        }
        if is_lit && !is_exact && self.mapped.as_ref().is_none_or(|m| m.0 != settings.parallax) {
            self.mapped = Some((settings.parallax, self.mapped(scene, settings.parallax)));
        }
        // Where a point shines, only a filter that asks for lights adds it to what is baked.
        let asks = settings.filter.traits().asks_for_lights;
        if is_lit && !is_exact && (!self.has_points || asks) {
            let kept = self.baked.take().filter(|(relief, _)| *relief == settings.parallax);
            let (_, mut baked) = kept.unwrap_or_else(|| (settings.parallax, Baked::new(scene)));
            let unlit = |material| self.of_material(material, settings.parallax);
            baked.light(scene, || self.occluders(scene), (unlit, self.reflectance()));
            if baked.has_shadows() {
                self.occluders(scene);
            }
            let curved = baked.curved(scene).map(|mesh| mesh.material).collect::<Vec<_>>();
            self.baked = Some((settings.parallax, baked));
            if !curved.is_empty() && asks {
                self.ceilings(scene);
                self.skies(scene);
            }
            if asks {
                let all = scene.meshes.iter().map(|mesh| mesh.material).filter(|_| self.has_points);
                for material in curved.into_iter().chain(all) {
                    let unlit = self.of_material(material, settings.parallax);
                    let mapped = self.mapped.as_ref().and_then(|(_, all)| all[material].as_ref());
                    let material = &scene.materials[material];
                    unlit.map(|unlit| unlit.horizons(!material.is_matte()));
                    if let (Some(mapped), Some(unlit)) = (mapped, unlit) {
                        mapped.make_glossy((material, unlit), (&scene.sky, self.reflectance()));
                    }
                }
            }
            if self.has_points {
                self.occluders(scene);
            }
        } else {
            self.baked = None;
        }
        // Frames without relief draw the flat surfaces, which ask for none of this.
        if settings.parallax {
            let baked = self.baked.iter().flat_map(|(_, baked)| baked.surfaces());
            let ready = self.surfaces.iter().map(|surface| (surface, is_lit));
            let ready: Vec<_> = ready.chain(baked.map(|surface| (surface, false))).collect();
            ready
                .into_par_iter()
                .for_each(|(surface, is_lit)| surface.make_ready(&settings.filter, is_lit));
        }
    }

    /// What textures of materials' numbers are drawn by.
    fn mapped(&self, scene: &Scene, has_relief: bool) -> Vec<Option<Mapped>> {
        let of = |(i, material): (usize, &Material)| {
            let is_plain = material.maps.is_empty() && material.is_matte();
            let unlit = self.of_material(i, has_relief).filter(|_| !is_plain)?;
            Some(Mapped::new(material, unlit))
        };
        scene.materials.iter().enumerate().map(of).collect()
    }

    /// How much surfaces reflect.
    pub(crate) fn reflectance(&self) -> &Reflectance {
        self.reflectance.get_or_init(Reflectance::new)
    }

    /// The triangles of the scene that this was made for.
    pub(crate) fn occluders(&self, scene: &Scene) -> &Occluders {
        self.occluders.get_or_init(|| Occluders::new(scene))
    }

    /// The relief of each mesh that has one.
    fn shells(&self, scene: &Scene) -> &[Option<Shell>] {
        self.shells.get_or_init(|| {
            let shell = |mesh: &Mesh| {
                let field = self.field_of(mesh)?;
                let is_textured = !mesh.tex_coords.is_empty();
                is_textured.then(|| Shell::new(mesh, field.relief_depth))
            };
            scene.meshes.par_iter().map(shell).collect()
        })
    }

    /// What follows rays through the reliefs of a scene, if settings ask for it and any may differ
    /// from its polygons.
    pub(crate) fn outlines<'a>(
        &'a self,
        scene: &'a Scene,
        settings: &Settings,
        projection: &'a Projection,
    ) -> Option<Outlines<'a>> {
        let reliefs = settings.has_outlines().then(|| self.reliefs(scene))?;
        Outlines::new(scene, projection, reliefs)
    }

    /// The meshes that throw the shadow of their relief, if settings ask for it: what
    /// [outlines](Self::outlines) know of light.
    pub(crate) fn outlined<'a>(
        &'a self,
        scene: &'a Scene,
        settings: &Settings,
    ) -> Option<Outlined<'a>> {
        outlined(scene, &settings.has_outlines().then(|| self.reliefs(scene))?)
    }

    fn reliefs<'a>(&'a self, scene: &Scene) -> Vec<Option<Relief<'a>>> {
        let meshes = scene.meshes.iter().zip(self.shells(scene));
        let relief =
            |(mesh, shell): (_, &'a Option<Shell>)| shell.as_ref().zip(self.field_of(mesh));
        meshes.map(relief).collect()
    }

    fn field_of(&self, mesh: &Mesh) -> Option<&HeightField> {
        self.of_material(mesh.material, true)?.field()
    }

    /// Whether any light is a point.
    pub(crate) fn has_points(&self) -> bool {
        self.has_points
    }

    /// What may hide each light from curved surfaces; `None` for a point.
    pub(crate) fn ceilings(&self, scene: &Scene) -> &[Option<Ceiling>] {
        self.ceilings.get_or_init(|| {
            let Some((_, baked)) = &self.baked else { return Vec::new() };
            let triangles = self.occluders(scene).triangles();
            let ceiling = |light: &Light| {
                Some(Ceiling::new(
                    Disc::of(light)?,
                    triangles.iter(),
                    baked.curved(scene).flat_map(|mesh| mesh.positions.iter().copied()),
                ))
            };
            scene.lights.iter().map(ceiling).collect()
        })
    }

    /// What of the sky gets to curved meshes.
    pub(crate) fn skies(&self, scene: &Scene) -> &Skies {
        let is_curved = |mesh: usize| self.baked.as_ref().is_some_and(|(_, b)| b.is_curved(mesh));
        self.skies.get_or_init(|| Skies::new(scene, is_curved))
    }

    /// Whether any piece has its light baked; if none, the groups are the materials.
    pub(crate) fn is_baked(&self) -> bool {
        self.baked.is_some()
    }

    /// The group in which a triangle is shaded, by the index of its mesh and in it.
    pub(crate) fn group(&self, scene: &Scene, triangle: [u32; 2]) -> u32 {
        let baked = self.baked.as_ref().and_then(|(_, baked)| baked.group(scene, triangle));
        // After the groups of materials.
        match baked {
            Some(group) => self.of_material.len() as u32 + group,
            None => scene.meshes[triangle[0] as usize].material as u32,
        }
    }

    /// What a block lies on; `None` for a material without a surface.
    pub(crate) fn ground<'a>(
        &'a self,
        scene: &'a Scene,
        settings: &Settings,
        [material, group]: [usize; 2],
    ) -> Option<Ground<'a>> {
        let baked = group
            .checked_sub(self.of_material.len())
            .and_then(|group| self.baked.as_ref()?.1.of_group(group));
        let unlit = self.of_material(material, settings.parallax)?;
        let (prepared, baked) =
            baked.map_or((unlit, None), |(prepared, baked)| (prepared, Some(baked)));
        let is_lit = settings.lighting == Lighting::Lit;
        let mapped = self.mapped.as_ref().filter(|_| is_lit);
        let mapped = mapped.and_then(|(_, of)| of.get(material)?.as_ref());
        let material = &scene.materials[material];
        let is_swept = scene.lights.len() <= 64
            && self.baked.is_some()
            && baked.is_none()
            && settings.filter.traits().asks_for_lights
            && prepared.field().is_some()
            && prepared.surface().has_normals();
        let diffuse = mapped.and_then(|mapped| mapped.diffuse.as_ref()).unwrap_or(unlit);
        let prepared = if is_swept { diffuse } else { prepared };
        let glow = mapped.and_then(|mapped| mapped.glow.as_ref());
        let gloss = mapped.and_then(|mapped| mapped.gloss.get());
        let sheen = gloss.map(|gloss| Sheen::Layer(gloss.layer));
        let swept = is_swept.then_some(Swept { lights: u64::MAX, has_sky: true, sheen });
        let hidden = None;
        Some(Ground {
            material,
            prepared,
            unlit,
            diffuse,
            is_lit,
            swept,
            baked,
            glow,
            gloss,
            hidden,
        })
    }

    /// The surface of a material, if it has one; drawn flat unless relief is traced.
    pub(crate) fn of_material(&self, material: usize, has_relief: bool) -> Option<&Prepared> {
        let surfaces = if has_relief { &self.surfaces } else { &self.flat };
        Some(&surfaces[self.of_material[material]?])
    }
}
