//! Options that say how a frame is drawn, and what they are called where the library refuses one.

use super::choices::{self, one_of, word};
use super::{Refusal, values};
use basrelief::{Derivatives, Error, Filter, Formulas, Lighting, Settings, Visibility};
use clap::Args;
use std::sync::LazyLock;

/// What an option is where it is not given.
static DEFAULT: LazyLock<Settings> = LazyLock::new(Settings::default);

#[derive(Args)]
#[command(next_help_heading = "Frame")]
pub(crate) struct SettingsOptions {
    /// Width and height of the picture in pixels
    #[arg(short, long, value_name = "WxH", default_value = "1280x720", value_parser = values::size, allow_hyphen_values = true)]
    size: [u32; 2],
    /// Samples a pixel for edges; surfaces are still shaded once a pixel
    #[arg(long, value_name = "N", default_value = word(choices::MSAA, &DEFAULT.msaa), value_parser = one_of(choices::MSAA))]
    msaa: u32,
    /// Leave out triangles seen from behind
    #[arg(long)]
    cull: bool,
    /// Side of the squares that threads draw, in pixels: 8, 16, 32, 64, 128 or 256; the picture stays the same
    #[arg(long, value_name = "N", default_value_t = DEFAULT.tile_size)]
    tile: u32,
    /// Whether lights are evaluated [default: unlit, or lit where a light is given]
    #[arg(long, value_name = "HOW", value_parser = one_of(choices::LIGHTING))]
    lighting: Option<Lighting>,

    #[command(flatten)]
    filter: FilterOptions,
}

#[derive(Args)]
#[command(next_help_heading = "Texture filter")]
struct FilterOptions {
    /// Which texels make up a pixel's colour
    #[arg(short, long, default_value = word(choices::FILTERS, &DEFAULT.filter), value_parser = one_of(choices::FILTERS))]
    filter: Filter,
    /// How --filter visible finds the hidden texels
    #[arg(long, value_name = "HOW", default_value = word(choices::VISIBILITIES, &DEFAULT.visibility), value_parser = one_of(choices::VISIBILITIES))]
    visible: Visibility,
    /// Whether the relief is traced; off draws flat polygons
    #[arg(long, value_name = "on|off", action = clap::ArgAction::Set, hide_possible_values = true, default_value = word(choices::ON_OFF, &DEFAULT.parallax), value_parser = one_of(choices::ON_OFF))]
    parallax: bool,
    /// Which texture coordinates a pixel's ellipse comes from
    #[arg(long, value_name = "OF", default_value = word(choices::DERIVATIVES, &DEFAULT.derivatives), value_parser = one_of(choices::DERIVATIVES))]
    derivatives: Derivatives,
    /// Which reading of the paper's formulas to use
    #[arg(long, value_name = "AS", default_value = word(choices::FORMULAS, &DEFAULT.formulas), value_parser = one_of(choices::FORMULAS))]
    formulas: Formulas,
    /// Choose the mip level so that an ellipse holds at most N texels; 0: always the full texture, as in the paper
    #[arg(long, value_name = "N", default_value_t = DEFAULT.texel_budget)]
    texel_budget: u32,
    /// Longest ellipse, as the ratio of its axes, 1 to 1e6; longer ones are widened
    #[arg(long, value_name = "N", default_value_t = DEFAULT.max_anisotropy, value_parser = values::number, allow_hyphen_values = true)]
    max_anisotropy: f32,
    /// For --filter visible: a derivative of formula (3) this many times as long as that of (2) is a jump of the relief,
    /// and (2) is taken; 1 to 1000000, or 0 for never, as in the paper
    #[arg(long, value_name = "N", default_value_t = DEFAULT.max_stretch, value_parser = values::number, allow_hyphen_values = true)]
    max_stretch: f32,
    /// Rays a pixel of --filter truth and parallax, 1 to 65536
    #[arg(long, value_name = "N", default_value_t = DEFAULT.samples)]
    samples: u32,
    /// Most lines that --filter horizon sweeps through a pixel's ellipse, 2 to 64; more is finer and slower
    #[arg(long, value_name = "N", default_value_t = DEFAULT.lines)]
    lines: u32,
    /// Whether --filter horizon keeps tables for distant surfaces
    #[arg(long, value_name = "on|off", action = clap::ArgAction::Set, hide_possible_values = true, default_value = word(choices::ON_OFF, &DEFAULT.far_field), value_parser = one_of(choices::ON_OFF))]
    far_field: bool,
    /// Most memory of those tables for each material in MiB, 1 to 4096
    #[arg(long, value_name = "N", default_value_t = DEFAULT.far_field_mib)]
    far_field_mib: u32,
}

impl SettingsOptions {
    /// The settings; `has_lights` says whether the command line names a light.
    pub(crate) fn settings(&self, has_lights: bool) -> Result<Settings, Refusal> {
        let [width, height] = self.size;
        let filter = &self.filter;
        let settings = Settings {
            width,
            height,
            filter: filter.filter,
            visibility: filter.visible,
            parallax: filter.parallax,
            derivatives: filter.derivatives,
            formulas: filter.formulas,
            texel_budget: filter.texel_budget,
            max_anisotropy: filter.max_anisotropy,
            max_stretch: filter.max_stretch,
            samples: filter.samples,
            lines: filter.lines,
            far_field: filter.far_field,
            far_field_mib: filter.far_field_mib,
            lighting: self.lighting.unwrap_or(if has_lights { Lighting::Lit } else { Lighting::Unlit }),
            cull_back_faces: self.cull,
            msaa: self.msaa,
            tile_size: self.tile,
        };
        settings.validate().map_err(|e| refusal(&e))?;
        Ok(settings)
    }
}

/// What the library refuses, in the words of the command line.
pub(crate) fn refusal(error: &Error) -> Refusal {
    match error {
        Error::Setting { name, reason } => format!("{}: {reason}", option_of(name)),
        Error::Scene { part, reason } if part == "camera" => {
            format!("the camera (--eye, --target, --up, --fov, --near): {reason}")
        }
        _ => with_options(error.to_string()),
    }
}

/// Fields of the load options that messages about files name.
const LIMITS: &[&str] = &["max_image_side", "max_image_mib", "max_triangles", "max_textures", "max_pixels"];

fn with_options(text: String) -> Refusal {
    LIMITS.iter().fold(text, |text, field| text.replace(field, &option_of(field)))
}

/// The option that sets a field of [`Settings`] or of the load options.
fn option_of(field: &str) -> String {
    match field {
        "width" | "height_pixels" => "--size".into(),
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
    fn each_option_sets_its_field() {
        let line = "--size 64x36 --msaa 4 --cull --tile 16 --lighting lit --filter horizon --visible two-ended \
                    --parallax off --derivatives flat --formulas printed --texel-budget 0 --max-anisotropy 8 --max-stretch 3 \
                    --samples 5 --lines 6 --far-field off --far-field-mib 7";
        let expected = Settings {
            width: 64,
            height: 36,
            filter: Filter::Horizon,
            visibility: Visibility::TwoEnded,
            parallax: false,
            derivatives: Derivatives::Flat,
            formulas: Formulas::Printed,
            texel_budget: 0,
            max_anisotropy: 8.0,
            max_stretch: 3.0,
            samples: 5,
            lines: 6,
            far_field: false,
            far_field_mib: 7,
            lighting: Lighting::Lit,
            cull_back_faces: true,
            msaa: 4,
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
            ("--max-stretch 0.5", "--max-stretch"),
            ("--max-stretch nan", "--max-stretch"),
            ("--msaa 3", "--msaa"),
            ("--size 1x0", "--size"),
        ] {
            let text = parse(line).unwrap_err();
            assert!(text.contains(option), "{line}: {text}");
        }
    }
}
