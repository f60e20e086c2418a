//! `basrelief completions` and `basrelief man`: what clap knows of the command line, for shells and
//! readers.

use crate::options::args::Cli;
use crate::output;
use crate::refusal::Refusal;
use clap::CommandFactory;
use clap_complete::Shell;
use std::path::Path;
use std::process::ExitCode;

/// Prints the completions of a shell.
pub(crate) fn completions(shell: Shell) -> Result<ExitCode, Refusal> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "basrelief", &mut script);
    output::print(&script)?;
    Ok(ExitCode::SUCCESS)
}

/// Prints the manual page, or writes one for each subcommand into `folder`.
pub(crate) fn man(folder: Option<&Path>) -> Result<ExitCode, Refusal> {
    let mut command = Cli::command();
    command.build();
    let Some(folder) = folder else {
        output::print(&page(&command)?)?;
        return Ok(ExitCode::SUCCESS);
    };
    // The help of a help has no page.
    let subcommands =
        command.get_subcommands().filter(|subcommand| subcommand.get_name() != "help");
    for command in subcommands.chain([&command]) {
        let name = command.get_display_name().unwrap_or(command.get_name());
        output::write(&folder.join(format!("{name}.1")), &page(command)?)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn page(command: &clap::Command) -> Result<Vec<u8>, Refusal> {
    let mut page = Vec::new();
    // The version's further lines are of this machine, and none of a manual's.
    let command = command.clone().version(env!("CARGO_PKG_VERSION"));
    clap_mangen::Man::new(command).render(&mut page).map_err(|e| format!("manual page: {e}"))?;
    Ok(page)
}
