//! Options that say how a frame is drawn, and what they are called where the library refuses one.
//!
//! The tables `[frame]` and `[filter]` of a scene file hold the same options under the same names.

use crate::options::choices::{self, ON_OFF, one_of};
use crate::options::file_values::Spelt;
use crate::options::filter::FilterOptions;
use crate::options::values;
use crate::refusal::Refusal;
use basrelief::{Filter, Lighting, Region, Settings, Tone};
use clap::Args;
use serde::{Deserialize, Serialize};

#[derive(Args, Clone, Debug, Default)]
pub(crate) struct SettingsOptions {
    #[command(flatten)]
    pub(crate) frame: FrameOptions,
    #[command(flatten)]
    pub(crate) filter: FilterOptions,
}

#[derive(Args, Clone, Debug, Default, Serialize, Deserialize)]
#[command(next_help_heading = "Frame")]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct FrameOptions {
    /// Width and height of the picture in pixels, each 1 to 32768 [default: 1280x720]
    #[arg(short, long, value_name = "WxH", value_parser = Spelt::<[u32; 2]>::parse, allow_hyphen_values = true)]
    size: Option<Spelt<[u32; 2]>>,
    /// Draw only this part of the picture, in pixels from its upper left corner; `basrelief join`
    /// puts parts together
    #[arg(long, value_name = "X,Y,W,H", value_parser = Spelt::<Region>::parse, allow_hyphen_values = true)]
    region: Option<Spelt<Region>>,
    /// Samples a pixel for edges: 1, 4 or 8; surfaces are still shaded once a pixel [default: 4]
    #[arg(long, value_name = "N", value_parser = one_of(choices::MSAA))]
    msaa: Option<u32>,
    /// Leave out triangles seen from behind
    #[arg(long, value_name = "on|off", num_args = 0..=1, require_equals = true, default_missing_value = "on",
          hide_possible_values = true, value_parser = one_of(ON_OFF))]
    cull: Option<bool>,
    /// Side of the squares that threads draw, in pixels: 8, 16, 32, 64, 128 or 256; the picture
    /// stays the same [default: 32]
    #[arg(long, value_name = "N")]
    tile: Option<u32>,
    /// How many times the light of the picture is doubled, -32 to 32 [default: 0]
    #[arg(long, value_name = "EV", value_parser = values::number, allow_hyphen_values = true)]
    exposure: Option<f32>,
    /// How light is brought within the range of a picture; EXR stays as it is [default: neutral for
    /// the built-in scene, else none]
    #[arg(long, value_name = "HOW", value_parser = one_of(choices::TONES))]
    #[serde(with = "choices")]
    tone: Option<Tone>,
    /// Whether lights are evaluated [default: lit for the built-in scene
    /// and where a light is given, else unlit]
    #[arg(long, value_name = "HOW", value_parser = one_of(choices::LIGHTING))]
    #[serde(with = "choices")]
    lighting: Option<Lighting>,
}

/// How a picture is where no option says so.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    /// Whether it is lit.
    pub(crate) is_lit: bool,
    pub(crate) tone: Tone,
}

impl Default for Look {
    /// That of a scene of which nothing is known.
    fn default() -> Self {
        let Settings { lighting, tone, .. } = Settings::default();
        Self { is_lit: lighting == Lighting::Lit, tone }
    }
}

impl SettingsOptions {
    /// Whether a size is given.
    pub(crate) fn has_size(&self) -> bool {
        self.frame.size.is_some()
    }

    /// The settings.
    pub(crate) fn settings(&self, look: Look) -> Result<Settings, Refusal> {
        self.check()?;
        Ok(self.unchecked(look))
    }

    /// Checks all but the number of pixels: a picture may be larger than a frame, and is then drawn
    /// part by part. An option of a filter must be within its range whatever filter is chosen.
    pub(crate) fn check(&self) -> basrelief::Result<()> {
        let settings = self.unchecked(Look::default());
        let Region { x, y, .. } = settings.drawn();
        let is_within = settings.drawn().is_within(settings.width, settings.height);
        let pixel = Region { x, y, width: 1, height: 1 };
        Settings { region: if is_within { Some(pixel) } else { settings.region }, ..settings }
            .validate()?;
        Filter::ALL.iter().try_for_each(|filter| self.filter.apply(*filter).validate())
    }

    /// The settings, whose numbers may be out of their ranges.
    fn unchecked(&self, look: Look) -> Settings {
        let Self { frame, filter } = self;
        let default = Settings::default();
        let [width, height] =
            frame.size.as_ref().map_or([default.width, default.height], |size| size.value);
        Settings {
            width,
            height,
            region: frame.region.as_ref().map(|region| region.value),
            filter: filter.chosen(),
            parallax: filter.parallax.unwrap_or(default.parallax),
            silhouette: filter.silhouette.unwrap_or(default.silhouette),
            lighting: frame.lighting.unwrap_or(if look.is_lit {
                Lighting::Lit
            } else {
                Lighting::Unlit
            }),
            exposure: frame.exposure.unwrap_or(default.exposure),
            tone: frame.tone.unwrap_or(look.tone),
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
            exposure: Some(settings.exposure),
            tone: Some(settings.tone),
            cull: Some(settings.cull_back_faces),
            tile: Some(settings.tile_size),
            lighting: Some(settings.lighting),
        };
        let mut filter = FilterOptions::from(settings.filter);
        filter.parallax = Some(settings.parallax);
        filter.silhouette = Some(settings.silhouette);
        Self { frame, filter }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use basrelief::{Derivatives, Ewa, Formulas, Horizon, Rays, Trilinear, Visibility, Visible};
    use clap::Parser;

    #[derive(Parser)]
    struct Only {
        #[command(flatten)]
        options: SettingsOptions,
    }

    fn options(line: &str) -> Result<SettingsOptions, Refusal> {
        let only = Only::try_parse_from(std::iter::once("x").chain(line.split_whitespace()));
        Ok(only.map_err(|e| e.to_string())?.options)
    }

    fn parse(line: &str) -> Result<Settings, Refusal> {
        options(line)?.settings(Look::default())
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
            let default =
                help.rsplit_once("[default: ").and_then(|(_, rest)| rest.strip_suffix(']'));
            if let Some(default) = default.filter(|default| !default.contains(' ')) {
                line.push(format!("--{}={default}", arg.get_long().unwrap()));
            }
        }
        assert_eq!(line.len(), 20, "{line:?}");
        let options = options(&line.join(" ")).unwrap();
        assert_eq!(options.settings(Look::default()).unwrap(), Settings::default());
        assert_eq!(Filter::ALL.map(|filter| options.filter.apply(filter)), Filter::ALL);
    }

    /// Every option of a filter, none at its default.
    const OF_FILTERS: &str = "--visible two-ended --derivatives flat --formulas printed \
                              --texel-budget 0 --cut 1.25 --texel-kernel 0.5 --every-texel on \
                              --max-anisotropy 8 --max-stretch 3 --samples 5 --lines 6 \
                              --far-field off --far-field-mib 7";

    #[test]
    fn settings_become_options_and_come_back() {
        let others = options(OF_FILTERS).unwrap().filter;
        for filter in Filter::ALL.into_iter().flat_map(|filter| [filter, others.apply(filter)]) {
            let region = Some(Region { x: 1, y: 2, width: 3, height: 4 });
            let settings = Settings {
                width: 64,
                region,
                filter,
                cull_back_faces: true,
                ..Settings::default()
            };
            assert_eq!(
                SettingsOptions::from(&settings)
                    .settings(Look { is_lit: true, ..Look::default() })
                    .unwrap(),
                settings
            );
        }
    }

    #[test]
    fn each_option_sets_its_field() {
        let line = "--size 64x36 --region 8,4,32,16 --msaa 8 --cull --tile 16 --exposure -1.5 --tone neutral --lighting lit --parallax off --silhouette off --filter ewa";
        let options = options(&format!("{line} {OF_FILTERS}")).unwrap();
        let (derivatives, formulas) = (Derivatives::Flat, Formulas::Printed);
        let (texel_budget, max_anisotropy) = (0, 8.0);
        let ewa = Ewa {
            derivatives,
            formulas,
            lines: 6,
            texel_budget,
            max_anisotropy,
            every_texel: true,
            cut: 1.25,
            texel_kernel: 0.5,
        };
        let visibility = Visibility::TwoEnded;
        let visible = Visible {
            visibility,
            derivatives,
            formulas,
            texel_budget,
            max_anisotropy,
            max_stretch: 3.0,
        };
        let expected = [
            Filter::Nearest,
            Filter::Bilinear,
            Filter::Trilinear(Trilinear { derivatives, formulas }),
            Filter::Ewa(ewa),
            Filter::Visible(visible),
            Filter::Horizon(Horizon {
                lines: 6,
                far_field: false,
                far_field_mib: 7,
                max_anisotropy,
            }),
            Filter::Parallax(Rays { samples: 5 }),
            Filter::Truth(Rays { samples: 5 }),
        ];
        assert_eq!(Filter::ALL.map(|filter| options.filter.apply(filter)), expected);
        let expected = Settings {
            width: 64,
            height: 36,
            region: Some(Region { x: 8, y: 4, width: 32, height: 16 }),
            filter: Filter::Ewa(ewa),
            parallax: false,
            silhouette: false,
            lighting: Lighting::Lit,
            cull_back_faces: true,
            msaa: 8,
            exposure: -1.5,
            tone: Tone::Neutral,
            tile_size: 16,
        };
        assert_eq!(options.settings(Look::default()).unwrap(), expected);
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
            // Whatever filter is chosen.
            for (filter, ..) in choices::FILTERS {
                let text = parse(&format!("{line} --filter {filter}")).unwrap_err().to_string();
                assert!(text.contains(option), "{line}: {text}");
            }
        }
    }
}
