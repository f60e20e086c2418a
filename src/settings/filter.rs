//! The filters, and what each of them can be told.

/// Which texels make up a pixel's colour. Each filter carries its own options, all with defaults:
///
/// ```
/// use basrelief::{Ewa, Filter};
///
/// let filter = Filter::Ewa(Ewa { max_anisotropy: 16.0, ..Ewa::default() });
/// assert_ne!(filter, Filter::Ewa(Ewa::default()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// The one texel under the hit, base level.
    Nearest,
    /// Four texels around the hit, base level.
    Bilinear,
    /// Bilinear on the two mip levels next to the footprint's longer axis, blended.
    Trilinear(Trilinear),
    /// Elliptical weighted average over the ellipse of formula (1).
    Ewa(Ewa),
    /// The paper's method: the texels of the ellipse that the relief does not hide.
    Visible(Visible),
    /// The floating horizon: visible texels by their visible length, in one sweep.
    Horizon(Horizon),
    /// Common practice, to compare with: 32 linear steps, a secant step, 16x anisotropic mip
    /// choice.
    Parallax(Rays),
    /// Ground truth: rays drawn from the filter kernel, each traced to its exact hit.
    Truth(Rays),
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

/// How [`Filter::Visible`] finds the hidden texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Visibility {
    /// A ray from every texel of the ellipse to the eye.
    Exact,
    /// Rows from both ends, each until its first hidden texel; what lies between is skipped.
    TwoEnded,
    /// A ray from every texel; a hidden one leads to the texel that covers it; a buffer keeps each
    /// from counting twice.
    Resolved,
}

/// What [`Filter::Trilinear`] can be told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trilinear {
    /// Formula (2) or (3) for the footprint. Default: [`Derivatives::Relief`].
    pub derivatives: Derivatives,
    /// The paper's formulas as meant or as printed. Default: [`Formulas::Meant`].
    pub formulas: Formulas,
}

/// What [`Filter::Ewa`] can be told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ewa {
    /// Formula (2) or (3) for the ellipse. Default: [`Derivatives::Relief`].
    pub derivatives: Derivatives,
    /// The paper's formulas as meant or as printed; as printed takes every texel. Default:
    /// [`Formulas::Meant`].
    pub formulas: Formulas,
    /// How finely ellipses are cut, 2 to 64: sixteen times as many of these take a mip level finer,
    /// and twice as many make `texel_budget`, which is for 12, 2.8 times as large. More is finer and slower: 4 is fast,
    /// 24 nearly as good as it gets but for `every_texel`, with which these do not count. Default:
    /// 12.
    pub lines: u32,
    /// The mip level is chosen so that an ellipse holds at most this many texels, and coarser still
    /// where its texels sample the Gaussian well; 0: always the base level, as in the paper, and
    /// every texel. Default: 256.
    pub texel_budget: u32,
    /// Longest allowed axis of the ellipse over its shortest; a longer ellipse is widened. 1 to
    /// 1e6. Default: 64.
    pub max_anisotropy: f32,
    /// Whether every texel of the ellipse counts. Else those next to its longer axis do, on a level
    /// as coarse as the shorter one allows: several times as fast, and `cut` and `texel_kernel` do
    /// not count. Default: `false`.
    pub every_texel: bool,
    /// Where the Gaussian `exp(-2 r^2)` is cut, in pixels, 1 to 1.5: 1 is the paper's ellipse.
    /// Default: 1.
    pub cut: f32,
    /// What is added to A and C of formula (1) for the base level's texels, in square texels, 0.25
    /// to 1: four times the variance of what interpolates between them. Default:
    /// [`RECONSTRUCTION`]; 1 is Heckbert's.
    pub texel_kernel: f32,
}

/// What [`Filter::Visible`] can be told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Visible {
    /// How hidden texels are found. Default: [`Visibility::Exact`].
    pub visibility: Visibility,
    /// Formula (2) or (3) for the ellipse. Default: [`Derivatives::Relief`].
    pub derivatives: Derivatives,
    /// The paper's formulas as meant or as printed. Default: [`Formulas::Meant`].
    pub formulas: Formulas,
    /// The mip level is chosen so that an ellipse holds at most this many texels; 0: always the
    /// base level, as in the paper. Default: 256.
    pub texel_budget: u32,
    /// Longest allowed axis of the ellipse over its shortest; a longer ellipse is widened. 1 to
    /// 1e6. Default: 64.
    pub max_anisotropy: f32,
    /// Longest difference of formula (3) over that of (2) that is taken for a slope of the relief;
    /// a longer one is a jump, where (2) stands. 1 to 1e6, or 0: never a jump, as in the paper.
    /// Default: 4.
    pub max_stretch: f32,
}

/// What [`Filter::Horizon`] can be told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Horizon {
    /// How finely footprints are cut, 2 to 64: two lines for three of these, five at least, on a mip
    /// level with at most 2 to 2.75 times as many texels across. More is finer and slower: 4 is fast,
    /// 24 is as good as it gets. Default: 12.
    pub lines: u32,
    /// Whether tables of the seen colour serve distant footprints, unlit. Default: `true`.
    pub far_field: bool,
    /// Most memory of those tables for each material in MiB, 1 to 4096. Default: 32.
    pub far_field_mib: u32,
    /// Longest allowed axis of the ellipse over its shortest; a longer ellipse is widened. 1 to
    /// 1e6. Default: 64.
    pub max_anisotropy: f32,
}

/// What [`Filter::Parallax`] and [`Filter::Truth`] can be told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rays {
    /// Rays a pixel, 1 to 65536. Default: 64.
    pub samples: u32,
}

/// What `texel_kernel` is by default, in square texels: four times the variance, 1/6, of bilinear
/// interpolation.
pub const RECONSTRUCTION: f32 = 4.0 / 6.0;

/// What `max_anisotropy` is by default.
pub(super) const MAX_ANISOTROPY: f32 = 64.0;

/// What `lines` are by default.
const LINES: u32 = 12;

const RELIEF: (Derivatives, Formulas) = (Derivatives::Relief, Formulas::Meant);
const TRILINEAR: Trilinear = Trilinear { derivatives: RELIEF.0, formulas: RELIEF.1 };
const EWA: Ewa = Ewa {
    derivatives: RELIEF.0,
    formulas: RELIEF.1,
    lines: LINES,
    texel_budget: 256,
    max_anisotropy: MAX_ANISOTROPY,
    every_texel: false,
    cut: 1.0,
    texel_kernel: RECONSTRUCTION,
};
const VISIBLE: Visible = Visible {
    visibility: Visibility::Exact,
    derivatives: RELIEF.0,
    formulas: RELIEF.1,
    texel_budget: 256,
    max_anisotropy: MAX_ANISOTROPY,
    max_stretch: 4.0,
};
const HORIZON: Horizon =
    Horizon { lines: LINES, far_field: true, far_field_mib: 32, max_anisotropy: MAX_ANISOTROPY };
const RAYS: Rays = Rays { samples: 64 };

impl Default for Trilinear {
    fn default() -> Self {
        TRILINEAR
    }
}

impl Default for Ewa {
    fn default() -> Self {
        EWA
    }
}

impl Default for Visible {
    fn default() -> Self {
        VISIBLE
    }
}

impl Default for Horizon {
    fn default() -> Self {
        HORIZON
    }
}

impl Default for Rays {
    fn default() -> Self {
        RAYS
    }
}

impl Default for Filter {
    fn default() -> Self {
        Self::Horizon(HORIZON)
    }
}

impl Filter {
    /// Every filter with its default options.
    pub const ALL: [Self; 8] = [
        Self::Nearest,
        Self::Bilinear,
        Self::Trilinear(TRILINEAR),
        Self::Ewa(EWA),
        Self::Visible(VISIBLE),
        Self::Horizon(HORIZON),
        Self::Parallax(RAYS),
        Self::Truth(RAYS),
    ];
}
