//! What the targets of the filters read from a fuzzer's bytes: a small texture, a pixel, settings.

use arbitrary::Arbitrary;
use basrelief::invariants::Pixel;
use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps, Wrap};
use basrelief::{Filter, Settings};

/// A number: mostly within -2 to 2, at times any float.
#[derive(Arbitrary, Clone, Copy, Debug)]
pub enum Number {
    Small(i16),
    Tiny(i16),
    Whole(i8),
    Any(f32),
}

impl Number {
    pub fn get(self) -> f32 {
        match self {
            Self::Small(n) => f32::from(n) / 16384.0,
            Self::Tiny(n) => f32::from(n) / 16_777_216.0,
            Self::Whole(n) => f32::from(n) / 8.0,
            Self::Any(x) => x,
        }
    }
}

/// A texture, a pixel and settings.
#[derive(Arbitrary, Clone, Debug)]
pub struct Input {
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
    pub fn maps(&self) -> SurfaceMaps {
        let [w, h] = self.size.map(|n| 1 + u32::from(n % 12));
        let at = |x: u32, y: u32, i: u32| f32::from(self.texels[((5 * x + 7 * y + x * y + i) % 24) as usize]) / 255.0;
        SurfaceMaps {
            albedo: Some(ColorImage::from_fn(w, h, |x, y| [at(x, y, 3), at(x, y, 11), at(x, y, 17)])),
            height: Some(HeightImage::from_fn(w, h, |x, y| at(x, y, 0))),
            wrap: [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp][usize::from(self.wrap % 3)],
            ..Default::default()
        }
    }

    pub fn surface(&self) -> Surface {
        Surface::new(self.maps()).expect("valid maps")
    }

    pub fn pixel(&self) -> Pixel {
        let [center, dx, dy, view] = self.footprint.map(|pair| pair.map(Number::get));
        Pixel::new(center, dx, dy, view)
    }

    pub fn settings(&self) -> Settings {
        const FILTERS: [Filter; 6] =
            [Filter::Nearest, Filter::Bilinear, Filter::Trilinear, Filter::Ewa, Filter::Visible, Filter::Horizon];
        Settings {
            filter: FILTERS[usize::from(self.filter % 6)],
            texel_budget: 1 + u32::from(self.budget),
            lines: 2 + u32::from(self.lines % 63),
            max_anisotropy: 1.0 + f32::from(self.anisotropy) / 64.0,
            far_field: false,
            ..Settings::default()
        }
    }
}

/// Fails the run with what an invariant says.
pub fn hold(checked: Result<(), String>) {
    if let Err(reason) = checked {
        panic!("{reason}");
    }
}
