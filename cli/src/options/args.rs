//! The command line as a whole. The options of each subcommand stand in a file of its name.

use crate::options::bench::BenchOptions;
use crate::options::compare::CompareOptions;
use crate::options::inspect::InspectOptions;
use crate::options::join::JoinOptions;
use crate::options::render::RenderOptions;
use crate::options::study::StudyOptions;
use crate::options::version;
#[cfg(feature = "viewer")]
use crate::options::viewer;
use crate::refusal::Refusal;
use basrelief::{Scene, Settings};
use clap::{CommandFactory, Parser, Subcommand};
use std::ffi::OsString;
use std::path::PathBuf;

/// Draws height-mapped surfaces on the CPU, with the texels that the relief hides left out of the
/// texture filter.
///
/// Without a subcommand it renders: `basrelief` draws the built-in scene to basrelief.png,
/// `basrelief scene.obj -o out.png` draws a file.
#[derive(Parser)]
#[command(name = "basrelief", version = version::text(), args_conflicts_with_subcommands = true, max_term_width = 120)]
#[command(args_override_self = true)]
#[command(after_long_help = EXIT_CODES)]
pub struct Cli {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
    #[command(flatten)]
    pub(crate) render: RenderOptions,
}

/// What scripts may rely on.
const EXIT_CODES: &str = "Exit codes:
  0    done
  1    a comparison is below its bound
  2    something is refused, said in one line on stderr; nothing is written
  130  interrupted; nothing half-written stays behind

Environment:
  NO_COLOR                   no colours or bold type, in this help as well
  BASRELIEF_ACCEPT=1         compare --golden accepts what it is given
  SLURM_ARRAY_TASK_ID, ...   the share of many frames that is drawn in a Slurm array
  JOB_COMPLETION_INDEX       the share in a Kubernetes Indexed Job, with --shards";

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Draw a scene to an image file (what happens without a subcommand)
    Render(RenderOptions),
    /// Measure how far two images are apart
    ///
    /// Prints the peak signal-to-noise ratio, the largest error with its pixel and channel, and the
    /// structural similarity (SSIM), of sRGB-encoded values over the pixels that are opaque in both
    /// images. EXR and HDR files are taken as linear. With --golden, tests images against those of
    /// a folder. Exit code 0; 1 if below --min-psnr or not golden; 2 if the images cannot be
    /// compared.
    Compare(CompareOptions),
    /// Show what one pixel sees and why: footprint, hidden texels, a cut through the relief, and
    /// the formulas' numbers
    Inspect(InspectOptions),
    /// Compare all filters on a scene with the truth: time, quality, pictures and charts on one
    /// page
    Study(StudyOptions),
    /// Measure how fast and how good every filter is on the standard scenes
    ///
    /// The scenes are made at start, the same on every machine: a floor, a steep wall, a curved
    /// body and a million triangles. Prints a table: the middle time of a frame, pixels and
    /// triangles a second, and decibels against the truth of a smaller picture. With --against,
    /// compares with an earlier run and says which differences are within noise.
    Bench(BenchOptions),
    /// Look around a scene in a window
    #[cfg(feature = "viewer")]
    #[command(after_help = viewer::KEYS)]
    View(viewer::ViewerOptions),
    /// Look around a scene in a window: not part of this build
    #[cfg(not(feature = "viewer"))]
    #[command(hide = true, disable_help_flag = true)]
    View {
        /// Whatever follows
        #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "...")]
        rest: Vec<OsString>,
    },
    /// Put the parts of a picture together that --region drew
    ///
    /// Reads PNG files that `render --region` wrote, which say where they lie, and writes the whole
    /// picture as PNG, row by row: no picture is too large. The parts must cover the picture and
    /// not overlap.
    Join(JoinOptions),
    /// Print the completions of a shell: bash, elvish, fish, powershell or zsh
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page, or write those of all subcommands into a folder
    Man {
        /// Folder for basrelief.1, basrelief-render.1 and so on
        #[arg(short, long, value_name = "DIR")]
        output: Option<PathBuf>,
    },
}

/// How a command line that does not parse ends the program.
pub enum Ending {
    /// It is wrong.
    Refused(Refusal),
    /// Help or version is asked for.
    Help(clap::Error),
}

impl Cli {
    /// Takes a command line apart, the program's name first.
    ///
    /// # Errors
    /// Where the command line is wrong, or asks for help.
    pub fn read(arguments: impl IntoIterator<Item = OsString>) -> Result<Self, Ending> {
        Self::try_parse_from(arguments).map_err(|e| {
            if e.use_stderr() { Ending::Refused(usage_line(&e).into()) } else { Ending::Help(e) }
        })
    }

    /// All options of pictures, and all words that they take.
    pub fn words() -> Vec<String> {
        let command = Self::command();
        let options =
            command.get_arguments().filter_map(|option| Some(format!("--{}", option.get_long()?)));
        let words = command.get_arguments().flat_map(|option| option.get_possible_values());
        options.chain(words.map(|word| word.get_name().to_owned())).collect()
    }

    /// The settings of the picture that is asked for, if one is. Places the camera and the lights
    /// of the options in `scene`.
    ///
    /// # Errors
    /// Where a setting is out of its range.
    pub fn picture(self, scene: &mut Scene) -> Result<Option<Settings>, Refusal> {
        let Command::Render(options) = self.command.unwrap_or(Command::Render(self.render)) else {
            return Ok(None);
        };
        options.scene.set(scene);
        options.settings.settings(options.scene.look()).map(Some)
    }
}

/// What clap has to say, without its hints on usage and help.
fn usage_line(error: &clap::Error) -> String {
    let text = error.render().to_string();
    let lines = text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
    let lines: Vec<&str> = lines
        .filter(|line| !line.is_empty() && !line.starts_with("For more information"))
        .collect();
    lines.join(" ").replace(" tip: ", "; ").trim_start_matches("error: ").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use basrelief::{Filter, Horizon};

    #[test]
    fn command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn refusals_are_one_line() {
        for args in [
            &["x", "--filter", "no"][..],
            &["x", "--what"],
            &["x", "compare", "a"],
            &["x", "--size", "0x0"],
        ] {
            let line = usage_line(&Cli::try_parse_from(args).err().unwrap());
            assert!(
                !line.contains('\n') && !line.contains("Usage") && !line.starts_with("error"),
                "{line}"
            );
        }
    }

    #[test]
    fn the_last_of_an_option_counts() {
        let line = "x -q --size 8x8 --sun 0,1,0 -f ewa --cull --wrap clamp -q --size 16x9 -f horizon --cull=off \
                    --sun 1,0,0 --wrap mirror --lines 4 --lines 6 --point-light 1,2,3";
        for start in ["x model.obj", "x render model.obj"] {
            let line = line.replacen('x', start, 1);
            let cli = Cli::read(line.split_whitespace().map(Into::into)).ok().unwrap();
            let mut scene = Scene::default();
            let settings = cli.picture(&mut scene).unwrap().unwrap();
            assert_eq!((settings.width, settings.height), (16, 9));
            let horizon = Horizon { lines: 6, ..Horizon::default() };
            assert!(settings.filter == Filter::Horizon(horizon) && !settings.cull_back_faces);
            // Lights add up.
            assert_eq!(scene.lights.len(), 3);
        }
    }
}
