//! Layers of a frame, tile by tile.

use super::hits::{self, Hits};
use super::layer::Layer;
use super::place::write_place;
use super::values::{Band, Layers, ValuesMut};
use crate::geometry::Projection;
use crate::raster::{CenterRow, Drawn, Follow};
use crate::render::{Outlines, Passages, Renderer};
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
        let (scene, asked, prepared, geometry, rasterizer) = self.parts();
        let has_relief = |material: usize| {
            prepared.of_material(material, true).is_some_and(|surface| surface.field().is_some())
        };
        let is_traced = asked.parallax
            && layers.iter().any(|(layer, _)| layer.is_of_hit())
            && (0..scene.materials.len()).any(has_relief);
        let has_quads = layers.iter().any(|(layer, _)| layer.asks_for_quads(is_traced));
        let has_normals = layers.iter().any(|(layer, _)| layer.is_normal());
        let settings = Settings {
            msaa: 1,
            // What is lit has normals.
            lighting: if has_normals { Lighting::Lit } else { Lighting::Unlit },
            parallax: is_traced,
            ..asked.clone()
        };
        geometry.project(scene, &settings);
        let projection = *geometry.projection();
        // What names and polygons are of is seen past outlines, too.
        let outlines =
            asked.has_outlines().then(|| Outlines::new(scene, prepared, &projection)).flatten();
        let passages = Passages::new(scene, &projection, outlines);
        let follow = passages.as_ref().map(|passages| passages as &dyn Follow);
        let hits = Hits { scene, prepared, is_traced, outlines, projection: &projection };
        let mut bands = Band::all(layers, &settings);
        let group = |triangle| hits::group(scene, triangle);
        let drawn = Drawn { scene, settings: &settings, group: Some(&group), follow };
        rasterizer.see_centers(geometry, (drawn, has_quads), &mut bands, &|tile, band| {
            let names_asked = band.slots.iter().any(|(layer, _)| layer.is_id());
            for row in tile.rows() {
                let mut names = [[u32::MAX; 2]; 8];
                if names_asked {
                    tile.names(&row, &mut names);
                }
                write_row(&row, &names, (scene, &projection), band);
            }
            hits.write(tile, band);
        });
    }
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
