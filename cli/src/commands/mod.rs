//! One file for each subcommand.

mod bench;
mod compare;
mod golden;
mod inspect;
mod join;
mod manual;
mod measure;
mod render;
mod study;
#[cfg(feature = "viewer")]
mod view;

use crate::options::args::{Cli, Command};
use crate::refusal::Refusal;
use std::process::ExitCode;

/// Runs the subcommand that the command line names.
pub(crate) fn run(cli: Cli) -> Result<ExitCode, Refusal> {
    match cli.command.unwrap_or(Command::Render(cli.render)) {
        Command::Render(options) => render::run(options),
        Command::Compare(options) => compare::run(&options),
        Command::Join(options) => join::run(&options),
        Command::Completions { shell } => manual::completions(shell),
        Command::Man { output } => manual::man(output.as_deref()),
        Command::Inspect(options) => inspect::run(options),
        Command::Study(options) => study::run(options),
        Command::Bench(options) => bench::run(&options),
        #[cfg(feature = "viewer")]
        Command::View(options) => view::run(options),
        #[cfg(not(feature = "viewer"))]
        Command::View { .. } => Err("view: this program was built without the feature viewer; \
                                     cargo install --path cli --features viewer builds it"
            .into()),
    }
}
