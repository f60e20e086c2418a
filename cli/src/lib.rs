//! The program `basrelief` as a library: its command line, and what each subcommand does.
//!
//! Exit codes: 0 done, 1 a comparison below its bound, 2 refused with one line on stderr,
//! 130 interrupted.
#![forbid(unsafe_code)]

mod commands;
mod machine;
mod options;
mod output;
mod pictures;
mod progress;
mod refusal;
mod stats;
mod timing;
#[cfg(feature = "viewer")]
mod view;

pub use options::args::{Cli, Ending};
pub use refusal::Refusal;
use std::process::ExitCode;

/// Crates that read files. The library contains their panics and refuses the file, which says
/// enough.
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

/// Runs the subcommand that the command line names, and says on stderr why it ends early if it
/// does.
pub fn run() -> ExitCode {
    silence_readers();
    let cli = match Cli::read(std::env::args_os()) {
        Ok(cli) => cli,
        Err(Ending::Refused(refusal)) => return refuse(&refusal),
        Err(Ending::Help(help)) => return print_help(&help),
    };
    output::clean_up_on_interrupt();
    commands::run(cli).unwrap_or_else(|refusal| refuse(&refusal))
}

fn refuse(refusal: &Refusal) -> ExitCode {
    eprintln!("basrelief: {refusal}");
    ExitCode::from(2)
}

fn print_help(help: &clap::Error) -> ExitCode {
    // A closed pipe, as of `basrelief --help | head`, is no failure.
    let _ = help.print();
    ExitCode::SUCCESS
}
