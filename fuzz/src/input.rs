//! What the targets read from a fuzzer's bytes: a small texture, a pixel, a filter.

use arbitrary::Arbitrary;
use basrelief::invariants::Footprint;
use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps, Wrap};
use basrelief::{Camera, Ewa, Filter, Horizon, Light, Material, Mesh, Scene, Visible};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// A number: mostly within -2 to 2, at times any float.
#[derive(Arbitrary, Clone, Copy, Debug)]
pub(crate) enum Number {
    Small(i16),
    Tiny(i16),
    Whole(i8),
    Any(f32),
}

impl Number {
    pub(crate) fn get(self) -> f32 {
        match self {
            Self::Small(n) => f32::from(n) / 16384.0,
            Self::Tiny(n) => f32::from(n) / 16_777_216.0,
            Self::Whole(n) => f32::from(n) / 8.0,
            Self::Any(x) => x,
        }
    }
}

/// A texture, a pixel and a filter with its options.
#[derive(Arbitrary, Clone, Debug)]
pub(crate) struct Input {
    size: [u8; 2],
    wrap: u8,
    texels: [u8; 24],
    footprint: [[Number; 2]; 4],
    filter: u8,
    budget: u8,
    lines: u8,
    anisotropy: u16,
}

impl Input {
    /// Maps of up to 12 x 12 texels.
    pub(crate) fn maps(&self) -> SurfaceMaps {
        let [w, h] = self.size.map(|n| 1 + u32::from(n % 12));
        let at = |x: u32, y: u32, i: u32| {
            f32::from(self.texels[((5 * x + 7 * y + x * y + i) % 24) as usize]) / 255.0
        };
        SurfaceMaps {
            albedo: Some(ColorImage::from_fn(w, h, |x, y| {
                [at(x, y, 3), at(x, y, 11), at(x, y, 17)]
            })),
            height: Some(HeightImage::from_fn(w, h, |x, y| at(x, y, 0))),
            wrap: [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp][usize::from(self.wrap % 3)],
            ..Default::default()
        }
    }

    /// The colours of [`maps`](Self::maps) the other way round.
    pub(crate) fn inverted(&self) -> ColorImage {
        let mut image = self.maps().albedo.expect("an albedo");
        image.texels.iter_mut().flatten().for_each(|c| *c = 65535 - *c);
        image
    }

    /// Repeating maps of 16 x 16 texels, which turn and shift exactly, with depths that can be
    /// halved.
    pub(crate) fn even_maps(&self) -> SurfaceMaps {
        let at = |x: u32, y: u32, i: u32| self.texels[((5 * x + 7 * y + x * y + i) % 24) as usize];
        let color = |x, y| [at(x, y, 3), at(x, y, 11), at(x, y, 17)].map(|c| f32::from(c) / 255.0);
        let mut height = HeightImage::from_fn(16, 16, |x, y| f32::from(at(x, y, 0)) / 255.0);
        height.texels.iter_mut().for_each(|h| *h = *h & !3 | 2);
        SurfaceMaps {
            albedo: Some(ColorImage::from_fn(16, 16, color)),
            height: Some(height),
            ..Default::default()
        }
    }

    /// Repeating maps large enough for tables, the texels of [`maps`](Self::maps) over and over with a
    /// few that are not; of one height, where there is one.
    pub(crate) fn large_maps(&self, height: Option<u16>) -> SurfaceMaps {
        let Self { texels, size: [w, h], .. } = self;
        let [w, h] = [192 + 2 * u32::from(w % 32), 96 + u32::from(h % 32)];
        let at = |x: u32, y: u32, i: u32| {
            f32::from(texels[((5 * x + 7 * y + x * y / 64 + i) % 24) as usize]) / 255.0
        };
        let mut heights = HeightImage::from_fn(w, h, |x, y| at(x / 3, y / 2, 0));
        if let Some(height) = height {
            heights.texels.fill(height);
        }
        SurfaceMaps {
            albedo: Some(ColorImage::from_fn(w, h, |x, y| {
                [at(x, y, 3), at(x, y / 4, 11), at(x / 2, y, 17)]
            })),
            height: Some(heights),
            wrap: [Wrap::Repeat, Wrap::Mirror][usize::from(self.wrap % 2)],
            ..Default::default()
        }
    }

    /// A pixel like [`near_pixel`](Self::near_pixel) that is eight times as wide.
    pub(crate) fn far_pixel(&self) -> Footprint {
        let Footprint { base, dx, dy, displacement, .. } = self.near_pixel();
        let wide = |d: [f32; 2]| d.map(|c| 8.0 * c);
        Footprint::new(base, wide(dx), wide(dy), displacement).bounded()
    }

    /// The pixel at a 1024th of a repeat within one of the middle, and with derivatives of up to
    /// half a repeat.
    pub(crate) fn near_pixel(&self) -> Footprint {
        let [center, dx, dy, displacement] = self.footprint.map(|pair| pair.map(Number::get));
        let within =
            |pair: [f32; 2], most: f32| pair.map(|c| if c.abs() <= most { c } else { most });
        let center = within(center, 1.0).map(|c| (c * 1024.0).round() / 1024.0);
        Footprint::new(center, within(dx, 0.5), within(dy, 0.5), within(displacement, 0.6))
            .bounded()
    }

    pub(crate) fn surface(&self) -> Surface {
        Surface::new(self.maps()).expect("valid maps")
    }

    pub(crate) fn pixel(&self) -> Footprint {
        let [center, dx, dy, displacement] = self.footprint.map(|pair| pair.map(Number::get));
        Footprint::new(center, dx, dy, displacement).bounded()
    }

    pub(crate) fn max_anisotropy(&self) -> f32 {
        1.0 + f32::from(self.anisotropy) / 64.0
    }

    fn texel_budget(&self) -> u32 {
        1 + u32::from(self.budget)
    }

    pub(crate) fn ewa(&self) -> Ewa {
        let (texel_budget, max_anisotropy) = (self.texel_budget(), self.max_anisotropy());
        Ewa { texel_budget, max_anisotropy, ..Ewa::default() }
    }

    pub(crate) fn visible(&self) -> Visible {
        let (texel_budget, max_anisotropy) = (self.texel_budget(), self.max_anisotropy());
        Visible { texel_budget, max_anisotropy, ..Visible::default() }
    }

    /// The sweep alone: tables are an estimate of it.
    pub(crate) fn horizon(&self) -> Horizon {
        let (lines, max_anisotropy) = (2 + u32::from(self.lines % 63), self.max_anisotropy());
        Horizon { lines, max_anisotropy, far_field: false, ..Horizon::default() }
    }

    /// Any filter that takes the texels of a footprint, with the options of the input.
    pub(crate) fn filter(&self) -> Filter {
        self.filter_limited(self.max_anisotropy())
    }

    /// [`filter`](Self::filter) with another greatest anisotropy, if it has one.
    pub(crate) fn filter_limited(&self, max_anisotropy: f32) -> Filter {
        let has_footprint =
            |filter: &Filter| !matches!(filter, Filter::Parallax(_) | Filter::Truth(_));
        let filters: Vec<Filter> = Filter::ALL.into_iter().filter(has_footprint).collect();
        let filter = filters[usize::from(self.filter) % filters.len()];
        match filter {
            Filter::Ewa(_) => Filter::Ewa(Ewa { max_anisotropy, ..self.ewa() }),
            Filter::Visible(_) => Filter::Visible(Visible { max_anisotropy, ..self.visible() }),
            Filter::Horizon(_) => Filter::Horizon(Horizon { max_anisotropy, ..self.horizon() }),
            as_it_is => as_it_is,
        }
    }
}

/// A floor of small steps under a light, which command lines place a camera and lights around.
pub(crate) fn floor() -> Scene {
    let steps = HeightImage::from_fn(8, 8, |x, y| ((x + y) % 4) as f32 / 3.0);
    let surface = Surface::new(SurfaceMaps { height: Some(steps), ..Default::default() })
        .expect("valid maps");
    let corners = [(-4.0, 4.0), (4.0, 4.0), (4.0, -4.0), (-4.0, -4.0)];
    let positions = corners.map(|(x, z)| Vec3::new(x, -1.0, z)).to_vec();
    let tex_coords = corners.map(|(x, z)| Vec2::new(x, -z)).to_vec();
    Scene {
        meshes: vec![Mesh::new(positions, tex_coords, vec![], vec![[0, 1, 2], [0, 2, 3]])],
        materials: vec![Material { surface: Some(Arc::new(surface)), ..Material::default() }],
        camera: Camera::framing(Vec3::splat(-4.0), Vec3::splat(4.0), 1.0),
        lights: vec![Light::sun(Vec3::Y, Vec3::ONE)],
        ..Scene::default()
    }
}
