//! Options that say how a frame is drawn, and what they are called where the library refuses one.
//!
//! The tables `[frame]` and `[filter]` of a scene file hold the same options under the same names.

use super::choices::{self, ON_OFF, one_of};
use super::file_values::Spelt;
use super::{Refusal, values};
use basrelief::{Derivatives, Error, Filter, Formulas, Lighting, Region, Settings, Visibility};
use clap::Args;
use serde::{Deserialize, Serialize};

#[derive(Args, Clone, Debug, Default)]
pub(crate) struct SettingsOptions {
    #[command(flatten)]
    pub(super) frame: FrameOptions,
    #[command(flatten)]
    pub(super) filter: FilterOptions,
}

#[derive(Args, Clone, Debug, Default, Serialize, Deserialize)]
#[command(next_help_heading = "Frame")]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct FrameOptions {
    /// Width and height of the picture in pixels, each 1 to 32768 [default: 1280x720]
    #[arg(short, long, value_name = "WxH", value_parser = Spelt::<[u32; 2]>::parse, allow_hyphen_values = true)]
    size: Option<Spelt<[u32; 2]>>,
    /// Draw only this part of the picture, in pixels from its upper left corner; `basrelief join` puts parts together
    #[arg(long, value_name = "X,Y,W,H", value_parser = Spelt::<Region>::parse, allow_hyphen_values = true)]
    region: Option<Spelt<Region>>,
    /// Samples a pixel for edges: 1, 4 or 8; surfaces are still shaded once a pixel [default: 4]
    #[arg(long, value_name = "N", value_parser = one_of(choices::MSAA))]
    msaa: Option<u32>,
    /// Leave out triangles seen from behind
    #[arg(long, value_name = "on|off", num_args = 0..=1, require_equals = true, default_missing_value = "on",
          hide_possible_values = true, value_parser = one_of(ON_OFF))]
    cull: Option<bool>,
    /// Side of the squares that threads draw, in pixels: 8, 16, 32, 64, 128 or 256; the picture stays the same [default: 32]
    #[arg(long, value_name = "N")]
    tile: Option<u32>,
    /// Whether lights are evaluated [default: unlit, or lit where a light is given]
    #[arg(long, value_name = "HOW", value_parser = one_of(choices::LIGHTING))]
    #[serde(with = "choices")]
    lighting: Option<Lighting>,
}

#[derive(Args, Clone, Debug, Default, Serialize, Deserialize)]
#[command(next_help_heading = "Texture filter")]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct FilterOptions {
    /// Which texels make up a pixel's colour [default: horizon]
    #[arg(short, long, value_parser = one_of(choices::FILTERS))]
    #[serde(with = "choices")]
    filter: Option<Filter>,
    /// How --filter visible finds the hidden texels [default: exact]
    #[arg(long, value_name = "HOW", value_parser = one_of(choices::VISIBILITIES))]
    #[serde(with = "choices")]
    visible: Option<Visibility>,
    /// Whether the relief is traced; off draws flat polygons [default: on]
    #[arg(long, value_name = "on|off", hide_possible_values = true, value_parser = one_of(ON_OFF))]
    parallax: Option<bool>,
    /// Which texture coordinates a pixel's ellipse comes from [default: relief]
    #[arg(long, value_name = "OF", value_parser = one_of(choices::DERIVATIVES))]
    #[serde(with = "choices")]
    derivatives: Option<Derivatives>,
    /// Which reading of the paper's formulas to use [default: meant]
    #[arg(long, value_name = "AS", value_parser = one_of(choices::FORMULAS))]
    #[serde(with = "choices")]
    formulas: Option<Formulas>,
    /// Choose the mip level so that an ellipse holds at most N texels; 0: always the full texture, as in the paper
    /// [default: 256]
    #[arg(long, value_name = "N")]
    texel_budget: Option<u32>,
    /// For --filter ewa: where the Gaussian is cut, in pixels, 1 to 1.5; 1 is the paper's ellipse [default: 1]
    #[arg(long, value_name = "R", value_parser = values::number, allow_hyphen_values = true)]
    cut: Option<f32>,
    /// For --filter ewa: added to A and C of formula (1) for the texels' own kernel, 0.25 to 1; 2/3 is bilinear
    /// interpolation, 1 Heckbert's [default: 0.6666667]
    #[arg(long, value_name = "S", value_parser = values::number, allow_hyphen_values = true)]
    texel_kernel: Option<f32>,
    /// Whether --filter ewa takes every texel of an ellipse, and not only those next to its longer axis, which is several
    /// times as fast; --cut and --texel-kernel are for every texel [default: off]
    #[arg(long, value_name = "on|off", hide_possible_values = true, value_parser = one_of(ON_OFF))]
    every_texel: Option<bool>,
    /// Longest ellipse, as the ratio of its axes, 1 to 1e6; longer ones are widened [default: 64]
    #[arg(long, value_name = "N", value_parser = values::number, allow_hyphen_values = true)]
    max_anisotropy: Option<f32>,
    /// For --filter visible: a derivative of formula (3) this many times as long as that of (2) is a jump of the relief,
    /// and (2) is taken; 1 to 1000000, or 0 for never, as in the paper [default: 4]
    #[arg(long, value_name = "N", value_parser = values::number, allow_hyphen_values = true)]
    max_stretch: Option<f32>,
    /// Rays a pixel of --filter truth and parallax, 1 to 65536 [default: 64]
    #[arg(long, value_name = "N")]
    samples: Option<u32>,
    /// Most lines that --filter horizon sweeps through a pixel's ellipse, 2 to 64; more is finer and slower [default: 10]
    #[arg(long, value_name = "N")]
    lines: Option<u32>,
    /// Whether --filter horizon keeps tables for distant surfaces [default: on]
    #[arg(long, value_name = "on|off", hide_possible_values = true, value_parser = one_of(ON_OFF))]
    far_field: Option<bool>,
    /// Most memory of those tables for each material in MiB, 1 to 4096 [default: 32]
    #[arg(long, value_name = "N")]
    far_field_mib: Option<u32>,
}

impl SettingsOptions {
    /// Whether a size is given.
    pub(crate) fn has_size(&self) -> bool {
        self.frame.size.is_some()
    }

    /// The settings; `has_lights` says whether the options name a light.
    pub(crate) fn settings(&self, has_lights: bool) -> Result<Settings, Refusal> {
        let settings = self.unchecked(has_lights);
        check(&settings).map_err(|e| refusal(&e))?;
        Ok(settings)
    }

    /// The settings, whose numbers may be out of their ranges.
    pub(super) fn unchecked(&self, has_lights: bool) -> Settings {
        let Self { frame, filter } = self;
        let default = Settings::default();
        let [width, height] = frame.size.as_ref().map_or([default.width, default.height], |size| size.value);
        Settings {
            width,
            height,
            region: frame.region.as_ref().map(|region| region.value),
            filter: filter.filter.unwrap_or(default.filter),
            visibility: filter.visible.unwrap_or(default.visibility),
            parallax: filter.parallax.unwrap_or(default.parallax),
            derivatives: filter.derivatives.unwrap_or(default.derivatives),
            formulas: filter.formulas.unwrap_or(default.formulas),
            texel_budget: filter.texel_budget.unwrap_or(default.texel_budget),
            cut: filter.cut.unwrap_or(default.cut),
            texel_kernel: filter.texel_kernel.unwrap_or(default.texel_kernel),
            every_texel: filter.every_texel.unwrap_or(default.every_texel),
            max_anisotropy: filter.max_anisotropy.unwrap_or(default.max_anisotropy),
            max_stretch: filter.max_stretch.unwrap_or(default.max_stretch),
            samples: filter.samples.unwrap_or(default.samples),
            lines: filter.lines.unwrap_or(default.lines),
            far_field: filter.far_field.unwrap_or(default.far_field),
            far_field_mib: filter.far_field_mib.unwrap_or(default.far_field_mib),
            lighting: frame.lighting.unwrap_or(if has_lights { Lighting::Lit } else { Lighting::Unlit }),
            cull_back_faces: frame.cull.unwrap_or(default.cull_back_faces),
            msaa: frame.msaa.unwrap_or(default.msaa),
            tile_size: frame.tile.unwrap_or(default.tile_size),
        }
    }
}

impl From<&Settings> for SettingsOptions {
    /// Options that give all of `settings`, whatever the defaults are.
    fn from(settings: &Settings) -> Self {
        let size = format!("{}x{}", settings.width, settings.height);
        let region = settings.region.map(|r| format!("{},{},{},{}", r.x, r.y, r.width, r.height));
        let frame = FrameOptions {
            size: Spelt::parse(&size).ok(),
            region: region.and_then(|region| Spelt::parse(&region).ok()),
            msaa: Some(settings.msaa),
            cull: Some(settings.cull_back_faces),
            tile: Some(settings.tile_size),
            lighting: Some(settings.lighting),
        };
        let filter = FilterOptions {
            filter: Some(settings.filter),
            visible: Some(settings.visibility),
            parallax: Some(settings.parallax),
            derivatives: Some(settings.derivatives),
            formulas: Some(settings.formulas),
            texel_budget: Some(settings.texel_budget),
            cut: Some(settings.cut),
            texel_kernel: Some(settings.texel_kernel),
            every_texel: Some(settings.every_texel),
            max_anisotropy: Some(settings.max_anisotropy),
            max_stretch: Some(settings.max_stretch),
            samples: Some(settings.samples),
            lines: Some(settings.lines),
            far_field: Some(settings.far_field),
            far_field_mib: Some(settings.far_field_mib),
        };
        Self { frame, filter }
    }
}

/// Checks all but the number of pixels: a picture may be larger than a frame, and is then drawn part by part.
pub(super) fn check(settings: &Settings) -> basrelief::Result<()> {
    let Region { x, y, .. } = settings.drawn();
    let is_within = settings.drawn().is_within(settings.width, settings.height);
    let pixel = Region { x, y, width: 1, height: 1 };
    Settings { region: if is_within { Some(pixel) } else { settings.region }, ..settings.clone() }.validate()
}

/// What the library refuses, in the words of the command line.
pub(crate) fn refusal(error: &Error) -> Refusal {
    match error {
        Error::Setting { name, reason } => format!("{}: {reason}", option_of(name)),
        Error::Scene { part, reason } if part == "camera" => {
            format!("the camera (--eye, --target, --up, --fov, --near): {reason}")
        }
        Error::Limit { option, .. } => {
            let text = error.to_string();
            let reason = text.strip_suffix(&format!("({option})")).unwrap_or(&text);
            format!("{reason}({})", option_of(option))
        }
        _ => error.to_string(),
    }
}

/// The option that sets a field of [`Settings`] or of the load options.
pub(super) fn option_of(field: &str) -> String {
    match field {
        "width" | "height" => "--size".into(),
        "visibility" => "--visible".into(),
        "cull_back_faces" => "--cull".into(),
        "tile_size" => "--tile".into(),
        _ => format!("--{}", field.replace('_', "-")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Only {
        #[command(flatten)]
        options: SettingsOptions,
    }

    fn parse(line: &str) -> Result<Settings, Refusal> {
        let only = Only::try_parse_from(std::iter::once("x").chain(line.split_whitespace()));
        only.map_err(|e| e.to_string())?.options.settings(false)
    }

    #[test]
    fn no_options_are_the_defaults() {
        assert_eq!(parse("").unwrap(), Settings::default());
    }

    #[test]
    fn defaults_in_the_help_are_the_defaults() {
        let command = <Only as clap::CommandFactory>::command();
        let mut line = Vec::new();
        for arg in command.get_arguments() {
            let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
            // What is not one word is a rule.
            let default = help.rsplit_once("[default: ").and_then(|(_, rest)| rest.strip_suffix(']'));
            if let Some(default) = default.filter(|default| !default.contains(' ')) {
                line.push(format!("--{}={default}", arg.get_long().unwrap()));
            }
        }
        assert_eq!(line.len(), 18, "{line:?}");
        assert_eq!(parse(&line.join(" ")).unwrap(), Settings::default());
    }

    #[test]
    fn settings_become_options_and_come_back() {
        let region = Some(Region { x: 1, y: 2, width: 3, height: 4 });
        let settings = Settings { width: 64, region, samples: 5, cull_back_faces: true, ..Settings::default() };
        assert_eq!(SettingsOptions::from(&settings).settings(true).unwrap(), settings);
    }

    #[test]
    fn each_option_sets_its_field() {
        let line = "--size 64x36 --region 8,4,32,16 --msaa 8 --cull --tile 16 --lighting lit --filter horizon \
                    --visible two-ended --parallax off --derivatives flat --formulas printed --texel-budget 0 \
                    --cut 1.25 --texel-kernel 0.5 --every-texel on --max-anisotropy 8 --max-stretch 3 \
                    --samples 5 --lines 6 --far-field off --far-field-mib 7";
        let expected = Settings {
            width: 64,
            height: 36,
            region: Some(Region { x: 8, y: 4, width: 32, height: 16 }),
            filter: Filter::Horizon,
            visibility: Visibility::TwoEnded,
            parallax: false,
            derivatives: Derivatives::Flat,
            formulas: Formulas::Printed,
            texel_budget: 0,
            cut: 1.25,
            texel_kernel: 0.5,
            every_texel: true,
            max_anisotropy: 8.0,
            max_stretch: 3.0,
            samples: 5,
            lines: 6,
            far_field: false,
            far_field_mib: 7,
            lighting: Lighting::Lit,
            cull_back_faces: true,
            msaa: 8,
            tile_size: 16,
        };
        assert_eq!(parse(line).unwrap(), expected);
    }

    #[test]
    fn refusals_name_the_option() {
        for (line, option) in [
            ("--tile 7", "--tile"),
            ("--samples 0", "--samples"),
            ("--lines 99", "--lines"),
            ("--far-field-mib 0", "--far-field-mib"),
            ("--max-anisotropy nan", "--max-anisotropy"),
            ("--max-anisotropy 0.5", "--max-anisotropy"),
            ("--cut 2", "--cut"),
            ("--texel-kernel 0", "--texel-kernel"),
            ("--max-stretch 0.5", "--max-stretch"),
            ("--max-stretch nan", "--max-stretch"),
            ("--msaa 3", "--msaa"),
            ("--size 1x0", "--size"),
            ("--size 8x8 --region 0,0,9,1", "--region"),
        ] {
            let text = parse(line).unwrap_err();
            assert!(text.contains(option), "{line}: {text}");
        }
    }
}
