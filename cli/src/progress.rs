//! What the user sees on stderr while waiting.

use crate::refusal::one_line;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;

/// A line of progress where stderr is a terminal, and messages for the user.
pub(crate) struct Progress {
    bar: ProgressBar,
    is_quiet: bool,
}

impl Progress {
    /// Shows nothing but warnings if `is_quiet`.
    pub(crate) fn new(is_quiet: bool) -> Self {
        let is_shown = !is_quiet && std::io::stderr().is_terminal();
        let bar = if is_shown { ProgressBar::new_spinner() } else { ProgressBar::hidden() };
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} {elapsed}") {
            bar.set_style(style);
        }
        Self { bar, is_quiet }
    }

    /// Shows what is being done.
    pub(crate) fn stage(&self, text: impl Into<String>) {
        self.bar.set_message(text.into());
        self.bar.tick();
    }

    /// Shows how much of so many steps is done, from now on.
    pub(crate) fn count(&self, num: u64) {
        self.bar.set_length(num);
        if let Ok(style) = ProgressStyle::with_template("{bar:24} {pos} of {len}, {msg} {elapsed}")
        {
            self.bar.set_style(style);
        }
    }

    /// One of the steps is done.
    pub(crate) fn step(&self) {
        self.bar.inc(1);
    }

    /// Tells the user something, unless quiet.
    pub(crate) fn say(&self, text: &str) {
        if !self.is_quiet {
            self.bar.suspend(|| eprintln!("{}", one_line(text)));
        }
    }

    /// Warns the user, even if quiet.
    pub(crate) fn warn(&self, text: &str) {
        self.bar.suspend(|| eprintln!("warning: {}", one_line(text)));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
