//! One number, or three, for every pixel of a frame.

use super::cut::Cut;
use super::ground::{QuadPixel, Quads, hit};
use super::light::{RAYS, hit_of, plain_hit};
use super::sets::Sets;
use crate::error::Result;
use crate::filter::{LevelChoice, Prepared, Scratch};
use crate::footprint::{Ellipse, Footprint, Footprints};
use crate::geometry::{self, Projection};
use crate::light::SurfacePoint;
use crate::light::exact::{ExactLight, Hit};
use crate::raster::{Drawn, Follow, Pool, QuadBlock, QuadPair, Rasterizer};
use crate::relief::{finite, stretch};
use crate::render::{
    Outlines, Passages, PreparedScene, Shader, clearance, pixel_center, point_of, surface_point,
};
use crate::scene::{Material, Scene};
use crate::settings::{Lighting, Settings};
use crate::shell::ReliefHit;
use crate::simd::PixelLanes;
use crate::texture::Texel;
use std::sync::atomic::{AtomicU32, Ordering};

/// What [`measure`] gives of each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum View {
    /// How many triangles the pixel's samples see, and the share of the samples that see one.
    Coverage,
    /// The mip level that the filter reads, 0 the finest, and the share of the colour that
    /// far-field tables give.
    Mip,
    /// Texels of the full texture in the pixel's ellipse of formula (1).
    Footprint,
    /// The part of the ellipse's texels that the relief leaves visible, 0 to 1, and how many texels
    /// there are.
    Visible,
    /// The part of the texel rows along the view that make the floating horizon rise, 0 to 1, and
    /// how many rows there are.
    Horizon,
    /// Distance along the view to the relief, in world units.
    Depth,
    /// The unit normal of the relief at the hit, in world space.
    Normal,
    /// Texture coordinates of the hit in repeats.
    Uv,
    /// The part of what suns and points send that nothing hides from the hit, 0 to 1; 1 without
    /// lights.
    Shadow,
    /// What all lights and the sky light a white surface to at the hit, linear RGB.
    Light,
    /// The part of the sky that nothing hides from the hit, weighed by the cosine, 0 to 1.
    Occlusion,
}

impl View {
    /// Whether it looks for light, so that the scene's normals and lights are asked for.
    pub fn is_of_light(self) -> bool {
        matches!(self, Self::Shadow | Self::Light | Self::Occlusion)
    }
}

/// Numbers of every pixel; what a [`View`] does not give is 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Pixels a row.
    pub width: u32,
    /// Rows; row 0 is the top.
    pub height: u32,
    /// Row by row; `None` where no surface is seen, or none that has what is asked for.
    pub pixels: Vec<Option<[f32; 3]>>,
}

/// Measures a frame. All views but [`View::Coverage`] look through the pixels' centres, whatever
/// `msaa` says.
///
/// # Errors
/// Names a part of the scene or a setting that is not valid.
pub fn measure(scene: &Scene, settings: &Settings, view: View) -> Result<Measured> {
    scene.validate()?;
    settings.validate()?;
    let mut prepared = PreparedScene::new(scene);
    let asks_levels = matches!(view, View::Mip | View::Horizon);
    if asks_levels {
        prepared.make_ready(scene, settings);
    }
    let msaa = if view == View::Coverage { settings.msaa } else { 1 };
    let is_lit = view == View::Normal || view.is_of_light();
    let lighting = if is_lit { Lighting::Lit } else { Lighting::Unlit };
    let asked = settings;
    let settings = Settings { msaa, lighting, ..settings.clone() };
    let pool = Pool::default();
    let geometry = geometry::project(scene, &settings);
    let outlines = prepared.outlines(scene, asked, geometry.projection());
    let outlines = outlines.as_ref();
    let passages = Passages::new(scene, geometry.projection(), outlines);
    let follow = passages.as_ref().map(|passages| passages as &dyn Follow);
    let shader = Shader::new(scene, &settings, &prepared, outlines, &pool);
    let probe = Probe {
        scene,
        asked,
        settings: &settings,
        view,
        asks_levels,
        prepared: &prepared,
        shader: &shader,
        projection: geometry.projection(),
        outlines,
    };
    let pixels = Pixels::new(&settings);
    let shade = |block: &QuadBlock, colors: &mut Vec<[PixelLanes; 3]>| {
        for (pair, values) in block.pairs().zip(probe.values(block)) {
            values
                .into_iter()
                .enumerate()
                .for_each(|(lane, value)| pixels.set(&pair, lane, view, value));
        }
        colors.resize(colors.len() + block.num_pairs(), [PixelLanes::ZERO; 3]);
    };
    let mut colors =
        vec![[0.0; 4]; settings.drawn().width as usize * settings.drawn().height as usize];
    let group = |triangle| prepared.group(scene, triangle);
    let drawn = Drawn { scene, settings: &settings, group: Some(&group), follow };
    Rasterizer::default().draw(&geometry, drawn, &shade, &|| 0.0, &mut colors);
    Ok(pixels.measured(&settings, view))
}

/// Numbers on their way in: a pixel belongs to one thread at a time, but to the compiler to all.
struct Pixels {
    width: usize,
    values: Vec<[AtomicU32; 4]>,
}

impl Pixels {
    fn new(settings: &Settings) -> Self {
        let num = settings.width as usize * settings.height as usize;
        Self {
            width: settings.width as usize,
            values: (0..num).map(|_| Default::default()).collect(),
        }
    }

    fn set(&self, pair: &QuadPair, lane: usize, view: View, value: Option<[f32; 3]>) {
        if pair.coverage[lane] == 0 {
            return;
        }
        let [x, y] = pair.pixel(lane).map(|c| c as usize);
        let numbers = &self.values[y * self.width + x];
        if view == View::Coverage {
            numbers[0].fetch_add(1, Ordering::Relaxed);
            numbers[1].fetch_add(u32::from(pair.coverage[lane]), Ordering::Relaxed);
        } else if let Some(value) = value {
            numbers.iter().zip(value).for_each(|(n, v)| n.store(v.to_bits(), Ordering::Relaxed));
            numbers[3].store(1, Ordering::Relaxed);
        }
    }

    fn measured(self, settings: &Settings, view: View) -> Measured {
        let pixels = self.values.into_iter().map(|numbers| {
            let [a, b, c, is_set] = numbers.map(AtomicU32::into_inner);
            match view {
                View::Coverage => (b > 0).then(|| [a as f32, b as f32 / settings.msaa as f32, 0.0]),
                _ => (is_set != 0).then(|| [a, b, c].map(f32::from_bits)),
            }
        });
        Measured { width: settings.width, height: settings.height, pixels: pixels.collect() }
    }
}

/// Measures pixels.
struct Probe<'a> {
    scene: &'a Scene,
    /// The settings that are asked about; `settings` draw what answers.
    asked: &'a Settings,
    settings: &'a Settings,
    view: View,
    asks_levels: bool,
    prepared: &'a PreparedScene,
    shader: &'a Shader<'a>,
    projection: &'a Projection,
    outlines: Option<&'a Outlines<'a>>,
}

/// A pixel, and what frames read for it.
struct Seen<'a> {
    pixel: QuadPixel<'a>,
    footprint: Footprint,
    choice: LevelChoice,
}

impl Probe<'_> {
    /// What a block's pairs give, `None` for what is not covered.
    fn values(&self, block: &QuadBlock) -> Vec<[Option<[f32; 3]>; 8]> {
        let index = [block.material, block.group];
        let ground = self.prepared.ground(self.scene, self.asked, index);
        let ground = ground.filter(|_| self.view != View::Coverage);
        let Some(ground) = ground else {
            let material = &self.scene.materials[block.material];
            return block.pairs().map(|pair| self.of_plain(&pair, material)).collect();
        };
        let (prepared, is_lit) = (ground.prepared, ground.asks_for_lights());
        // Made and chosen for the whole block, as frames do it.
        let (mut footprints, mut scratch) = (Vec::<Footprints>::new(), Scratch::default());
        let with = (prepared, &self.shader.traits.rule);
        self.shader.footprints(with, (block, 0..block.num_pairs()), &mut footprints);
        let choices = if self.asks_levels {
            self.settings.filter.levels(prepared, &footprints, is_lit, &mut scratch)
        } else {
            vec![Default::default(); footprints.len()]
        };
        let pairs = block.pairs().zip(footprints.iter().zip(choices));
        pairs
            .map(|(pair, (footprints, choices))| {
                let pixels = Quads::new(&pair, prepared.field()).pixels();
                each_covered(&pair, |lane| {
                    let seen = Seen {
                        pixel: self.followed(&pair, pixels[lane]),
                        footprint: footprints.lane(lane),
                        choice: choices[lane],
                    };
                    if self.view.is_of_light() {
                        let hit = |point| hit_of(ground.material, prepared, &seen.pixel, point);
                        return self.light(&pair, (lane, seen.pixel.past), hit);
                    }
                    self.value(&pair, prepared, &seen)
                })
            })
            .collect()
    }

    /// Pixels of a material without a texture. How many triangles there are is counted, not
    /// measured.
    fn of_plain(&self, pair: &QuadPair, material: &Material) -> [Option<[f32; 3]>; 8] {
        match self.view {
            View::Depth => each_covered(pair, |lane| [self.depth(pair, lane, 0.0), 0.0, 0.0]),
            View::Normal => each_covered(pair, |lane| world(pair, lane, Texel::UP)),
            View::Shadow | View::Light | View::Occlusion => each_covered(pair, |lane| {
                self.light(pair, (lane, None), |point| plain_hit(material, point))
            }),
            View::Coverage
            | View::Mip
            | View::Footprint
            | View::Visible
            | View::Horizon
            | View::Uv => [None; 8],
        }
    }

    /// A pixel of a pair whose ray is followed where its mesh is curved.
    fn followed<'p>(&self, pair: &QuadPair, mut pixel: QuadPixel<'p>) -> QuadPixel<'p> {
        let (place, triangle) = (pair.pixel(pixel.lane), pair.planes[pixel.lane / 4].triangle);
        let hit = |outlines| hit(outlines, triangle, place.map(|c| c as u32));
        if let Some(hit) = self.outlines.and_then(hit) {
            pixel.meet(&hit);
        }
        pixel
    }

    /// What light does at a lane's hit.
    fn light<'a>(
        &self,
        pair: &QuadPair,
        (lane, past): (usize, Option<ReliefHit>),
        hit: impl Fn(SurfacePoint) -> Hit<'a>,
    ) -> [f32; 3] {
        let planes = pair.planes[lane / 4];
        let above = self.outlines.zip(past).map(|(all, hit)| all.point(planes.triangle[0], &hit));
        let of_polygon = || surface_point(planes, pixel_center(pair, lane));
        let Some(point) = above.or_else(of_polygon) else { return [0.0; 3] };
        let occluders = self.prepared.occluders(self.scene);
        let outlined = self.outlines.and_then(Outlines::outlined);
        let exact = ExactLight { scene: self.scene, occluders, outlined };
        let mut hit = hit(point);
        let at = (pixel_center(pair, lane), &point);
        hit.clearance = clearance(self.scene, (planes, hit.spot.relief), at);
        let reaching = exact.reaching(&hit, RAYS);
        match self.view {
            View::Shadow => [reaching.part(), 0.0, 0.0],
            View::Occlusion => [reaching.open, 0.0, 0.0],
            _ => reaching.shown().to_array(),
        }
    }

    fn value(&self, pair: &QuadPair, prepared: &Prepared, seen: &Seen) -> [f32; 3] {
        let (surface, filter) = (prepared.surface(), &self.settings.filter);
        let Seen { pixel, footprint, choice } = seen;
        match self.view {
            View::Mip => [choice.level as f32 + choice.blend, choice.far_share, 0.0],
            View::Footprint => {
                let formulas = filter.traits().rule.formulas;
                let ellipse = Ellipse::new(footprint, surface.base().texels_per_repeat(), formulas);
                [ellipse.widened(filter.max_anisotropy(), formulas).area(), 0.0, 0.0]
            }
            View::Visible => {
                let sets = Sets::new(prepared, pixel, filter);
                [
                    sets.visible.len() as f32 / sets.all.len().max(1) as f32,
                    sets.all.len() as f32,
                    0.0,
                ]
            }
            View::Horizon => {
                let [seen, all] =
                    Cut::new(surface, pixel, choice.level, filter.max_anisotropy()).num_seen();
                [seen as f32 / all.max(1) as f32, all as f32, 0.0]
            }
            View::Depth if pixel.past.is_some() => {
                let distance = pixel.past.map_or(0.0, |hit| hit.distance as f32);
                // Not before the polygon, whatever is rounded.
                [distance.max(self.depth(pair, pixel.lane, 0.0)), 0.0, 0.0]
            }
            View::Depth => {
                let sunk =
                    prepared.field().map_or(0.0, |field| field.relief_depth * pixel.ray.hit_depth);
                [self.depth(pair, pixel.lane, sunk), 0.0, 0.0]
            }
            View::Normal => {
                let [x, y] = pixel.texel(surface);
                world(pair, pixel.lane, surface.base().texel(x, y).normal)
            }
            View::Uv => [pixel.ray.hit[0], pixel.ray.hit[1], 0.0],
            View::Coverage | View::Shadow | View::Light | View::Occlusion => [0.0; 3],
        }
    }

    /// Distance along the view to where a ray has sunk so many repeats below the polygon.
    fn depth(&self, pair: &QuadPair, lane: usize, sunk: f32) -> f32 {
        let ([x, y], planes) = (pair.centers(), pair.planes[lane / 4]);
        let [a, b, c] = planes.nearness;
        let polygon = self.projection.distance(x * a + y * b + PixelLanes::splat(c));
        self.projection.behind(polygon, finite(stretch(&pair.view(), sunk))).as_array()[lane]
    }
}

fn each_covered(
    pair: &QuadPair,
    mut value: impl FnMut(usize) -> [f32; 3],
) -> [Option<[f32; 3]>; 8] {
    let mut values = [None; 8];
    pair.covered().for_each(|lane| values[lane] = Some(value(lane)));
    values
}

/// A normal of the texture's frame in the world, on the side that the eye sees.
fn world(pair: &QuadPair, lane: usize, local: [f32; 3]) -> [f32; 3] {
    pair.lit().map_or([0.0; 3], |lit| point_of(&lit, lane).in_world(local).to_array())
}
