//! One number, or three, for every pixel of a frame.

use super::cut::Cut;
use super::ground::Quad;
use super::sets::Sets;
use crate::error::Result;
use crate::filter::horizon::{Patches, picture_bins};
use crate::filter::{Ellipse, FarField, Footprint, PixelFootprints, ewa, isotropic, level_within_budget, parallax};
use crate::geometry;
use crate::raster::{self, QuadPair};
use crate::relief::HeightField;
use crate::scene::Scene;
use crate::settings::{Derivatives, Filter, Formulas, Lighting, Settings};
use crate::simd::PixelLanes;
use crate::texture::{Surface, unpack_normal};
use glam::Vec3;
use std::sync::atomic::{AtomicU32, Ordering};

/// What [`measure`] gives of each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum View {
    /// How many triangles the pixel's samples see, and the share of the samples that see one.
    Coverage,
    /// The mip level that the filter reads, 0 the finest, and the share of the colour that far-field tables give.
    Mip,
    /// Texels of the full texture in the pixel's ellipse of formula (1).
    Footprint,
    /// The part of the ellipse's texels that the relief leaves visible, 0 to 1, and how many texels there are.
    Visible,
    /// The part of the texel rows along the view that make the floating horizon rise, 0 to 1, and how many rows there are.
    Horizon,
    /// Distance along the view to the relief, in world units.
    Depth,
    /// The unit normal of the relief at the hit, in world space.
    Normal,
    /// Texture coordinates of the hit in repeats.
    Uv,
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

/// Measures a frame. All views but [`View::Coverage`] look through the pixels' centres, whatever `msaa` says.
///
/// # Errors
/// Names a part of the scene or a setting that is not valid.
pub fn measure(scene: &Scene, settings: &Settings, view: View) -> Result<Measured> {
    scene.validate()?;
    settings.validate()?;
    let is_lit = settings.lighting == Lighting::Lit;
    let msaa = if view == View::Coverage { settings.msaa } else { 1 };
    let lighting = if view == View::Normal { Lighting::Lit } else { Lighting::Unlit };
    let settings = Settings { msaa, lighting, ..settings.clone() };
    let grounds = scene.materials.iter().map(|material| {
        let surface = material.surface.as_deref()?;
        Some(Ground::new(surface, &settings, (view, is_lit)))
    });
    let probe = Probe { settings: &settings, view, is_lit, grounds: grounds.collect() };
    let pixels = Pixels::new(&settings);
    let shade = |pair: &QuadPair| {
        for (lane, value) in probe.values(pair).into_iter().enumerate() {
            pixels.set(pair, lane, view, value);
        }
        [PixelLanes::ZERO; 3]
    };
    let geometry = geometry::project(scene, &settings);
    raster::draw(&geometry, scene, &settings, &shade, &mut crate::Frame::filled(1, 1, [0.0; 4]));
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
        Self { width: settings.width as usize, values: (0..num).map(|_| Default::default()).collect() }
    }

    fn set(&self, pair: &QuadPair, lane: usize, view: View, value: Option<[f32; 3]>) {
        if pair.coverage[lane] == 0 {
            return;
        }
        let [x, y] = pair.origin[lane / 4];
        let [x, y] = [x + (lane as i32 & 1), y + (lane as i32 >> 1 & 1)].map(|c| c as usize);
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

/// What pixels on one material need.
struct Ground<'a> {
    surface: &'a Surface,
    field: Option<HeightField>,
    far: Option<FarField>,
}

impl<'a> Ground<'a> {
    fn new(surface: &'a Surface, settings: &Settings, (view, is_lit): (View, bool)) -> Self {
        let is_traced = settings.parallax && surface.relief_depth > 0.0;
        let has_tables = is_traced && !is_lit && settings.filter == Filter::Horizon && settings.far_field;
        Self {
            surface,
            field: is_traced.then(|| HeightField::new(surface)),
            far: if has_tables && view == View::Mip { FarField::new(surface, settings) } else { None },
        }
    }
}

/// Measures pixels.
struct Probe<'a> {
    settings: &'a Settings,
    view: View,
    is_lit: bool,
    grounds: Vec<Option<Ground<'a>>>,
}

impl Probe<'_> {
    fn values(&self, pair: &QuadPair) -> [Option<[f32; 3]>; 8] {
        let ground = self.grounds[pair.material].as_ref();
        match (ground, self.view) {
            // How many triangles there are is counted, not measured.
            (_, View::Coverage) => [None; 8],
            (Some(ground), _) => {
                let quads = Quad::lanes(&pair.uv, &pair.view(), ground.surface, ground.field.as_ref());
                self.each_covered(pair, |lane| self.value(pair, ground, &quads[lane]))
            }
            (None, View::Depth) => self.each_covered(pair, |lane| [self.distance(pair, lane), 0.0, 0.0]),
            (None, View::Normal) => self.each_covered(pair, |lane| world(pair, lane, [0.0, 0.0, 1.0])),
            (None, _) => [None; 8],
        }
    }

    fn each_covered(&self, pair: &QuadPair, mut value: impl FnMut(usize) -> [f32; 3]) -> [Option<[f32; 3]>; 8] {
        std::array::from_fn(|lane| (pair.coverage[lane] > 0).then(|| value(lane)))
    }

    fn value(&self, pair: &QuadPair, ground: &Ground, quad: &Quad) -> [f32; 3] {
        let (surface, settings) = (ground.surface, self.settings);
        match self.view {
            View::Mip => self.mip(ground, quad),
            View::Footprint => {
                let ellipse = Ellipse::new(&self.footprint(quad), surface.texels_per_repeat(0), settings.formulas);
                [ellipse.widened(settings.max_anisotropy, settings.formulas).area(), 0.0, 0.0]
            }
            View::Visible => {
                let sets = Sets::new(surface, quad, ground.field.is_some(), settings);
                [sets.visible.len() as f32 / sets.all.len().max(1) as f32, sets.all.len() as f32, 0.0]
            }
            View::Horizon => {
                let [seen, all] = Cut::new(surface, quad, self.swept(ground, quad).0, settings).num_seen();
                [seen as f32 / all.max(1) as f32, all as f32, 0.0]
            }
            View::Depth => {
                // The ray sinks by gamma repeats on its way from the eye, and on by the depth of the hit.
                let [.., gamma] = pair.view().map(|lanes| lanes.as_array()[quad.lane].abs());
                let sunk = ground.field.as_ref().map_or(0.0, |_| surface.relief_depth * quad.ray.hit_depth);
                [self.distance(pair, quad.lane) * (1.0 + sunk / gamma.max(f32::MIN_POSITIVE)), 0.0, 0.0]
            }
            View::Normal => {
                let [x, y] = quad.texel(surface);
                let normal = surface.has_normals.then(|| unpack_normal(surface.levels[0].packed(x, y)[2]));
                world(pair, quad.lane, normal.unwrap_or([0.0, 0.0, 1.0]))
            }
            View::Uv => [quad.ray.hit[0], quad.ray.hit[1], 0.0],
            View::Coverage => [0.0; 3],
        }
    }

    /// Distance along the view to the polygon.
    fn distance(&self, pair: &QuadPair, lane: usize) -> f32 {
        let [x, y] = pair.centers().map(|lanes| lanes.as_array()[lane]);
        let [a, b, c] = pair.planes[lane / 4].inverse_w;
        1.0 / (a * x + b * y + c)
    }

    /// The footprint of the filters that put it around the hit.
    fn footprint(&self, quad: &Quad) -> Footprint {
        quad.filtered(self.settings)
    }

    fn mip(&self, ground: &Ground, quad: &Quad) -> [f32; 3] {
        let (surface, settings) = (ground.surface, self.settings);
        let last = (surface.levels.len() - 1) as f32;
        let level = match settings.filter {
            Filter::Nearest | Filter::Bilinear | Filter::Truth => 0.0,
            Filter::Trilinear => level_of_size(isotropic::longest_side(surface, &self.footprint(quad))).min(last),
            Filter::Ewa => ewa::level(surface, &self.footprint(quad), settings) as f32,
            Filter::Visible => level_within_budget(surface, &self.footprint(quad), settings).0 as f32,
            Filter::Parallax => {
                let footprint = quad.footprint((Derivatives::Flat, Formulas::Meant));
                level_of_size(parallax::texel_size(surface, &footprint, settings.samples)).min(last)
            }
            Filter::Horizon => {
                let (level, share) = self.swept(ground, quad);
                return [level as f32, share, 0.0];
            }
        };
        [level, 0.0, 0.0]
    }

    /// The level that the floating horizon takes for a pixel by itself, and the share of its colour that comes from tables.
    fn swept(&self, ground: &Ground, quad: &Quad) -> (usize, f32) {
        let differences = quad.differences((Derivatives::Flat, Formulas::Meant));
        let pixels = [PixelFootprints::new(&quad.uv, &differences, quad.reach)];
        let (surface, far, settings) = (ground.surface, ground.far.as_ref(), self.settings);
        let patches =
            Patches { surface, far, pixels: &pixels, settings, num_bins: picture_bins(settings, self.is_lit) };
        let share = far.map_or(0.0, |far| far.shares(surface, &pixels[0], settings).as_array()[quad.lane]);
        (patches.level(quad.lane as u8, self.is_lit), share)
    }
}

/// The mip level, in fractions, whose texels have a size in base texels.
fn level_of_size(size: f32) -> f32 {
    let (level, blend) = isotropic::level_of_size(size);
    level as f32 + blend
}

/// A normal of the texture frame in world space, on the side that the eye sees.
fn world(pair: &QuadPair, lane: usize, [x, y, z]: [f32; 3]) -> [f32; 3] {
    let Some(lit) = pair.lit() else { return [0.0; 3] };
    let at = |lanes: &[PixelLanes; 3]| Vec3::from(lanes.map(|lanes| lanes.as_array()[lane]));
    let normal = at(&lit.normal).normalize_or(Vec3::Z);
    let normal = if pair.view()[2].as_array()[lane] < 0.0 { -normal } else { normal };
    let [u, v] = [at(&lit.tangent_u), at(&lit.tangent_v)].map(|t| (t - normal * t.dot(normal)).normalize_or_zero());
    (u * x + v * y + normal * z).normalize_or(normal).to_array()
}
