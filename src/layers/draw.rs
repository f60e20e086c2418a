//! Layers of a frame, tile by tile.

use super::hits::{self, Hits};
use super::layer::Layer;
use super::place::write_place;
use super::values::{Band, Layers, PixelsMut, ValuesMut};
use crate::geometry::Projection;
use crate::raster::{CenterRow, CenterTile, Centers, Drawn, Follow, QuadBlock};
use crate::render::{DrawnPixel, Passages, PreparedScene, Renderer, Shader};
use crate::scene::Scene;
use crate::settings::{Lighting, Settings};
use crate::simd::set_bits;

impl Renderer {
    /// What the centres of a frame's pixels see, or those of its [region](Settings::region), on the
    /// threads of the current rayon pool: see [`layers`](crate::layers).
    pub fn render_layers(&mut self, layers: &[Layer]) -> Layers {
        let drawn = self.settings().drawn();
        let mut found = Layers::unwritten(layers, drawn.width, drawn.height);
        self.render_layers_to(found.all_mut());
        found
    }

    /// [`Self::render_layers`] into memory of the caller's, each layer row by row from the top. A
    /// layer may be there twice.
    ///
    /// # Panics
    /// If the numbers of a layer are not [of its kind](Layer::is_id), or not as many as
    /// [`Settings::drawn`] and [`Layer::num_channels`] say.
    pub fn render_layers_to(&mut self, layers: Vec<(Layer, ValuesMut)>) {
        self.see_layers::<[u8; 4]>(None, layers);
    }

    /// [`Self::render_to`] and [`Self::render_layers_to`] together, with the same numbers. Where
    /// [`Settings::msaa`] is 1, triangles are projected and what pixels see is found once for both.
    ///
    /// # Panics
    /// As the two do.
    pub fn render_with_layers_to(&mut self, pixels: PixelsMut, layers: Vec<(Layer, ValuesMut)>) {
        match pixels {
            PixelsMut::Bytes(pixels) => self.see_layers(Some(pixels), layers),
            PixelsMut::Linear(pixels) => self.see_layers(Some(pixels), layers),
        }
    }

    fn see_layers<P: DrawnPixel>(
        &mut self,
        mut pixels: Option<&mut [P]>,
        layers: Vec<(Layer, ValuesMut)>,
    ) {
        let is_shared = !layers.is_empty() && shares_visibility(self.settings());
        if !is_shared && let Some(pixels) = pixels.take() {
            self.render_to(pixels);
        }
        if layers.is_empty() {
            return;
        }
        let (scene, asked, prepared, pool, geometry, rasterizer) = self.parts();
        let settings = layer_settings(scene, asked, prepared, &layers);
        let is_traced = settings.parallax;
        let has_quads = layers.iter().any(|(layer, _)| layer.asks_for_quads(is_traced));
        geometry.project(scene, &settings);
        let projection = *geometry.projection();
        // What names and polygons are of is seen past outlines, too.
        let outlines = prepared.outlines(scene, asked, &projection);
        let outlines = outlines.as_ref();
        let passages = Passages::new(scene, &projection, outlines);
        let follow = passages.as_ref().map(|passages| passages as &dyn Follow);
        let hits = Hits { scene, prepared, is_traced, outlines, projection: &projection };
        let mut bands = Band::all(layers, &settings);
        let group = |triangle| hits::group(scene, triangle);
        let drawn = Drawn { scene, settings: &settings, group: Some(&group), follow };
        let see = |tile: &CenterTile, band: &mut Band| write_tile(tile, &hits, band);
        let centers = Centers { drawn, has_quads, see: &see };
        if let Some(pixels) = pixels {
            let shader = Shader::new(scene, asked, prepared, outlines, pool);
            let shade = |block: &QuadBlock, colors: &mut Vec<_>| shader.shade(block, colors);
            let group = |triangle| prepared.group(scene, triangle);
            let group = prepared.is_baked().then_some(&group as &(dyn Fn(_) -> _ + Sync));
            let drawn = Drawn { settings: asked, group, ..drawn };
            rasterizer.draw_and_see(geometry, (drawn, &shade), pixels, centers, &mut bands);
        } else {
            rasterizer.see_centers(geometry, centers, &mut bands);
        }
    }
}

/// Whether pictures and layers of a frame see the same samples, and rows of tiles, by which layers
/// are shared out, are enough for all threads.
fn shares_visibility(settings: &Settings) -> bool {
    let num_rows = settings.height / settings.tile_size;
    settings.msaa == 1
        && settings.region.is_none()
        && num_rows as usize >= 2 * rayon::current_num_threads()
}

/// The settings that layers of a frame are drawn by; `parallax` says whether relief is traced.
fn layer_settings(
    scene: &Scene,
    asked: &Settings,
    prepared: &PreparedScene,
    layers: &[(Layer, ValuesMut)],
) -> Settings {
    let has_relief = |material: usize| {
        prepared.of_material(material, true).is_some_and(|surface| surface.field().is_some())
    };
    let is_traced = asked.parallax
        && layers.iter().any(|(layer, _)| layer.is_of_hit())
        && (0..scene.materials.len()).any(has_relief);
    let has_normals = layers.iter().any(|(layer, _)| layer.is_normal());
    Settings {
        msaa: 1,
        // What is lit has normals.
        lighting: if has_normals { Lighting::Lit } else { Lighting::Unlit },
        parallax: is_traced,
        ..asked.clone()
    }
}

/// Writes what a tile sees.
fn write_tile(tile: &CenterTile, hits: &Hits, band: &mut Band) {
    let names_asked = band.slots.iter().any(|(layer, _)| layer.is_id());
    for row in tile.rows() {
        let mut names = [[u32::MAX; 2]; 8];
        if names_asked {
            tile.names(&row, &mut names);
        }
        write_row(&row, &names, (hits.scene, hits.projection), band);
    }
    hits.write(tile, band);
}

/// Writes what needs no attributes: all of the polygon, which [`Hits`] then moves where relief is
/// hit.
#[inline(always)]
fn write_row(
    row: &CenterRow,
    names: &[[u32; 2]; 8],
    (scene, projection): (&Scene, &Projection),
    band: &mut Band,
) {
    let w = row.w.to_array();
    for lane in set_bits(row.seen) {
        let pixel = [row.x + lane as i32, row.y];
        let Some(at) = band.index(pixel) else { continue };
        for (layer, slot) in &mut band.slots {
            match slot {
                ValuesMut::Ids(ids) => {
                    let [mesh, triangle] = names[lane];
                    ids[at] = match layer {
                        Layer::Object => mesh,
                        Layer::Triangle => triangle,
                        _ => scene.meshes[mesh as usize].material as u32,
                    };
                }
                ValuesMut::Floats(values) => {
                    let is_polygon = matches!(layer, Layer::PolygonDepth | Layer::PolygonPosition);
                    if is_polygon || layer.is_place() {
                        write_place(
                            *layer,
                            pixel,
                            w[lane],
                            projection,
                            &mut values[at * layer.num_channels()..],
                        );
                    }
                }
            }
        }
    }
}
