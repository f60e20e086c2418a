//! Layers made of a triangle's attributes, and of where the relief is hit.

use super::layer::Layer;
use super::place::write_place;
use super::values::{Band, ValuesMut};
use crate::geometry::Projection;
use crate::raster::{CenterTile, LitLanes, QuadBlock, QuadPair};
use crate::relief::{HeightField, ViewRays, displacement_over, finite, march_all, stretch};
use crate::render::{Outlines, PreparedScene, point_of};
use crate::scene::{Material, Scene};
use crate::shell::Met;
use crate::simd::PixelLanes;
use crate::texture::{FULL_F32, Texel};
use glam::Vec3;

/// What all tiles share.
pub(super) struct Hits<'a> {
    pub(super) scene: &'a Scene,
    pub(super) prepared: &'a PreparedScene,
    /// Whether relief is traced.
    pub(super) is_traced: bool,
    /// Where rays end on curved meshes.
    pub(super) outlines: Option<&'a Outlines<'a>>,
    pub(super) projection: &'a Projection,
}

/// Where the rays of a pair of quads meet the relief.
struct PairHits {
    /// Texture coordinates of the hits.
    uv: [PixelLanes; 2],
    /// Distance along the view to the hits, not less than to the polygon.
    distance: PixelLanes,
}

/// One pixel of a pair.
struct Pixel<'a> {
    /// As in [`PairHits`].
    distance: f32,
    polygon_uv: [f32; 2],
    uv: [f32; 2],
    lit: Option<&'a LitLanes>,
    lane: usize,
}

/// The group in which quads are listed, by whether their mesh has texture coordinates.
pub(super) fn group(scene: &Scene, [mesh, _]: [u32; 2]) -> u32 {
    let mesh = &scene.meshes[mesh as usize];
    2 * mesh.material as u32 + u32::from(!mesh.tex_coords.is_empty())
}

impl Hits<'_> {
    /// Writes what the tile's quads see.
    pub(super) fn write(&self, tile: &CenterTile, band: &mut Band) {
        let mut hits = Vec::new();
        for block in tile.blocks() {
            // Without texture coordinates there is no relief.
            let is_textured = block.group & 1 != 0;
            let field = self
                .prepared
                .of_material(block.material, true)
                .and_then(|surface| surface.field())
                .filter(|_| self.is_traced && is_textured);
            hits.clear();
            hits.extend(block.pairs().map(|pair| PairHits {
                uv: pair.uv.map(finite),
                distance: if field.is_some() { tile.distances(&pair) } else { PixelLanes::ONE },
            }));
            if let Some(field) = field {
                trace(&block, (field, self.projection), &mut hits);
                if let Some(outlines) = self.outlines {
                    follow(&block, (outlines, tile), &mut hits);
                }
            }
            let material = &self.scene.materials[block.material];
            for (pair, hits) in block.pairs().zip(&hits) {
                self.write_pair((&pair, hits, field.is_some()), material, band);
            }
        }
    }

    fn write_pair(
        &self,
        (pair, hits, has_relief): (&QuadPair, &PairHits, bool),
        material: &Material,
        band: &mut Band,
    ) {
        let lit = pair.lit();
        for lane in pair.covered() {
            let place = pair.pixel(lane);
            let Some(at) = band.index(place) else { continue };
            let of = |lanes: &PixelLanes| lanes.as_array()[lane];
            let pixel = Pixel {
                distance: of(&hits.distance),
                polygon_uv: pair.uv.each_ref().map(|lanes| of(&finite(*lanes))),
                uv: hits.uv.each_ref().map(of),
                lit: lit.as_ref(),
                lane,
            };
            for (layer, slot) in &mut band.slots {
                let ValuesMut::Floats(values) = slot else { continue };
                let values = &mut values[at * layer.num_channels()..];
                // Without relief the polygon's place stands already.
                if layer.is_place() && has_relief {
                    // Infinity is the background's.
                    let distance = pixel.distance.min(f32::MAX);
                    write_place(*layer, place, distance, self.projection, values);
                } else {
                    self.write_attribute(*layer, &pixel, material, values);
                }
            }
        }
    }

    fn write_attribute(&self, layer: Layer, pixel: &Pixel, material: &Material, out: &mut [f32]) {
        match layer {
            Layer::Uv => out[..2].copy_from_slice(&pixel.uv),
            Layer::PolygonUv => out[..2].copy_from_slice(&pixel.polygon_uv),
            Layer::Albedo => out[..3].copy_from_slice(&albedo(material, pixel.uv).to_array()),
            Layer::PolygonNormal => {
                out[..3].copy_from_slice(&normal(pixel, Texel::UP).to_array());
            }
            Layer::Normal | Layer::CameraNormal => {
                let normal = normal(pixel, texel(material, pixel.uv).1);
                let is_world = layer == Layer::Normal;
                let normal = if is_world { normal } else { self.projection.along_axes(normal) };
                out[..3].copy_from_slice(&normal.to_array());
            }
            _ => {}
        }
    }
}

/// A normal of the texture's frame in the world, on the side of the polygon that the eye sees.
fn normal(pixel: &Pixel, local: [f32; 3]) -> Vec3 {
    pixel.lit.map_or(Vec3::ZERO, |lit| point_of(lit, pixel.lane).in_world(local))
}

/// Traces the rays of a block's pairs to the relief.
fn trace(
    block: &QuadBlock,
    (field, projection): (&HeightField, &Projection),
    hits: &mut [PairHits],
) {
    let along =
        |pair: QuadPair| displacement_over(&pair.view(), pair.bend().as_ref(), field.relief_depth);
    let along: Vec<_> = block.pairs().map(along).collect();
    let rays = hits.iter().zip(&along).zip(block.pairs()).map(|((hits, along), pair)| ViewRays {
        base: hits.uv,
        displacement: *along,
        wanted: pair.covered_bits(),
    });
    let mut depths = vec![PixelLanes::ZERO; hits.len()];
    march_all(field, rays, &mut depths);
    for (((hits, along), pair), depth) in hits.iter_mut().zip(along).zip(block.pairs()).zip(depths)
    {
        hits.uv = [0, 1].map(|i| hits.uv[i] + along[i] * depth);
        let lengths = finite(stretch(&pair.view(), field.relief_depth) * depth);
        hits.distance = projection.behind(hits.distance, lengths);
    }
}

/// Follows the rays of a block's pairs that see curved meshes.
fn follow(block: &QuadBlock, (outlines, tile): (&Outlines, &CenterTile), hits: &mut [PairHits]) {
    for (pair, hits) in block.pairs().zip(hits) {
        let polygon = tile.distances(&pair);
        for lane in pair.covered() {
            let triangle = pair.planes[lane / 4].triangle;
            if !outlines.is_curved(triangle[0]) {
                continue;
            }
            let place = pair.pixel(lane).map(|c| f64::from(c) + 0.5);
            // Where rounding lets a ray pass after all, the polygon's own frame serves.
            let Met::Relief(hit) = outlines.met(triangle, place) else { continue };
            (0..2).for_each(|i| hits.uv[i].as_mut_array()[lane] = hit.place.uv[i] as f32);
            let distance = polygon.as_array()[lane].max(hit.distance as f32);
            hits.distance.as_mut_array()[lane] = distance;
        }
    }
}

/// Colour, as stored, and normal of the full texture's texel at a place in repeats.
fn texel(material: &Material, uv: [f32; 2]) -> ([f32; 3], [f32; 3]) {
    let Some(surface) = &material.surface else { return ([FULL_F32; 3], Texel::UP) };
    let [x, y] = surface.base().in_texels(uv).map(|c| c.floor() as i32);
    let Texel { color, normal } = surface.base().texel(x, y);
    (color, normal)
}

/// Linear colour of the full texture's texel at a place in repeats, as the material shows it.
fn albedo(material: &Material, uv: [f32; 2]) -> Vec3 {
    let scale = material.surface.as_ref().map_or(1.0, |surface| surface.color_scale());
    Vec3::from(texel(material, uv).0) * material.base_color * (scale / FULL_F32)
}
