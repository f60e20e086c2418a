//! Why a command ends early, in the words of the command line.

use basrelief::Error;
use std::fmt::{Display, Formatter, Result};
use std::path::Path;

/// Why a command ends early: one line for the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal(String);

impl Refusal {
    /// A refusal of a file.
    pub(crate) fn file(path: &Path, reason: impl Display) -> Self {
        Self(format!("{}: {reason}", path.display()))
    }
}

impl Display for Refusal {
    /// Control characters, such as a line break in a file's name, become visible.
    fn fmt(&self, to: &mut Formatter) -> Result {
        to.write_str(&one_line(&self.0))
    }
}

impl std::error::Error for Refusal {}

impl From<String> for Refusal {
    fn from(text: String) -> Self {
        Self(text)
    }
}

impl From<&str> for Refusal {
    fn from(text: &str) -> Self {
        Self(text.into())
    }
}

/// What the library refuses, by the options that set it.
impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        match error {
            Error::Setting { name, reason } => Self(format!("{}: {reason}", option_of(name))),
            Error::Scene { part, reason } if part == "camera" => Self(format!(
                "the camera (--eye, --target, --up, --fov, --intrinsics, --orthographic, --pose, \
                 --near): {reason}"
            )),
            Error::Limit { option, .. } => {
                let text = error.to_string();
                let reason = text.strip_suffix(&format!("({option})")).unwrap_or(&text);
                Self(format!("{reason}({})", option_of(option)))
            }
            _ => Self(error.to_string()),
        }
    }
}

/// `text` on one line, its control characters visible.
pub(crate) fn one_line(text: &str) -> String {
    let visible = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.into() };
    text.chars().map(visible).collect()
}

/// The option that sets a field of the settings or of the load options.
pub(crate) fn option_of(field: &str) -> String {
    match field {
        "width" | "height" => "--size".into(),
        "cull_back_faces" => "--cull".into(),
        "tile_size" => "--tile".into(),
        _ => format!("--{}", field.replace('_', "-")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refusals_are_one_line() {
        assert_eq!(Refusal::from("a\nb\u{1b}[1m").to_string(), "a\\nb\\u{1b}[1m");
    }
}
