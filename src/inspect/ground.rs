//! The triangle at a pixel's centre, and what the pixel's quad knows of it.

use super::Ray;
use crate::filter::{self, Differences};
use crate::geometry::{self, Geometry, ScreenTriangle, sample_offsets};
use crate::raster::{AttributePlanes, Edges, Rect};
use crate::relief::{self, HeightField, displacement, march};
use crate::scene::Scene;
use crate::settings::{Derivatives, Formulas, Settings};
use crate::simd::PixelLanes;
use crate::texture::Surface;

/// The triangle seen at a pixel's centre.
pub(super) struct Ground {
    pub(super) mesh: usize,
    pub(super) triangle: usize,
    pub(super) material: usize,
    pixel: [u32; 2],
    planes: AttributePlanes,
}

/// A pixel within its 2x2 quad, which are four of eight lanes: `4 * quad + 2 * dy + dx`.
#[derive(Clone, Copy)]
pub(super) struct Quad {
    /// The pixel's lane.
    pub(super) lane: usize,
    /// Coordinates on the polygon, in repeats.
    pub(super) uv: [PixelLanes; 2],
    /// How far the view ray moves along the texture down to the deepest relief.
    pub(super) reach: [PixelLanes; 2],
    /// How far the relief moves them.
    pub(super) offset: [PixelLanes; 2],
    /// The pixel's own ray.
    pub(super) ray: Ray,
}

impl Ground {
    /// The nearest triangle at the centre of a pixel.
    pub(super) fn at(scene: &Scene, settings: &Settings, pixel: [u32; 2]) -> Option<Self> {
        let settings = Settings { msaa: 1, ..settings.clone() };
        let geometry = geometry::project(scene, &settings);
        let triangle = nearest(&geometry, pixel)?;
        let planes = AttributePlanes::new(&geometry, triangle, scene, &settings);
        let mesh = triangle.mesh as usize;
        let material = scene.meshes[mesh].material;
        (!scene.meshes[mesh].tex_coords.is_empty() || scene.materials[material].surface.is_none()).then_some(Self {
            mesh,
            triangle: triangle.triangle as usize,
            material,
            pixel,
            planes,
        })
    }

    /// The pixel's quad over the relief of `field`, or over the bare polygon.
    pub(super) fn quad(&self, surface: &Surface, field: Option<&HeightField>) -> Quad {
        let [x, y] = self.pixel.map(|c| (c & !1) as f32);
        let x = PixelLanes::new([0.5, 1.5, 0.5, 1.5, 0.5, 1.5, 0.5, 1.5]) + x;
        let y = PixelLanes::new([0.5, 0.5, 1.5, 1.5, 0.5, 0.5, 1.5, 1.5]) + y;
        let (uv, view) = self.planes.at(x, y);
        let lane = (self.pixel[0] & 1 | (self.pixel[1] & 1) << 1) as usize;
        Quad::lanes(&uv, &view, surface, field)[lane]
    }
}

impl Quad {
    /// The eight pixels of two quads, over the relief of `field`, or over the bare polygon.
    pub(super) fn lanes(
        uv: &[PixelLanes; 2],
        view: &[PixelLanes; 3],
        surface: &Surface,
        field: Option<&HeightField>,
    ) -> [Self; 8] {
        let uv = uv.map(relief::finite);
        let reach = displacement(view, field.map_or(0.0, |_| surface.relief_depth));
        let depth = field.map_or(PixelLanes::ZERO, |field| march(field, &uv, &reach));
        let offset = [reach[0] * depth, reach[1] * depth];
        let place = [uv[0] + offset[0], uv[1] + offset[1]];
        std::array::from_fn(|lane| {
            let at = |lanes: &[PixelLanes; 2]| lanes.map(|lanes| lanes.as_array()[lane]);
            let hit_depth = depth.as_array()[lane];
            let ray = Ray { base: at(&uv), displacement: at(&reach), hit_depth, hit: at(&place) };
            Self { lane, uv, reach, offset, ray }
        })
    }

    /// The texel of the full texture that the pixel's ray hits.
    pub(super) fn texel(&self, surface: &Surface) -> [i32; 2] {
        let texels = surface.texels_per_repeat(0);
        [0, 1].map(|i| (self.ray.hit[i] * texels[i]).floor() as i32)
    }

    /// Formula (2) or (3) of the quad.
    pub(super) fn differences(&self, which: (Derivatives, Formulas)) -> Differences {
        filter::differences(&self.uv, &self.offset, which)
    }

    /// The footprint that filters put around the hit.
    pub(super) fn filtered(&self, settings: &Settings) -> filter::Footprint {
        let place = [self.uv[0] + self.offset[0], self.uv[1] + self.offset[1]];
        filter::differences_for(&self.uv, &self.offset, settings).footprint(&place, self.lane)
    }

    /// The pixel's footprint by a formula: (2) around the place on the polygon, (3) around the hit.
    pub(super) fn footprint(&self, which: (Derivatives, Formulas)) -> filter::Footprint {
        let place = match which.0 {
            Derivatives::Flat => self.uv,
            Derivatives::Relief => [self.uv[0] + self.offset[0], self.uv[1] + self.offset[1]],
        };
        self.differences(which).footprint(&place, self.lane)
    }
}

/// The nearest triangle at the centre of a pixel; of equally near ones the first, as in the rasterizer.
fn nearest(geometry: &Geometry, pixel: [u32; 2]) -> Option<&ScreenTriangle> {
    let [x, y] = pixel.map(|c| c as i32);
    let rect = Rect { min: [x, y], max: [x + 1, y + 1] };
    let mut best: Option<(f32, &ScreenTriangle)> = None;
    for triangle in geometry.triangles() {
        let mut is_inside = false;
        Edges::<1>::new(&triangle.corners, sample_offsets(1)).cover(&rect, &mut |row| {
            is_inside |= row.mask.to_array()[(x - row.x) as usize] != 0;
        });
        let [dx, dy, constant] = triangle.depth;
        let inverse_w = (x as f32 + 0.5) * dx + (y as f32 + 0.5) * dy + constant;
        if is_inside && best.is_none_or(|(nearest, _)| inverse_w > nearest) {
            best = Some((inverse_w, triangle));
        }
    }
    best.map(|(_, triangle)| triangle)
}
