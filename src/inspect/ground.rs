//! The triangle at a pixel's centre, and what the pixel's quad knows of it.

use super::ray::Ray;
use crate::footprint::{Footprint, FootprintRule, Footprints};
use crate::geometry::{self, Geometry, ScreenTriangle, sample_offsets};
use crate::light::SurfacePoint;
use crate::raster::{AttributePlanes, Edges, Rect};
use crate::relief::{HeightField, displacement, finite, march};
use crate::render::surface_point;
use crate::scene::Scene;
use crate::settings::{Lighting, Settings};
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

/// Two quads over a relief, or over the bare polygon: lane `4 * quad + 2 * dy + dx`.
#[derive(Clone, Copy)]
pub(super) struct Quads<'a> {
    uv: [PixelLanes; 2],
    view: [PixelLanes; 3],
    field: Option<&'a HeightField>,
}

/// A pixel of two quads.
#[derive(Clone, Copy)]
pub(super) struct QuadPixel<'a> {
    quads: Quads<'a>,
    pub(super) lane: usize,
    pub(super) ray: Ray,
}

impl Ground {
    /// The nearest triangle at the centre of a pixel.
    pub(super) fn at(scene: &Scene, settings: &Settings, pixel: [u32; 2]) -> Option<Self> {
        // Lit planes say where a pixel is in the world.
        let settings = Settings { msaa: 1, lighting: Lighting::Lit, ..settings.clone() };
        let geometry = geometry::project(scene, &settings);
        let triangle = nearest(&geometry, pixel)?;
        let planes = AttributePlanes::new(&geometry, triangle, scene, &settings);
        let mesh = triangle.mesh as usize;
        let material = scene.meshes[mesh].material;
        (!scene.meshes[mesh].tex_coords.is_empty() || scene.materials[material].surface.is_none())
            .then_some(Self { mesh, triangle: triangle.triangle as usize, material, pixel, planes })
    }

    /// The polygon's point at the pixel's centre.
    pub(super) fn point(&self) -> Option<SurfacePoint> {
        surface_point(&self.planes, self.pixel.map(|c| c as f32 + 0.5))
    }

    /// The pixel over the relief of `field`, or over the bare polygon.
    pub(super) fn pixel<'a>(&self, field: Option<&'a HeightField>) -> QuadPixel<'a> {
        let [x, y] = self.pixel.map(|c| (c & !1) as f32);
        let x = PixelLanes::new([0.5, 1.5, 0.5, 1.5, 0.5, 1.5, 0.5, 1.5]) + x;
        let y = PixelLanes::new([0.5, 0.5, 1.5, 1.5, 0.5, 0.5, 1.5, 1.5]) + y;
        let (uv, view) = self.planes.at(x, y);
        Quads { uv, view, field }.pixels()[(self.pixel[0] & 1 | (self.pixel[1] & 1) << 1) as usize]
    }
}

impl<'a> Quads<'a> {
    /// Quads with the texture coordinates `uv` and view rays `view`.
    pub(super) fn new(
        uv: [PixelLanes; 2],
        view: [PixelLanes; 3],
        field: Option<&'a HeightField>,
    ) -> Self {
        Self { uv, view, field }
    }

    /// Its pixels with their rays.
    pub(super) fn pixels(self) -> [QuadPixel<'a>; 8] {
        let uv = self.uv.map(finite);
        let displacement =
            displacement(&self.view, self.field.map_or(0.0, |field| field.relief_depth));
        let depth = self.field.map_or(PixelLanes::ZERO, |field| march(field, &uv, &displacement));
        let hit = [0, 1].map(|i| uv[i] + displacement[i] * depth);
        std::array::from_fn(|lane| {
            let at = |lanes: &[PixelLanes; 2]| lanes.map(|lanes| lanes.as_array()[lane]);
            let hit_depth = depth.as_array()[lane];
            let ray =
                Ray { base: at(&uv), displacement: at(&displacement), hit_depth, hit: at(&hit) };
            QuadPixel { quads: self, lane, ray }
        })
    }
}

impl QuadPixel<'_> {
    /// The pixel's footprint by a rule.
    pub(super) fn footprint(&self, rule: &FootprintRule) -> Footprint {
        let Quads { uv, view, field } = self.quads;
        Footprints::of_quads(&uv, &view, field, rule, u8::MAX).lane(self.lane)
    }

    /// Texture coordinates of a lane of the quad, and what the relief adds to them.
    pub(super) fn corner(&self, lane: usize) -> [[f32; 2]; 2] {
        let Ray { base, hit_depth, displacement, .. } = self.quads.pixels()[lane].ray;
        [base, displacement.map(|d| d * hit_depth)]
    }

    /// The texel of the full texture that the pixel's ray hits.
    pub(super) fn texel(&self, surface: &Surface) -> [i32; 2] {
        surface.base().in_texels(self.ray.hit).map(|c| c.floor() as i32)
    }
}

/// The nearest triangle at the centre of a pixel; of equally near ones the first, as in the
/// rasterizer.
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
        let nearness = (x as f32 + 0.5) * dx + (y as f32 + 0.5) * dy + constant;
        if is_inside && best.is_none_or(|(nearest, _)| nearness > nearest) {
            best = Some((nearness, triangle));
        }
    }
    best.map(|(_, triangle)| triangle)
}
