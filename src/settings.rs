//! How a frame is drawn. Plain data: every field may be set alone, the rest comes from [`Settings::default`].

use crate::error::{Error, Result};
use crate::filter::RECONSTRUCTION;

/// Which texels make up a pixel's colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Filter {
    /// The one texel under the hit, base level.
    Nearest,
    /// Four texels around the hit, base level.
    Bilinear,
    /// Bilinear on the two mip levels next to the footprint's longer axis, blended.
    Trilinear,
    /// Elliptical weighted average: all texels of the ellipse of formula (1).
    Ewa,
    /// The paper's method: the texels of the ellipse that the relief does not hide.
    Visible,
    /// The floating horizon: visible texels by their visible length, in one sweep.
    Horizon,
    /// Common practice, to compare with: 32 linear steps, a secant step, 16x anisotropic mip choice, `samples` rays a pixel.
    Parallax,
    /// Ground truth: `samples` rays a pixel drawn from the filter kernel, each traced to its exact hit.
    Truth,
}

/// How [`Filter::Visible`] finds the hidden texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Visibility {
    /// A ray from every texel of the ellipse to the eye.
    Exact,
    /// Rows from both ends, each until its first hidden texel; what lies between is skipped.
    TwoEnded,
    /// A ray from every texel; a hidden one leads to the texel that covers it; a buffer keeps each from counting twice.
    Resolved,
}

/// Which texture coordinates the derivatives are differences of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Derivatives {
    /// Formula (2): undisplaced coordinates.
    Flat,
    /// Formula (3): coordinates displaced by the relief.
    Relief,
}

/// Which reading of the paper's formulas is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Formulas {
    /// As the derivation demands (Heckbert).
    Meant,
    /// Letter by letter as the paper prints them, misprints included.
    Printed,
}

/// Whether lights are evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Lighting {
    /// The filtered albedo is the colour.
    Unlit,
    /// Ambient, Lambert and Blinn-Phong from the scene's lights.
    Lit,
}

/// A rectangle of a frame's pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Region {
    /// First column, 0 at the left.
    pub x: u32,
    /// First row, 0 at the top.
    pub y: u32,
    /// Columns, 1 or more.
    pub width: u32,
    /// Rows, 1 or more.
    pub height: u32,
}

impl Region {
    /// Whether it lies within a frame of `width` by `height` pixels and holds a pixel.
    #[must_use]
    pub fn is_within(&self, width: u32, height: u32) -> bool {
        let fits = |first: u32, num: u32, end: u32| num > 0 && first.checked_add(num).is_some_and(|last| last <= end);
        fits(self.x, self.width, width) && fits(self.y, self.height, height)
    }
}

/// How a frame is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Width of the frame in pixels, 1 to 32768; width times height of what is drawn is at most 2^28. Default: 1280.
    pub width: u32,
    /// Height of the frame in pixels, 1 to 32768. Default: 720.
    pub height: u32,
    /// The part of the frame that is drawn: the picture has its size, and the bytes that this part has in the whole
    /// frame. Default: `None`, all of it.
    pub region: Option<Region>,
    /// Which texels make up a pixel's colour. Default: [`Filter::Horizon`].
    pub filter: Filter,
    /// How [`Filter::Visible`] finds hidden texels. Default: [`Visibility::Exact`].
    pub visibility: Visibility,
    /// Whether the view ray is traced to the relief; `false` draws the polygon's own texels. Default: `true`.
    pub parallax: bool,
    /// Formula (2) or (3) for the ellipse of `Ewa`, `Visible` and the level of `Trilinear`. Default: [`Derivatives::Relief`].
    pub derivatives: Derivatives,
    /// The paper's formulas as meant or as printed. Default: [`Formulas::Meant`].
    pub formulas: Formulas,
    /// The mip level is chosen so that an ellipse holds at most this many texels; 0: always the base level, as in the
    /// paper. Used by `Ewa`, which takes a level coarser still if its texels sample the Gaussian well, and `Visible`.
    /// Default: 256.
    pub texel_budget: u32,
    /// Where `Ewa` cuts its Gaussian `exp(-2 r^2)`, in pixels, 1 to 1.5: 1 is the paper's ellipse. Default: 1.
    pub cut: f32,
    /// What `Ewa` adds to A and C of formula (1) for the base level's texels, in square texels, 0.25 to 1: four times the
    /// variance of what interpolates between them. Default: 2/3, bilinear interpolation; 1 is Heckbert's.
    pub texel_kernel: f32,
    /// Whether `Ewa` takes every texel of the ellipse, as it does with a `texel_budget` of 0 or the formulas as printed.
    /// Else those next to its longer axis count, on a level as coarse as the shorter one allows: several times as fast, and
    /// `cut` and `texel_kernel` do not count. Default: `false`.
    pub every_texel: bool,
    /// Longest allowed axis of the ellipse over its shortest; a longer ellipse is widened. 1 to 1e6. Default: 64.
    pub max_anisotropy: f32,
    /// Longest difference of formula (3) over that of (2) that `Visible` takes for a slope of the relief; a longer one is
    /// a jump, where (2) stands. 1 to 1e6, or 0: never a jump, as in the paper. Default: 4.
    pub max_stretch: f32,
    /// Rays a pixel of `Truth` and `Parallax`, 1 to 65536. Default: 64.
    pub samples: u32,
    /// Most texels across a footprint's shorter axis that `Horizon` sweeps, 2 to 64; picks the mip level, and how many lines
    /// (two for three texels) and bins cut the footprint: more is finer and slower. Default: 10.
    pub lines: u32,
    /// Whether `Horizon` uses tables of the seen colour for distant footprints; made for the first materials whose maps
    /// have up to 2^22 texels together. Default: `true`.
    pub far_field: bool,
    /// Most memory of the far-field tables of one material in MiB, 1 to 4096. Default: 32.
    pub far_field_mib: u32,
    /// Whether lights are evaluated. Default: [`Lighting::Unlit`].
    pub lighting: Lighting,
    /// Whether triangles seen from behind (clockwise on the screen) are left out. Default: `false`.
    pub cull_back_faces: bool,
    /// Coverage and depth samples a pixel: 1, 4 or 8. Shading stays once per pixel and triangle. Default: 4.
    pub msaa: u32,
    /// Side of a tile in pixels: 8 (drawn as 16, the side of a block of shading), 16, 32, 64, 128 or 256. The picture does
    /// not depend on it. Default: 32.
    pub tile_size: u32,
}

/// Most pixels of a frame: 4 GiB of linear pixels.
const MAX_PIXELS: u64 = 1 << 28;

impl Default for Settings {
    fn default() -> Self {
        Self {
            width: 1280,
            height: 720,
            region: None,
            filter: Filter::Horizon,
            visibility: Visibility::Exact,
            parallax: true,
            derivatives: Derivatives::Relief,
            formulas: Formulas::Meant,
            texel_budget: 256,
            cut: 1.0,
            texel_kernel: RECONSTRUCTION,
            every_texel: false,
            max_anisotropy: 64.0,
            max_stretch: 4.0,
            samples: 64,
            lines: 10,
            far_field: true,
            far_field_mib: 32,
            lighting: Lighting::Unlit,
            cull_back_faces: false,
            msaa: 4,
            tile_size: 32,
        }
    }
}

impl Settings {
    /// What is drawn: the region, or the whole frame.
    #[must_use]
    pub fn drawn(&self) -> Region {
        self.region.unwrap_or(Region { x: 0, y: 0, width: self.width, height: self.height })
    }

    /// Checks every field against its range.
    ///
    /// # Errors
    /// Names the first field whose value is out of its range.
    pub fn validate(&self) -> Result<()> {
        let within = |name, value: u32, least: u32, most: u32| {
            if (least..=most).contains(&value) {
                Ok(())
            } else {
                Err(Error::setting(name, format!("{value} is not within {least} to {most}")))
            }
        };
        within("width", self.width, 1, 32768)?;
        within("height", self.height, 1, 32768)?;
        if let Some(Region { x, y, width, height }) = self.region.filter(|r| !r.is_within(self.width, self.height)) {
            let reason = format!("{x},{y},{width},{height} is not a part of {}x{} pixels", self.width, self.height);
            return Err(Error::setting("region", reason));
        }
        let Region { width, height, .. } = self.drawn();
        if u64::from(width) * u64::from(height) > MAX_PIXELS {
            let name = if self.region.is_some() { "region" } else { "width" };
            return Err(Error::setting(name, format!("{width} x {height} is more than {MAX_PIXELS} pixels")));
        }
        within("samples", self.samples, 1, 65536)?;
        within("lines", self.lines, 2, 64)?;
        within("far_field_mib", self.far_field_mib, 1, 4096)?;
        if !matches!(self.msaa, 1 | 4 | 8) {
            return Err(Error::setting("msaa", format!("{} is not 1, 4 or 8", self.msaa)));
        }
        if !(self.tile_size.is_power_of_two() && (8..=256).contains(&self.tile_size)) {
            return Err(Error::setting("tile_size", format!("{} is not 8, 16, 32, 64, 128 or 256", self.tile_size)));
        }
        if !(1.0..=1.5).contains(&self.cut) {
            return Err(Error::setting("cut", format!("{} is not within 1 to 1.5", self.cut)));
        }
        if !(0.25..=1.0).contains(&self.texel_kernel) {
            return Err(Error::setting("texel_kernel", format!("{} is not within 0.25 to 1", self.texel_kernel)));
        }
        if !(1.0..=1e6).contains(&self.max_anisotropy) {
            return Err(Error::setting("max_anisotropy", format!("{} is not within 1 to 1e6", self.max_anisotropy)));
        }
        if !(self.max_stretch == 0.0 || (1.0..=1e6).contains(&self.max_stretch)) {
            return Err(Error::setting("max_stretch", format!("{} is not 0 or within 1 to 1e6", self.max_stretch)));
        }
        Ok(())
    }
}
