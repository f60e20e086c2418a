//! The program around the library: one file for each subcommand, and what they share.
//!
//! Exit codes: 0 done, 1 a comparison below its bound, 2 refused with one line on stderr, 130 interrupted.

mod args;
mod camera_path;
mod choices;
mod compare;
mod draw;
mod file_values;
mod frames;
mod golden;
mod inspect;
mod join;
mod manual;
mod measured;
mod output;
mod picture;
mod progress;
mod render;
mod scene;
mod scene_file;
mod settings;
mod shard;
mod stats;
mod study;
mod values;
mod version;
#[cfg(feature = "viewer")]
mod view;

pub(crate) use args::{Cli, Command};
use clap::Parser;
use std::ffi::OsString;
use std::process::ExitCode;

/// Why a subcommand ends early: one line for the user.
pub(crate) type Refusal = String;

/// Crates that read files. The library contains their panics and refuses the file, which says enough.
const READERS: [&str; 6] = ["exr-", "image-", "png-", "tiff-", "tobj-", "zune-"];

/// Keeps quiet about panics in [`READERS`]; all others are reported as before.
fn silence_readers() {
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        let file = panic.location().map_or("", |location| location.file());
        if !READERS.iter().any(|reader| file.contains(reader)) {
            report(panic);
        }
    }));
}

/// Runs the subcommand that the command line names.
pub(crate) fn run() -> ExitCode {
    silence_readers();
    let cli = match parse(std::env::args_os()) {
        Ok(cli) => cli,
        Err(Ending::Refused(text)) => return refuse(&text),
        Err(Ending::Help(help)) => return print_help(&help),
    };
    output::clean_up_on_interrupt();
    let outcome = match cli.command.unwrap_or(Command::Render(cli.render)) {
        Command::Render(options) => render::run(options),
        Command::Compare(options) => compare::run(&options),
        Command::Join(options) => join::run(&options),
        Command::Completions { shell } => manual::completions(shell),
        Command::Man { output } => manual::man(output.as_deref()),
        Command::Inspect(options) => inspect::run(options),
        Command::Study(options) => study::run(options),
        #[cfg(feature = "viewer")]
        Command::View(options) => view::run(options),
        #[cfg(not(feature = "viewer"))]
        Command::View { .. } => Err("view: this program was built without the feature viewer; \
                                     cargo install --path . --features viewer builds it"
            .into()),
    };
    outcome.unwrap_or_else(|refusal| refuse(&refusal))
}

/// How a command line that does not parse ends the program.
pub(crate) enum Ending {
    Refused(Refusal),
    /// Help or version, asked for.
    Help(clap::Error),
}

/// Takes a command line apart, the program's name first.
pub(crate) fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Cli, Ending> {
    Cli::try_parse_from(arguments)
        .map_err(|e| if e.use_stderr() { Ending::Refused(usage_line(&e)) } else { Ending::Help(e) })
}

fn refuse(text: &str) -> ExitCode {
    eprintln!("basrelief: {}", one_line(text));
    ExitCode::from(2)
}

fn print_help(help: &clap::Error) -> ExitCode {
    // A closed pipe, as of `basrelief --help | head`, is no failure.
    let _ = help.print();
    ExitCode::SUCCESS
}

/// What clap has to say, without its hints on usage and help.
fn usage_line(error: &clap::Error) -> String {
    let text = error.render().to_string();
    let lines = text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
    let lines: Vec<&str> = lines.filter(|line| !line.is_empty() && !line.starts_with("For more information")).collect();
    lines.join(" ").replace(" tip: ", "; ").trim_start_matches("error: ").to_owned()
}

/// `text` with control characters, such as a line break in a file's name, made visible.
pub(crate) fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { c.escape_default().to_string() } else { c.to_string() }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn messages_are_one_line() {
        assert_eq!(one_line("a\nb\u{1b}[1m"), "a\\nb\\u{1b}[1m");
        for args in [&["x", "--filter", "no"][..], &["x", "--what"], &["x", "compare", "a"], &["x", "--size", "0x0"]] {
            let line = usage_line(&Cli::try_parse_from(args).err().unwrap());
            assert!(!line.contains('\n') && !line.contains("Usage") && !line.starts_with("error"), "{line}");
        }
    }
}
