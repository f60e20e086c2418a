//! Which filters are studied, and with which options.

use basrelief::{Derivatives, Filter, Settings, Visibility};

/// A filter with its options.
pub(crate) struct Trial {
    /// A short name.
    pub(crate) name: &'static str,
    /// What sets it on the command line.
    pub(crate) options: &'static str,
    change: fn(&mut Settings),
}

impl Trial {
    /// The settings of the trial, given those of the study.
    pub(crate) fn settings(&self, settings: &Settings) -> Settings {
        let mut settings = settings.clone();
        (self.change)(&mut settings);
        settings
    }
}

/// Trials of one filter stand together, so that its tables are built once.
pub(crate) const TRIALS: &[Trial] = &[
    Trial { name: "nearest", options: "--filter nearest", change: |s| s.filter = Filter::Nearest },
    Trial { name: "bilinear", options: "--filter bilinear", change: |s| s.filter = Filter::Bilinear },
    Trial { name: "trilinear", options: "--filter trilinear", change: |s| s.filter = Filter::Trilinear },
    Trial {
        name: "EWA (2)",
        options: "--filter ewa --derivatives flat",
        change: |s| (s.filter, s.derivatives) = (Filter::Ewa, Derivatives::Flat),
    },
    Trial {
        name: "EWA (3)",
        options: "--filter ewa --derivatives relief",
        change: |s| (s.filter, s.derivatives) = (Filter::Ewa, Derivatives::Relief),
    },
    Trial {
        name: "visible, two-ended",
        options: "--filter visible --visible two-ended",
        change: |s| (s.filter, s.visibility) = (Filter::Visible, Visibility::TwoEnded),
    },
    Trial {
        name: "visible, exact",
        options: "--filter visible --visible exact",
        change: |s| (s.filter, s.visibility) = (Filter::Visible, Visibility::Exact),
    },
    Trial {
        name: "parallax, 1 ray",
        options: "--filter parallax --samples 1",
        change: |s| (s.filter, s.samples) = (Filter::Parallax, 1),
    },
    Trial {
        name: "parallax, 4 rays",
        options: "--filter parallax --samples 4",
        change: |s| (s.filter, s.samples) = (Filter::Parallax, 4),
    },
    Trial {
        name: "parallax, 16 rays",
        options: "--filter parallax --samples 16",
        change: |s| (s.filter, s.samples) = (Filter::Parallax, 16),
    },
    Trial {
        name: "horizon, no tables",
        options: "--filter horizon --far-field off",
        change: |s| (s.filter, s.far_field) = (Filter::Horizon, false),
    },
    Trial {
        name: "horizon, 4 lines",
        options: "--filter horizon --lines 4",
        change: |s| (s.filter, s.lines) = (Filter::Horizon, 4),
    },
    Trial { name: "horizon", options: "--filter horizon", change: |s| s.filter = Filter::Horizon },
    Trial {
        name: "horizon, 16 lines",
        options: "--filter horizon --lines 16",
        change: |s| (s.filter, s.lines) = (Filter::Horizon, 16),
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::args::{Cli, Command};
    use crate::options::choices::FILTERS;
    use clap::Parser;

    #[test]
    fn options_are_those_of_the_command_line() {
        for trial in TRIALS {
            let line = ["basrelief", "render"].into_iter().chain(trial.options.split(' '));
            let Some(Command::Render(options)) = Cli::try_parse_from(line).unwrap().command else { panic!("render") };
            assert_eq!(
                options.settings.settings(false).unwrap(),
                trial.settings(&Settings::default()),
                "{}",
                trial.name
            );
        }
    }

    #[test]
    fn every_filter_is_tried() {
        for &(word, filter, _) in FILTERS {
            let is_tried = TRIALS.iter().any(|trial| trial.settings(&Settings::default()).filter == filter);
            assert!(is_tried || filter == Filter::Truth, "{word}");
        }
    }
}
