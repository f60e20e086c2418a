//! The triangle at a pixel's centre, and what the pixel's quad knows of it.

use super::ray::Ray;
use crate::footprint::{Footprint, FootprintRule, Footprints};
use crate::geometry::{self, Geometry};
use crate::light::SurfacePoint;
use crate::light::exact::{Clearance, Hit};
use crate::raster::{
    AttributePlanes, CenterTile, Centers, Drawn, Follow, QuadPair, Rasterizer, TileGrid,
};
use crate::relief::{HeightField, displacement_over, finite, march};
use crate::render::{Outlines, Passages, PreparedScene, clearance, surface_point};
use crate::scene::Scene;
use crate::settings::{Lighting, Region, Settings};
use crate::shell::{Met, ReliefHit};
use crate::simd::PixelLanes;
use crate::texture::Surface;

/// The triangle seen at a pixel's centre.
pub(super) struct Ground {
    pub(super) mesh: usize,
    pub(super) triangle: usize,
    pub(super) material: usize,
    pixel: [u32; 2],
    planes: AttributePlanes,
    /// Where the ray hits the relief of a curved mesh, and the polygon above.
    past: Option<(ReliefHit, SurfacePoint)>,
}

/// Two quads over a relief, or over the bare polygon: lane `4 * quad + 2 * dy + dx`.
#[derive(Clone, Copy)]
pub(super) struct Quads<'a> {
    uv: [PixelLanes; 2],
    view: [PixelLanes; 3],
    bend: Option<[[PixelLanes; 2]; 3]>,
    field: Option<&'a HeightField>,
}

/// A pixel of two quads.
#[derive(Clone, Copy)]
pub(super) struct QuadPixel<'a> {
    quads: Quads<'a>,
    pub(super) lane: usize,
    pub(super) ray: Ray,
    /// Where its ray was followed to the relief of a curved mesh.
    pub(super) past: Option<ReliefHit>,
}

impl Ground {
    /// What is seen at the centre of a pixel.
    pub(super) fn at(
        (scene, prepared): (&Scene, &PreparedScene),
        settings: &Settings,
        pixel: [u32; 2],
    ) -> Option<Self> {
        let [x, y] = pixel;
        // Lit planes say where a pixel is in the world.
        let settings = Settings {
            msaa: 1,
            lighting: Lighting::Lit,
            region: Some(Region { x, y, width: 1, height: 1 }),
            ..settings.clone()
        };
        let geometry = geometry::project(scene, &settings);
        let outlines = prepared.outlines(scene, &settings, geometry.projection());
        let outlines = outlines.as_ref();
        let passages = Passages::new(scene, geometry.projection(), outlines);
        let follow = passages.as_ref().map(|passages| passages as &dyn Follow);
        let drawn = Drawn { scene, settings: &settings, group: None, follow };
        let seen = seen(&geometry, drawn, pixel)?;
        let [mesh, triangle] = seen.map(|index| index as usize);
        let of_seen = geometry.triangles().find(|t| [t.mesh, t.triangle] == seen)?;
        let planes = AttributePlanes::new(&geometry, of_seen, scene, &settings);
        let past = outlines.and_then(|outlines| {
            let hit = hit(outlines, seen, pixel)?;
            Some((hit, outlines.point(seen[0], &hit)))
        });
        let material = scene.meshes[mesh].material;
        (!scene.meshes[mesh].tex_coords.is_empty() || scene.materials[material].surface.is_none())
            .then_some(Self { mesh, triangle, material, pixel, planes, past })
    }

    /// The polygon's point at the pixel's centre, or above its hit.
    pub(super) fn point(&self) -> Option<SurfacePoint> {
        let of_polygon = || surface_point(&self.planes, self.center());
        self.past.map(|(_, point)| point).or_else(of_polygon)
    }

    /// How light gets clear of the polygon at that point.
    pub(super) fn clearance(&self, scene: &Scene, hit: &Hit) -> Clearance {
        clearance(scene, (&self.planes, hit.spot.relief), (self.center(), &hit.point))
    }

    fn center(&self) -> [f32; 2] {
        self.pixel.map(|c| c as f32 + 0.5)
    }

    /// The pixel over the relief of `field`, or over the bare polygon.
    pub(super) fn pixel<'a>(&self, field: Option<&'a HeightField>) -> QuadPixel<'a> {
        let origin = self.pixel.map(|c| (c & !1) as i32);
        let pair = QuadPair::new(self.material, [origin; 2], [1; 8], [&self.planes; 2]);
        let lane = (self.pixel[0] & 1 | (self.pixel[1] & 1) << 1) as usize;
        let mut pixel = Quads::new(&pair, field).pixels()[lane];
        if let (Some((hit, _)), Some(_)) = (&self.past, field) {
            pixel.meet(hit);
        }
        pixel
    }
}

/// The indices of mesh and triangle that the centre of the pixel sees which is the frame's region.
fn seen(geometry: &Geometry, drawn: Drawn, [x, y]: [u32; 2]) -> Option<[u32; 2]> {
    let bands = TileGrid::new(drawn.settings).num_tiles[1] as usize;
    let mut found = vec![None; bands];
    let see = |tile: &CenterTile, found: &mut Option<[u32; 2]>| {
        for row in tile.rows().filter(|row| row.y == y as i32) {
            let lane = (x as i32 - row.x) as usize;
            if lane < 8 && row.seen >> lane & 1 == 1 {
                let mut names = [[0; 2]; 8];
                tile.names(&row, &mut names);
                *found = Some(names[lane]);
            }
        }
    };
    let centers = Centers { drawn, has_quads: false, see: &see };
    Rasterizer::default().see_centers(geometry, centers, &mut found);
    found.into_iter().flatten().next()
}

/// Where the ray through a pixel's centre hits the relief of a curved mesh.
pub(super) fn hit(outlines: &Outlines, triangle: [u32; 2], pixel: [u32; 2]) -> Option<ReliefHit> {
    if !outlines.is_curved(triangle[0]) {
        return None;
    }
    match outlines.met(triangle, pixel.map(|c| f64::from(c) + 0.5)) {
        Met::Relief(hit) => Some(hit),
        Met::Polygon | Met::Nothing(_) => None,
    }
}

impl<'a> Quads<'a> {
    /// A pair over the relief of `field`, or over the bare polygon.
    pub(super) fn new(pair: &QuadPair, field: Option<&'a HeightField>) -> Self {
        let bend = pair.bend().filter(|_| field.is_some());
        Self { uv: pair.uv, view: pair.view(), bend, field }
    }

    /// Its pixels with their rays.
    pub(super) fn pixels(self) -> [QuadPixel<'a>; 8] {
        let uv = self.uv.map(finite);
        let relief_depth = self.field.map_or(0.0, |field| field.relief_depth);
        let displacement = displacement_over(&self.view, self.bend.as_ref(), relief_depth);
        let depth = self.field.map_or(PixelLanes::ZERO, |field| march(field, &uv, &displacement));
        let hit = [0, 1].map(|i| uv[i] + displacement[i] * depth);
        std::array::from_fn(|lane| {
            let at = |lanes: &[PixelLanes; 2]| lanes.map(|lanes| lanes.as_array()[lane]);
            let hit_depth = depth.as_array()[lane];
            let ray =
                Ray { base: at(&uv), displacement: at(&displacement), hit_depth, hit: at(&hit) };
            QuadPixel { quads: self, lane, ray, past: None }
        })
    }

    fn footprints(&self, rule: &FootprintRule) -> Footprints {
        let Quads { uv, view, bend, field } = self;
        let all = u8::MAX;
        let (Some(bend), Some(field)) = (bend, field) else {
            return Footprints::of_quads(uv, view, *field, rule, all);
        };
        if !rule.is_traced {
            return Footprints::of_quads(uv, view, Some(field), rule, all).bent(view, bend, field);
        }
        let mut pixels = [Footprints::before_hits(uv, view, field, all).bent(view, bend, field)];
        Footprints::find_hits(&mut pixels, field, rule);
        let [pixels] = pixels;
        pixels
    }
}

impl QuadPixel<'_> {
    /// The pixel's footprint by a rule.
    pub(super) fn footprint(&self, rule: &FootprintRule) -> Footprint {
        self.quads.footprints(rule).lane(self.lane)
    }

    /// The ray hits the relief of a curved mesh.
    pub(super) fn meet(&mut self, hit: &ReliefHit) {
        self.ray.hit = hit.place.uv.map(|c| c as f32);
        self.ray.hit_depth = hit.place.depth as f32;
        self.past = Some(*hit);
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
