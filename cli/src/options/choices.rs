//! Options that are one of a few words.

use basrelief::load::{HeightSense, NormalY};
use basrelief::texture::Wrap;
use basrelief::{Derivatives, Filter, Formulas, Lighting, PoseAxes, Tone, Visibility};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serializer};

/// A word, what it stands for, and its help.
pub(crate) type Choice<T> = (&'static str, T, &'static str);

/// A filter's word and help: one line for each.
const fn described(filter: &Filter) -> (&'static str, &'static str) {
    match filter {
        Filter::Nearest => ("nearest", "One texel; flickers and shows stairs"),
        Filter::Bilinear => ("bilinear", "Four texels; flickers in the distance"),
        Filter::Trilinear(_) => ("trilinear", "Mip levels; blurs at grazing angles"),
        Filter::Ewa(_) => ("ewa", "All texels of the pixel's ellipse, hidden ones too"),
        Filter::Visible(_) => {
            ("visible", "The texels of the ellipse that the relief does not hide")
        }
        Filter::Horizon(_) => ("horizon", "Visible texels by their visible length, in one sweep"),
        Filter::Parallax(_) => {
            ("parallax", "Common practice: 32 steps, then 16x anisotropy; --samples rays a pixel")
        }
        Filter::Truth(_) => ("truth", "Supersampled: --samples exact rays a pixel; slow"),
    }
}

/// All filters, each with its default options: other options do not make it another choice.
pub(crate) const FILTERS: &[Choice<Filter>] = &{
    let mut choices = [("", Filter::Nearest, ""); Filter::ALL.len()];
    let mut i = 0;
    while i < choices.len() {
        let (word, help) = described(&Filter::ALL[i]);
        choices[i] = (word, Filter::ALL[i], help);
        i += 1;
    }
    choices
};

pub(crate) const VISIBILITIES: &[Choice<Visibility>] = &[
    ("exact", Visibility::Exact, "A ray from each texel to the eye"),
    ("two-ended", Visibility::TwoEnded, "Rows from both ends until the first hidden texel; faster"),
    ("resolved", Visibility::Resolved, "A hidden texel leads to the one that covers it"),
];

pub(crate) const DERIVATIVES: &[Choice<Derivatives>] = &[
    ("flat", Derivatives::Flat, "Of the polygon's texture coordinates: formula (2)"),
    ("relief", Derivatives::Relief, "Of the coordinates that the relief displaces: formula (3)"),
];

pub(crate) const FORMULAS: &[Choice<Formulas>] = &[
    ("meant", Formulas::Meant, "As their derivation demands"),
    ("printed", Formulas::Printed, "Letter by letter, misprints included"),
];

pub(crate) const LIGHTING: &[Choice<Lighting>] = &[
    ("unlit", Lighting::Unlit, "The surface's colour alone"),
    ("lit", Lighting::Lit, "Sky, diffuse light and highlights"),
];

pub(crate) const TONES: &[Choice<Tone>] = &[
    ("none", Tone::None, "What is brighter than white is cut"),
    ("neutral", Tone::Neutral, "Khronos PBR Neutral: highlights are compressed"),
];

pub(crate) const MSAA: &[Choice<u32>] =
    &[("1", 1, "Edges as stairs"), ("4", 4, "Smooth edges"), ("8", 8, "Smoother edges")];

pub(crate) const HEIGHT_SENSES: &[Choice<HeightSense>] = &[
    ("white-high", HeightSense::WhiteHigh, "A height map: white lies on the polygon"),
    ("white-deep", HeightSense::WhiteDeep, "A depth map: white is deepest"),
];

pub(crate) const NORMAL_YS: &[Choice<NormalY>] = &[
    ("up", NormalY::Up, "As in OpenGL, glTF and Blender"),
    ("down", NormalY::Down, "As in DirectX and Unreal"),
];

pub(crate) const WRAPS: &[Choice<Wrap>] = &[
    ("repeat", Wrap::Repeat, "The texture again"),
    ("mirror", Wrap::Mirror, "The texture mirrored, then again"),
    ("clamp", Wrap::Clamp, "The texels of the edge"),
];

pub(crate) const POSE_AXES: &[Choice<PoseAxes>] = &[
    ("opencv", PoseAxes::OpenCv, "x to the right, y down, z forward"),
    ("opengl", PoseAxes::OpenGl, "x to the right, y up, z backward: Blender, NeRF"),
];

pub(crate) const ON_OFF: &[Choice<bool>] = &[("on", true, ""), ("off", false, "")];

/// What is one of a few words wherever it is given.
pub(crate) trait Words: Copy + PartialEq + Send + Sync + 'static {
    const CHOICES: &'static [Choice<Self>];

    /// Whether one word stands for both.
    fn is_same_choice(&self, other: &Self) -> bool {
        self == other
    }
}

impl Words for Filter {
    const CHOICES: &'static [Choice<Self>] = FILTERS;

    /// Whatever their options are.
    fn is_same_choice(&self, other: &Self) -> bool {
        described(self).0 == described(other).0
    }
}

/// Names the words of each type.
macro_rules! words {
    ($($type:ty: $choices:expr;)*) => { $(impl Words for $type { const CHOICES: &'static [Choice<Self>] = $choices; })* };
}

words! {
    Visibility: VISIBILITIES;
    Derivatives: DERIVATIVES;
    Formulas: FORMULAS;
    Lighting: LIGHTING;
    Tone: TONES;
    HeightSense: HEIGHT_SENSES;
    NormalY: NORMAL_YS;
    Wrap: WRAPS;
    PoseAxes: POSE_AXES;
}

/// Writes the word of a value, for `serde(with = "choices")`.
pub(crate) fn serialize<T: Words, S: Serializer>(
    value: &Option<T>,
    to: S,
) -> Result<S::Ok, S::Error> {
    match value {
        Some(value) => to.serialize_some(word(value)),
        None => to.serialize_none(),
    }
}

/// Reads the value of a word, for `serde(with = "choices")`.
pub(crate) fn deserialize<'de, T: Words, D: Deserializer<'de>>(
    from: D,
) -> Result<Option<T>, D::Error> {
    let given = String::deserialize(from)?;
    let known = || T::CHOICES.iter().map(|(word, ..)| *word).collect::<Vec<_>>().join(", ");
    let found = T::CHOICES.iter().find(|(word, ..)| *word == given).map(|&(_, value, _)| value);
    found.map(Some).ok_or_else(|| D::Error::custom(format!("`{given}` is not one of {}", known())))
}

/// A parser of one of `choices`.
pub(crate) fn one_of<T>(choices: &'static [Choice<T>]) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    let words = choices.iter().map(|&(word, _, help)| match help {
        "" => PossibleValue::new(word),
        _ => PossibleValue::new(word).help(help),
    });
    PossibleValuesParser::new(words).try_map(|given| {
        let found = choices.iter().find(|(word, ..)| *word == given);
        found.map(|&(_, value, _)| value).ok_or("is not known")
    })
}

/// The word that stands for `value`.
pub(crate) fn word<T: Words>(value: &T) -> &'static str {
    T::CHOICES
        .iter()
        .find(|(_, known, _)| known.is_same_choice(value))
        .map_or("?", |&(word, ..)| word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use basrelief::{Ewa, Horizon, Settings, Visible};

    #[test]
    fn each_default_has_a_word() {
        let settings = Settings::default();
        assert_eq!(word(&settings.filter), "horizon");
        assert_eq!(word(&Visible::default().visibility), "exact");
        assert_eq!(word(&settings.lighting), "unlit");
        assert_eq!(word(&Wrap::default()), "repeat");
        assert!(MSAA.iter().any(|(_, num, _)| *num == settings.msaa));
    }

    #[test]
    fn a_filter_keeps_its_word_with_other_options() {
        assert_eq!(word(&Filter::Ewa(Ewa { cut: 1.5, ..Ewa::default() })), "ewa");
        assert_eq!(word(&Filter::Horizon(Horizon { lines: 4, ..Horizon::default() })), "horizon");
        let words = Filter::ALL.each_ref().map(word);
        assert!(FILTERS.iter().map(|(word, ..)| *word).eq(words), "{words:?}");
        let num = words.iter().collect::<std::collections::HashSet<_>>().len();
        assert_eq!(num, words.len(), "no word stands for two: {words:?}");
    }
}
