//! The colour of two quads: view slope, hits, footprints, texels, light.

use super::tables::Tables;
use crate::filter::{self, Differences, Filtered, TexelSet, isotropic, parallax, truth};
use crate::raster::{LitPlanes, QuadBlock, QuadPair};
use crate::relief::{HeightField, displacement, march};
use crate::scene::{Material, Scene};
use crate::settings::{Derivatives, Filter, Formulas, Lighting, Settings};
use crate::shade::{LocalLights, SurfacePoint};
use crate::simd::PixelLanes;
use crate::texture::{FULL_F32, Surface};
use glam::Vec3;
use std::sync::atomic::{AtomicU64, Ordering};

/// Shades quads of a frame.
pub(super) struct QuadShader<'a> {
    scene: &'a Scene,
    pub(super) settings: &'a Settings,
    pub(super) tables: &'a Tables,
    texels: [AtomicU64; 2],
}

/// What all pixels of a block have in common.
pub(super) struct Ground<'a> {
    pub(super) material: &'a Material,
    pub(super) surface: &'a Surface,
    pub(super) field: Option<&'a HeightField>,
}

impl<'a> QuadShader<'a> {
    pub(super) fn new(scene: &'a Scene, settings: &'a Settings, tables: &'a Tables) -> Self {
        Self { scene, settings, tables, texels: Default::default() }
    }

    /// Texels tested and texels averaged so far.
    pub(super) fn num_texels(&self) -> [u64; 2] {
        self.texels.each_ref().map(|num| num.load(Ordering::Relaxed))
    }

    /// Appends the linear colours of a block's pairs; helper lanes are 0.
    pub(super) fn shade(&self, block: &QuadBlock, colors: &mut Vec<[PixelLanes; 3]>) {
        let material = &self.scene.materials[block.material];
        let field = self.tables.fields[block.material].as_deref().filter(|_| self.settings.parallax);
        match &material.surface {
            Some(surface) if self.settings.filter == Filter::Horizon => {
                self.horizon(&Ground { material, surface, field }, block, colors);
            }
            Some(surface) if self.settings.filter == Filter::Trilinear && self.settings.lighting == Lighting::Unlit => {
                self.trilinear(&Ground { material, surface, field }, block, colors);
            }
            Some(surface) if self.settings.filter == Filter::Ewa => {
                self.ewa(&Ground { material, surface, field }, block, colors);
            }
            surface => colors.extend(block.pairs().map(|pair| {
                let colors = match surface {
                    None => each_covered(&pair, |lane| self.plain(&pair, material, lane)),
                    Some(surface) => self.textured(&Ground { material, surface, field }, &pair),
                };
                in_lanes(&colors)
            })),
        }
    }

    fn plain(&self, pair: &QuadPair, material: &Material, lane: usize) -> Vec3 {
        let Some(lights) = self.lights_at(pair, lane, pixel_center(pair, lane)) else { return material.diffuse };
        material.diffuse * lights.diffuse(Vec3::Z) + lights.specular(Vec3::Z, material)
    }

    fn textured(&self, ground: &Ground, pair: &QuadPair) -> [Vec3; 8] {
        match self.settings.filter {
            Filter::Truth => each_covered(pair, |lane| self.truth(ground, pair, lane)),
            Filter::Parallax => self.parallax(ground, pair),
            _ => self.at_hits(ground, pair),
        }
    }

    /// Where the rays of a pair hit the relief, in repeats, and the differences there.
    #[inline(always)]
    pub(super) fn hits(&self, ground: &Ground, pair: &QuadPair) -> ([PixelLanes; 2], Differences) {
        let offset = ground.field.map_or([PixelLanes::ZERO; 2], |field| {
            let reach = ground.reach(pair);
            let depth = march(field, &pair.uv, &reach);
            reach.map(|reach| reach * depth)
        });
        let place = [pair.uv[0] + offset[0], pair.uv[1] + offset[1]];
        (place, filter::differences_for(&pair.uv, &offset, self.settings))
    }

    /// The filters that put the footprint around the hit.
    fn at_hits(&self, ground: &Ground, pair: &QuadPair) -> [Vec3; 8] {
        let Ground { surface, field, .. } = *ground;
        let (place, differences) = self.hits(ground, pair);
        let reach = field.map(|_| ground.reach(pair));
        let mut set = TexelSet::default();
        let mut num_texels = [0; 2];
        let colors = each_covered(pair, |lane| {
            let footprint = differences.footprint(&place, lane);
            let texel = match self.settings.filter {
                Filter::Nearest => isotropic::nearest(surface, footprint.center),
                Filter::Bilinear => isotropic::bilinear(surface, 0, footprint.center),
                Filter::Trilinear => {
                    isotropic::trilinear(surface, footprint.center, isotropic::longest_side(surface, &footprint))
                }
                _ => {
                    let reach = reach.map(|reach| reach.map(|lanes| lanes.as_array()[lane]));
                    let (mean, counts) = filter::ellipse_mean(surface, &footprint, reach, self.settings, &mut set);
                    num_texels = [num_texels[0] + counts[0], num_texels[1] + counts[1]];
                    mean
                }
            };
            self.lit(ground, pair, lane, &texel)
        });
        self.count(num_texels);
        colors
    }

    fn parallax(&self, ground: &Ground, pair: &QuadPair) -> [Vec3; 8] {
        let Ground { surface, field, .. } = *ground;
        let none = [PixelLanes::ZERO; 2];
        let differences = filter::differences(&pair.uv, &none, (Derivatives::Flat, Formulas::Meant));
        let depth = field.map_or(0.0, |_| surface.relief_depth);
        each_covered(pair, |lane| {
            let footprint = differences.footprint(&pair.uv, lane);
            let size = parallax::texel_size(surface, &footprint, self.settings.samples);
            let [x, y] = pixel_center(pair, lane);
            let sum = self.tables.offsets.iter().fold(Vec3::ZERO, |sum, offset| {
                let (x, y) = (PixelLanes::splat(x + offset[0]), PixelLanes::splat(y + offset[1]));
                let (uv, view) = pair.planes[lane / 4].at(x, y);
                let reach = displacement(&view, depth).map(|lanes| lanes.as_array()[0]);
                let base = uv.map(|lanes| crate::relief::finite(lanes).as_array()[0]);
                sum + self.lit(ground, pair, lane, &parallax::trace(surface, base, reach, size))
            });
            sum / self.tables.offsets.len() as f32
        })
    }

    /// Every sample a ray of its own, shaded on its own.
    fn truth(&self, ground: &Ground, pair: &QuadPair, lane: usize) -> Vec3 {
        let Ground { surface, field, .. } = *ground;
        let planes = pair.planes[lane / 4];
        let [center_x, center_y] = pixel_center(pair, lane);
        let depth = field.map_or(0.0, |_| surface.relief_depth);
        let (mut sum, mut num) = (Vec3::ZERO, 0.0);
        for [dx, dy, counts] in &self.tables.kernel.groups {
            let (x, y) = (*dx + center_x, *dy + center_y);
            let (uv, view) = planes.at(x, y);
            let reach = displacement(&view, depth);
            let hit = field.map_or(PixelLanes::ZERO, |field| march(field, &uv, &reach));
            let place = [uv[0] + reach[0] * hit, uv[1] + reach[1] * hit];
            let [a, b, c] = planes.inverse_w;
            let inverse_w = x * a + y * b + c;
            for i in 0..8 {
                let place = place.map(|lanes| lanes.as_array()[i]);
                // Beyond the horizon there is no surface to sample.
                let is_sample = counts.as_array()[i] > 0.0 && inverse_w.as_array()[i] > 0.0;
                if is_sample && place.iter().all(|c| c.abs() < 1e6) {
                    let texel = truth::sample(surface, place);
                    sum += self.lit_at(ground, pair, lane, [x.as_array()[i], y.as_array()[i]], &texel);
                    num += 1.0;
                }
            }
        }
        sum / f32::max(num, 1.0)
    }

    pub(super) fn count(&self, num_texels: [u64; 2]) {
        self.texels.iter().zip(num_texels).for_each(|(total, num)| {
            total.fetch_add(num, Ordering::Relaxed);
        });
    }

    pub(super) fn lit(&self, ground: &Ground, pair: &QuadPair, lane: usize, texel: &Filtered) -> Vec3 {
        self.lit_at(ground, pair, lane, pixel_center(pair, lane), texel)
    }

    /// The colour of a filtered texel seen at a place on the screen.
    fn lit_at(&self, ground: &Ground, pair: &QuadPair, lane: usize, screen: [f32; 2], texel: &Filtered) -> Vec3 {
        let color = albedo(ground, texel);
        let Some(lights) = self.lights_at(pair, lane, screen) else { return color };
        let normal = Vec3::from(texel.normal);
        color * lights.diffuse(normal) + lights.specular(normal, ground.material)
    }

    /// The lights at a place on the screen, if there is lighting.
    pub(super) fn lights_at(&self, pair: &QuadPair, lane: usize, [x, y]: [f32; 2]) -> Option<LocalLights> {
        let planes = pair.planes[lane / 4];
        let lit = planes.lit.as_deref().filter(|_| self.settings.lighting == Lighting::Lit)?;
        let [a, b, c] = planes.inverse_w;
        let w = 1.0 / (a * x + b * y + c);
        let at = |planes: &[crate::raster::Plane; 3]| Vec3::from(planes.map(|[a, b, c]| (a * x + b * y + c) * w));
        let LitPlanes { position, normal, tangent_u, tangent_v } = lit;
        let point =
            SurfacePoint { position: at(position), normal: at(normal), tangents: [at(tangent_u), at(tangent_v)] };
        Some(LocalLights::at(&point, self.scene.camera.eye, &self.scene.lights, self.scene.ambient))
    }
}

impl Ground<'_> {
    /// How far the view rays move along the texture down to the deepest relief, in repeats.
    pub(super) fn reach(&self, pair: &QuadPair) -> [PixelLanes; 2] {
        displacement(&pair.view(), self.field.map_or(0.0, |_| self.surface.relief_depth))
    }
}

pub(super) fn in_lanes(colors: &[Vec3; 8]) -> [PixelLanes; 3] {
    [0, 1, 2].map(|c| PixelLanes::new(colors.map(|color| color[c])))
}

pub(super) fn albedo(ground: &Ground, texel: &Filtered) -> Vec3 {
    Vec3::from(texel.color) * ground.material.diffuse * (ground.surface.color_scale / FULL_F32)
}

fn each_covered(pair: &QuadPair, mut color: impl FnMut(usize) -> Vec3) -> [Vec3; 8] {
    let mut colors = [Vec3::ZERO; 8];
    for (lane, out) in colors.iter_mut().enumerate().filter(|(lane, _)| pair.coverage[*lane] > 0) {
        *out = color(lane);
    }
    colors
}

/// Where a lane's pixel has its centre on the screen.
pub(super) fn pixel_center(pair: &QuadPair, lane: usize) -> [f32; 2] {
    let [x, y] = pair.origin[lane / 4];
    [(x + (lane as i32 & 1)) as f32 + 0.5, (y + (lane as i32 >> 1 & 1)) as f32 + 0.5]
}
