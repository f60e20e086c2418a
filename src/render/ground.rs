//! What pixels lie on: a material with its texture, and the polygon at places of the screen.

use super::gloss::PieceGloss;
use super::hidden_lights::HiddenLights;
use super::mapped::{Glow, MappedGloss};
use super::open_sky::OpenSky;
use super::outlines::Outlines;
use crate::filter::Prepared;
use crate::footprint::{Footprint, Footprints};
use crate::light::exact::Clearance;
use crate::light::{LocalLights, Sheen, SmoothTriangle, SurfacePoint};
use crate::raster::{AttributePlanes, LitLanes, LitPlanes, Plane, QuadPair};
use crate::relief::HeightField;
use crate::scene::{Finish, Material, Scene};
use crate::shell::ReliefHit;
use crate::simd::PixelLanes;
use crate::texture::{FULL_F32, Surface, Texel};
use glam::Vec3;

/// What all pixels of a block lie on.
#[derive(Clone, Copy)]
pub(crate) struct Ground<'a> {
    pub(crate) material: &'a Material,
    /// What is filtered, whose colours are lit already where they are [baked](Self::baked).
    pub(crate) prepared: &'a Prepared,
    /// The same before light.
    pub(crate) unlit: &'a Prepared,
    /// The same in the colours of its diffuse layer, where a texture says what of it is metal.
    pub(crate) diffuse: &'a Prepared,
    /// Whether there is light.
    pub(crate) is_lit: bool,
    /// By what its texels are lit as they are swept: a relief on what is curved, under suns and a sky.
    pub(crate) swept: Option<Swept>,
    /// Where its light is baked.
    pub(crate) baked: Option<LitPiece<'a>>,
    /// What it sends out by a texture, in a lit frame.
    pub(crate) glow: Option<&'a Glow>,
    /// What it reflects, where highlights of some lights are swept as diffuse light is.
    pub(crate) gloss: Option<&'a MappedGloss>,
    /// What meshes hide of its lights, where they are evaluated place by place.
    pub(super) hidden: Option<&'a HiddenLights>,
}

/// Lights of a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Swept {
    /// A bit for each light.
    pub(crate) lights: u64,
    /// Whether the sky is one of them.
    pub(crate) has_sky: bool,
    /// What is asked for of a glossy surface, if that is not its diffuse layer alone.
    pub(crate) sheen: Option<Sheen>,
}

/// A side of a flat piece whose light is baked.
#[derive(Clone, Copy)]
pub(crate) struct LitPiece<'a> {
    /// Unit normal on that side.
    pub(crate) normal: Vec3,
    /// Under the sky alone, and under each sun alone; nothing where no mesh can hide a sun from it.
    pub(crate) apart: &'a [Prepared],
    /// Of a glossy surface, what the horizon's highlights of each sun are made of, and what it reflects
    /// of the sky.
    pub(super) gloss: &'a [PieceGloss],
    /// What meshes leave of the sky, where they hide any of it.
    pub(crate) open_sky: Option<&'a OpenSky>,
}

impl Ground<'_> {
    /// Takes from the lights of pixels, in the order of their covered lanes, what a texture of
    /// occlusion says.
    pub(super) fn occlude(&self, pixels: &[Footprints], lights: &mut [LocalLights]) {
        let Some(map) = &self.material.maps.occlusion else { return };
        let pixels = pixels.iter().flat_map(|p| p.covered().map(|lane| p.lane(lane)));
        for (pixel, lights) in pixels.zip(lights) {
            let share = map.over(pixel.hit, [pixel.dx, pixel.dy])[0].min(1.0);
            lights.occlude(Vec3::splat(share));
        }
    }

    /// The rays of up to eight samples of a pixel through places on the screen.
    pub(super) fn rays(
        &self,
        planes: &AttributePlanes,
        ([x, y], num_samples): ([PixelLanes; 2], usize),
        (pixel, is_traced): (&Footprint, bool),
    ) -> Footprints {
        // Beyond the horizon there is no surface to sample.
        let is_before = eval(&planes.inverse_w, x, y).simd_gt(PixelLanes::ZERO).to_bitmask() as u8;
        // The last group may hold fewer than eight samples.
        let covered = is_before & (0xff_u16 >> (8 - num_samples)) as u8;
        let (uv, view) = planes.at(x, y);
        let field = self.prepared.field();
        let rays = Footprints::of_samples((&uv, &view), field, is_traced, pixel, covered);
        match field {
            Some(field) if planes.bend != [[0.0; 2]; 3] && !is_traced => {
                rays.bent(&view, &planes.bend.map(|of| of.map(PixelLanes::splat)), field)
            }
            _ => rays,
        }
    }

    /// Where the rays of samples hit the relief of a curved mesh; `None` where it is flat.
    pub(super) fn hits(
        &self,
        outlines: &Outlines,
        planes: &AttributePlanes,
        ([x, y], num_samples): ([PixelLanes; 2], usize),
    ) -> Option<[Option<ReliefHit>; 8]> {
        let is_curved = self.prepared.field().is_some() && outlines.is_curved(planes.triangle[0]);
        let asked = (0xff_u16 >> (8 - num_samples)) as u8;
        is_curved.then(|| outlines.hits(planes.triangle, [x, y], asked))
    }

    /// Whether lights are evaluated place by place.
    pub(crate) fn asks_for_lights(&self) -> bool {
        self.is_lit && self.baked.is_none() && self.swept.is_none()
    }

    /// What the material does with light at a pixel: around its hit, whatever hides parts of it.
    pub(super) fn finish(&self, pixel: &Footprint) -> Finish {
        let finish = self.material.finish(|map| map.over(pixel.hit, [pixel.dx, pixel.dy]));
        Finish { emissive: self.emissive(), ..finish }
    }

    /// Whether the horizon shows its diffuse layer through what lies above each texel.
    pub(super) fn is_seen_through(&self) -> bool {
        match self.swept {
            Some(swept) => matches!(swept.sheen, Some(Sheen::Layer(_))),
            None => self.prepared.shows_eye(),
        }
    }

    /// Whether no place of it has a diffuse layer.
    pub(super) fn is_all_metal(&self) -> bool {
        self.material.metallic == 1.0 && self.material.maps.metallic.is_none()
    }

    /// What it sends out without a texture.
    pub(super) fn emissive(&self) -> Vec3 {
        if self.glow.is_some() { Vec3::ZERO } else { self.material.emissive }
    }

    /// The colour of a surface's texel as the material shows it.
    pub(super) fn color_of(&self, surface: &Surface, texel: &Texel) -> Vec3 {
        let scale = surface.color_scale() / FULL_F32;
        Vec3::from(texel.color) * self.material.base_color * scale
    }

    /// What the unit of stored colours is worth.
    pub(super) fn scale(&self) -> f32 {
        self.prepared.surface().color_scale() / FULL_F32
    }

    /// Stored colours as the material shows them.
    #[inline(always)]
    pub(super) fn tinted(&self, stored: &[PixelLanes; 3]) -> [PixelLanes; 3] {
        // Products in the order of `lit`, so that a colour without light has the same bits in both.
        let scale = self.scale();
        std::array::from_fn(|c| stored[c] * self.material.base_color[c] * scale)
    }
}

/// Samples of a pixel that hit a relief.
pub(super) fn of_hits(hits: &[Option<ReliefHit>; 8], pixel: &Footprint) -> Footprints {
    let uv = |axis: usize| {
        PixelLanes::new(hits.map(|hit| hit.map_or(0.0, |hit| hit.place.uv[axis] as f32)))
    };
    let covered = hits.iter().enumerate().map(|(lane, hit)| u8::from(hit.is_some()) << lane).sum();
    Footprints::of_hits([uv(0), uv(1)], pixel, covered)
}

pub(super) fn in_lanes(colors: &[Vec3; 8]) -> [PixelLanes; 3] {
    [0, 1, 2].map(|c| PixelLanes::new(colors.map(|color| color[c])))
}

pub(super) fn eval([a, b, c]: &Plane, x: PixelLanes, y: PixelLanes) -> PixelLanes {
    x * *a + y * *b + *c
}

/// Where a lane's pixel has its centre on the screen.
pub(crate) fn pixel_center(pair: &QuadPair, lane: usize) -> [f32; 2] {
    let [x, y] = pair.pixel(lane);
    [x as f32 + 0.5, y as f32 + 0.5]
}

/// The polygon's point at a lane's pixel centre.
pub(crate) fn point_of(lit: &LitLanes, lane: usize) -> SurfacePoint {
    let at = |lanes: &[PixelLanes; 3]| Vec3::from(lanes.map(|lanes| lanes.as_array()[lane]));
    SurfacePoint {
        position: at(&lit.position),
        normal: at(&lit.normal),
        tangents: [at(&lit.tangent_u), at(&lit.tangent_v)],
        is_back: lit.is_back.to_bitmask() >> lane & 1 == 1,
    }
}

/// The polygon's point at a place of the screen; `None` without lighting.
pub(crate) fn surface_point(planes: &AttributePlanes, [x, y]: [f32; 2]) -> Option<SurfacePoint> {
    let LitPlanes { position, normal, tangent_u, tangent_v, is_back } = planes.lit.as_deref()?;
    let [a, b, c] = planes.inverse_w;
    // Divided once for all twelve coordinates.
    let w = 1.0 / (a * x + b * y + c);
    let at = |planes: &[Plane; 3]| Vec3::from(planes.map(|[a, b, c]| (a * x + b * y + c) * w));
    let tangents = [at(tangent_u), at(tangent_v)];
    Some(SurfacePoint { position: at(position), normal: at(normal), tangents, is_back: *is_back })
}

/// How light gets clear of a polygon from its point at a place of the screen: out of a relief it finds
/// its way by that.
pub(crate) fn clearance(
    scene: &Scene,
    (planes, relief): (&AttributePlanes, Option<&HeightField>),
    ([x, y], point): ([f32; 2], &SurfacePoint),
) -> Clearance {
    if relief.is_some() {
        return Clearance::default();
    }
    let triangle = SmoothTriangle::new(scene, planes.triangle);
    let next = [[x + 1.0, y], [x, y + 1.0]].map(|place| surface_point(planes, place));
    let steps = next.map(|next| next.map_or(0.0, |p| (p.position - point.position).length()));
    Clearance { lift: triangle.lift(point.position, point.is_back), reach: steps[0] + steps[1] }
}
