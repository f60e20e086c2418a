//! The options of all filters by name, for whoever reads, sets or checks them.

use super::filter::{
    Derivatives, Ewa, Filter, Formulas, Horizon, MAX_ANISOTROPY, Rays, Trilinear, Visibility,
    Visible,
};
use crate::error::{Error, Result, within};

/// The options of a filter, whichever it is: `None` where it has no such option. What each means
/// and its range stands at its field in [`Trilinear`], [`Ewa`], [`Visible`], [`Horizon`] or
/// [`Rays`].
///
/// ```
/// use basrelief::Filter;
///
/// // A finer horizon and finer ellipses; filters without lines stay what they are.
/// let finer = Filter::ALL.map(|mut filter| {
///     filter.options_mut().lines.into_iter().for_each(|lines| *lines = 24);
///     filter
/// });
/// assert_eq!(finer.iter().zip(&Filter::ALL).filter(|(a, b)| a != b).count(), 2);
/// ```
#[allow(missing_docs, reason = "the words of each stand in the filters' own structs")]
#[derive(Debug, Default)]
pub struct OptionsMut<'a> {
    pub derivatives: Option<&'a mut Derivatives>,
    pub formulas: Option<&'a mut Formulas>,
    pub visibility: Option<&'a mut Visibility>,
    pub texel_budget: Option<&'a mut u32>,
    pub max_anisotropy: Option<&'a mut f32>,
    pub max_stretch: Option<&'a mut f32>,
    pub every_texel: Option<&'a mut bool>,
    pub cut: Option<&'a mut f32>,
    pub texel_kernel: Option<&'a mut f32>,
    pub lines: Option<&'a mut u32>,
    pub far_field: Option<&'a mut bool>,
    pub far_field_mib: Option<&'a mut u32>,
    pub samples: Option<&'a mut u32>,
}

/// The options of a struct by the names of its fields: a field that is not named here, or has no
/// such option, does not compile.
macro_rules! all_of {
    ($options:expr, $type:ident { $($field:ident),* }) => {{
        let $type { $($field),* } = $options;
        OptionsMut { $($field: Some($field),)* ..OptionsMut::default() }
    }};
}

impl Filter {
    /// Its options by name.
    pub fn options_mut(&mut self) -> OptionsMut<'_> {
        match self {
            Self::Nearest | Self::Bilinear => OptionsMut::default(),
            Self::Trilinear(options) => all_of!(options, Trilinear { derivatives, formulas }),
            Self::Ewa(options) => all_of!(
                options,
                Ewa {
                    derivatives,
                    formulas,
                    lines,
                    texel_budget,
                    max_anisotropy,
                    every_texel,
                    cut,
                    texel_kernel
                }
            ),
            Self::Visible(options) => all_of!(
                options,
                Visible {
                    visibility,
                    derivatives,
                    formulas,
                    texel_budget,
                    max_anisotropy,
                    max_stretch
                }
            ),
            Self::Horizon(options) => {
                all_of!(options, Horizon { lines, far_field, far_field_mib, max_anisotropy })
            }
            Self::Parallax(options) | Self::Truth(options) => all_of!(options, Rays { samples }),
        }
    }

    /// Longest allowed axis of its ellipse over the shortest; without an ellipse of its own, the
    /// default.
    pub fn max_anisotropy(mut self) -> f32 {
        self.options_mut().max_anisotropy.map_or(MAX_ANISOTROPY, |max| *max)
    }

    /// Checks every option against its range.
    ///
    /// # Errors
    /// Names the first option whose value is out of its range.
    pub fn validate(mut self) -> Result<()> {
        fn check<T: Copy + PartialOrd + std::fmt::Display>(
            name: &'static str,
            value: Option<&mut T>,
            [least, most]: [T; 2],
        ) -> Result<()> {
            value.map_or(Ok(()), |value| within(name, *value, least, most))
        }
        let options = self.options_mut();
        check("cut", options.cut, [1.0, 1.5])?;
        check("texel_kernel", options.texel_kernel, [0.25, 1.0])?;
        check("lines", options.lines, [2, 64])?;
        check("far_field_mib", options.far_field_mib, [1, 4096])?;
        check("samples", options.samples, [1, 65536])?;
        check("max_anisotropy", options.max_anisotropy, [1.0, 1e6])?;
        // 0 is no length but says never.
        let max_stretch = options.max_stretch.map_or(0.0, |max| *max);
        if !(max_stretch == 0.0 || (1.0..=1e6).contains(&max_stretch)) {
            let reason = format!("{max_stretch} is not 0 or within 1 to 1e6");
            return Err(Error::setting("max_stretch", reason));
        }
        Ok(())
    }
}
