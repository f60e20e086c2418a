//! Which filters are studied, and with which options.

use crate::options::choices::{FILTERS, Words};
use crate::options::filter::FilterOptions;
use crate::refusal::Refusal;
use basrelief::{Filter, Rays};
use clap::Parser;

/// A filter with its options.
#[derive(Clone)]
pub(crate) struct Trial {
    /// A short name.
    pub(crate) name: &'static str,
    /// What sets it on the command line.
    pub(crate) options: String,
    /// With these options, and those of the study where they say nothing.
    pub(crate) filter: Filter,
}

/// Name and options. A filter without a line is tried by its own name as it is.
const TRIALS: &[(&str, &str)] = &[
    ("nearest", "--filter nearest"),
    ("bilinear", "--filter bilinear"),
    ("trilinear", "--filter trilinear"),
    ("EWA (2)", "--filter ewa --derivatives flat"),
    ("EWA (3)", "--filter ewa --derivatives relief"),
    ("visible, two-ended", "--filter visible --visible two-ended"),
    ("visible, exact", "--filter visible --visible exact"),
    ("parallax, 1 ray", "--filter parallax --samples 1"),
    ("parallax, 4 rays", "--filter parallax --samples 4"),
    ("parallax, 16 rays", "--filter parallax --samples 16"),
    ("horizon, no tables", "--filter horizon --far-field off"),
    ("horizon, 4 lines", "--filter horizon --lines 4"),
    ("horizon", "--filter horizon"),
    ("horizon, 16 lines", "--filter horizon --lines 16"),
];

/// All trials, each with the options that are `given` where its own say nothing.
pub(crate) fn all(given: &FilterOptions) -> Result<Vec<Trial>, Refusal> {
    let trial = |name, options: String| Trial::new(name, options, given);
    let mut trials: Vec<_> = TRIALS
        .iter()
        .map(|&(name, options)| trial(name, options.into()))
        .collect::<Result<_, _>>()?;
    for &(word, filter, _) in FILTERS {
        // The truth is what all are held against.
        let is_tried = |trial: &Trial| trial.filter.is_same_choice(&filter);
        if !trials.iter().any(is_tried) && !filter.is_same_choice(&Filter::Truth(Rays::default())) {
            trials.push(trial(word, format!("--filter {word}"))?);
        }
    }
    Ok(trials)
}

/// The options of a trial as a command line.
#[derive(Parser)]
#[command(no_binary_name = true)]
struct Line {
    #[command(flatten)]
    filter: FilterOptions,
}

impl Trial {
    fn new(name: &'static str, options: String, given: &FilterOptions) -> Result<Self, Refusal> {
        let mut line = Line { filter: given.clone() };
        line.try_update_from(options.split(' ')).map_err(|e| e.to_string())?;
        Ok(Self { name, filter: line.filter.chosen(), options })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use basrelief::{Derivatives, Ewa, Horizon};

    /// The trials without options of the study's own.
    pub(in super::super) fn defaults() -> Vec<Trial> {
        all(&FilterOptions::default()).unwrap()
    }

    fn named(trials: &[Trial], name: &str) -> Filter {
        trials.iter().find(|trial| trial.name == name).unwrap().filter
    }

    #[test]
    fn options_are_those_of_the_command_line() {
        let trials = defaults();
        assert!(trials.len() >= TRIALS.len());
        assert_eq!(named(&trials, "horizon"), Filter::default());
        let horizon = Horizon { lines: 16, ..Horizon::default() };
        assert_eq!(named(&trials, "horizon, 16 lines"), Filter::Horizon(horizon));
        let ewa = Ewa { derivatives: Derivatives::Flat, ..Ewa::default() };
        assert_eq!(named(&trials, "EWA (2)"), Filter::Ewa(ewa));
    }

    #[test]
    fn options_of_the_study_stand_below_those_of_a_trial() {
        let given = Horizon { lines: 7, max_anisotropy: 8.0, ..Horizon::default() };
        let trials = all(&Filter::Horizon(given).into()).unwrap();
        assert_eq!(named(&trials, "horizon"), Filter::Horizon(given));
        assert_eq!(
            named(&trials, "horizon, 4 lines"),
            Filter::Horizon(Horizon { lines: 4, ..given })
        );
        let ewa = Ewa { lines: 7, max_anisotropy: 8.0, ..Ewa::default() };
        assert_eq!(named(&trials, "EWA (3)"), Filter::Ewa(ewa));
    }

    #[test]
    fn every_filter_is_tried_but_the_truth() {
        let trials = defaults();
        for (word, filter, _) in FILTERS {
            let is_tried = trials.iter().any(|trial| trial.filter.is_same_choice(filter));
            assert!(is_tried != (*word == "truth"), "{word}");
        }
    }
}
